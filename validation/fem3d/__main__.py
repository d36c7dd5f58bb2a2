"""Compute impacts: ``python -m validation.fem3d [NAME ...]``, names of `cases.SETS` or "edges".

It goes on where it was stopped, and prints what there is. An oblique impact takes a minute, one
near an edge about five. Beside an oblique impact is the model's answer, and in the last column 1
where the model flags that friction makes a body flow.
"""

from __future__ import annotations

import math
import sys

import contactlaw as cl
from contactlaw.parser import Parser
from validation.fem3d import cases, edges

_COLUMNS = (
    "kind",
    "R/H",
    "mu",
    "psi",
    "psi'",
    "J_t/J_n",
    "e",
    "e normal",
    "mu p/sY",
    "slide/a",
    "psi' of the model",
    "less that of elements",
    "flag",
)
_EDGE_COLUMNS = "kind", "R/H", "s/H", "hole/s", "across", "e", "wave", "plastic", "balance"
_NAMES = *cases.SETS, edges.NAME


def main(arguments: list[str] | None = None) -> int:
    """Compute the named impacts, or all; 0: done, 2: wrong usage, 130: Ctrl-C."""
    parser = Parser(prog="python -m validation.fem3d")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(_NAMES)}")
    options = parser.parse_args(arguments)
    if wrong := set(options.names) - set(_NAMES):
        parser.error(f"no such impacts: {', '.join(wrong)}; there are {', '.join(_NAMES)}")
    try:
        for name in options.names or _NAMES:
            _print_edges() if name == edges.NAME else _print_oblique(name)
    except KeyboardInterrupt:
        print("interrupted; the impacts that were finished are kept", file=sys.stderr)
        return 130
    return 0


def _print_oblique(name: str) -> None:
    print(name, *_COLUMNS, sep="\t")
    for case, hit in cases.compute(name, cases.Case, cases.solve):
        pressure, model = hit["pressure"] / case.strength, cases.model(case)
        psi = float(model.sliding_speed / (case.friction * case.speed))
        values = (
            case.slimness,
            case.friction,
            case.psi,
            hit["psi_after"],
            hit["impulse_ratio"],
            hit["restitution"],
            hit["normal_restitution"],
            case.friction * pressure,
            hit["slide"] / hit["contact_radius"],
            psi,
            psi - hit["psi_after"],
            bool(model.flags & cl.Validity.SLIDING_FLOW),
        )
        _print_row(case.kind, values)


def _print_edges() -> None:
    print(edges.NAME, *_EDGE_COLUMNS, sep="\t")
    for case, hit in cases.compute(edges.NAME, edges.Case, edges.solve):
        values = (
            case.radius / case.thickness,
            case.distance / case.thickness,
            case.hole / (case.distance or math.inf),
            case.across,
            *(hit[key] for key in ("restitution", "wave", "plastic", "balance")),
        )
        _print_row(case.kind, values)


def _print_row(kind: str, values: tuple[float, ...]) -> None:
    row = "\t".join(f"{value:.4g}" for value in values)
    print(f"\t{kind}\t{row}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
