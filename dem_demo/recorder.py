"""A run's file: written frame by frame while it goes on, read back by figures and report."""

from __future__ import annotations

import datetime
import io
import platform
from collections.abc import Callable, Mapping, Sequence, Set
from importlib.metadata import version
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Self

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw import ImpactModel, Material
from contactlaw.engines.record import COLUMNS, IMPACT, OBSERVED
from contactlaw.laws import Law
from dem_demo.disk import Disk, complaint
from dem_demo.folder import files as _files
from dem_demo.scene import Scene
from dem_demo.signals import raise_dropped, undisturbed, unstoppable

RECORD = "rain.h5"
FORMAT, SCHEMA = "contactlaw-rain", 3
COMPLETE, PARTIAL = "complete", "partial"  # what the attribute "state" of a closed file says
_ROWS = 1024  # collisions that are stored together

# The columns' own descriptions are those of any engine; this is what they mean in this file.
_AXES = (
    "one row per impact; bead and other are rows of /beads, plate of /plates; x is horizontal, y "
    "points up, z is the depth"
)


class Dataset(NamedTuple):
    """What a file holds of each frame under one name."""

    name: str
    kind: str
    shape: tuple[int, ...]
    unit: str
    description: str


class Recorder:
    """Writes one run to an HDF5 file; a context manager.

    Parameters
    ----------
    path : Path
        File to create.
    attributes : mapping
        What the file says of itself, beside when and by which versions it was made.
    write_scene : callable
        Writes what is known before the run into the open file.
    trajectories : sequence of Dataset
        What there is of each frame; its time comes by itself.
    frame_rate : float
        Frames per second [1/s].
    axes : str
        What the columns of impacts mean in this file.
    files : set of str
        Names of the files that will be made of it; those of the engine's own join them.

    Attributes
    ----------
    folder : Path
        Where the file is; an engine may put one of its own there.
    reason : str or None
        Why the run is partial, a sentence; None if nothing has gone wrong.
    """

    def __init__(
        self,
        path: Path,
        *,
        attributes: Mapping[str, object],
        write_scene: Callable[[h5py.File], None],
        trajectories: Sequence[Dataset],
        frame_rate: float,
        axes: str,
        files: Set[str],
    ) -> None:
        raise_dropped()  # nothing has been written yet
        self.folder = path.parent
        self.reason: str | None = None
        self._path, self._disk = path, Disk(path)
        self._files, self._frame_rate = files, frame_rate
        self._frames = 0
        with undisturbed():
            self._file = h5py.File(self._disk, "w")
            self._file.attrs.update(_made())
            self._file.attrs.update(attributes)
            write_scene(self._file)
            self._trajectories = self._file.create_group("trajectories")
            _create(self._trajectories, "time", (_ROWS,), "f8", "s", "time of the frame")
            for name, kind, shape, unit, description in trajectories:
                chunk = (1 if shape else _ROWS, *shape)
                _create(self._trajectories, name, chunk, kind, unit, description)
            self._collisions = self._file.create_group("collisions")
            self._collisions.attrs["description"] = axes

    @property
    def disk_error(self) -> OSError | None:
        """What the disk said, if it is full."""
        return self._disk.error

    def __enter__(self) -> Self:
        """Return the recorder."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Close the file, and say in it whether the rain is complete."""
        with unstoppable():
            if not self._collisions.keys():
                self._append(np.empty(0, IMPACT[list(OBSERVED)]))
            if self.reason is None and self._disk.error is not None:
                self.reason = complaint(self._disk.error)
            self._file.attrs["state"] = COMPLETE if self.reason is None else PARTIAL
            self._file.attrs["reason"] = self.reason or ""
            self._file.attrs["files"] = sorted(self._files | {f.name for f in _files(self.folder)})
            self._file.close()
            if self._disk.error is not None:
                _write_shorter(self._path, self._disk.content(), self._frames)
            self._disk.close()

    def frame(self, frame: NamedTuple) -> None:
        """Append one frame, whose fields have the names of the datasets.

        Raises
        ------
        OSError
            If the disk is full; what has been recorded is safe.
        """
        with undisturbed():
            values = {"time": self._frames / self._frame_rate, **frame._asdict()}
            for name, value in values.items():
                if value is not None:
                    dataset = self._trajectories[name]
                    dataset.resize(self._frames + 1, axis=0)
                    dataset[self._frames] = value
            self._frames += 1
        raise_dropped()
        if self._disk.error is not None:
            raise self._disk.error

    def collisions(self, table: NDArray[np.void]) -> None:
        """Append collisions, in the columns that their table has."""
        with undisturbed():
            self._append(table)

    def _append(self, table: NDArray[np.void]) -> None:
        if self._collisions.keys() and not table.size:
            return
        for name, kind, unit, description in COLUMNS:
            if name in (table.dtype.names or ()):
                if name not in self._collisions:
                    _create(self._collisions, name, (_ROWS,), kind, unit, description)
                column = self._collisions[name]
                before = column.size
                column.resize(before + table.size, axis=0)
                column[before:] = table[name]


