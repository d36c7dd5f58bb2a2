"""Run all benchmarks and print a table of targets: ``python -m validation.bench [NAME ...]``."""

from __future__ import annotations

import importlib
import platform
import sys

from tqdm import tqdm

SUBJECTS = (
    "lookups",
    "histories",
    "solver",
    "fits",
    "startup",
    "processes",
    "rain",
    "elements",
    "c_header",
    "lammps",
    "meshes",
    "liggghts",
    "census",
)


def main(names: list[str]) -> int:
    """Print each row as it is measured; 0 if all targets are met, 1 if not, 2 for wrong usage."""
    wrong = set(names) - set(SUBJECTS)
    if wrong:
        print(f"no such benchmark: {', '.join(wrong)}; there are {', '.join(SUBJECTS)}")
        return 2
    print(f"{platform.processor() or platform.machine()}, Python {platform.python_version()}")
    print(f"{'':34s} {'measured':>12s} {'target':>8s}  peer")
    met = True
    for name in tqdm(names or SUBJECTS, desc="bench", disable=None, leave=False):
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
    sys.exit(main(sys.argv[1:]))
