"""Writing and reading the two records of a bed, which runs under the law and with a constant COR.

The run under the law is in NAME.h5, that with a constant COR in constant.h5.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

import h5py

from contactlaw.record.file import write
from dem_demo.kit import recorder
from dem_demo.kit.beads import Floats
from dem_demo.kit.bed import Bed
from dem_demo.kit.recorder import Dataset, Making, Recorded, Recorder

CONSTANT = "constant.h5"

S = TypeVar("S", bound=Bed)


@dataclass(frozen=True, eq=False, kw_only=True)
class Run(Recorded, Generic[S]):
    """One recorded run of a bed."""

    scene: S
    ranks: int  # MPI processes
    kinetic: Floats  # energies of all beads at each frame, shape (T,) [J]
    rotational: Floats
    potential: Floats
    elapsed: Floats  # computing time until each frame, shape (T,) [s]

    @property
    def dissipated(self) -> Floats:
        """Energy that each impact lost at its wall, without sliding friction [J]."""
        rows = self.collisions
        lost: Floats = rows["plastic_energy"] + rows["wave_energy"] + rows["other_energy"] + rows["scheme_energy"]
        return lost

    @property
    def name(self) -> str:
        """Short name of the run: its law, or its constant COR."""
        return f"law {self.law}" if self.constant_cor is None else f"COR {self.constant_cor:.3g}"


@dataclass(frozen=True, eq=False)
class Runs(Generic[S]):
    """The same bed under the law and with a constant COR."""

    law: Run[S]
    constant: Run[S]

    @property
    def both(self) -> list[Run[S]]:
        """The runs, that of the law first."""
        return [self.law, self.constant]


def bed_recorder(path: Path, scene: Bed, making: Making, ranks: int) -> Recorder:
    """Make the recorder of a bed, for a file; `ranks` is the number of MPI processes."""
    attributes = {name: getattr(scene, name) for name in scene.NUMBERS}
    energy = "kinetic", "rotational", "potential"
    return Recorder(
        path,
        making,
        {**attributes, "scene": scene.NAME, "scene_schema": scene.SCHEMA, "ranks": ranks},
        lambda file: _write(file, scene),
        [
            Dataset("position", "f4", "m", "centre; of a bead that is gone: where it was"),
            Dataset("velocity", "f4", "m/s", "velocity; of a bead that is gone: 0"),
            Dataset("status", "u1", "1", "1 in the box, 2 gone"),
            *(Dataset(name, "f8", "J", f"{name} energy of all beads") for name in energy),
            Dataset("elapsed", "f8", "s", "computing time so far"),
        ],
        scene.FRAME_RATE,
    )


def _write(file: h5py.File, scene: Bed) -> None:
    beads = file.create_group("beads")
    write(beads, "radius", scene.radius, "m", "radius")
    write(beads, "position", scene.position, "m", "centre (x, y, z) at the start")
    text = "velocity (x, y, z) of all at the start"
    write(beads, "velocity", scene.velocity, "m/s", text)
    scene.write_walls(file)


def read(folder: Path, scene: type[S]) -> Runs[S]:
    """Read the records of a kind of scene in a folder."""
    law, constant = (read_one(folder / name, scene) for name in (f"{scene.NAME}.h5", CONSTANT))
    return Runs(law, constant)


def read_one(path: Path, scene: type[S]) -> Run[S]:
    """Read one record of a kind of scene; a `ValueError` if the file is something else."""
    with h5py.File(path, "r") as file:
        fields = recorder.read(file, path, scene.NAME, scene.SCHEMA)
        made = fields["record"].made
        sphere, plate = fields["record"].bodies[0].pair.given
        return Run(
            scene=scene(
                **{name: file[f"beads/{name}"][()] for name in ("radius", "position", "velocity")},
                **{name: made[name].item() for name in scene.NUMBERS},
                **scene.read_walls(file),
                sphere_material=sphere,
                plate_material=plate,
            ),
            ranks=int(made["ranks"]),
            **fields,
        )
