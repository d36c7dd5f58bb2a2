"""A bed that is simulated twice: under the law, and with one COR for all impacts on its walls."""

from __future__ import annotations

import argparse
import math
import warnings
from collections.abc import Callable
from functools import partial
from importlib import metadata
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from contactlaw import ImpactModel, Pair, laws
from dem_demo.kit import drawing, lammps, options, session, signals
from dem_demo.kit.constant import LEAST, constant_model
from dem_demo.kit.figures import energy, load, restitution, snapshot
from dem_demo.kit.run import Making, Run, simulate
from dem_demo.kit.scene import Bed

CONSTANT = "constant.h5"


class Planned(NamedTuple):
    """A run of a bed: its record, the model of its walls, their thickness in it [m], and the rest."""

    name: str
    model: ImpactModel
    thickness: float
    making: Making


def plan(scene: Bed, command: str, law: str = laws.DEFAULT, constant_cor: float | None = None) -> list[Planned]:
    """Choose the models of both runs, so that arguments out of range are refused before.

    The default of the constant COR is the law's COR on a half-space at the speed at which the beads
    come down: the result of a drop test on a thick block.
    """
    pair = Pair(scene.sphere_material, scene.plate_material)
    model, cor = ImpactModel(pair, law, outside="clamp"), constant_cor
    if cor is None:
        speed = max(float(-scene.velocity[0, 2]), 0.1)
        cor = round(max(LEAST, float(model.restitution(speed, float(scene.radius.mean()), math.inf))), 3)
    making = Making(model, command, lammps.time_step(scene, model))
    return [
        Planned(f"{scene.NAME}.h5", model, scene.thickness, making),
        Planned(CONSTANT, constant_model(pair, cor), math.inf, making._replace(constant_cor=cor)),
    ]


def start(make: Callable[..., Bed], arguments: argparse.Namespace, command: str, own: ModuleType) -> int:
    """Simulate both runs, and write the records, figures, summary and page; `own` draws a figure."""
    with options.needing(options.LAMMPS):
        from mpi4py import MPI

        metadata.version("lammps")
    warnings.filterwarnings("ignore", "softening: an impact")  # the title says how deep it was
    with options.refusing(arguments):
        scene = make(**options.of(make, arguments))
        begin = partial(_simulate, scene, plan(scene, command, **options.of(plan, arguments)))
    if MPI.COMM_WORLD.rank > 0:
        _, stop = begin(None)
        if stop is not None:
            raise stop  # the command waits until rank 0 has kept the records
        return 0
    show = session.Show((own, energy, load, restitution, snapshot), drawing.gif)
    return session.deliver(arguments.out, show, begin)


def _simulate(scene: Bed, planned: list[Planned], folder: Path | None) -> tuple[list[Run[Any]], BaseException | None]:
    """Write both records into a folder, which rank 0 knows; returns what stopped a run, if any."""
    from mpi4py import MPI

    first, runs = folder is not None, []
    folder = MPI.COMM_WORLD.bcast(folder)
    if first:
        scene.write_files(folder)
    MPI.COMM_WORLD.barrier()
    for name, model, thickness, making in planned:
        begin = partial(lammps.Simulation, scene, model, thickness, making.time_step, folder)
        with signals.held():  # a signal has to stop all ranks at the same step
            run, stop = simulate(begin, scene, making, folder / name if first else None)
        if stop is not None:
            return [], stop
        runs += [run] if run is not None else []
    return runs, None
