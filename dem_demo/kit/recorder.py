"""Recording a run: its frames and impacts, as an HDF5 file that explains itself.

The layout of the file is that of `contactlaw.record.file`, plus what the scene writes. The file
is written when the run has ended, in whichever way: HDF5 can neither be interrupted halfway nor
close a file that the disk has no room for. The record of a run fits into memory, because figures
and page need all of it at once.
"""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw import ImpactModel, Pair
from contactlaw.engines.record import IMPACT
from contactlaw.record.file import Record, bodies_of, write
from dem_demo.kit import disk, signals
from dem_demo.kit.signals import Interrupted

COMPLETE, PARTIAL = "complete", "partial"  # values of the attribute "state" of a file
FORESEEN = (Interrupted, OSError, ValueError, RuntimeError)  # their messages suffice: no traceback


class Dataset(NamedTuple):
    """A dataset of the file with one entry per frame."""

    name: str
    kind: str
    unit: str
    description: str


class Making(NamedTuple):
    """Model, engine and command that a run is made with."""

    model: ImpactModel
    """Model of the impacts; with a constant COR, the model to compare them with."""
    engine: tuple[str, str]
    """Name and version of the engine."""
    command: str
    """Command line of the run."""
    files: Iterable[str]
    """Names of the files that will be made of the record; files of the engine are added."""
    time_step: float
    """Time step of the engine [s]."""
    constant_cor: float | None = None
    """COR of every impact; None if the model gives it."""


class Recorder:
    """Keeps the frames and impacts of one run in memory, and writes them to an HDF5 file.

    Parameters
    ----------
    path : Path
        File to create.
    scene : str
        Name of the scene.
    making : Making
        Model, engine and command of the run.
    attributes : mapping
        Further attributes of the file.
    write_scene : callable
        Writes beads and walls into the open file.
    trajectories : sequence of Dataset
        Datasets with one entry per frame; the time of the frame is added.
    frame_rate : float
        Frames per second [1/s].
    axes : str
        What the columns of the table of impacts mean in this file.

    Attributes
    ----------
    folder : Path
        Folder of the file; an engine may write files of its own there.
    """

    def __init__(
        self,
        path: Path,
        scene: str,
        making: Making,
        *,
        attributes: Mapping[str, object],
        write_scene: Callable[[h5py.File], None],
        trajectories: Sequence[Dataset],
        frame_rate: float,
        axes: str,
    ) -> None:
        self.folder, self._path = path.parent, path
        self._attributes, self._model = {**_made(scene, making), **attributes}, making.model
        self._files, self._write_scene, self._axes = {*making.files}, write_scene, axes
        self._trajectories, self._frame_rate = trajectories, frame_rate
        self._frames: list[dict[str, NDArray[Any]]] = []
        self._impacts: list[NDArray[np.void]] = []

    def record(
        self, run: Callable[[Recorder], None], sentence: Callable[[BaseException], str]
    ) -> BaseException | None:
        """Let an engine run, then write the file with a note whether the run is complete.

        Parameters
        ----------
        run : callable
            Runs the engine, and passes frames and impacts to the recorder.
        sentence : callable
            Puts an error into words.

        Returns
        -------
        BaseException or None
            What stopped the run or kept frames out of the file, if anything did.
        """
        stop: BaseException | None = None
        reason = ""
        try:
            signals.check()
            run(self)
        except (Exception, Interrupted) as error:
            if not isinstance(error, FORESEEN):
                traceback.print_exc()
            stop, reason = error, sentence(error)
        with signals.held():
            full = self._save(reason)
        return stop or full

    def frame(self, frame: NamedTuple) -> None:
        """Append one frame; its fields have the names of the datasets."""
        values = frame._asdict()
        self._frames.append({one.name: np.array(values[one.name], one.kind)
                             for one in self._trajectories})  # fmt: skip
        signals.check()

    def collisions(self, table: NDArray[np.void]) -> None:
        """Append collisions, in the columns that their table has."""
        self._impacts.append(table.copy())  # of the few rows; a view would keep the whole table

    def _save(self, reason: str) -> OSError | None:
        """Write the file if there is a frame; returns why it has fewer frames, if it has.

        If the disk has no room, it gets every impact but half of the frames, or half of these, and
        so on. That leaves room for the other files.
        """
        frames, full = len(self._frames), None
        while frames:
            try:
                disk.write(self._path, self._content(frames, reason))
                break
            except OSError as error:
                frames, full, reason = frames // 2, error, reason or disk.complaint(error)
        return full

    def _content(self, frames: int, reason: str) -> bytes:
        others = {file.name for file in self.folder.iterdir() if not file.name.startswith(".")}
        rows = np.concatenate(self._impacts or [np.empty(0, IMPACT)])
        on_plate = bodies_of(self._model)
        sphere = on_plate.pair.sphere
        bodies = [on_plate, on_plate._replace(pair=Pair(sphere, sphere))]
        made = {**self._attributes, "state": PARTIAL if reason else COMPLETE, "reason": reason,
                "files": sorted(self._files | others)}  # fmt: skip
        record = Record(rows, bodies, (rows["plate"] < 0).astype(np.int64), None, made)
        return record.content(partial(self._write_rest, frames))

    def _write_rest(self, frames: int, file: h5py.File) -> None:
        """Write the scene, its frames and what its columns of impacts mean."""
        file["impacts"].attrs["description"] = self._axes
        self._write_scene(file)
        group, time = file.create_group("trajectories"), np.arange(frames) / self._frame_rate
        write(group, "time", time, "s", "time of the frame")
        for name, _, unit, description in self._trajectories:
            values = np.stack([frame[name] for frame in self._frames[:frames]])
            write(group, name, values, unit, description)


def _made(scene: str, making: Making) -> dict[str, object]:
    engine, version_of_engine = making.engine
    law, cor = making.model.force_law, making.constant_cor
    return {
        "scene": scene,
        "command": making.command,
        "engine": engine,
        f"version_{engine}": version_of_engine,
        # The family's name suffices where the pair gives the numbers of the law.
        "law": law.family if law.from_pair else law.name,
        "outside": making.model.outside,
        "time_step": making.time_step,
        **({} if cor is None else {"constant_cor": cor}),
        "version_numba": version("numba"),
    }
