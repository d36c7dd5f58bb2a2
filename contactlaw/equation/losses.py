"""Where the energy of an impact goes: one list of channels, and the work that each of them takes.

The waves in the plate take work during the contact, which the integrator adds up over the plate's
mobility, since that has a limit where the mobility is 0. The other channels take an amount that
follows from the largest compression. `Losses` lists all of them; its members and the square of the
restitution add up to one.

Legend: q root compression, f contact force, in the law's scale; ds = dt/(2 q).
"""

from typing import Any, NamedTuple


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
