"""Reading the parts that the records of all scenes share."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw.record.file import read_from
from dem_demo.kit.beads import Floats


@dataclass(frozen=True, eq=False, kw_only=True)
class Recorded:
    """The parts of a run that the record of any scene has.

    Attributes
    ----------
    law : str
        Contact law; of a run with a constant COR, the law to compare it with.
    outside : str
        Policy of the model for impacts outside its table.
    constant_cor : float or None
        COR of every impact; None if a law gives it.
    engine, command, created : str
        Name of the engine, command line, and date and time.
    versions : dict of str
        Versions of the programs that made the record, by name.
    reason : str
        Why the run is partial; empty if it is complete.
    collisions : structured ndarray
        One row per impact, as in `contactlaw.engines.record`. With a constant COR in an engine that
        resolves an impact in one step, the columns after the COR are missing.
    impact : ndarray of bool
        Mask of the collisions that are impacts.
    left_out : str
        Which collisions are none; empty if all are impacts.
    time, position, velocity, status : ndarray
        Frames: shapes (T,) [s], (T, N, 2 or 3) [m], (T, N, 2 or 3) [m/s] and (T, N).
    """

    law: str
    outside: Literal["raise", "solve", "clamp"]
    constant_cor: float | None
    engine: str
    command: str
    created: str
    versions: dict[str, str]
    reason: str
    collisions: NDArray[np.void]
    impact: NDArray[np.bool_]
    left_out: str
    time: Floats
    position: NDArray[np.float32]
    velocity: NDArray[np.float32]
    status: NDArray[np.uint8]

    @property
    def impacts(self) -> NDArray[np.void]:
        """Collisions that are impacts; COR and speed of the others mean nothing."""
        rows: NDArray[np.void] = self.collisions[self.impact]
        return rows


def checked(file: h5py.File, path: Path, name: str, schema: int) -> dict[str, Any]:
    """Attributes of a scene's record; `ValueError` if it is another file."""
    attributes = dict(file.attrs)
    found = tuple(attributes.get(one) for one in ("scene", "scene_schema"))
    if found != (name, schema):
        raise ValueError(
            f"{path}: no record of the scene {name!r}, schema {schema}, but of {found[0]!r}, "
            f"schema {found[1]}: run the {name} again"
        )
    return attributes


def common(file: h5py.File) -> dict[str, Any]:
    """Read the fields of `Recorded`, and all datasets of the frames, by the names of the fields."""
    attributes = dict(file.attrs)
    names = "law", "outside", "engine", "command", "created", "reason"
    versions = {
        name.removeprefix("version_"): text
        for name, text in attributes.items()
        if name.startswith("version_")
    }
    record = read_from(file)
    record = record.part(np.argsort(record.rows["time"], kind="stable"))
    return {
        **{name: attributes[name] for name in names},
        "constant_cor": attributes.get("constant_cor"),
        "versions": versions,
        "collisions": record.rows,
        "impact": record.impact,
        "left_out": record.left_out,
        "pair": record.bodies[0].pair,
        **{name: dataset[()] for name, dataset in file["trajectories"].items()},
    }
