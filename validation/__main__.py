"""Reproduce the paper: ``python -m validation [--out DIR]``."""

from __future__ import annotations

import argparse
import collections
import sys
from pathlib import Path

from tqdm import tqdm

from validation import figures
from validation.claims import SECTIONS, of_section
from validation.figures import _style
from validation.report import page, png


def main(argv: list[str] | None = None) -> int:
    """Write report and pictures; print what became of the claims."""
    parser = argparse.ArgumentParser(prog="python -m validation", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path(__file__).parent / "report")
    out = parser.parse_args(argv).out
    out.mkdir(parents=True, exist_ok=True)
    names = figures.names()
    drawn = []
    with _style.applied():
        for name in tqdm(names, "validation: figures", disable=None):
            module = figures.module(name)
            figure, numbers = module.draw()
            image = png(figure)
            (out / f"{name}.png").write_bytes(image)
            drawn.append((name, module.__doc__, numbers, image))
    sections = tqdm(SECTIONS, "validation: claims", disable=None)
    found = tuple(claim for section in sections for claim in of_section(section))
    (out / "index.html").write_text(page(found, drawn), encoding="utf-8")
    for verdict, count in collections.Counter(claim.verdict for claim in found).items():
        print(f"{count:3d} claims: {verdict}")
    print(out / "index.html")
    return 0


if __name__ == "__main__":
    sys.exit(main())
