"""Finite element results, where they exist: ``validation/data/fem_*.h5``.

``fem_indentation.h5`` has the 1-D datasets ``compression`` [m] and ``force`` [N] of the paper's
bead on a half-space; ``fem_impacts.h5`` has ``speed`` [m/s], ``thickness`` [m], ``restitution`` and
``contact_time`` [s] of the paper's bead on plates. Figures draw them as points.
"""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np

_DATA = Path(__file__).parent.parent / "data"


def read(name: str) -> dict[str, np.ndarray] | None:
    """Datasets of ``fem_<name>.h5``; None where there is no such file."""
    path = _DATA / f"fem_{name}.h5"
    if not path.exists():
        return None
    with h5py.File(path, "r") as file:
        return {key: value[()] for key, value in file.items() if isinstance(value, h5py.Dataset)}
