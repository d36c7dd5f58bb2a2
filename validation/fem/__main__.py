"""Recompute the studies: ``python -m validation.fem [NAME ...] [--processes N]``.

``fit`` makes the numbers of the law ``"fem"`` from what is stored, ``acceptance`` prints its errors
and their bounds; ``python -m validation`` draws the stored results beside the model.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool

from tqdm import tqdm

from contactlaw.parser import Parser
from validation.accuracy import acceptance
from validation.fem import fit, store
from validation.fem.studies import STUDIES


def main(arguments: list[str] | None = None) -> int:
    """Run the named studies, or all; 0: done, 1: failed, 2: wrong usage, 130: Ctrl-C."""
    steps: dict[str, Callable[[int], None]] = {**STUDIES, "fit": fit.run, "acceptance": _acceptance}
    parser = Parser(prog="python -m validation.fem")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(steps)}")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args(arguments)
    if options.processes < 1:
        parser.error(f"--processes: must be 1 or more, got {options.processes}")
    wrong = set(options.names) - set(steps)
    if wrong:
        parser.error(f"no such study: {', '.join(wrong)}; there are {', '.join(steps)}")
    if not os.access(store.FOLDER, os.W_OK) and not set(options.names) <= {"acceptance"}:
        parser.error(f"{store.FOLDER}: results cannot be written there; take a writable copy")
    bar = tqdm(options.names or list(steps), disable=None)
    try:
        for name in bar:
            bar.set_description(name)
            start = time.perf_counter()
            steps[name](options.processes)
            tqdm.write(f"{name:14s} {time.perf_counter() - start:6.0f} s")
    except KeyboardInterrupt:
        bar.close()
        print("interrupted; the studies that were finished are kept", file=sys.stderr)
        return 130
    except (BrokenProcessPool, OSError) as error:
        bar.close()
        print(f"validation.fem: {name}: {error}", file=sys.stderr)
        return 1
    return 0


def _acceptance(_: int) -> None:
    tqdm.write(acceptance.report())


if __name__ == "__main__":
    sys.exit(main())