def rain_recorder(
    path: Path,
    scene: Scene,
    model: ImpactModel,
    *,
    engine: tuple[str, str],
    command: str,
    files: Set[str],
    time_step: float,
    dimensions: int,
    constant_cor: float | None = None,
    bead_on_bead: str | None = None,
) -> Recorder:
    """Begin the record of a rain.

    Parameters
    ----------
    path : Path
        File to create.
    scene : Scene
        What is recorded.
    model : ImpactModel
        What rules the impacts; in the baseline what to compare them with.
    engine : tuple of str
        Name and version of the engine.
    command : str
        Command line that made the file.
    files : set of str
        Names of the files that will be made of it.
    time_step : float
        The engine's step [s].
    dimensions : int
        Of the engine, 2 or 3.
    constant_cor : float, optional
        The COR of every contact, in the baseline.
    bead_on_bead : str, optional
        What is to be said of beads that hit beads, where the engine does not record them.
    """
    attributes: dict[str, object] = {
        "format": FORMAT,
        "schema": SCHEMA,
        **made_by(engine, command, model),
        "seed": scene.seed,
        "duration": scene.duration,
        "frame_rate": scene.frame_rate,
        "time_step": time_step,
    }
    if constant_cor is not None:
        attributes["constant_cor"] = constant_cor
    if bead_on_bead is not None:
        attributes["bead_on_bead"] = bead_on_bead
    return Recorder(
        path,
        attributes=attributes,
        write_scene=lambda file: _write_scene(file, scene),
        trajectories=_trajectories(scene, dimensions),
        frame_rate=scene.frame_rate,
        axes=_AXES,
        files=files,
    )


def _name(law: Law) -> str:
    """Name by which the pair gets the law again: without the numbers that are the pair's own."""
    return law.family if law.from_pair else law.name


def made_by(engine: tuple[str, str], command: str, model: ImpactModel) -> dict[str, object]:
    """Attributes that tell what made a run: engine and its version, command line, law."""
    return {
        "command": command,
        "engine": engine[0],
        f"version_{engine[0]}": engine[1],
        "law": _name(model.force_law),
        "outside": model.outside,
    }


def _made() -> dict[str, object]:
    return {
        "created": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "version_contactlaw": version("contactlaw"),
        "version_numba": version("numba"),
        "version_numpy": np.__version__,
        "version_python": platform.python_version(),
        "units": "SI: metres, seconds, kilograms, newtons, joules; each dataset names its own",
    }


def write(group: h5py.Group, name: str, values: object, units: str, description: str) -> None:
    """Write an array that says what it is."""
    data = np.asarray(values)
    dataset = group.create_dataset(name, data=data, compression="gzip" if data.size else None)
    dataset.attrs.update({"units": units, "description": description})


def write_materials(file: h5py.File, sphere: Material, plate: Material) -> None:
    """Write all that is known of the two materials."""
    for part, material in (("sphere", sphere), ("plate", plate)):
        file.create_group(f"materials/{part}").attrs.update(_attributes(material))


def _write_scene(file: h5py.File, scene: Scene) -> None:
    write_materials(file, scene.sphere_material, scene.plate_material)
    plates = file.create_group("plates")
    for name, description in (
        ("thickness", "thickness, inf: half-space"),
        ("x0", "left end"),
        ("x1", "right end"),
        ("y", "height of the upper face"),
    ):
        write(plates, name, [getattr(plate, name) for plate in scene.plates], "m", description)
    beads = file.create_group("beads")
    for name, units, description in (
        ("radius", "m", "radius"),
        ("emission_time", "s", "time at which the bead leaves its nozzle"),
        ("position", "m", "centre (x, y) at emission"),
        ("velocity", "m/s", "velocity (x, y) at emission"),
    ):
        write(beads, name, getattr(scene.beads, name), units, description)
    mass = scene.beads.mass(scene.sphere_material.density)
    write(beads, "mass", mass, "kg", "mass of the sphere")


def _attributes(material: Material) -> Mapping[str, object]:
    values: dict[str, object] = {
        "name": material.name,
        "youngs_modulus": material.youngs_modulus,
        "poissons_ratio": material.poissons_ratio,
        "density": material.density,
        "source": material.source,
        "units": "Pa (moduli, strength, hardness), kg/m3",
    }
    for name in ("yield_strength", "kind", "hardness"):
        if getattr(material, name) is not None:
            values[name] = getattr(material, name)
    return values


def _create(
    group: h5py.Group, name: str, chunk: tuple[int, ...], kind: str, units: str, description: str
) -> None:
    """Make an empty dataset that grows along its first axis, chunk by chunk."""
    shape, most = (0, *chunk[1:]), (None, *chunk[1:])
    dataset = group.create_dataset(
        name, shape, kind, maxshape=most, chunks=chunk, compression="gzip"
    )
    dataset.attrs.update({"units": units, "description": description})


def _trajectories(scene: Scene, dimensions: int) -> list[Dataset]:
    beads = scene.beads.radius.size
    return [
        Dataset("position", "f4", (beads, 2), "m", "centre (x, y); of a bead that is gone: where "
                "it left"),
        Dataset("velocity", "f4", (beads, 2), "m/s", "velocity (x, y); of a bead that is gone: 0"),
        Dataset("status", "u1", (beads,), "1", "0 waiting for its emission, 1 flying, 2 gone"),
        *[Dataset("depth", "f4", (beads,), "m", "third coordinate of the centre")]
        [: dimensions - 2],
    ]  # fmt: skip


def _write_shorter(path: Path, content: bytes, frames: int) -> None:
    """Write a record that the disk had no room for, with every collision but fewer frames.

    Half of the room is left to what else there is to write.
    """
    while frames > 0:
        frames //= 2
        with h5py.File(io.BytesIO(content), "r+") as whole:
            for dataset in whole["trajectories"].values():
                dataset.resize(frames, axis=0)
            short = io.BytesIO()
            with h5py.File(short, "w") as part:
                part.attrs.update(whole.attrs)
                for name in whole:
                    whole.copy(name, part)
        try:
            path.write_bytes(short.getvalue())
        except OSError:
            continue
        return
    path.unlink()
