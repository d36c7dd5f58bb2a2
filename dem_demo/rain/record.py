"""Writing and reading the record of a rain, rain.h5, which figures and report are made from."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw import ImpactModel, Pair
from contactlaw.record.file import write
from dem_demo.kit import recorder
from dem_demo.kit.beads import Floats
from dem_demo.kit.recorder import Dataset, Making, Recorded, Recorder
from dem_demo.rain.scene import Beads, Plate, Scene

NAME, SCHEMA = "rain", 4


def rain_recorder(path: Path, scene: Scene, making: Making) -> Recorder:
    """Make the recorder of a rain, for a file."""
    numbers = "seed", "duration", "frame_rate", "friction"
    spin = [Dataset("spin", "f4", "rad/s", "counterclockwise seen from the front; 0 once gone")]
    return Recorder(
        path,
        making,
        {"scene": NAME, "scene_schema": SCHEMA, **{one: getattr(scene, one) for one in numbers}},
        lambda file: _write_scene(file, scene),
        [
            Dataset("position", "f4", "m", "centre (x, y); of a bead that is gone: where it left"),
            Dataset("velocity", "f4", "m/s", "velocity (x, y); of a bead that is gone: 0"),
            Dataset("status", "u1", "1", "0 waiting for its emission, 1 flying, 2 gone"),
            *(spin if scene.friction > 0.0 else []),
        ],
        scene.frame_rate,
    )


def _write_scene(file: h5py.File, scene: Scene) -> None:
    plates, beads = file.create_group("plates"), file.create_group("beads")
    for name, description in (
        ("thickness", "thickness, inf: half-space"),
        ("x0", "left end"),
        ("x1", "right end"),
        ("y", "height of the upper face"),
    ):
        values = [getattr(plate, name) for plate in scene.plates]
        write(plates, name, values, "m", description)
    for name, units, description in (
        ("radius", "m", "radius"),
        ("emission_time", "s", "time at which the bead leaves its nozzle"),
        ("position", "m", "centre (x, y) at emission"),
        ("velocity", "m/s", "velocity (x, y) at emission"),
    ):
        write(beads, name, getattr(scene.beads, name), units, description)


@dataclass(frozen=True, eq=False, kw_only=True)
class Run(Recorded):
    """One recorded rain."""

    scene: Scene
    spin: NDArray[np.float32] | None = None  # shape (T, N) [rad/s], counterclockwise; of friction

    @cached_property
    def model(self) -> ImpactModel:
        """The impact model.

        Its curves may lie outside the table where no recorded impact does: there it takes the value
        at the border, and flags it.
        """
        outside = "clamp" if self.outside == "raise" else self.outside
        return ImpactModel(self.pair, self.law, outside=outside)

    @cached_property
    def on_plates(self) -> NDArray[np.void]:
        """Impacts on plates."""
        rows: NDArray[np.void] = self.impacts[self.impacts["plate"] >= 0]
        return rows

    @cached_property
    def edge_distance(self) -> Floats:
        """Distance [m] of all impacts on plates from the nearest edge of the plate."""
        rows = self.on_plates
        x0, x1 = np.array([(plate.x0, plate.x1) for plate in self.scene.plates])[rows["plate"]].T
        distance: Floats = np.minimum(rows["x"] - x0, x1 - rows["x"])
        return distance.clip(0.0)  # rounding may put a contact with the rim beside the plate


def read(path: Path) -> Run:
    """Read a file that `dem-demo rain` has written; a `ValueError` if it is something else."""
    with h5py.File(path, "r") as file:
        fields = recorder.read(file, path, NAME, SCHEMA)
        return Run(scene=_scene(file, fields["record"].bodies[0].pair), **fields)


def read_folder(folder: Path) -> Run:
    """Read the record in a folder."""
    return read(folder / f"{NAME}.h5")


def _scene(file: h5py.File, pair: Pair) -> Scene:
    plates = [file[f"plates/{name}"][()].tolist() for name in ("thickness", "x0", "x1", "y")]
    sphere, plate = pair.given
    fields = ("radius", "emission_time", "position", "velocity")
    return Scene(
        beads=Beads(**{name: file[f"beads/{name}"][()] for name in fields}),
        plates=[Plate(*values) for values in zip(*plates, strict=True)],
        sphere_material=sphere,
        plate_material=plate,
        duration=float(file.attrs["duration"]),
        seed=int(file.attrs["seed"]),
        frame_rate=float(file.attrs["frame_rate"]),
        friction=float(file.attrs.get("friction", 0.0)),
    )
