"""``dem-demo rain``: its options, and the function that runs it."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dem_demo.kit import options
from dem_demo.kit.options import Refused
from dem_demo.rain.scene import Shower, rain

if TYPE_CHECKING:
    from contactlaw import ImpactModel
    from dem_demo.kit.run import Run

_ABOUT = {
    "plates": ("H,...", "thickness of each plate [m], or with units; inf: a half-space"),
    "speed": ("MIN,MAX", "speeds at which beads leave the nozzles [m/s], or with units"),
    "friction": ("MU", "coefficient of friction on the plates; beads on each other have none"),
    "tilt": (
        "DEG",
        "angle between nozzles and the vertical, to the left and to the right in turn [degrees] "
        "(default: 40 with friction, else 0)",
    ),
}


def add(commands: Any) -> None:
    """Add the command to those of ``dem-demo``."""
    options.add_scene(
        commands,
        rain,
        _ABOUT,
        _start,
        help="beads rain on plates of different thickness",
        description="Beads rain on a row of plates of different thickness.",
    ).add_argument(
        "--outside",
        choices=("raise", "solve", "clamp"),
        default="solve",
        help="impacts outside the law's table stop the rain, are integrated, or get the value at its border and a flag",
    )


def _start(arguments: argparse.Namespace, command: str) -> int:
    with options.needing("demo"):
        from dem_demo.kit import restitution, session
        from dem_demo.kit.run import Making, simulate
        from dem_demo.rain import player
        from dem_demo.rain.engine import Rain
        from dem_demo.rain.figures import constant_cor, energy

    with options.refusing(arguments):
        scene = rain(**options.of(rain, arguments))
        model = options.model(scene, arguments, arguments.outside)
        _check(scene, model)

    def simulated(folder: Path) -> tuple[list[Run[Shower]], BaseException | None]:
        making = Making(model, command, scene.time_step)
        run, stop = simulate(lambda: Rain(scene, model), scene, making, folder / "rain.h5")
        return [run] if run is not None else [], stop

    show = session.Show((constant_cor, energy, restitution), "dem_demo.rain", player.data)
    return session.deliver(arguments.out, show, simulated)


def _check(scene: Shower, model: ImpactModel) -> None:
    """Refuse a scene whose hardest impact on a plate is outside the model."""
    from contactlaw.reporting.limits import label

    speed, radius = scene.top_speed, float(scene.radius.max())
    for thickness in scene.plates:
        try:
            model.lookup(speed, radius, thickness)
        except ValueError as error:
            raise Refused(
                f"a bead of {scene.sphere_material.name} of radius {radius * 1e3:.3g} mm on the "
                f"plate of {label(thickness)} at {speed:.3g} m/s: {error}"
            ) from error
