"""The command ``dem-demo``.

What takes long to import is imported inside the commands, where Ctrl-C is already caught.
"""

from __future__ import annotations

import argparse
import shlex
import sys
import time
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from dem_demo import defaults, engines
from dem_demo.folder import Interrupted, interruptible, results

if TYPE_CHECKING:
    from contactlaw import ImpactModel
    from dem_demo.baseline import ConstantRestitution
    from dem_demo.engines import Engine
    from dem_demo.scene import Scene


class _Refused(Exception):
    """The physics does not allow what was asked for."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run ``dem-demo``.

    Parameters
    ----------
    argv : sequence of str, optional
        Arguments; those of the command line by default.

    Returns
    -------
    int
        0: done; 1: refused, with a message on stderr; 128 + signal: interrupted. Wrong usage exits
        with 2.
    """
    argv = sys.argv[1:] if argv is None else list(argv)
    arguments = _parser().parse_args(argv)
    try:
        with interruptible():
            return _rain(arguments, shlex.join(["dem-demo", *argv]))
    except Interrupted as stop:
        print("\ndem-demo: interrupted; nothing was written", file=sys.stderr)
        return _stopped(stop.exit_status)
    except (_Refused, OSError, RuntimeError) as error:  # an engine's adapter raises the last one
        print(f"dem-demo: {error}", file=sys.stderr)
        return _stopped(1)
    except Exception:
        traceback.print_exc()
        return _stopped(1)


def _stopped(status: int) -> int:
    """Stop the other ranks too, which would wait for this one for ever."""
    mpi = sys.modules.get("mpi4py.MPI")
    if mpi is not None and mpi.COMM_WORLD.size > 1:
        if mpi.COMM_WORLD.rank > 0:
            time.sleep(5.0)  # rank 0 takes its files away before it ends everything
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
        "figures (PNG) and summary.txt. All numbers are in SI units.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    add = rain.add_argument
    add("--beads", type=int, metavar="N", default=defaults.BEADS, help="number of beads")
    add("--plates", type=_numbers, metavar="H,...", default=_text(defaults.THICKNESSES),
        help="thickness of each plate [m], inf for a half-space")  # fmt: skip
    add("--sphere", metavar="NAME", default=defaults.SPHERE, help="material of the beads")
    add("--plate", metavar="NAME", default=defaults.PLATE, help="material of the plates")
    add("--radius", type=_range, metavar="MIN,MAX", default=_text(defaults.RADIUS),
        help="bead radii [m]")  # fmt: skip
    add("--speed", type=_range, metavar="MIN,MAX", default=_text(defaults.SPEED),
        help="speeds at which beads are thrown down [m/s]")  # fmt: skip
    add("--duration", type=float, metavar="T", default=argparse.SUPPRESS,
        help=f"simulated time [s] (default: {durations})")  # fmt: skip
    add("--seed", type=int, metavar="S", default=defaults.SEED,
        help="the same seed gives the same rain")  # fmt: skip
    add("--constant-cor", type=float, metavar="E", default=argparse.SUPPRESS,
        help="the same COR in every contact: the baseline to compare with")  # fmt: skip
    add("--engine", choices=list(known), default=defaults.ENGINE,
        help="engine that moves the beads; "
        + "; ".join(f"{name}: {engine.ABOUT}" for name, engine in known.items()))  # fmt: skip
    add("--out", type=Path, metavar="DIR", default=Path("rain"), help="folder for the results")
    return parser


def _text(numbers: Sequence[float]) -> str:
    return ",".join(f"{number:g}" for number in numbers)


def _numbers(text: str) -> list[float]:
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"expected numbers with commas between them, as in 0.5e-3,1e-3, got {text!r}"
        ) from None


def _range(text: str) -> tuple[float, float]:
    values = _numbers(text)
    if len(values) != 2:
        raise argparse.ArgumentTypeError(f"expected two numbers MIN,MAX, got {text!r}")
    return values[0], values[1]


def _rain(arguments: argparse.Namespace, command: str) -> int:
    engine = engines.load(arguments.engine)
    try:
        from dem_demo import figures
        from dem_demo.reader import read
        from dem_demo.report import summary

        named, rank = (arguments.engine, engine.version()), engine.rank()
    except ModuleNotFoundError as error:
        hint = f"pip install contactlaw[{engine.EXTRAS}]"
        raise _Refused(f"{error.name} is missing: {hint}") from error
    scene, model = _plan(arguments, engine)
    if rank > 0:
        engine.run(scene, model, None)
        return 0
    with results(arguments.out) as folder:
        _simulate(engine, named, scene, model, folder / "rain.h5", command)
        run = read(folder / "rain.h5")
        text = summary(run)
        (folder / "summary.txt").write_text(text + "\n", encoding="utf-8")
        figures.draw_all(run, folder)
        names = ", ".join(sorted(file.name for file in folder.iterdir()))
    print(f"{text}\n\nWritten to {arguments.out}: {names}")
    return 0


def _plan(
    arguments: argparse.Namespace, engine: Engine
) -> tuple[Scene, ImpactModel | ConstantRestitution]:
    """Scene and model; whatever they refuse is refused before it rains."""
    from contactlaw import ImpactModel, Pair, material, materials
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
        if scene.sphere_material.yield_strength is None:
            known = [name for name in materials() if material(name).yield_strength is not None]
            raise ValueError(
                f"sphere: no yield strength is known for {scene.sphere_material.name!r}, so it is "
                f"not known when it yields; take one of {', '.join(known)}"
            )
        model = ImpactModel(Pair(scene.sphere_material, scene.plate_material))
        hardest = [plate.thickness for plate in scene.plates]
        model.lookup(scene.top_speed, float(scene.beads.radius.max()), hardest)
        if "constant_cor" in arguments:
            return scene, ConstantRestitution(model.pair, arguments.constant_cor)
    except ValueError as error:
        raise _Refused(error) from error
    return scene, model


def _simulate(
    engine: Engine,
    named: tuple[str, str],
    scene: Scene,
    model: ImpactModel | ConstantRestitution,
    path: Path,
    command: str,
) -> None:
    from dem_demo.baseline import ConstantRestitution
    from dem_demo.recorder import Recorder

    constant = model.restitution if isinstance(model, ConstantRestitution) else None
    with Recorder(
        path,
        scene,
        law=model.law,
        engine=named,
        command=command,
        time_step=engine.time_step(scene, model),
        dimensions=engine.DIMENSIONS,
        constant_cor=constant,
        bead_on_bead=engine.BEAD_ON_BEAD,
    ) as recorder:
        engine.run(scene, model, recorder)
