"""Judge the model and reproduce the paper: ``python -m validation [PART ...] [--out DIR]``.

What takes long to import is imported inside `_write`, where Ctrl-C is already caught.
"""

from __future__ import annotations

import collections
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from contactlaw import _atomic
from contactlaw.parser import Parser
from dem_demo.kit.signals import Interrupted, interruptible
from validation.figures import PAPER, PARTS


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
        "parts",
        nargs="*",
        default=PARTS,
        metavar="PART",
        help=f"parts of the report: {', '.join(PARTS)} (default: all)",
    )
    parser.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        default=Path(__file__).parent / "report",
        help="folder for index.html and the PNGs (default: %(default)s)",
    )
    options = parser.parse_args(argv)
    if wrong := set(options.parts) - set(PARTS):
        parser.error(f"no such part: {', '.join(wrong)}; there are {', '.join(PARTS)}")
    start = time.perf_counter()
    try:
        with interruptible(), _atomic.folder(options.out) as folder:
            verdicts = _write(folder, options.parts)
    except OSError as error:
        print(f"validation: {error}; nothing was written to --out {options.out}", file=sys.stderr)
        return 1
    except Interrupted as stop:
        print("\nvalidation: interrupted; nothing was written", file=sys.stderr)
        return stop.exit_status
    for verdict, count in verdicts.items():
        print(f"{count:3d} claims: {verdict}")
    print(f"{options.out / 'index.html'}, in {time.perf_counter() - start:.0f} s")
    return 0


def _write(folder: Path, parts: Sequence[str]) -> collections.Counter[str]:
    """Draw, judge and write; count the verdicts."""
    from tqdm import tqdm

    from contactlaw import style
    from validation import figures
    from validation.paper.claims import ROWS
    from validation.paper.verdicts import judge
    from validation.report import Picture, page

    chosen = {name: drawing for name, drawing in figures.drawings().items() if drawing.part in parts}
    pictures = []
    with style.applied():
        for name, drawing in tqdm(chosen.items(), "validation: figures", disable=None):
            figure, numbers = drawing.draw()
            numbers = {key: float(number) for key, number in numbers.items()}
            pictures.append(Picture(name, drawing.part, drawing.caption, numbers))
            (folder / pictures[-1].file).write_bytes(style.png(figure))
    rows = ROWS if PAPER in parts else ()
    claims = tuple(judge(row) for row in tqdm(rows, "validation: claims", disable=None))
    (folder / "index.html").write_text(page(parts, claims, pictures), encoding="utf-8")
    return collections.Counter(claim.verdict for claim in claims)


if __name__ == "__main__":
    sys.exit(main())
