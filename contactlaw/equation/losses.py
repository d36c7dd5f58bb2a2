"""Where the energy of an impact goes: one list of channels, and the work that each of them takes.

Some channels take work during the contact (`Work`, which the integrator adds up), the others an
amount that follows from the largest compression. `Losses` lists all of them; its members and the
square of the restitution add up to one.

Legend: q root compression, f contact force, dm largest compression, u0 impact speed, in the law's
scale; ds = dt/(2 q).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation import force

Array = NDArray[np.float64]


class Losses(NamedTuple):
    """Shares of the initial kinetic energy that an impact loses."""

    plastic: Any  # plastic work at the contact
    wave: Any  # the bending wave and all other waves in the plate
    other: Any  # part of the law's loss that is not plastic work


DESCRIPTIONS = Losses(
    plastic="lost to plastic flow at the contact",
    wave="carried off by the bending wave in the plate",
    other="that the normal impact leaves in vibration and locked-in stress (law fem)",
)
"""How records of impacts describe the energy of each channel."""


class Work(NamedTuple):
    """Work that channels have taken since first touch."""

    wave: float  # of the waves, over the plate's mobility: it has a limit where that is 0


NO_WORK = Work(0.0)
"""The work at first touch."""


@kernel(inline=True)
def power(q: float, f: float, drive: float) -> Work:
    """Work that each channel takes per ds, from the plate's speed over its mobility."""
    return Work(2.0 * q * f * drive)


@kernel(inline=True)
def gathered(
    work: Work, w1: float, p1: Work, w3: float, p3: Work, w4: float, p4: Work,
    w5: float, p5: Work, w6: float, p6: Work,
) -> Work:  # fmt: skip
    """Work after a step, from the weights and powers of its stages."""
    wave = w1 * p1.wave + w3 * p3.wave + w4 * p4.wave + w5 * p5.wave + w6 * p6.wave
    return Work(work.wave + wave)


@kernel(inline=True)
def at_the_contact(law: Array, dm: float) -> tuple[float, float, float]:
    """Residual compression, and plastic and other work, of a contact that was loaded to dm."""
    residual, loss, other = force.residual_and_losses(law, dm)
    return residual, loss - other, other


@kernel(inline=True)
def shares(plastic: float, work: Work, other: float, mobility: float, u0: float) -> Losses:
    """Losses of a contact that has ended."""
    per_energy = 2.0 / (u0 * u0)
    return Losses(per_energy * plastic, per_energy * mobility * work.wave, per_energy * other)
