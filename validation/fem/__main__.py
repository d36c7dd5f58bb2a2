"""Recompute the studies: ``python -m validation.fem [NAME ...] [--processes N]``."""

from __future__ import annotations

import argparse
import os
import sys
import time

from tqdm import tqdm

from validation.fem.studies import STUDIES


def main(arguments: list[str] | None = None) -> int:
    """Run the studies named, or all; 0 when done, 2 for wrong usage."""
    parser = argparse.ArgumentParser(prog="python -m validation.fem", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(STUDIES)}")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args(arguments)
    wrong = set(options.names) - set(STUDIES)
    if wrong:
        parser.error(f"no such study: {', '.join(wrong)}; there are {', '.join(STUDIES)}")
    for name in tqdm(options.names or list(STUDIES), "studies", disable=None):
        start = time.perf_counter()
        STUDIES[name](options.processes)
        tqdm.write(f"{name:14s} {time.perf_counter() - start:6.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
