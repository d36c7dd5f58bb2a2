"""``dem-demo drum``: its options."""

from __future__ import annotations

from typing import Any

from dem_demo.drum.scene import drum
from dem_demo.kit import options

_ABOUT = {
    "drum": ("R", "radius of the drum [m], or with a unit"),
    "length": ("L", "length of the drum [m], or with a unit"),
    "turns": ("F", "revolutions of the drum per second [1/s]"),
    "speed": ("V", "speed at which the beads are thrown down [m/s], or with a unit"),
}


def add(commands: Any) -> None:
    """Add the command to those of ``dem-demo``."""
    options.add_bed(
        commands,
        drum,
        about=_ABOUT,
        help="beads in a turning drum of sheet metal",
        description="Beads are lifted and thrown by a turning drum of sheet metal.",
    )
