"""Plates: rectangles with a thickness."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import scalars
from contactlaw.walls.motion import Motion, check_motion, vector

Vector = Sequence[float]
Models = ImpactModel | Mapping[int, ImpactModel]  # for all beads, or by their atom type

_SQUARE = 1e-9  # cosine of two edges that count as perpendicular: rounding of a rotated pair


@dataclass(frozen=True, slots=True)
class Plate:
    """A rectangular plate.

    Parameters
    ----------
    corner : sequence of 3 floats
        One of its corners [m].
    edge_a, edge_b : sequence of 3 floats
        From there to the two neighbouring corners [m]; perpendicular.
    thickness : float
        Thickness for the model [m]; ``inf`` is the half-space. It is no geometry: beads touch the
        rectangle itself, from either side.
    model : ImpactModel or dict of int to ImpactModel, optional
        For a plate of another material than that of the attached model; by atom type.
    motion : Translation, Rotation, Vibration or Tabulated, optional
        How it moves; it stands still otherwise.

    Raises
    ------
    ValueError
        If the three vectors span no rectangle, or the thickness is no positive number.

    Examples
    --------
    >>> Plate((0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), thickness=1e-3).thickness
    0.001
    """

    corner: Vector
    edge_a: Vector
    edge_b: Vector
    thickness: float
    model: Models | None = None
    motion: Motion | None = None

    def __post_init__(self) -> None:
        """Refuse what is no plate."""
        vector("corner", self.corner)
        a, b = vector("edge_a", self.edge_a), vector("edge_b", self.edge_b)
        area = float(np.linalg.norm(a) * np.linalg.norm(b))
        if not area > 0.0 or not abs(a @ b) <= _SQUARE * area:
            raise ValueError(
                f"edge_a, edge_b: must be perpendicular and of some length [m], got "
                f"{self.edge_a!r} and {self.edge_b!r}"
            )
        scalars(thickness=self.thickness)
        check_models(self.model)
        check_motion(self.motion)


def by_type(models: Models | None, types: int) -> dict[int, ImpactModel]:
    """Models by atom type, from 1."""
    if models is None:
        return {}
    if isinstance(models, Mapping):
        return {int(kind): model for kind, model in models.items()}
    return dict.fromkeys(range(1, types + 1), models)


def check_models(models: Any) -> None:
    """Refuse what is no model, and no model for each of some atom types."""
    if models is None or isinstance(models, ImpactModel):
        return
    if not isinstance(models, Mapping):
        raise TypeError(
            "model: expected a contactlaw.ImpactModel, or a dict of them by atom type, got "
            f"{models!r}"
        )
    for kind, model in models.items():
        if not isinstance(kind, int | np.integer) or isinstance(kind, bool) or kind < 1:
            raise ValueError(f"model: atom types are integers from 1 on, got {kind!r}")
        if not isinstance(model, ImpactModel):
            raise TypeError(
                f"model: expected a contactlaw.ImpactModel for atom type {kind}, got {model!r}"
            )
