"""Finite element results, where they exist: ``validation/data/fem_*.h5``.

Figures draw them as points, and claims that need them are judged by them; without them, those
claims stay open. What is read:

- ``fem_indentation.h5``: ``compression_5`` [m], ``force_5`` [N], the paper's bead pressed into a
  half-space to 5 d_Y and drawn back;
- ``fem_matrix.h5``: ``speed`` [m/s], ``thickness`` [m], ``restitution``, ``contact_time`` [s],
  impacts of the paper's bead on plates;
- ``fem_paper.h5``: ``largest_plastic_strain`` of the impact at 26 m/s on 0.5 mm.
"""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np

DATA = Path(__file__).parent / "data"


def read(name: str) -> dict[str, np.ndarray] | None:
    """Datasets of ``fem_<name>.h5``; None where there is no such file."""
    path = DATA / f"fem_{name}.h5"
    if not path.exists():
        return None
    with h5py.File(path, "r") as file:
        return {key: value[()] for key, value in file.items()}
