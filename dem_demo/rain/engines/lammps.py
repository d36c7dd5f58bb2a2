"""The rain in LAMMPS: three dimensions, LAMMPS's own contact of two beads, any number of ranks.

The scene's x and height become LAMMPS's x and z. The plates, and the rows of nozzles above them,
are as deep as a plate is wide. Contacts of two beads are not recorded.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from dem_demo.kit.beads import FLYING, GONE, GRAVITY, WAITING, Floats
from dem_demo.kit.bed import EXTRAS as EXTRAS
from dem_demo.kit.lammps import COLUMNS, Gathering, box, gathered, made, record, set_sizes
from dem_demo.kit.lammps import rank as rank
from dem_demo.kit.lammps import version as version
from dem_demo.rain.frame import Frame
from dem_demo.rain.scene import Scene

if TYPE_CHECKING:
    from contactlaw import ImpactModel
    from dem_demo.kit.recorder import Recorder

ABOUT = "three dimensions, under mpirun too"
DIMENSIONS = 3
DURATION = 0.3  # [s]; short, since a contact of microseconds takes 20 steps
FRAME_RATE = 1000.0  # [1/s]
NO_CONSTANT_COR = "LAMMPS's plates follow the law"
BEAD_ON_BEAD = "LAMMPS's own contact, not recorded"
DUMP = "rain.lammpstrj"

_AROUND = 0.1  # [m], room beside and above the scene in the simulation box
# With its default bin size LAMMPS would make millions of bins: 30 ms per neighbour list.
_BIN = 6.0  # [largest radius], size of the bins
_RESERVE = 3.0  # heavy beads may drive light ones to this multiple of the top speed


def time_step(scene: Scene, model: ImpactModel) -> float:
    """Largest step [s] that the hardest impacts allow, and that divides a frame."""
    from contactlaw.softsphere import time_step as longest_step

    speed, radius = _RESERVE * scene.top_speed, float(scene.beads.radius.min())
    least = min(longest_step(model, speed, radius, plate.thickness) for plate in scene.plates)
    frame = 1.0 / scene.frame_rate
    return float(frame / np.ceil(frame / least))


class _Rain:
    """A scene in a LAMMPS box; every rank has one."""

    def __init__(self, scene: Scene, model: ImpactModel, dump: str) -> None:
        self.lmp, self.comm = made()
        from contactlaw.engines.lammps import Plate, attach
        from dem_demo.rain.nozzles import DEPTH, depths

        self.scene, self.density = scene, model.pair.sphere.density
        self.step = time_step(scene, model)
        self.steps = round(1.0 / (scene.frame_rate * self.step))
        self.lmp.commands_string(self._input(model))
        deep = 0, DEPTH, 0
        plates = [
            Plate((p.x0, -0.5 * DEPTH, p.y), (p.x1 - p.x0, 0, 0), deep, p.thickness, edges="free")
            for p in scene.plates
        ]
        self.plates = attach(self.lmp, model, plates, friction=scene.friction)
        self.lmp.command(f"dump rain all custom {self.steps} {dump} {COLUMNS}")
        self.lmp.command("dump_modify rain sort id first yes")
        n = scene.beads.radius.size
        self.depth = depths(scene)
        self.impacts = Gathering(self.comm, self.plates)
        self.emitted = 0
        self.late = np.empty(0, dtype=np.int64)  # beads whose place was taken when they were due
        self.frames = 0
        self.now = Frame(
            scene.beads.position.copy(),
            scene.beads.velocity.copy(),
            np.full(n, WAITING, np.uint8),
            self.depth.copy(),
            np.zeros(n),
        )

    def _input(self, model: ImpactModel) -> str:
        from contactlaw.engines.lammps import pair_coeff

        scene, radius = self.scene, self.scene.beads.radius
        nozzles = scene.beads.position[:, 0]
        left = min(nozzles.min(), *(plate.x0 for plate in scene.plates)) - _AROUND
        right = max(nozzles.max(), *(plate.x1 for plate in scene.plates)) + _AROUND
        top = float(scene.beads.position[:, 1].max()) + _AROUND
        size = float(radius.max())
        bead_on_bead = pair_coeff(
            model.pair.sphere, radius=float(radius.mean()), speed=0.5 * scene.top_speed
        )
        low, high = (left, -_AROUND, scene.floor), (right, _AROUND, top)
        return box(
            low, high, size=size, bins=_BIN * size, step=self.step, bead_on_bead=bead_on_bead
        )

    def advance(self) -> None:
        """Simulate one frame; the beads emitted during it appear at its end, at their places then.

        A bead whose place is taken by a rebounding one waits for the next frame.
        """
        self.lmp.command(f"run {self.steps} post no")
        self.frames += 1
        beads, time = self.scene.beads, self.frames / self.scene.frame_rate
        until = int(np.searchsorted(beads.emission_time, time, side="right"))
        new = np.r_[self.late, self.emitted : until]
        age = time - beads.emission_time[new]
        age[: self.late.size] = 0.0
        x, height = (beads.position[new] + beads.velocity[new] * age[:, None]).T
        height = height - 0.5 * GRAVITY * age**2
        u, w = beads.velocity[new].T
        position = np.column_stack((x, self.depth[new], height))
        velocity = np.column_stack((u, np.zeros_like(u), w - GRAVITY * age))
        self.emitted = until
        if new.size:
            fits = self._fits(position)
            self.late = new[~fits]
            if fits.any():
                self._create(new[fits], position[fits], velocity[fits])

    def _fits(self, position: Floats) -> NDArray[np.bool_]:
        """Mask of places at which a bead can appear, after those before it in the list."""
        reach = 2.0 * float(self.scene.beads.radius.max())
        here = self.lmp.extract_setting("nlocal")
        others = self.lmp.numpy.extract_atom("x")[:here] if here else np.empty((0, 3))
        near = others[others[:, 2] > position[:, 2].min() - reach]
        taken = np.concatenate([*self.comm.allgather(near), position])
        count = len(taken) - len(position)
        fits = np.zeros(len(position), dtype=bool)
        for n, place in enumerate(position):
            fits[n] = not (((taken[:count] - place) ** 2).sum(axis=1) < reach**2).any()
            taken[count] = place
            count += int(fits[n])
        return fits

    def _create(self, index: NDArray[np.int64], position: Floats, velocity: Floats) -> None:
        n = index.size
        self.now.status[index] = FLYING
        ids = (index + 1).tolist()
        self.lmp.create_atoms(n, ids, [1] * n, position.ravel().tolist(), velocity.ravel().tolist())
        beads = self.scene.beads
        set_sizes(self.lmp, index, beads.radius, beads.mass(self.density))

    def look(self) -> Frame | None:
        """Gather the beads of all ranks: on rank 0, None on the others."""
        rows = gathered(self.lmp, self.comm, "id", "x", "v", "omega")
        if rows is None:
            return None
        bead, now = rows[:, 0].astype(int) - 1, self.now
        gone = now.status != WAITING
        gone[bead] = False
        now.status[gone] = GONE
        assert now.depth is not None
        assert now.spin is not None
        now.velocity[gone] = now.spin[gone] = 0.0
        now.position[bead], now.velocity[bead] = rows[:, [1, 3]], rows[:, [4, 6]]
        now.depth[bead] = rows[:, 2]
        now.spin[bead] = -rows[:, 8]  # LAMMPS's y points into the picture
        return now

    def collisions(self) -> NDArray[np.void] | None:
        """Gather new impacts on plates, in the axes of the scene: on rank 0, None on the others."""
        rows = self.impacts.take()
        if rows is not None:
            rows["y"], rows["z"] = rows["z"].copy(), rows["y"].copy()
            # The exchange is a reflection, which also turns spins round.
            rows["spin_x"] = -rows["spin_x"]
            rows["spin_y"], rows["spin_z"] = -rows["spin_z"], -rows["spin_y"]
        return rows


def run(scene: Scene, model: ImpactModel, recorder: Recorder | None) -> None:
    """Simulate the rain, and record it.

    Parameters
    ----------
    scene : Scene
        Beads and plates.
    model : ImpactModel
        The law of the plates, and the COR of bead on bead.
    recorder : Recorder or None
        Records every frame and all collisions; None on all ranks but 0. The file for OVITO goes
        into its folder.
    """
    from mpi4py import MPI

    folder = MPI.COMM_WORLD.bcast(None if recorder is None else recorder.folder)
    rain = _Rain(scene, model, str(folder / DUMP))
    frames = range(scene.frames)
    if recorder is not None:
        frames = tqdm(frames, desc="rain", unit="frame", disable=None)
    record(rain, recorder)
    for _ in frames:
        rain.advance()
        record(rain, recorder)
    rain.lmp.close()
