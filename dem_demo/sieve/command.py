"""``dem-demo sieve``: options, and the two simulations.

What takes long to import is imported inside functions, where Ctrl-C is already heard.
"""

from __future__ import annotations

import argparse
import traceback
from collections.abc import Set
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from dem_demo import engines, options
from dem_demo.options import Refused
from dem_demo.sieve import defaults
from dem_demo.signals import Interrupted, undisturbed

if TYPE_CHECKING:
    from contactlaw import ImpactModel
    from dem_demo.sieve.scene import Sieve


def add(commands: Any) -> None:
    """Add the command to those of ``dem-demo``."""
    sieve = commands.add_parser(
        "sieve",
        help="beads on a vibrating deck, a mesh from an STL file",
        description="Beads of two sizes fall on a perforated deck of thin sheet that vibrates; the "
        "deck is a mesh from an STL file. It is simulated twice: under the law, and with one COR "
        "for all impacts on the deck. Writes sieve.h5 and constant.h5, index.html, figures "
        "(PNG), sieve.gif, summary.txt, deck.stl, and a dump for OVITO. What has been "
        "computed is kept if it is stopped. All numbers are in SI units. Works under mpirun.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    add = sieve.add_argument
    add("--beads", type=int, metavar="N", default=defaults.BEADS,
        help="number of beads; the deck is as large as they need")  # fmt: skip
    add("--radius", type=options.radii, metavar="MIN,MAX",
        default=options.text(defaults.RADIUS),
        help="radii of beads that pass the openings, and of others [m], or with units")  # fmt: skip
    add("--opening", type=options.length, metavar="D", default=f"{defaults.OPENING:g}",
        help="diameter of the openings [m], or with a unit")  # fmt: skip
    add("--thickness", type=options.length, metavar="H", default=f"{defaults.THICKNESS:g}",
        help="thickness of the sheet [m], or with a unit")  # fmt: skip
    add("--sphere", metavar="NAME", default=defaults.SPHERE, help="material of the beads")
    add("--plate", metavar="NAME", default=defaults.PLATE, help="material of the sheet")
    add("--speed", type=options.speed, metavar="V", default=f"{defaults.SPEED:g}",
        help="speed at which the feed comes down [m/s], or with a unit")  # fmt: skip
    add("--frequency", type=float, metavar="F", default=defaults.FREQUENCY,
        help="frequency of the deck [1/s]")  # fmt: skip
    add("--amplitude", type=options.length, metavar="A", default=f"{defaults.AMPLITUDE:g}",
        help="amplitude of the deck [m], or with a unit, at 45 degrees to it")  # fmt: skip
    add("--friction", type=float, metavar="MU", default=defaults.FRICTION,
        help="coefficient of friction, on the deck and of beads on each other")  # fmt: skip
    add("--duration", type=float, metavar="T", default=defaults.DURATION,
        help="simulated time [s]")  # fmt: skip
    add("--seed", type=int, metavar="S", default=defaults.SEED,
        help="the same seed gives the same feed")  # fmt: skip
    add("--law", metavar="NAME", default=argparse.SUPPRESS,
        help="contact law, of those that contactlaw cor --help lists (default: the one there)"
    )  # fmt: skip
    add("--constant-cor", type=float, metavar="E", default=argparse.SUPPRESS,
        help="COR of the other run (default: the law's for a thick block, at the feed's speed)"
    )  # fmt: skip
    add("--out", type=Path, metavar="DIR", default=Path("sieve"), help="folder for the results")
    sieve.set_defaults(start=start)


class _Plan(NamedTuple):
    """The scene, its two models, and what the records say of it."""

    scene: Sieve
    law: ImpactModel
    constant: ImpactModel
    constant_cor: float
    step: float
    engine: tuple[str, str]
    command: str


def start(arguments: argparse.Namespace, command: str) -> int:
    """Run the command; returns its exit status."""
    engine = engines.load(defaults.ENGINE)
    try:
        with undisturbed():  # extension modules of matplotlib drop an interrupt, or crash
            from dem_demo import session
            from dem_demo.sieve import products, record, report

        version, rank = engine.version(), engine.rank()
    except ModuleNotFoundError as error:
        hint = f"pip install contactlaw[{engine.EXTRAS}]"
        raise Refused(f"{error.name} is missing: {hint}") from error
    plan = _plan(arguments, (defaults.ENGINE, version), command)
    if rank > 0:
        for constant in (False, True):
            _run(plan, None, constant=constant)
        return 0
    kind = products.kind()
    steps = session.Steps(
        simulate=partial(_simulate, plan, files=kind.files),
        read=record.read,
        summary=report.summary,
        progress=report.progress,
        make=products.make,
        sentence=_sentence,
    )
    return session.deliver(arguments.out, kind, steps)


def _plan(arguments: argparse.Namespace, engine: tuple[str, str], command: str) -> _Plan:
    """Scene and models; whatever they refuse is refused now."""
    from contactlaw import ImpactModel, Pair, laws
    from contactlaw.cli.parts import wording
    from dem_demo.sieve.constant import constant_model
    from dem_demo.sieve.engine import time_step
    from dem_demo.sieve.scene import sieve

    names = (
        "beads", "radius", "opening", "thickness", "sphere", "plate", "speed", "frequency",
        "amplitude", "friction", "duration", "seed",
    )  # fmt: skip
    try:
        scene = sieve(**{name: getattr(arguments, name) for name in names})
        pair = Pair(scene.sphere_material, scene.plate_material)
        model = ImpactModel(pair, getattr(arguments, "law", laws.DEFAULT), outside="clamp")
        cor = getattr(arguments, "constant_cor", None)
        if cor is None:
            cor = round(_thick(model, scene), 3)
        constant = constant_model(pair, cor)
        step = time_step(scene, model)
    except ValueError as error:
        raise Refused(wording.sentence(error, vars(arguments))) from error
    return _Plan(scene, model, constant, cor, step, engine, command)


def _thick(model: ImpactModel, scene: Sieve) -> float:
    """COR of the law where the sheet is thick: what a drop test on a block would tell."""
    from math import inf

    from dem_demo.sieve.constant import LEAST

    speed = max(abs(float(scene.velocity[2])), 0.1)
    return max(LEAST, float(model.restitution(speed, float(scene.radius.mean()), inf)))


def _run(plan: _Plan, recorder: Any, *, constant: bool) -> None:
    from math import inf

    from dem_demo.sieve import engine

    engine.run(
        plan.scene,
        plan.constant if constant else plan.law,
        recorder,
        thickness=inf if constant else plan.scene.thickness,
        step=plan.step,
        name=f"COR {plan.constant_cor:g}" if constant else "law",
        dump=not constant,
    )


def _simulate(plan: _Plan, folder: Path, files: Set[str]) -> BaseException | None:
    """Fill a folder with the deck and the records; returns what stopped it, if anything did."""
    from mpi4py import MPI

    from dem_demo.session import FORESEEN
    from dem_demo.sieve.deck import FORM, write_stl
    from dem_demo.sieve.record import CONSTANT, RECORD, sieve_recorder

    triangles = plan.scene.deck.triangles()
    write_stl(folder / FORM, triangles)
    for name, constant in ((RECORD, None), (CONSTANT, plan.constant_cor)):
        recorder = sieve_recorder(
            folder / name, plan.scene, plan.law, triangles, engine=plan.engine,
            command=plan.command, files=files, ranks=MPI.COMM_WORLD.size, time_step=plan.step,
            constant_cor=constant,
        )  # fmt: skip
        with recorder:
            try:
                _run(plan, recorder, constant=constant is not None)
            except (Exception, Interrupted) as error:
                if not isinstance(error, FORESEEN):
                    traceback.print_exc()
                recorder.reason = _sentence(error)
                return error
        if recorder.disk_error is not None:
            return recorder.disk_error
    return None


def _sentence(error: BaseException) -> str:
    from dem_demo import disk

    return disk.complaint(error) if isinstance(error, OSError) else str(error) or repr(error)
