"""``dem-demo sieve``: its options, and the function that runs it.

Slow imports are inside functions, where Ctrl-C is handled.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from dem_demo.kit import options
from dem_demo.kit.bed import EXTRAS
from dem_demo.sieve import defaults


def add(commands: Any) -> None:
    """Add the command to those of ``dem-demo``."""
    sieve = commands.add_parser(
        "sieve",
        help="beads on a vibrating deck, a mesh from an STL file",
        description="Beads of two sizes fall on a vibrating, perforated deck of sheet metal; the "
        "deck is a mesh from an STL file. It is simulated twice: under the law, and with one COR "
        "for all impacts on the deck. Writes sieve.h5 and constant.h5, index.html, figures "
        "(PNG), sieve.gif, summary.txt, deck.stl, and a dump for OVITO. What has been "
        "computed is kept if it is stopped. All numbers are in SI units. Works under mpirun.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    add = sieve.add_argument
    add(
        "--beads",
        type=int,
        metavar="N",
        default=defaults.BEADS,
        help="number of beads; the deck is as large as they need",
    )
    options.quantity(
        add,
        "--radius",
        options.radii,
        "MIN,MAX",
        defaults.RADIUS,
        "radii of beads that pass the openings, and of others [m], or with units",
    )
    options.quantity(
        add, "--opening", options.length, "D", defaults.OPENING, "diameter of the openings [m], or with a unit"
    )
    add("--frequency", type=float, metavar="F", default=defaults.FREQUENCY, help="frequency of the deck [1/s]")
    options.quantity(
        add,
        "--amplitude",
        options.length,
        "A",
        defaults.AMPLITUDE,
        "amplitude of the deck [m], or with a unit, at 45 degrees to it",
    )
    options.quantity(
        add, "--speed", options.speed, "V", defaults.SPEED, "speed at which the feed comes down [m/s], or with a unit"
    )
    options.add_bed(add, defaults, wall="deck", beads="feed")
    add("--out", type=Path, metavar="DIR", default=Path("sieve"), help="folder for the results")
    sieve.set_defaults(start=_start)


def _start(arguments: argparse.Namespace, command: str) -> int:
    with options.needing(EXTRAS):
        from dem_demo.kit import comparison
        from dem_demo.sieve.drawing import Sheet
        from dem_demo.sieve.scene import sieve
        from dem_demo.sieve.tale import TALE

        comparison.engine()
    with options.refusing(arguments):
        scene = sieve(**options.of(sieve, arguments))
        plan = comparison.plan(arguments, scene, abs(float(scene.velocity[2])))
    return comparison.start(arguments, command, plan, TALE, Sheet)
