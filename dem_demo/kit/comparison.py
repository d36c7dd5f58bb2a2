"""A bed that is simulated twice: under the law, and with one COR for all impacts on its walls."""

from __future__ import annotations

import argparse
import math
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from contactlaw import ImpactModel, Pair, laws
from dem_demo.kit import disk, drawing, lammps, session, tale
from dem_demo.kit.bed import ENGINE, Bed
from dem_demo.kit.constant import LEAST, constant_model
from dem_demo.kit.recorder import Making, Recorder
from dem_demo.kit.runs import CONSTANT, bed_recorder, read
from dem_demo.kit.tale import Tale


class Plan(NamedTuple):
    """A scene, its two models, and the time step [s]."""

    scene: Bed
    law: ImpactModel
    constant: ImpactModel
    constant_cor: float
    step: float


def engine() -> None:
    """Import the engine; raises `ModuleNotFoundError` if it is missing."""
    lammps.version()
    lammps.rank()


def plan(arguments: argparse.Namespace, scene: Bed, speed: float) -> Plan:
    """Choose the models of a bed, so that arguments out of range are refused before the run.

    The default of the constant COR is the law's COR on a half-space at a speed [m/s]: the result of
    a drop test on a thick block.
    """
    pair = Pair(scene.sphere_material, scene.plate_material)
    law = ImpactModel(pair, getattr(arguments, "law", laws.DEFAULT), outside="clamp")
    cor = getattr(arguments, "constant_cor", None)
    if cor is None:
        thick = law.restitution(max(speed, 0.1), float(scene.radius.mean()), math.inf)
        cor = round(max(LEAST, float(thick)), 3)
    constant = constant_model(pair, cor)
    return Plan(scene, law, constant, cor, lammps.time_step(scene, law))


def start(
    arguments: argparse.Namespace,
    command: str,
    chosen: Plan,
    texts: Tale,
    drawn: type[drawing.Drawing[Any]],
    others: frozenset[str] = frozenset(),
) -> int:
    """Simulate both runs, and write the records, figures, summary and page.

    Parameters
    ----------
    arguments : Namespace
        Parsed options; ``out`` is the folder for the results.
    command : str
        Command line, for the records.
    chosen : Plan
        The scene, its two models and the time step.
    texts : Tale
        Titles, facts and figures of the scene.
    drawn : type of Drawing
        Class that draws a panel of the scene.
    others : set of str, optional
        Names of files that the scene writes beside its records.

    Returns
    -------
    int
        Exit status of the command.
    """
    kind = type(chosen.scene)
    show = session.Show(
        name=kind.NAME,
        others=frozenset({CONSTANT, *others}),
        figures=texts.figures,
        read=partial(read, scene=kind),
        summary=partial(tale.summary, texts),
        progress=tale.progress,
        page=partial(tale.page, texts),
        film=partial(drawing.gif, drawn),
        sentence=_sentence,
    )
    if lammps.rank() > 0:
        for constant in (False, True):
            _run(chosen, None, constant=constant)
        return 0
    return session.deliver(arguments.out, show, partial(_simulate, chosen, show, command))


def _run(chosen: Plan, recorder: Recorder | None, *, constant: bool) -> None:
    lammps.run(
        chosen.scene,
        chosen.constant if constant else chosen.law,
        recorder,
        thickness=math.inf if constant else chosen.scene.thickness,
        step=chosen.step,
        name=f"COR {chosen.constant_cor:g}" if constant else "law",
        dump=not constant,
    )


def _simulate(chosen: Plan, show: session.Show, command: str, folder: Path) -> BaseException | None:
    """Write both records into a folder; returns the exception that stopped a run, if any."""
    from mpi4py import MPI

    chosen.scene.write_files(folder)
    for name, cor in ((show.record, None), (CONSTANT, chosen.constant_cor)):
        making = Making(
            chosen.law, (ENGINE, lammps.version()), command, show.files, chosen.step, cor
        )
        recorder = bed_recorder(folder / name, chosen.scene, making, MPI.COMM_WORLD.size)
        stop = recorder.record(partial(_run, chosen, constant=cor is not None), _sentence)
        if stop is not None:
            return stop
    return None


def _sentence(error: BaseException) -> str:
    return disk.complaint(error) if isinstance(error, OSError) else str(error) or repr(error)
