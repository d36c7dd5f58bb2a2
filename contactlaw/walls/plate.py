"""Plates: rectangles with a thickness."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from contactlaw._errors import ArgumentError
from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import number, scalars, warn_of_metres
from contactlaw.physical.plates import Foundation, Shell, sheet_of, wall_of
from contactlaw.walls.edges import Rows, Sides, edges_of
from contactlaw.walls.motion import Motion, check_motion, keep, vector

Vector = Sequence[float]
# for all beads, or by their atom type; None for one that flies through the wall
Models = ImpactModel | Mapping[int, ImpactModel | None]

_SQUARE = 1e-9  # largest cosine between perpendicular edges; a rotated pair has rounding errors


@dataclass(frozen=True, slots=True)
class Plate:
    """A rectangular plate.

    Parameters
    ----------
    corner : sequence of 3 floats
        One of the plate's corners [m].
    edge_a, edge_b : sequence of 3 floats
        From that corner to its two neighbours [m]; perpendicular to each other.
    thickness : float, Foundation or Shell
        Thickness in the model [m]; ``inf`` is the half-space. The geometry has none: beads touch
        the rectangle itself, from either side. A `contactlaw.Shell` swings back as the curved wall
        of which this is a part, but with the R* of a flat contact.
    model : ImpactModel or dict of int to ImpactModel, optional
        For a plate of another material than the attached model's; a dict has one by atom type,
        with None for beads that fly through the plate, as fines through the deck of a sieve.
    motion : Translation, Rotation, Vibration or Tabulated, optional
        How the plate moves; without it, the plate stands still.
    edges : {"free", "supported", "clamped"} or sequence of 4, optional
        How the plate ends, on all sides, or on each in the order of a walk around it that starts
        at the corner along `edge_a`; None for a side on which it goes on, as in another plate.
        Without it, the plate gives way as an endless one. Impacts near edges bounce differently.

    Raises
    ------
    TypeError, ValueError
        If the three vectors span no rectangle, the thickness is no positive number, the model or
        motion is of no such type, or an edge is of no such kind.

    Examples
    --------
    >>> Plate((0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), thickness=1e-3).thickness
    0.001
    """

    corner: Vector
    edge_a: Vector
    edge_b: Vector
    thickness: float | Foundation | Shell
    model: Models | None = None
    motion: Motion | None = None
    edges: Sides | None = None

    def __post_init__(self) -> None:
        """Check the arguments."""
        a, b = vector("edge_a", self.edge_a), vector("edge_b", self.edge_b)
        area = float(np.linalg.norm(a) * np.linalg.norm(b))
        if not area > 0.0 or not abs(a @ b) <= _SQUARE * area:
            reason = "must be perpendicular and of some length [m]"
            raise ArgumentError("edge_a, edge_b", (self.edge_a, self.edge_b), reason)
        keep(self, corner=vector("corner", self.corner), edge_a=a, edge_b=b)
        scalars(thickness=checked_sheet(self.thickness))
        warn_of_metres("thickness", sheet_of(self.thickness), stacklevel=3)
        check_models(self.model)
        check_motion(self.motion)
        rim(self)


def rim(plate: Plate) -> Rows:
    """Edges of a plate."""
    here, a, b = (np.asarray(v, dtype=float) for v in (plate.corner, plate.edge_a, plate.edge_b))
    corners = np.array([here, here + a, here + a + b, here + b])
    return edges_of(plate.edges, corners, np.roll(corners, -1, axis=0), np.zeros(4, int))


def checked_sheet(thickness: Any) -> Any:
    """Thickness of the sheet of a wall, if time steps can hold what it sends back."""
    wall = wall_of(thickness).numbers
    for name in wall.keys() & {"stiffness", "wall_radius"}:
        number(name.removeprefix("wall_"), wall[name])
    return sheet_of(thickness)


def by_type(models: Models | None, types: int) -> dict[int, ImpactModel | None]:
    """Models by atom type, from 1."""
    if models is None:
        return {}
    if isinstance(models, Mapping):
        return {int(kind): model for kind, model in models.items()}
    return dict.fromkeys(range(1, types + 1), models)


def check_models(models: Any) -> None:
    """Refuse anything but None, a model, or a dict of models by atom type."""
    if models is None or isinstance(models, ImpactModel):
        return
    if not isinstance(models, Mapping):
        raise TypeError(f"model: expected a contactlaw.ImpactModel, or a dict of them by atom type, got {models!r}")
    for kind, model in models.items():
        if not isinstance(kind, int | np.integer) or isinstance(kind, bool) or kind < 1:
            raise ArgumentError("model", kind, "atom types are integers from 1 on")
        if not isinstance(model, ImpactModel | None):
            raise TypeError(f"model: expected a contactlaw.ImpactModel or None for atom type {kind}, got {model!r}")
