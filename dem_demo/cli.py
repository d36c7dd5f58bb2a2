"""The command ``dem-demo``.

What takes long to import is imported inside the commands, where Ctrl-C is already heard.
"""

from __future__ import annotations

import argparse
import shlex
import sys
import time
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dem_demo import defaults, engines, options
from dem_demo.options import Refused
from dem_demo.sieve import command as sieve
from dem_demo.signals import Interrupted, interruptible, undisturbed

if TYPE_CHECKING:
    from contactlaw import ImpactModel
    from dem_demo.baseline import ConstantRestitution
    from dem_demo.engines import Engine
    from dem_demo.scene import Scene


_PATIENCE = 300.0  # [s]; more than figures and page of a rain take


def main(argv: Sequence[str] | None = None) -> int:
    """Run ``dem-demo``.

    Parameters
    ----------
    argv : sequence of str, optional
        Arguments; those of the command line by default.

    Returns
    -------
    int
        0: done; 1: refused or partial, with a message on stderr; 128 + signal: interrupted. Wrong
        usage exits with 2.
    """
    argv = sys.argv[1:] if argv is None else list(argv)
    try:
        with interruptible():
            arguments = _parser().parse_args(_joined(argv))
            status = int(arguments.start(arguments, shlex.join(["dem-demo", *argv])))
        return _stopped(status) if status else 0
    except Interrupted as stop:
        if not _rank():  # of several, the first one tells what becomes of the results
            print(f"\ndem-demo: {stop} before it began; nothing was written", file=sys.stderr)
        return _stopped(stop.exit_status)
    except (Refused, OSError, RuntimeError) as error:  # an engine's adapter raises the last one
        print(f"dem-demo: {error}", file=sys.stderr)
        return _stopped(1)
    except Exception:
        traceback.print_exc()
        return _stopped(1)


def _joined(words: Sequence[str]) -> Sequence[str]:
    """Join options with negative quantities; a help page need not load contactlaw for that."""
    if all(word[:1] != "-" or word[:2] in ("--", "-h") for word in words):
        return words
    from contactlaw.cli.parts.options import joined

    return joined(words)


def _rank() -> int:
    mpi = sys.modules.get("mpi4py.MPI")
    return 0 if mpi is None else int(mpi.COMM_WORLD.rank)


def _stopped(status: int) -> int:
    """Stop the other ranks too, which would wait for this one for ever."""
    mpi = sys.modules.get("mpi4py.MPI")
    if mpi is not None and mpi.COMM_WORLD.size > 1:
        if _rank() > 0:
            time.sleep(_PATIENCE)  # rank 0 keeps what there is before it ends everything
        mpi.COMM_WORLD.Abort(status)
    return status


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="dem-demo", description="Simulations that show what contactlaw gives an engine."
    )
    known = {name: engines.load(name) for name in engines.names()}
    durations = ", ".join(f"{engine.DURATION:g} in {name}" for name, engine in known.items())
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
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
        help="speeds at which beads are thrown down [m/s], or with units")  # fmt: skip
    add("--duration", type=float, metavar="T", default=argparse.SUPPRESS,
        help=f"simulated time [s] (default: {durations})")  # fmt: skip
    add("--seed", type=int, metavar="S", default=defaults.SEED,
        help="the same seed gives the same rain")  # fmt: skip
    add(
        "--law",
        metavar="NAME",
        default=argparse.SUPPRESS,
        help="contact law, of those that contactlaw cor --help lists (default: the one there)",
    )
    add("--outside", choices=("raise", "solve", "clamp"), default="raise",
        help="impacts outside the law's table stop the rain, are integrated, or get the value at "
        "its border and a flag")  # fmt: skip
    add("--constant-cor", type=float, metavar="E", default=argparse.SUPPRESS,
        help="the same COR in every contact: the baseline to compare with")  # fmt: skip
    add("--engine", choices=list(known), default=defaults.ENGINE,
        help="engine that moves the beads; "
        + "; ".join(f"{name}: {engine.ABOUT}" for name, engine in known.items()))  # fmt: skip
    add("--out", type=Path, metavar="DIR", default=Path("rain"), help="folder for the results")
    rain.set_defaults(start=_rain)
    sieve.add(commands)
    return parser


