"""A bead on the soft-sphere law, moved by velocity Verlet: in compiled code, and in Python."""

import math

import numpy as np

from contactlaw._jit import kernel
from contactlaw.softsphere import PARTED, advance


@kernel(cache=True)
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


def fallen(contacts, speed, step):
    """COR of the one bead of these contacts, which flies at its wall."""
    overlap, u = np.zeros(1), np.array([speed])
    while u > 0.0 or contacts.force > 0.0:
        u -= 0.5 * step * contacts.force / contacts.mass
        overlap += step * u
        u -= 0.5 * step * contacts.advance(overlap, step) / contacts.mass
    return -u[0] / speed
