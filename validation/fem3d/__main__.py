"""Compute oblique impacts: ``python -m validation.fem3d [NAME ...]``, the names of `cases.SEEDS`.

It goes on where it was stopped, and prints what there is, the model's answer beside it; an impact
takes a minute. In the last column is 1 where the model flags that friction makes a body flow.
"""

from __future__ import annotations

import argparse
import sys

import contactlaw as cl
from validation.fem3d import cases

_COLUMNS = (
    "kind", "R/H", "mu", "psi", "psi'", "J_t/J_n", "e", "e normal", "mu p/sY", "slide/a",
    "psi' of the model", "less that of elements", "flag",
)  # fmt: skip


def main(arguments: list[str] | None = None) -> int:
    """Compute the named impacts, or all; 0: done, 2: wrong usage, 130: Ctrl-C."""
    parser = argparse.ArgumentParser(prog="python -m validation.fem3d")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(cases.SEEDS)}")
    options = parser.parse_args(arguments)
    if wrong := set(options.names) - set(cases.SEEDS):
        parser.error(f"no such impacts: {', '.join(wrong)}; there are {', '.join(cases.SEEDS)}")
    try:
        for name in options.names or cases.SEEDS:
            print(name, *_COLUMNS, sep="\t")
            for case, hit in cases.compute(name):
                pressure, model = hit["pressure"] / case.strength, cases.model(case)
                psi = float(model.sliding_speed / (case.friction * case.speed))
                values = (
                    case.slimness, case.friction, case.psi, hit["psi_after"], hit["impulse_ratio"],
                    hit["restitution"], hit["normal_restitution"], case.friction * pressure,
                    hit["slide"] / hit["contact_radius"], psi, psi - hit["psi_after"],
                    bool(model.flags & cl.Validity.SLIDING_FLOW),
                )  # fmt: skip
                row = "\t".join(f"{value:.4g}" for value in values)
                print(f"\t{case.kind}\t{row}", flush=True)
    except KeyboardInterrupt:
        print("interrupted; the impacts that were finished are kept", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
