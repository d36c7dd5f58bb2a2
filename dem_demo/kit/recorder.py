"""Running a scene and recording it, as an HDF5 file that explains itself.

The layout of the file is that of `contactlaw.Record`, with groups for what the scene writes and for
its frames. The file is written when the run has ended, in whichever way: HDF5 can neither be
interrupted halfway nor close a file that the disk has no room for.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, NamedTuple, Protocol

import h5py
import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from contactlaw import ImpactModel, Pair, Record, _atomic
from contactlaw.record.file import bodies_of, read_from, write
from contactlaw.reporting import page
from dem_demo.kit import signals
from dem_demo.kit.beads import Floats
from dem_demo.kit.signals import Interrupted


class Dataset(NamedTuple):
    """A dataset of the file with one entry per frame."""

    name: str
    kind: str
    unit: str
    description: str


class Making(NamedTuple):
    """How a run is made."""

    model: ImpactModel  # of the impacts; with a constant COR, the model to compare them with
    command: str
    time_step: float  # of the engine [s]
    constant_cor: float | None = None  # of every impact; None if the model gives it


class Simulation(Protocol):
    """A scene in an engine; under MPI every rank has one, and all call its functions."""

    def advance(self) -> None:
        """Simulate one frame."""

    def look(self) -> NamedTuple | None:
        """Return the current frame, with a field for each dataset; None on all ranks but 0."""

    def record(self) -> Record | None:
        """Return the contacts so far; None on all ranks but 0."""


class Recorder:
    """Keeps the frames of a run in memory, and writes them with its contacts.

    `attributes` are those of the scene, `write_scene` writes beads and walls into the open file.
    """

    def __init__(
        self,
        path: Path,
        making: Making,
        attributes: Mapping[str, object],
        write_scene: Callable[[h5py.File], None],
        trajectories: Sequence[Dataset],
        frame_rate: float,
    ) -> None:
        self.path, self._making, self._attributes = path, making, attributes
        self._write_scene, self._trajectories = write_scene, trajectories
        self._frame_rate = frame_rate
        self._frames: list[dict[str, NDArray[Any]]] = []

    def add(self, frame: NamedTuple) -> None:
        """Append one frame."""
        values = frame._asdict()
        self._frames.append({one.name: np.array(values[one.name], one.kind) for one in self._trajectories})

    def save(self, record: Record) -> None:
        """Write the file; without room for all, an `OSError` after the contacts alone are tried."""
        making, sphere = self._making, self._making.model.pair.sphere
        on_wall = bodies_of(making.model)
        bodies = [on_wall, on_wall._replace(pair=Pair(sphere, sphere))]
        made = {
            **record.made,
            **self._attributes,
            "command": making.command,
            "law": on_wall.law,
            "outside": making.model.outside,
            "time_step": making.time_step,
        }
        if making.constant_cor is not None:
            made["constant_cor"] = making.constant_cor
        on_bead = (record.rows["plate"] < 0).astype(np.int64)
        whole = replace(record, bodies=bodies, which=on_bead, made=made)
        try:
            _atomic.write(self.path, whole.content(self._write_rest))
        except OSError:
            _atomic.write(self.path, whole.content())
            raise

    def _write_rest(self, file: h5py.File) -> None:
        """Write the scene and its frames."""
        self._write_scene(file)
        if not self._frames:
            return
        group, count = file.create_group("trajectories"), len(self._frames)
        write(group, "time", np.arange(count) / self._frame_rate, "s", "time of the frame")
        for name, _, unit, description in self._trajectories:
            values = np.stack([frame[name] for frame in self._frames])
            write(group, name, values, unit, description)


def run(begin: Callable[[], Simulation], frames: int, name: str, recorder: Recorder | None) -> BaseException | None:
    """Simulate and record a run, and return what stopped it or kept frames out, if anything did.

    The recorder, which is None on all ranks but 0, writes its file in whichever way the run ends.
    """
    simulation: Simulation | None = None
    stop: BaseException | None = None
    try:
        simulation = begin()
        # None: no progress bar unless stderr is a terminal
        hidden = None if recorder is not None else True
        for n in tqdm(range(frames + 1), desc=name, unit="frame", disable=hidden):
            if n > 0:
                simulation.advance()
            frame = simulation.look()
            if recorder is not None and frame is not None:
                recorder.add(frame)
    except (Exception, Interrupted) as error:
        came = signals.first()  # the error may be what an interrupt has left that Python dropped
        stop = Interrupted(came) if came else error
    with signals.held():
        try:
            record = None if simulation is None else simulation.record()
            if recorder is not None and record is not None:
                recorder.save(record)
        except Exception as error:
            stop = stop or error
    return stop


@dataclass(frozen=True, eq=False, kw_only=True)
class Recorded:
    """The parts of a run that the record of any scene has."""

    # all contacts by time; with a constant COR in an engine that resolves an impact in one step,
    # the columns after the COR are missing
    record: Record
    time: Floats  # of the frames, shape (T,) [s]
    position: NDArray[np.float32]  # shape (T, N, 2 or 3) [m]
    velocity: NDArray[np.float32]  # shape (T, N, 2 or 3) [m/s]
    status: NDArray[np.uint8]  # shape (T, N)

    @property
    def collisions(self) -> NDArray[np.void]:
        """One row per contact, as in `contactlaw.engines.record`."""
        return self.record.rows

    @property
    def impacts(self) -> NDArray[np.void]:
        """Contacts that are impacts; COR and speed of the others mean nothing."""
        return self.record.impacts

    @property
    def pair(self) -> Pair:
        """Materials of beads and walls."""
        return self.record.bodies[0].pair

    @property
    def law(self) -> str:
        """Contact law; of a run with a constant COR, the law to compare it with."""
        return str(self.record.made["law"])

    @property
    def outside(self) -> Literal["raise", "solve", "clamp"]:
        """Policy for impacts outside the law's table."""
        found: Literal["raise", "solve", "clamp"] = self.record.made["outside"]
        return found

    @property
    def constant_cor(self) -> float | None:
        """COR of every impact; None if the law gives it."""
        return self.record.made.get("constant_cor")

    @property
    def made(self) -> str:
        """When the record was made, and by which versions."""
        known = self.record.made
        versions = {name.removeprefix("version_"): known[name] for name in known if name.startswith("version_")}
        return page.made(known["created"], versions)


def read(file: h5py.File, path: Path, name: str, schema: int) -> dict[str, Any]:
    """Read the fields of `Recorded`, and all datasets of the frames, by the names of the fields."""
    found = tuple(file.attrs.get(one) for one in ("scene", "scene_schema"))
    if found != (name, schema):
        raise ValueError(
            f"{path}: no record of the scene {name!r}, schema {schema}, but of {found[0]!r}, "
            f"schema {found[1]}: run the {name} again"
        )
    record = read_from(file)
    record = record.part(np.argsort(record.rows["time"], kind="stable"))
    return {"record": record, **{name: dataset[()] for name, dataset in file["trajectories"].items()}}
