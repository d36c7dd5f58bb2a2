"""A bead on the soft-sphere law, moved by velocity Verlet."""

import math

from contactlaw._jit import kernel
from contactlaw.softsphere import PARTED, advance


@kernel(entry=True)
def drop(law, spring, speed, step, phase):
    """COR of one bead that first touches at this phase of a step."""
    x, u, state = -phase * speed * step, speed, PARTED
    for n in range(10**7):
        u -= 0.5 * step * state.force / spring.mass
        x += u * step
        state = advance(law, spring, state, x, step)
        u -= 0.5 * step * state.force / spring.mass
        if n > 2 and state.force == 0.0 and u < 0.0:
            return -u / speed
    return math.nan
