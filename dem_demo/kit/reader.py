"""Reading what every record says of its run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import h5py
import numpy as np
from numpy.typing import NDArray

from contactlaw.engines import layout
from dem_demo.kit.beads import Floats
from dem_demo.kit.recorder import COMPLETE, PARTIAL


@dataclass(frozen=True, eq=False, kw_only=True)
class Recorded:
    """What the record of any scene has.

    Attributes
    ----------
    law : str
        Contact law; with a constant COR the one that it is to be compared with.
    outside : str
        What the model does outside its table.
    constant_cor : float or None
        The COR of every impact, where there is one.
    engine, command, created : str
        What ran it, the command line that made it, and when.
    versions : dict of str
        Of the programs that made it, by name.
    reason : str
        Why it is partial; empty if it is complete.
    collisions : structured ndarray
        One row per impact, as in `contactlaw.engines.record`; with a constant COR in an engine that
        resolves an impact at once, it ends with the COR.
    time, position, velocity, status : ndarray
        Frames (T,) [s], (T, N, 2 or 3) [m], (T, N, 2 or 3) [m/s], (T, N).
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
    time: Floats
    position: NDArray[np.float32]
    velocity: NDArray[np.float32]
    status: NDArray[np.uint8]


def closed(file: h5py.File, path: Path, name: str, schema: int) -> dict[str, Any]:
    """Attributes of a record of a scene; a `ValueError` if it is something else or is open."""
    attributes = dict(file.attrs)
    form, found, state = (attributes.get(name) for name in ("format", "schema", "state"))
    wanted = layout.FORMAT + name
    if (form, found) != (wanted, schema) or state not in (COMPLETE, PARTIAL):
        raise ValueError(
            f"{path}: not a closed file of format {wanted!r}, schema {schema}, but "
            f"format {form!r}, schema {found}, state {state}: run the {name} again"
        )
    return attributes


def common(file: h5py.File) -> dict[str, Any]:
    """Read what every record has, the frames too, by the names that a run has for it."""
    attributes = dict(file.attrs)
    names = "law", "outside", "engine", "command", "created", "reason"
    versions = {
        name.removeprefix("version_"): text
        for name, text in attributes.items()
        if name.startswith("version_")
    }
    return {
        **{name: attributes[name] for name in names},
        "constant_cor": attributes.get("constant_cor"),
        "versions": versions,
        "collisions": layout.impacts(file),
        **{name: dataset[()] for name, dataset in file["trajectories"].items()},
    }
