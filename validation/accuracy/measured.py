"""Published measurements of the normal COR, in ``validation/measured``.

Each file ``NAME-normal.csv`` is one source, in the format of ``contactlaw compare``.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import contactlaw as cl
from contactlaw.cli.parts import rebounds

FOLDER = Path(__file__).parent.parent / "measured"


class Source(NamedTuple):
    """A publication: its title in figures, its materials and its rebounds."""

    title: str
    reference: str
    pair: cl.Pair
    rebounds: cl.Measurements
    errors: dict[str, float]  # of speed and sizes

    def compared(self, law: str = "fem") -> cl.Comparison:
        """Compare the rebounds with the model."""
        return cl.compare(self.pair, self.rebounds, law, **self.errors)


def sources() -> list[Source]:
    """Read all files.

    Examples
    --------
    >>> for source in sources():
    ...     print(source.title)
    nylon on an aluminium plate, R = 6.5 mm
    alumina on a thick glass anvil, R = 2.5 mm
    glass on acrylic, R = 1.55 mm
    """
    return [_read(path) for path in sorted(FOLDER.glob("*-normal.csv"))]


def _read(path: Path) -> Source:
    read = rebounds.read(path)
    known = rebounds.conditions(read, {})
    data = rebounds.completed(read, path, known.bodies["sphere"].density)
    return Source(known.title, known.reference, cl.Pair(**known.bodies), data, known.errors)
