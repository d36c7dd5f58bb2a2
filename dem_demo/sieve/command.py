"""``dem-demo sieve``: its options."""

from __future__ import annotations

from typing import Any

from dem_demo.kit import options
from dem_demo.sieve.scene import sieve

_ABOUT = {
    "beads": ("N", "number of beads; the deck is as large as they need"),
    "radius": ("MIN,MAX", "radii of beads that pass the openings, and of others [m], or with units"),
    "opening": ("D", "diameter of the openings [m], or with a unit"),
    "speed": ("V", "speed at which the feed comes down [m/s], or with a unit"),
    "frequency": ("F", "frequency of the deck [1/s]"),
    "amplitude": ("A", "amplitude of the deck [m], or with a unit, at 45 degrees to it"),
}


def add(commands: Any) -> None:
    """Add the command to those of ``dem-demo``."""
    options.add_bed(
        commands,
        sieve,
        about=_ABOUT,
        help="beads on a vibrating deck, a mesh from an STL file",
        description="Beads of two sizes fall on a vibrating, perforated deck of sheet metal, a mesh from an STL file.",
    )
