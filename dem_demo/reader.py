"""Reading rain.h5 back: everything that the figures and the report need is in the file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw import ImpactModel, Pair
from contactlaw.cli.parts.hdf5 import material_of
from contactlaw.engines.record import IMPACT, fill
from dem_demo.recorder import COMPLETE, FORMAT, PARTIAL, SCHEMA
from dem_demo.scene import Beads, Floats, Plate, Scene


@dataclass(frozen=True, eq=False)
class Run:
    """One recorded rain.

    Attributes
    ----------
    scene : Scene
        What fell on what.
    law : str
        Contact law; in the baseline the one that it is to be compared with.
    outside : str
        What the model does outside its table.
    constant_cor : float or None
        The COR of every contact, in the baseline.
    engine : str
        Engine that ran it.
    bead_on_bead : str or None
        What is to be said of beads that hit beads, where the engine does not record them.
    command, created : str
        Command line that made it, and when.
    versions : dict of str
        Of the programs that made it, by name.
    reason : str
        Why it is partial; empty if it is complete.
    collisions : structured ndarray
        One row per collision: the impact record of `contactlaw.engines.record`. In the baseline it
        ends with the COR.
    time, position, velocity, status : ndarray
        Frames (T,) [s], (T, N, 2) [m], (T, N, 2) [m/s], (T, N).
    depth : ndarray or None
        Third coordinate (T, N) [m], if the engine has one.
    """

    scene: Scene
    law: str
    outside: Literal["raise", "solve", "clamp"]
    constant_cor: float | None
    engine: str
    bead_on_bead: str | None
    command: str
    created: str
    versions: dict[str, str]
    reason: str
    collisions: NDArray[np.void]
    time: Floats
    position: NDArray[np.float32]
    velocity: NDArray[np.float32]
    status: NDArray[np.uint8]
    depth: NDArray[np.float32] | None = None

    @cached_property
    def model(self) -> ImpactModel:
        """The impact model; for the baseline the one that it is to be compared with.

        Curves and the baseline's impacts may leave the table where no recorded impact has: there it
        takes the value at the border, and flags it.
        """
        pair = Pair(self.scene.sphere_material, self.scene.plate_material)
        outside = "clamp" if self.outside == "raise" else self.outside
        return ImpactModel(pair, self.law, outside=outside)

    @cached_property
    def modelled(self) -> NDArray[np.void]:
        """Impacts on plates with all that the model says of them: every column of the record.

        As recorded; only where the record has no flags, as in the baseline, is the model asked
        about the same impacts. Their COR is that of the run all the same.
        """
        recorded = self.collisions[self.collisions["plate"] >= 0]
        names = recorded.dtype.names or ()
        if "flags" in names:
            return recorded
        rows = np.zeros(recorded.size, IMPACT)
        for name in names:
            rows[name] = recorded[name]
        thickness = np.array([plate.thickness for plate in self.scene.plates])[rows["plate"]]
        radius = self.scene.beads.radius[rows["bead"]]
        rebound = self.model.lookup(rows["approach_speed"], radius, thickness)
        fill(rows, rebound, self.energy(rows))
        return rows

    @property
    def baseline(self) -> bool:
        """Whether every contact had the same COR."""
        return self.constant_cor is not None

    def energy(self, rows: NDArray[np.void]) -> Floats:
        """Kinetic energy of the normal motion before impacts on plates [J]."""
        mass = self.scene.beads.mass(self.scene.sphere_material.density)[rows["bead"]]
        energy: Floats = 0.5 * mass * rows["approach_speed"] ** 2
        return energy


def read(path: Path) -> Run:
    """Read a file that `dem-demo rain` has written.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    Run

    Raises
    ------
    ValueError
        If the file is something else, of another schema, or was never closed.
    """
    with h5py.File(path, "r") as file:
        attributes = closed(file, path, FORMAT, SCHEMA)
        frames = {name: dataset[()] for name, dataset in file["trajectories"].items()}
        return Run(
            scene=_scene(file),
            law=attributes["law"],
            outside=attributes["outside"],
            constant_cor=attributes.get("constant_cor"),
            engine=attributes["engine"],
            bead_on_bead=attributes.get("bead_on_bead"),
            command=attributes["command"],
            created=attributes["created"],
            versions=versions(attributes),
            reason=attributes["reason"],
            collisions=impacts(file["collisions"]),
            **frames,
        )


def _scene(file: h5py.File) -> Scene:
    plates = [file[f"plates/{name}"][()].tolist() for name in ("thickness", "x0", "x1", "y")]
    fields = ("radius", "emission_time", "position", "velocity")
    return Scene(
        beads=Beads(**{name: file[f"beads/{name}"][()] for name in fields}),
        plates=[Plate(*values) for values in zip(*plates, strict=True)],
        sphere_material=material_of(file["materials/sphere"]),
        plate_material=material_of(file["materials/plate"]),
        duration=float(file.attrs["duration"]),
        seed=int(file.attrs["seed"]),
        frame_rate=float(file.attrs["frame_rate"]),
    )


def closed(file: h5py.File, path: Path, form: str, schema: int) -> dict[str, Any]:
    """Attributes of a file of this format; a `ValueError` if it is something else or is open."""
    attributes = dict(file.attrs)
    found = [attributes.get(name) for name in ("format", "schema", "state")]
    if found[:2] != [form, schema] or found[2] not in (COMPLETE, PARTIAL):
        raise ValueError(
            f"{path}: not a closed file of format {form!r}, schema {schema}, but "
            f"format {found[0]!r}, schema {found[1]}, state {found[2]}: run the "
            f"{form.removeprefix('contactlaw-')} again"
        )
    return attributes


def versions(attributes: Mapping[str, Any]) -> dict[str, str]:
    """Versions of the programs that made a file, by name."""
    return {
        name.removeprefix("version_"): text
        for name, text in attributes.items()
        if name.startswith("version_")
    }


def impacts(group: h5py.Group) -> NDArray[np.void]:
    """Read a table of impacts by time, with the columns of the one record that it has."""
    columns = {name: group[name][()] for name in IMPACT.names or () if name in group}
    table = np.empty(columns["time"].size, [(name, IMPACT[name]) for name in columns])
    for name, column in columns.items():
        table[name] = column
    return table[np.argsort(table["time"], kind="stable")]
