"""``dem-demo drum``: its options, and the function that runs it.

Slow imports are inside functions, where Ctrl-C is handled.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from dem_demo.drum import defaults
from dem_demo.kit import options
from dem_demo.kit.bed import EXTRAS


def add(commands: Any) -> None:
    """Add the command to those of ``dem-demo``."""
    drum = commands.add_parser(
        "drum",
        help="beads in a turning drum of sheet metal",
        description="Beads are lifted and thrown by a turning drum of sheet metal. It is "
        "simulated twice: under the law, and with one COR for all impacts on the drum. Writes "
        "drum.h5 and constant.h5, index.html, figures (PNG), drum.gif, summary.txt, and a dump "
        "for OVITO. What has been computed is kept if it is stopped. All numbers are in SI units. "
        "Works under mpirun.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    add = drum.add_argument
    add("--beads", type=int, metavar="N", default=defaults.BEADS, help="number of beads")
    options.quantity(add, "--radius", options.radii, "MIN,MAX", defaults.RADIUS, "bead radii [m], or with units")
    options.quantity(add, "--drum", options.length, "R", defaults.DRUM, "radius of the drum [m], or with a unit")
    options.quantity(add, "--length", options.length, "L", defaults.LENGTH, "length of the drum [m], or with a unit")
    add("--turns", type=float, metavar="F", default=defaults.TURNS, help="revolutions of the drum per second [1/s]")
    options.quantity(
        add,
        "--speed",
        options.speed,
        "V",
        defaults.SPEED,
        "speed at which the beads are thrown down [m/s], or with a unit",
    )
    options.add_bed(add, defaults, wall="drum", beads="beads")
    add("--out", type=Path, metavar="DIR", default=Path("drum"), help="folder for the results")
    drum.set_defaults(start=_start)


def _start(arguments: argparse.Namespace, command: str) -> int:
    with options.needing(EXTRAS):
        from dem_demo.drum.drawing import Section
        from dem_demo.drum.scene import drum
        from dem_demo.drum.tale import TALE
        from dem_demo.kit import comparison

        comparison.engine()
    with options.refusing(arguments):
        scene = drum(**options.of(drum, arguments))
        plan = comparison.plan(arguments, scene, arguments.speed)
    return comparison.start(arguments, command, plan, TALE, Section)
