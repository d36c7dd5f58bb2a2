"""The plate under a contact: a dashpot, as in the paper, with a speed in proportion to the force.

Real plates differ from it by a factor on the mobility, see `contactlaw.equation.corrections`, and
by the memory of what a near edge sends back, see `contactlaw.equation.edge`.

Legend: f contact force, beta mobility, all in the law's scale.
"""

from typing import Any, NamedTuple

from contactlaw._jit import kernel
from contactlaw.equation import edge
from contactlaw.equation.edge import Memories


class PlateMobility(NamedTuple):
    """The plate as the equation of motion has it."""

    mobility: float  # beta, lambda y^(1/4)
    response: Any = None  # of a near edge, as `contactlaw.equation.edge.near` gives it


@kernel(inline=True)
def speed(plate: PlateMobility, f: float, memory: Memories | None) -> float:
    """Speed of the plate at the contact under a force."""
    return plate.mobility * edge.drive(plate.response, f, memory)


@kernel(inline=True)
def held(plate: PlateMobility) -> PlateMobility:
    """Plate that does not move any more."""
    return PlateMobility(0.0, plate.response)


@kernel(inline=True)
def endless(plate: PlateMobility) -> bool:
    """Whether no edge sends back what the plate took."""
    return plate.response is None


@kernel(inline=True)
def only_recedes(plate: PlateMobility) -> bool:
    """Whether a plate moves, and so takes energy, and gives none of it back."""
    return plate.mobility > 0.0 and plate.response is None
