"""Writing a run while it happens: frames and impacts, as an HDF5 file that explains itself.

The layout of the file is that of `contactlaw.engines.layout`, plus what the scene writes.
"""

from __future__ import annotations

import datetime
import io
import platform
import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw import ImpactModel
from contactlaw.engines import layout
from contactlaw.engines.record import IMPACT, OBSERVED
from dem_demo.kit.disk import Disk, complaint
from dem_demo.kit.signals import Interrupted, noted, raise_dropped, undisturbed

COMPLETE, PARTIAL = "complete", "partial"  # values of the attribute "state" of a closed file
FORESEEN = (Interrupted, OSError, ValueError, RuntimeError)  # their messages suffice: no traceback


class Dataset(NamedTuple):
    """A dataset of the file with one entry per frame."""

    name: str
    kind: str
    shape: tuple[int, ...]
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
    """Writes one run to an HDF5 file.

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
    columns : iterable of str, optional
        Columns of the table of impacts if none happens.

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
        columns: Iterable[str] = OBSERVED,
    ) -> None:
        raise_dropped()  # nothing has been written yet
        self.folder = path.parent
        self._path, self._disk = path, Disk(path)
        self._files, self._frame_rate = {*making.files}, frame_rate
        self._frames, self._columns = 0, list(columns)
        with undisturbed():
            self._file = h5py.File(self._disk, "w")
            self._file.attrs.update(_made(scene, making))
            self._file.attrs.update(attributes)
            write_scene(self._file)
            self._trajectories = self._file.create_group("trajectories")
            for name, kind, shape, unit, description in (
                Dataset("time", "f8", (), "s", "time of the frame"), *trajectories,
            ):  # fmt: skip
                layout.grow(self._trajectories, name, kind, unit, description, shape)
            layout.begin_impacts(self._file, axes)

    def record(
        self, run: Callable[[Recorder], None], sentence: Callable[[BaseException], str]
    ) -> BaseException | None:
        """Let an engine run, then close the file with a note whether the run is complete.

        Parameters
        ----------
        run : callable
            Runs the engine, and passes frames and impacts to the recorder.
        sentence : callable
            Puts an error into words.

        Returns
        -------
        BaseException or None
            What stopped the run, if anything did.
        """
        stop: BaseException | None = None
        reason = ""
        try:
            run(self)
        except (Exception, Interrupted) as error:
            if not isinstance(error, FORESEEN):
                traceback.print_exc()
            stop, reason = error, sentence(error)
        finally:
            with noted():
                self._close(reason)
        return stop or self._disk.error

    def frame(self, frame: NamedTuple) -> None:
        """Append one frame; its fields have the names of the datasets.

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
            layout.append_impacts(self._file, table)

    def _close(self, reason: str) -> None:
        if not layout.has_impacts(self._file):
            layout.append_impacts(self._file, np.empty(0, IMPACT[self._columns]))
        if not reason and self._disk.error is not None:
            reason = complaint(self._disk.error)
        own = {file.name for file in self.folder.iterdir() if not file.name.startswith(".")}
        self._file.attrs["state"] = PARTIAL if reason else COMPLETE
        self._file.attrs["reason"] = reason
        self._file.attrs["files"] = sorted(self._files | own)
        self._file.close()
        if self._disk.error is not None:
            _write_shorter(self._path, self._disk.content(), self._frames)
        elif self._frames == 0:
            self._path.unlink()  # nothing has been simulated
        self._disk.close()


def _made(scene: str, making: Making) -> dict[str, object]:
    engine, version_of_engine = making.engine
    law, cor = making.model.force_law, making.constant_cor
    return {
        "format": layout.FORMAT + scene,
        "command": making.command,
        "engine": engine,
        f"version_{engine}": version_of_engine,
        # The family's name suffices where the pair gives the numbers of the law.
        "law": law.family if law.from_pair else law.name,
        "outside": making.model.outside,
        "time_step": making.time_step,
        **({} if cor is None else {"constant_cor": cor}),
        "created": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "version_contactlaw": version("contactlaw"),
        "version_numba": version("numba"),
        "version_numpy": np.__version__,
        "version_python": platform.python_version(),
        "units": "SI: metres, seconds, kilograms, newtons, joules; each dataset names its own",
    }


def _write_shorter(path: Path, content: bytes, frames: int) -> None:
    """Write a record that the disk had no room for, with every collision but fewer frames.

    The frames are halved at least once, which leaves room for the other files.
    """
    while frames > 0:
        frames //= 2
        short = io.BytesIO()
        with h5py.File(io.BytesIO(content), "r+") as whole, h5py.File(short, "w") as part:
            for dataset in whole["trajectories"].values():
                dataset.resize(frames, axis=0)
            part.attrs.update(whole.attrs)
            for name in whole:
                whole.copy(name, part)
        try:
            path.write_bytes(short.getvalue())
        except OSError:
            continue
        return
    path.unlink()