def _rain(arguments: argparse.Namespace, command: str) -> int:
    engine = engines.load(arguments.engine)
    try:
        with undisturbed():  # extension modules of matplotlib drop an interrupt, or crash
            from dem_demo import products, session
            from dem_demo.complaint import sentence
            from dem_demo.reader import read
            from dem_demo.recorder import RECORD
            from dem_demo.report import progress, summary

        named, rank = (arguments.engine, engine.version()), engine.rank()
    except ModuleNotFoundError as error:
        hint = f"pip install contactlaw[{engine.EXTRAS}]"
        raise Refused(f"{error.name} is missing: {hint}") from error
    scene, ruling, model = _plan(arguments, engine)
    if rank > 0:
        engine.run(scene, ruling, None)
        return 0
    kind = products.kind()
    facts = {"engine": named, "command": command, "files": kind.files}
    steps = session.Steps(
        simulate=lambda folder: _simulate(engine, scene, (ruling, model), folder / RECORD, facts),
        read=lambda folder: read(folder / RECORD),
        summary=summary,
        progress=progress,
        make=products.make,
        sentence=lambda error: sentence(error, scene, model),
    )
    return session.deliver(arguments.out, kind, steps)


def _plan(
    arguments: argparse.Namespace, engine: Engine
) -> tuple[Scene, ImpactModel | ConstantRestitution, ImpactModel]:
    """Scene, what rules its impacts, and the model; whatever they refuse is refused now."""
    from contactlaw import ImpactModel, Pair, laws
    from contactlaw.cli.parts import wording
    from dem_demo.baseline import ConstantRestitution
    from dem_demo.nozzles import rain

    try:
        if engine.NO_CONSTANT_COR is not None and "constant_cor" in arguments:
            raise ValueError(f"constant-cor: {engine.NO_CONSTANT_COR}; leave it out")
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
        )
        pair = Pair(scene.sphere_material, scene.plate_material)
        law = getattr(arguments, "law", laws.DEFAULT)
        model = ImpactModel(pair, law, outside=arguments.outside)
        if "constant_cor" in arguments:
            return scene, ConstantRestitution(pair, arguments.constant_cor), model
    except ValueError as error:
        raise Refused(wording.sentence(error, vars(arguments))) from error
    return scene, _checked(scene, model), model


def _checked(scene: Scene, model: ImpactModel) -> ImpactModel:
    """Refuse now what could not be answered later: the hardest impact on each plate."""
    from dem_demo.complaint import sentence
    from dem_demo.report import label

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


def _simulate(
    engine: Engine,
    scene: Scene,
    models: tuple[ImpactModel | ConstantRestitution, ImpactModel],
    path: Path,
    facts: dict[str, Any],
) -> BaseException | None:
    """Let it rain into a file; returns what stopped it, if anything did."""
    from dem_demo.baseline import ConstantRestitution
    from dem_demo.complaint import sentence
    from dem_demo.recorder import rain_recorder
    from dem_demo.session import FORESEEN

    ruling, model = models
    recorder = rain_recorder(
        path,
        scene,
        model,
        time_step=engine.time_step(scene, ruling),
        dimensions=engine.DIMENSIONS,
        constant_cor=ruling.restitution if isinstance(ruling, ConstantRestitution) else None,
        bead_on_bead=engine.BEAD_ON_BEAD,
        **facts,
    )
    with recorder:
        try:
            engine.run(scene, ruling, recorder)
        except (Exception, Interrupted) as error:
            if not isinstance(error, FORESEEN):
                traceback.print_exc()
            recorder.reason = sentence(error, scene, model)
            return error
    return recorder.disk_error
