"""rain.h5: written frame by frame while it rains, read back by the figures and the report."""

from __future__ import annotations

import datetime
import platform
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from types import TracebackType
from typing import Self

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw import Material
from contactlaw.engines.record import COLUMNS
from dem_demo.frame import Frame
from dem_demo.scene import Scene

FORMAT, SCHEMA = "contactlaw-rain", 2
CONSTANT = "constant"  # the law's name where every contact has the same COR

# The columns' own descriptions are those of any engine; this is what they mean in this file.
_AXES = (
    "one row per impact; bead and other are rows of /beads, plate of /plates; x is horizontal, y "
    "points up, z is the depth"
)


class Recorder:
    """Writes one rain to an HDF5 file; a context manager.

    Parameters
    ----------
    path : Path
        File to create.
    scene : Scene
        What is recorded.
    law : str
        Name of the contact law, or "constant".
    engine : tuple of str
        Name and version of the engine.
    command : str
        Command line that made the file.
    time_step : float
        The engine's step [s].
    dimensions : int
        Of the engine, 2 or 3.
    constant_cor : float, optional
        The COR of every contact, in the baseline.
    bead_on_bead : str, optional
        What is to be said of beads that hit beads, where the engine does not record them.
    """

    def __init__(
        self,
        path: Path,
        scene: Scene,
        *,
        law: str,
        engine: tuple[str, str],
        command: str,
        time_step: float,
        dimensions: int,
        constant_cor: float | None = None,
        bead_on_bead: str | None = None,
    ) -> None:
        self.folder = path.parent
        self._file = h5py.File(path, "x")
        self._frames = 0
        self._file.attrs.update(_provenance(engine, command))
        self._file.attrs.update({"law": law, "seed": scene.seed, "duration": scene.duration})
        self._file.attrs.update({"frame_rate": scene.frame_rate, "time_step": time_step})
        if constant_cor is not None:
            self._file.attrs["constant_cor"] = constant_cor
        if bead_on_bead is not None:
            self._file.attrs["bead_on_bead"] = bead_on_bead
        _write_scene(self._file, scene)
        self._trajectories = _create_trajectories(self._file, scene, dimensions)

    def __enter__(self) -> Self:
        """Return the recorder."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Close the file, and declare it complete if nothing went wrong."""
        if kind is None:
            self._file.attrs["complete"] = True
        self._file.close()

    def frame(self, frame: Frame) -> None:
        """Append one frame."""
        for name, values in frame._asdict().items():
            if values is not None:
                self._trajectories[name][self._frames] = values
        self._frames += 1

    def collisions(self, table: NDArray[np.void]) -> None:
        """Write all collisions, with those columns of the impact record that the engine gives."""
        group = self._file.create_group("collisions")
        group.attrs["description"] = _AXES
        for name, _, unit, description in COLUMNS:
            if name in (table.dtype.names or ()):
                _write(group, name, table[name], unit, description)


def _provenance(engine: tuple[str, str], command: str) -> dict[str, object]:
    return {
        "format": FORMAT,
        "schema": SCHEMA,
        "complete": False,
        "created": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "command": command,
        "engine": engine[0],
        f"version_{engine[0]}": engine[1],
        "version_contactlaw": version("contactlaw"),
        "version_numba": version("numba"),
        "version_numpy": np.__version__,
        "version_python": platform.python_version(),
        "units": "SI: metres, seconds, kilograms, newtons, joules; each dataset names its own",
    }


def _write(group: h5py.Group, name: str, values: object, units: str, description: str) -> None:
    data = np.asarray(values)
    dataset = group.create_dataset(name, data=data, compression="gzip" if data.size else None)
    dataset.attrs.update({"units": units, "description": description})


def _write_scene(file: h5py.File, scene: Scene) -> None:
    for part, material in (("sphere", scene.sphere_material), ("plate", scene.plate_material)):
        file.create_group(f"materials/{part}").attrs.update(_attributes(material))
    plates = file.create_group("plates")
    for name, description in (
        ("thickness", "thickness, inf: half-space"),
        ("x0", "left end"),
        ("x1", "right end"),
        ("y", "height of the upper face"),
    ):
        _write(plates, name, [getattr(plate, name) for plate in scene.plates], "m", description)
    beads = file.create_group("beads")
    for name, units, description in (
        ("radius", "m", "radius"),
        ("emission_time", "s", "time at which the bead leaves its nozzle"),
        ("position", "m", "centre (x, y) at emission"),
        ("velocity", "m/s", "velocity (x, y) at emission"),
    ):
        _write(beads, name, getattr(scene.beads, name), units, description)
    mass = scene.beads.mass(scene.sphere_material.density)
    _write(beads, "mass", mass, "kg", "mass of the sphere")


def _attributes(material: Material) -> Mapping[str, object]:
    values: dict[str, object] = {
        "name": material.name,
        "youngs_modulus": material.youngs_modulus,
        "poissons_ratio": material.poissons_ratio,
        "density": material.density,
        "source": material.source,
        "units": "Pa (moduli, strength), kg/m3",
    }
    if material.yield_strength is not None:
        values["yield_strength"] = material.yield_strength
    return values


def _create_trajectories(file: h5py.File, scene: Scene, dimensions: int) -> h5py.Group:
    """Datasets of their final size; frames are written into them one by one."""
    group = file.create_group("trajectories")
    frames, beads = scene.frames + 1, scene.beads.radius.size
    time = np.arange(frames) / scene.frame_rate
    _write(group, "time", time, "s", "time of the frame")
    for name, kind, size, units, description in (
        ("position", "f4", (2,), "m", "centre (x, y); of a bead that is gone: where it left"),
        ("velocity", "f4", (2,), "m/s", "velocity (x, y); of a bead that is gone: 0"),
        ("status", "u1", (), "1", "0 waiting for its emission, 1 flying, 2 gone"),
        *[("depth", "f4", (), "m", "third coordinate of the centre")][: dimensions - 2],
    ):
        shape = (frames, beads, *size)
        dataset = group.create_dataset(
            name, shape, kind, chunks=(1, beads, *size), compression="gzip"
        )
        dataset.attrs.update({"units": units, "description": description})
    return group
