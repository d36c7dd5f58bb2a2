"""The plate under a contact: a dashpot, as in the paper, with a speed in proportion to the force.

Real plates differ from it by a factor on the mobility, see `contactlaw.equation.corrections`.

Legend: f contact force, beta mobility, all in the law's scale.
"""

from __future__ import annotations

from typing import NamedTuple

from contactlaw._jit import kernel


class PlateMobility(NamedTuple):
    """The plate as the equation of motion has it."""

    mobility: float  # beta, lambda y^(1/4)


HELD = PlateMobility(0.0)
"""A plate that does not move."""


@kernel(inline=True)
def speed(plate: PlateMobility, f: float) -> float:
    """Speed of the plate at the contact under a force."""
    return plate.mobility * f


@kernel(inline=True)
def moves(plate: PlateMobility) -> bool:
    """Whether a plate moves, and so takes energy."""
    return plate.mobility > 0.0
