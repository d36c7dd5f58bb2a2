"""``dem-demo rain``: its options, and the function that runs it.

Slow imports are inside functions, where Ctrl-C is handled.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contactlaw import ArgumentError
from dem_demo.kit import options
from dem_demo.kit.options import Refused
from dem_demo.rain import defaults, engines

if TYPE_CHECKING:
    from contactlaw import ImpactModel
    from dem_demo.rain.baseline import ConstantRestitution
    from dem_demo.rain.engines import Engine
    from dem_demo.rain.scene import Scene


def add(commands: Any) -> None:
    """Add the command to those of ``dem-demo``."""
    known = {name: engines.load(name) for name in engines.names()}
    durations = ", ".join(f"{engine.DURATION:g} in {name}" for name, engine in known.items())
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
    add("--plates", type=options.lengths, metavar="H,...",
        default=options.text(defaults.THICKNESSES),
        help="thickness of each plate [m], or with units; inf: a half-space")  # fmt: skip
    add("--sphere", metavar="NAME", default=defaults.SPHERE, help="material of the beads")
    add("--plate", metavar="NAME", default=defaults.PLATE, help="material of the plates")
    add("--radius", type=options.radii, metavar="MIN,MAX",
        default=options.text(defaults.RADIUS), help="bead radii [m], or with units")  # fmt: skip
    add("--speed", type=options.speeds, metavar="MIN,MAX",
        default=options.text(defaults.SPEED),
        help="speeds at which beads leave the nozzles [m/s], or with units")  # fmt: skip
    add("--friction", type=float, metavar="MU", default=0.0,
        help="coefficient of friction on the plates; beads on each other have none")  # fmt: skip
    add("--tilt", type=float, metavar="DEG", default=argparse.SUPPRESS,
        help="angle between nozzles and the vertical, to the left and to the right in turn "
        f"[degrees] (default: {defaults.TILT:g} with friction, else 0)")  # fmt: skip
    add("--duration", type=float, metavar="T", default=argparse.SUPPRESS,
        help=f"simulated time [s] (default: {durations})")  # fmt: skip
    add("--seed", type=int, metavar="S", default=defaults.SEED,
        help="the same seed gives the same rain")  # fmt: skip
    add("--outside", choices=("raise", "solve", "clamp"), default="raise",
        help="impacts outside the law's table stop the rain, are integrated, or get the value at "
        "its border and a flag")  # fmt: skip
    options.add_law(add, "the same COR in every contact: the baseline to compare with")
    add("--engine", choices=list(known), default=defaults.ENGINE,
        help="engine that moves the beads; "
        + "; ".join(f"{name}: {engine.ABOUT}" for name, engine in known.items()))  # fmt: skip
    add("--out", type=Path, metavar="DIR", default=Path("rain"), help="folder for the results")
    rain.set_defaults(start=_start)


def _start(arguments: argparse.Namespace, command: str) -> int:
    engine = engines.load(arguments.engine)
    with options.needing(engine.EXTRAS):
        from dem_demo.kit import session
        from dem_demo.kit.recorder import Making
        from dem_demo.rain import complaint, figures, film, page, record, report

        named, rank = (arguments.engine, engine.version()), engine.rank()
    scene, ruling, model = _plan(arguments, engine)
    if rank > 0:
        engine.run(scene, ruling, None)
        return 0

    def sentence(error: BaseException) -> str:
        return complaint.sentence(error, scene, model)

    show = session.Show(
        name=record.NAME,
        others=frozenset(),
        figures=figures,
        read=record.read_folder,
        summary=report.summary,
        progress=report.progress,
        page=lambda run, pictures, _: page.page(run, pictures),
        film=lambda run: film.gif(run),
        sentence=sentence,
    )

    def simulate(folder: Path) -> BaseException | None:
        step, cor = engine.time_step(scene, ruling), getattr(arguments, "constant_cor", None)
        recorder = record.rain_recorder(
            folder / show.record,
            scene,
            Making(model, named, command, show.files, step, cor),
            dimensions=engine.DIMENSIONS,
            bead_on_bead=engine.BEAD_ON_BEAD,
        )
        return recorder.record(lambda it: engine.run(scene, ruling, it), sentence)

    return session.deliver(arguments.out, show, simulate)


def _plan(
    arguments: argparse.Namespace, engine: Engine
) -> tuple[Scene, ImpactModel | ConstantRestitution, ImpactModel]:
    """Scene, model or constant COR for the engine, and model; refuses bad arguments early."""
    from contactlaw import ImpactModel, Pair, laws
    from dem_demo.rain.baseline import ConstantRestitution
    from dem_demo.rain.nozzles import rain

    with options.refusing(arguments):
        if engine.NO_CONSTANT_COR is not None and "constant_cor" in arguments:
            raise ArgumentError("constant_cor", None, f"{engine.NO_CONSTANT_COR}; leave it out")
        if "constant_cor" in arguments and arguments.friction:
            raise ArgumentError(
                "friction",
                None,
                "a constant COR says nothing about sliding; leave out --friction or --constant-cor",
            )
        scene = rain(
            beads=arguments.beads,
            thicknesses=arguments.plates,
            radius=arguments.radius,
            speed=arguments.speed,
            duration=getattr(arguments, "duration", engine.DURATION),
            seed=arguments.seed,
            sphere=arguments.sphere,
            plate=arguments.plate,
            dimensions=engine.DIMENSIONS,
            frame_rate=engine.FRAME_RATE,
            friction=arguments.friction,
            tilt=getattr(arguments, "tilt", defaults.TILT if arguments.friction else 0.0),
        )
        pair = Pair(scene.sphere_material, scene.plate_material)
        law = getattr(arguments, "law", laws.DEFAULT)
        model = ImpactModel(pair, law, outside=arguments.outside)
        if "constant_cor" in arguments:
            return scene, ConstantRestitution(pair, arguments.constant_cor), model
    return scene, _checked(scene, model), model


def _checked(scene: Scene, model: ImpactModel) -> ImpactModel:
    """Refuse a scene whose hardest impact on a plate is outside the model, before the run."""
    from contactlaw.reporting.limits import label
    from dem_demo.rain.complaint import sentence

    speed, radius = scene.top_speed, float(scene.beads.radius.max())
    for plate in scene.plates:
        try:
            model.lookup(speed, radius, plate.thickness)
        except ValueError as error:
            error.add_note(
                f"a bead of {scene.sphere_material.name} of radius {radius * 1e3:.3g} mm on the "
                f"plate of {label(plate.thickness)} at {speed:.3g} m/s"
            )
            raise Refused(sentence(error, scene, model)) from error
    return model
