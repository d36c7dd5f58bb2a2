"""Judge the model and reproduce the paper: ``python -m validation [--out DIR]``.

What takes long to import is imported inside `_write`, where Ctrl-C is already caught.
"""

from __future__ import annotations

import collections
import sys
from collections.abc import Sequence
from pathlib import Path

from contactlaw import _atomic
from contactlaw.parser import Parser
from dem_demo.kit.signals import Interrupted, interruptible


def main(argv: Sequence[str] | None = None) -> int:
    """Write report and pictures, all of them or none; print the count of each verdict.

    Returns
    -------
    int
        0: done; 1: a file cannot be read or written; 128 + signal: interrupted. Wrong usage exits
        with 2.
    """
    parser = Parser(
        prog="python -m validation",
        description="Say how accurate the model is, and reproduce the paper: its figures and "
        "numbers, and what holds of its claims.",
    )
    parser.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        default=Path(__file__).parent / "report",
        help="folder for index.html and the PNGs (default: %(default)s)",
    )
    out = parser.parse_args(argv).out
    try:
        with interruptible(), _atomic.folder(out) as folder:
            verdicts = _write(folder)
    except OSError as error:
        print(f"validation: {error}; nothing was written to --out {out}", file=sys.stderr)
        return 1
    except Interrupted as stop:
        print("\nvalidation: interrupted; nothing was written", file=sys.stderr)
        return stop.exit_status
    for verdict, count in verdicts.items():
        print(f"{count:3d} claims: {verdict}")
    print(out / "index.html")
    return 0


def _write(folder: Path) -> collections.Counter[str]:
    """Draw, judge and write; count the verdicts."""
    from tqdm import tqdm

    from contactlaw import style
    from validation import figures
    from validation.paper.claims import ROWS
    from validation.paper.verdicts import judge
    from validation.report import Picture, page

    drawn = []
    with style.applied():
        for name, (part, caption, draw) in tqdm(figures.drawings().items(), "validation: figures", disable=None):
            figure, numbers = draw()
            numbers = {key: float(number) for key, number in numbers.items()}
            one = Picture(name, part, caption, numbers, style.png(figure))
            (folder / one.file).write_bytes(one.png)
            drawn.append(one)
    found = tuple(judge(row) for row in tqdm(ROWS, "validation: claims", disable=None))
    (folder / "index.html").write_text(page(found, drawn), encoding="utf-8")
    return collections.Counter(claim.verdict for claim in found)


if __name__ == "__main__":
    sys.exit(main())
