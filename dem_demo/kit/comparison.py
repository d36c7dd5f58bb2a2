"""A bed that is simulated twice: under the law, and with one COR for all impacts on its walls."""

from __future__ import annotations

import argparse
import math
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from contactlaw import ImpactModel, Pair, laws
from dem_demo.kit import drawing, lammps, recorder, session, signals, tale
from dem_demo.kit.bed import Bed
from dem_demo.kit.constant import LEAST, constant_model
from dem_demo.kit.recorder import Making
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
    arguments: argparse.Namespace, command: str, chosen: Plan, texts: Tale, drawn: type[drawing.Drawing[Any]]
) -> int:
    """Simulate both runs, and write the records, figures, summary and page."""
    kind = type(chosen.scene)
    show = session.Show(
        kind.NAME,
        texts.figures,
        partial(read, scene=kind),
        partial(tale.summary, texts),
        partial(tale.page, texts),
        partial(drawing.gif, drawn),
    )
    if lammps.rank() > 0:
        stop = _simulate(chosen, command, None)
        if stop is not None:
            raise stop  # the command waits until rank 0 has kept the records
        return 0
    return session.deliver(arguments.out, show, partial(_simulate, chosen, command))


def _simulate(chosen: Plan, command: str, folder: Path | None) -> BaseException | None:
    """Write both records into a folder, which rank 0 knows; returns what stopped a run, if any."""
    from mpi4py import MPI

    first, scene = folder is not None, chosen.scene
    folder = MPI.COMM_WORLD.bcast(folder)
    if first:
        scene.write_files(folder)
    MPI.COMM_WORLD.barrier()
    for name, model, thickness, cor in (
        (f"{scene.NAME}.h5", chosen.law, scene.thickness, None),
        (CONSTANT, chosen.constant, math.inf, chosen.constant_cor),
    ):
        making = Making(chosen.law, command, chosen.step, cor)
        writes = bed_recorder(folder / name, scene, making, MPI.COMM_WORLD.size) if first else None
        begin = partial(lammps.Simulation, scene, model, thickness, chosen.step, folder)
        title = "law" if cor is None else f"COR {cor:g}"
        with signals.held():  # a signal has to stop all ranks at the same step
            stop = recorder.run(begin, scene.frames, title, writes)
        if stop is not None:
            return stop
    return None
