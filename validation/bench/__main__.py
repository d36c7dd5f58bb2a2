"""Run all benchmarks and print a table of targets: ``python -m validation.bench [NAME ...]``."""

from __future__ import annotations

import importlib
import platform
import sys

from tqdm import tqdm

from contactlaw.parser import Parser

SUBJECTS = (
    "lookups",
    "histories",
    "solver",
    "fits",
    "uncertainty",
    "startup",
    "processes",
    "rain",
    "edges",
    "elements",
    "c_header",
    "lammps",
    "meshes",
    "liggghts",
    "census",
)


def main(arguments: list[str] | None = None) -> int:
    """Print each row as it is measured; 0 if all targets are met, 1 if not."""
    parser = Parser(prog="python -m validation.bench", description=__doc__)
    parser.add_argument("name", nargs="*", default=list(SUBJECTS), choices=SUBJECTS)
    names = parser.parse_args(arguments).name
    print(f"{platform.processor() or platform.machine()}, Python {platform.python_version()}")
    print(f"{'':34s} {'measured':>12s} {'target':>8s}  peer")
    met = True
    for name in tqdm(names, desc="bench", disable=None, leave=False):
        for row in importlib.import_module(f"{__package__}.{name}").rows():
            target = "-" if row.target is None else f"{row.target:g}"
            ratio = "" if row.ratio is None else f"{row.peer}: {row.ratio:.3g}x"
            if row.least_ratio is not None:
                ratio += f" (target {row.least_ratio:g}x)"
            verdict = "" if row.met else "NOT MET  "
            line = f"{row.name:34s} {row.measured:9.3g} {row.unit:2s} {target:>8s}  {ratio}"
            tqdm.write(f"{line}  {verdict}{row.note}".rstrip())
            met &= row.met
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
