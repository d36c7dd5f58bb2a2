"""The records of a bed that ran twice, under the law and with one COR; written and read.

NAME.h5 is that of the law, constant.h5 the other one.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw import ImpactModel, Pair
from contactlaw.engines import layout
from dem_demo.kit.beads import Floats
from dem_demo.kit.bed import Bed
from dem_demo.kit.reader import closed, common
from dem_demo.kit.recorder import Dataset, Recorder, made_by

CONSTANT = "constant.h5"

S = TypeVar("S", bound=Bed)


@dataclass(frozen=True, eq=False)
class Run(Generic[S]):
    """One recorded run of a bed.

    Attributes
    ----------
    scene : Bed
        What fell on what.
    law : str
        Contact law; with a constant COR the one that it is to be compared with.
    constant_cor : float or None
        The COR of every impact, where there is one.
    ranks : int
        Processes that shared the work.
    engine, command, created : str
        What made it, the command line, and when.
    versions : dict of str
        Of the programs that made it, by name.
    reason : str
        Why it is partial; empty if it is complete.
    collisions : structured ndarray
        One row per impact on a wall, as in `contactlaw.engines.record`.
    time : ndarray, shape (T,)
        Of the frames [s].
    position, velocity, status : ndarray
        Frames (T, N, 3) [m], (T, N, 3) [m/s], (T, N).
    kinetic, rotational, potential, elapsed : ndarray, shape (T,)
        Energies of all beads [J], and computing time [s].
    """

    scene: S
    law: str
    constant_cor: float | None
    ranks: int
    engine: str
    command: str
    created: str
    versions: dict[str, str]
    reason: str
    collisions: NDArray[np.void]
    time: Floats
    position: NDArray[np.float32]
    velocity: NDArray[np.float32]
    status: NDArray[np.uint8]
    kinetic: Floats
    rotational: Floats
    potential: Floats
    elapsed: Floats

    @property
    def pair(self) -> Pair:
        """Materials."""
        return Pair(self.scene.sphere_material, self.scene.plate_material)

    @property
    def dissipated(self) -> Floats:
        """Energy that each impact has lost at its wall, but for friction [J]."""
        rows = self.collisions
        lost: Floats = rows["plastic_energy"] + rows["wave_energy"] + rows["other_energy"]
        return lost

    @property
    def name(self) -> str:
        """What ruled its impacts, in a few words."""
        return f"law {self.law}" if self.constant_cor is None else f"COR {self.constant_cor:.3g}"


@dataclass(frozen=True, eq=False)
class Runs(Generic[S]):
    """The same bed twice: under the law, and with a constant COR if it got so far."""

    law: Run[S]
    constant: Run[S] | None

    @property
    def every(self) -> list[Run[S]]:
        """Those there are."""
        return [self.law] if self.constant is None else [self.law, self.constant]

    @property
    def reason(self) -> str:
        """Why they are partial; empty if they are complete."""
        return next((run.reason for run in self.every if run.reason), "")


def bed_recorder(
    path: Path,
    scene: Bed,
    model: ImpactModel,
    *,
    engine: tuple[str, str],
    command: str,
    files: Iterable[str],
    ranks: int,
    time_step: float,
    constant_cor: float | None = None,
) -> Recorder:
    """Begin the record of a bed.

    Parameters
    ----------
    path : Path
        File to create.
    scene : Bed
        What is recorded.
    model : ImpactModel
        What rules the impacts; with a constant COR what to compare them with.
    engine : tuple of str
        Name and version of the engine.
    command : str
        Command line that made the file.
    files : iterable of str
        Names of the files that will be made of it.
    ranks : int
        Processes that share the work.
    time_step : float
        The engine's step [s].
    constant_cor : float, optional
        The COR of every impact, where there is one.
    """
    attributes = {
        **made_by(scene.NAME, engine, command, model),
        "schema": scene.SCHEMA,
        **{name: getattr(scene, name) for name in scene.NUMBERS},
        "ranks": ranks,
        "time_step": time_step,
    }
    if constant_cor is not None:
        attributes["constant_cor"] = constant_cor
    n = scene.radius.size
    energy = "kinetic", "rotational", "potential"
    return Recorder(
        path,
        attributes=attributes,
        write_scene=lambda file: _write(file, scene),
        trajectories=[
            Dataset("position", "f4", (n, 3), "m", "centre; of a bead that is gone: where it was"),
            Dataset("velocity", "f4", (n, 3), "m/s", "velocity; of a bead that is gone: 0"),
            Dataset("status", "u1", (n,), "1", "1 in the box, 2 gone"),
            *(Dataset(name, "f8", (), "J", f"{name} energy of all beads") for name in energy),
            Dataset("elapsed", "f8", (), "s", "computing time so far"),
        ],
        frame_rate=scene.FRAME_RATE,
        axes=scene.AXES,
        files=files,
    )


def _write(file: h5py.File, scene: Bed) -> None:
    layout.write_materials(file, scene.sphere_material, scene.plate_material)
    beads = layout.write_beads(file, scene.radius, scene.mass)
    layout.write(beads, "position", scene.position, "m", "centre (x, y, z) at the start")
    text = "velocity (x, y, z) of all at the start"
    layout.write(beads, "velocity", scene.velocity, "m/s", text)
    scene.write_walls(file)


def read(folder: Path, scene: type[S]) -> Runs[S]:
    """Read the records of a kind of scene in a folder."""
    constant = folder / CONSTANT
    law = read_one(folder / f"{scene.NAME}.h5", scene)
    return Runs(law, read_one(constant, scene) if constant.exists() else None)


def read_one(path: Path, scene: type[S]) -> Run[S]:
    """Read one record of a kind of scene.

    Raises
    ------
    ValueError
        If the file is something else, of another schema, or was never closed.
    """
    with h5py.File(path, "r") as file:
        attributes = closed(file, path, scene.NAME, scene.SCHEMA)
        sphere, plate = layout.materials(file)
        return Run(
            scene=scene(
                **{name: file[f"beads/{name}"][()] for name in ("radius", "position", "velocity")},
                **{name: attributes[name].item() for name in scene.NUMBERS},
                **scene.read_walls(file),
                sphere_material=sphere,
                plate_material=plate,
            ),
            ranks=int(attributes["ranks"]),
            collisions=layout.impacts(file),
            **common(attributes),
            **{name: dataset[()] for name, dataset in file["trajectories"].items()},
        )
