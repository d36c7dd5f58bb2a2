"""The plate under a contact: a dashpot, as in the paper, with a speed in proportion to the force.

Real plates differ from it by a factor on the mobility, see `contactlaw.equation.corrections`, and
by the memory of what a near edge sends back, see `contactlaw.equation.near_edge`.

Legend: f contact force, beta mobility, all in the law's scale.
"""

from contactlaw._jit import kernel


@kernel(inline=True)
def speed(mobility: float, f: float) -> float:
    """Speed of the plate at the contact under a force."""
    return mobility * f
