"""Run all benchmarks and print a table of targets: ``python -m validation.bench [NAME ...]``."""

from __future__ import annotations

import importlib
import platform
import sys

from tqdm import tqdm

from contactlaw.parser import Parser

SUBJECTS = "lookups", "solver", "processes", "lammps"


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
            tqdm.write(str(row))
            met &= row.met
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
