"""Published measurements of the normal COR, in ``validation/measured``, and the model beside them.

Each file ``NAME-normal.csv`` is one source. Its lines with # are a header in TOML: the reference,
how the numbers were read, and both materials, each ``like`` one of the catalogue.
"""

from __future__ import annotations

import csv
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import contactlaw as cl

FOLDER = Path(__file__).parent.parent / "measured"
_COLUMNS = "speed_m_s", "radius_m", "thickness_m", "restitution", "reading_error"


class Rebound(NamedTuple):
    """A measured rebound, in SI units."""

    speed: float
    radius: float
    thickness: float  # inf: a block, or a plate that the source calls thick
    restitution: float
    reading_error: float  # of the restitution


class Source(NamedTuple):
    """A publication: its title in figures, its materials and its rebounds."""

    title: str
    reference: str
    pair: cl.Pair
    rebounds: tuple[Rebound, ...]


def sources() -> list[Source]:
    """Read all files.

    Examples
    --------
    >>> [source.title for source in sources()]
    ['alumina on a thick glass anvil, R = 2.5 mm']
    """
    return [_read(path) for path in sorted(FOLDER.glob("*-normal.csv"))]


def _read(path: Path) -> Source:
    lines = path.read_text("utf-8").splitlines()
    header = tomllib.loads("\n".join(line[1:] for line in lines if line.startswith("#")))
    rows = csv.DictReader(line for line in lines if not line.startswith("#"))
    return Source(
        header["title"],
        header["reference"],
        cl.Pair(_material(header["sphere"]), _material(header["plate"])),
        tuple(Rebound(*(float(row[name]) for name in _COLUMNS)) for row in rows),
    )


def _material(numbers: dict[str, Any]) -> cl.Material:
    return replace(cl.material(numbers.pop("like")), **numbers)
