"""Published measurements of the normal COR, in ``validation/measured``.

Each file ``NAME-normal.csv`` is one source, in the format of ``contactlaw compare``.
"""

from __future__ import annotations

from pathlib import Path

import contactlaw as cl
from contactlaw.cli.parts import rebounds

FOLDER = Path(__file__).parent.parent / "measured"


class Source(rebounds.Source):
    """A publication: its title in figures, its materials and its rebounds."""

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
    return [
        Source(*rebounds.read(path, {}, lambda bodies: cl.Pair(**bodies)))
        for path in sorted(FOLDER.glob("*-normal.csv"))
    ]
