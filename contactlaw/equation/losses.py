"""Where the energy of an impact goes: one list of channels, and the work that each of them takes.

A channel takes work along the way of a contact (`Work`, which the integrator adds up), or all at
once, by how far the contact was loaded. `Losses` has them all, and with the square of the
restitution its members are one.

Legend: q root compression, f contact force, dm largest compression, u0 first speed, in the law's
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
    wave: Any  # the bending wave, and what else runs away in the plate
    other: Any  # what the law loses between loading and unloading that is no plastic work


DESCRIPTIONS = Losses(
    plastic="lost to plastic flow at the contact",
    wave="carried off by the bending wave in the plate",
    other="that the normal impact leaves in vibration and locked-in stress (law fem); the "
    "work of sliding friction is in no column",
)
"""What records of impacts say of the energy of each channel."""


class Work(NamedTuple):
    """Work that channels have taken along the way."""

    wave: float  # over the mobility, a ratio that has a limit where the plate is held


NO_WORK = Work(0.0)
"""At first touch."""


@kernel(inline=True)
def power(q: float, f: float) -> Work:
    """Work that each channel takes, over ds."""
    return Work(2.0 * q * f * f)


@kernel(inline=True)
def gathered(
    work: Work, w1: float, p1: Work, w3: float, p3: Work, w4: float, p4: Work,
    w5: float, p5: Work, w6: float, p6: Work,
) -> Work:  # fmt: skip
    """Work after a step, from the weights of its stages and the power at them."""
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
