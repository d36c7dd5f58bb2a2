"""What a plate does under a contact: the paper's is a dashpot, faster the more it is pushed.

What makes real plates differ from it is a factor on its mobility, see `contactlaw.equation.waves`.

Legend: f contact force, beta mobility, all in the law's scale.
"""

from __future__ import annotations

from typing import NamedTuple

from contactlaw._jit import kernel


class Plate(NamedTuple):
    """A plate, as the equation of motion takes it."""

    mobility: float  # beta, lambda y^(1/4)


HELD = Plate(0.0)
"""One that does not move."""


@kernel(inline=True)
def speed(plate: Plate, f: float) -> float:
    """Speed at which the plate gives way to a force."""
    return plate.mobility * f


@kernel(inline=True)
def moves(plate: Plate) -> bool:
    """Whether a plate takes energy at all."""
    return plate.mobility > 0.0
