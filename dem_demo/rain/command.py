"""``dem-demo rain``: its options, and the function that runs it.

Slow imports are inside functions, where Ctrl-C is handled.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dem_demo.kit import options
from dem_demo.kit.options import Refused
from dem_demo.rain import defaults

if TYPE_CHECKING:
    from contactlaw import ImpactModel
    from dem_demo.rain.scene import Scene


def add(commands: Any) -> None:
    """Add the command to those of ``dem-demo``."""
    rain = commands.add_parser(
        "rain",
        help="beads rain on plates of different thickness",
        description="Beads rain on a row of plates of different thickness. Writes rain.h5, "
        "index.html with figures and the rain itself as an animation, the figures (PNG), "
        "rain.gif and summary.txt. What has been computed is kept if the rain is stopped. All "
        "numbers are in SI units.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    add = rain.add_argument
    add("--beads", type=int, metavar="N", default=defaults.BEADS, help="number of beads")
    options.quantity(
        add,
        "--plates",
        options.lengths,
        "H,...",
        defaults.THICKNESSES,
        "thickness of each plate [m], or with units; inf: a half-space",
    )
    add("--sphere", metavar="NAME", default=defaults.SPHERE, help="material of the beads")
    add("--plate", metavar="NAME", default=defaults.PLATE, help="material of the plates")
    options.quantity(add, "--radius", options.radii, "MIN,MAX", defaults.RADIUS, "bead radii [m], or with units")
    options.quantity(
        add,
        "--speed",
        options.speeds,
        "MIN,MAX",
        defaults.SPEED,
        "speeds at which beads leave the nozzles [m/s], or with units",
    )
    add(
        "--friction",
        type=float,
        metavar="MU",
        default=0.0,
        help="coefficient of friction on the plates; beads on each other have none",
    )
    add(
        "--tilt",
        type=float,
        metavar="DEG",
        default=argparse.SUPPRESS,
        help="angle between nozzles and the vertical, to the left and to the right in turn "
        f"[degrees] (default: {defaults.TILT:g} with friction, else 0)",
    )
    add("--duration", type=float, metavar="T", default=defaults.DURATION, help="simulated time [s]")
    add("--seed", type=int, metavar="S", default=defaults.SEED, help="the same seed gives the same rain")
    add(
        "--outside",
        choices=("raise", "solve", "clamp"),
        default="solve",
        help="impacts outside the law's table stop the rain, are integrated, or get the value at its border and a flag",
    )
    options.add_law(add)
    add("--out", type=Path, metavar="DIR", default=Path("rain"), help="folder for the results")
    rain.set_defaults(start=_start)


def _start(arguments: argparse.Namespace, command: str) -> int:
    with options.needing("demo"):
        from dem_demo.kit import session
        from dem_demo.kit.recorder import Making, run
        from dem_demo.rain import figures, film, page, record, report
        from dem_demo.rain.engine import Rain

    scene, model = _plan(arguments)
    show = session.Show(record.NAME, figures, record.read_folder, report.summary, page.page, film.gif)

    def simulate(folder: Path) -> BaseException | None:
        making = Making(model, command, scene.time_step)
        recorder = record.rain_recorder(folder / f"{record.NAME}.h5", scene, making)
        return run(lambda: Rain(scene, model), scene.frames, "rain", recorder)

    return session.deliver(arguments.out, show, simulate)


def _plan(arguments: argparse.Namespace) -> tuple[Scene, ImpactModel]:
    """Scene and model; refuses bad arguments early."""
    from contactlaw import ImpactModel, Pair, laws
    from dem_demo.rain.nozzles import rain

    with options.refusing(arguments):
        tilt = getattr(arguments, "tilt", defaults.TILT if arguments.friction else 0.0)
        given = vars(arguments) | {"thicknesses": arguments.plates, "tilt": tilt}
        scene = rain(**options.of(rain, argparse.Namespace(**given)))
        pair = Pair(scene.sphere_material, scene.plate_material)
        law = getattr(arguments, "law", laws.DEFAULT)
        model = ImpactModel(pair, law, outside=arguments.outside)
    return scene, _checked(scene, model)


def _checked(scene: Scene, model: ImpactModel) -> ImpactModel:
    """Refuse a scene whose hardest impact on a plate is outside the model, before the run."""
    from contactlaw.reporting.limits import label

    speed, radius = scene.top_speed, float(scene.beads.radius.max())
    for plate in scene.plates:
        try:
            model.lookup(speed, radius, plate.thickness)
        except ValueError as error:
            raise Refused(
                f"a bead of {scene.sphere_material.name} of radius {radius * 1e3:.3g} mm on the "
                f"plate of {label(plate.thickness)} at {speed:.3g} m/s: {error}"
            ) from error
    return model
