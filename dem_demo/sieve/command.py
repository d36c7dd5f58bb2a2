"""``dem-demo sieve``: its options, and its two runs: under the law, and with one COR for all impacts."""

from __future__ import annotations

import argparse
import warnings
from functools import partial
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dem_demo.kit import options
from dem_demo.sieve.scene import Sieve, sieve

if TYPE_CHECKING:
    from dem_demo.kit.run import Making, Run

_ABOUT = {
    "beads": ("N", "number of beads; the deck is as large as they need"),
    "radius": ("MIN,MAX", "radii of beads that pass the openings, and of others [m], or with units"),
    "opening": ("D", "diameter of the openings [m], or with a unit"),
    "speed": ("V", "speed at which the feed comes down [m/s], or with a unit"),
    "frequency": ("F", "frequency of the deck [1/s]"),
    "amplitude": ("A", "amplitude of the deck [m], or with a unit, at 45 degrees to it"),
}


def add(commands: Any) -> None:
    """Add the command to those of ``dem-demo``."""
    options.add_scene(
        commands,
        sieve,
        _ABOUT,
        _start,
        help="beads on a vibrating deck, a mesh from an STL file",
        description="Beads of two sizes fall on a vibrating, perforated deck of sheet metal, a mesh from an STL file. "
        "It is simulated twice: under the law, and with one COR for all impacts on the deck, which constant.h5 "
        "records. Writes a dump for OVITO, too. Works under mpirun.",
    ).add_argument(
        "--constant-cor",
        type=float,
        metavar="E",
        default=argparse.SUPPRESS,
        help="COR of the other run (default: the law's for a thick block, at the mean speed of the impacts)",
    )


def _start(arguments: argparse.Namespace, command: str) -> int:
    with options.needing("demo,lammps"):
        from mpi4py import MPI

        from dem_demo.kit import restitution, session
        from dem_demo.kit.run import Making
        from dem_demo.sieve import engine
        from dem_demo.sieve.constant import constant_model
        from dem_demo.sieve.figures import dissipation, energy

        metadata.version("lammps")
    warnings.filterwarnings("ignore", "softening: an impact")  # the title says how deep it was
    with options.refusing(arguments):
        scene = sieve(**options.of(sieve, arguments))
        model = options.model(scene, arguments, "clamp")
        cor = getattr(arguments, "constant_cor", None)
        if cor is not None:
            constant_model(model.pair, cor)
        making = Making(model, command, engine.time_step(scene, model))
    begin = partial(_simulate, scene, making, cor)
    if MPI.COMM_WORLD.rank > 0:
        _, stop = begin(None)
        if stop is not None:
            raise stop  # the command waits until rank 0 has kept the records
        return 0
    return session.deliver(arguments.out, session.Show((dissipation, energy, restitution)), begin)


def _simulate(
    scene: Sieve, making: Making, constant_cor: float | None, folder: Path | None
) -> tuple[list[Run[Any]], BaseException | None]:
    """Write both records into a folder, which rank 0 knows; returns what stopped a run, if any."""
    from mpi4py import MPI

    from dem_demo.sieve import constant, deck, engine

    first, comm = folder is not None, MPI.COMM_WORLD
    folder = comm.bcast(folder)
    if first:
        deck.write_stl(folder / deck.FORM, scene.deck.triangles())
    comm.barrier()
    run, stop = engine.simulated(scene, making, folder)
    if stop is not None:
        return [], stop
    cor = comm.bcast(constant_cor or (run and constant.thick_cor(run)))
    other, stop = engine.simulated(scene, making._replace(constant_cor=cor), folder)
    return [each for each in (run, other) if each is not None], stop
