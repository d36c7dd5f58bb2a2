"""Plates as the adapter knows them: rectangles with a thickness, and what its kernel reads."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw.equation.waves import Waves
from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import scalars
from contactlaw.physical.validity import Limits
from contactlaw.softsphere import Spring, unit_spring

Vector = Sequence[float]

_SQUARE = 1e-9  # cosine of two edges that count as perpendicular: rounding of a rotated pair

SPRING = [(name, "f8") for name in (*Spring._fields[:-1], *Waves._fields)]
ROW = np.dtype(
    [("corner", "f8", 3), ("a", "f8", 3), ("b", "f8", 3), ("normal", "f8", 3)]
    + [("length_a", "f8"), ("length_b", "f8"), ("tangential", "f8"), *SPRING]
    # of the flags of an impact, beside what a Limits has
    + [("thickness", "f8")]
    + [
        (name, "i8" if "int" in str(kind) else "f8")
        for name, kind in Limits.__annotations__.items()
    ]
    # address and size of the law
    + [("law", "i8"), ("law_size", "i8")],
    align=True,
)


@dataclass(frozen=True, slots=True)
class Plate:
    """A rectangular plate that does not move.

    Parameters
    ----------
    corner : sequence of 3 floats
        One of its corners [m].
    edge_a, edge_b : sequence of 3 floats
        From there to the two neighbouring corners [m]; perpendicular.
    thickness : float
        Thickness for the model [m]; ``inf`` is the half-space. It is no geometry: beads touch the
        rectangle itself, from either side.
    model : ImpactModel, optional
        For a plate of another material than that of the attached model.

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
    model: ImpactModel | None = None

    def __post_init__(self) -> None:
        """Refuse what is no plate."""
        for name in ("corner", "edge_a", "edge_b"):
            vector = np.asarray(getattr(self, name), dtype=float)
            if vector.shape != (3,) or not np.isfinite(vector).all():
                raise ValueError(
                    f"{name}: expected three finite numbers [m], got {getattr(self, name)!r}"
                )
        a, b = np.asarray(self.edge_a, dtype=float), np.asarray(self.edge_b, dtype=float)
        area = float(np.linalg.norm(a) * np.linalg.norm(b))
        if not area > 0.0 or not abs(a @ b) <= _SQUARE * area:
            raise ValueError(
                f"edge_a, edge_b: must be perpendicular and of some length [m], got "
                f"{self.edge_a!r} and {self.edge_b!r}"
            )
        scalars(thickness=self.thickness)
        if self.model is not None and not isinstance(self.model, ImpactModel):
            raise TypeError(f"model: expected a contactlaw.ImpactModel, got {self.model!r}")


def rows(plates: Sequence[Plate], model: ImpactModel) -> NDArray[np.void]:
    """Plates as the kernel reads them."""
    out = np.zeros(len(plates), ROW)
    for row, plate in zip(out, plates, strict=True):
        own = model if plate.model is None else plate.model
        a, b = np.asarray(plate.edge_a, dtype=float), np.asarray(plate.edge_b, dtype=float)
        row["corner"] = plate.corner
        row["length_a"], row["length_b"] = np.linalg.norm(a), np.linalg.norm(b)
        row["a"], row["b"] = a / row["length_a"], b / row["length_b"]
        row["normal"] = np.cross(row["a"], row["b"])
        row["tangential"] = 8.0 * own.pair.effective_shear_modulus
        spring = unit_spring(own, plate.thickness)
        springs, waves = spring._asdict(), spring.waves._asdict()
        del springs["waves"]
        for name, value in {**springs, **waves, **own.limits._asdict()}.items():
            row[name] = value
        law = own.force_law.data
        row["law"], row["law_size"] = law.ctypes.data, law.size
        row["thickness"] = plate.thickness
    return out


def bounds(plates: NDArray[np.void]) -> NDArray[np.float64]:
    """Lowest and highest coordinates of all plates, shape (2, 3) [m]."""
    a = plates["a"] * plates["length_a"][:, None]
    b = plates["b"] * plates["length_b"][:, None]
    corners = np.concatenate([plates["corner"] + p * a + q * b for p in (0, 1) for q in (0, 1)])
    return np.array([corners.min(axis=0), corners.max(axis=0)])


def checked(plates: Any, model: Any) -> list[Plate]:
    """Refuse plates that the model of the beads cannot serve."""
    if not isinstance(model, ImpactModel):
        raise TypeError(f"model: expected a contactlaw.ImpactModel, got {model!r}")
    if not isinstance(plates, Sequence):
        raise TypeError(f"plates: expected a list of plates, got {plates!r}")
    found = list(plates)
    if not found:
        raise ValueError("plates: at least one contactlaw.engines.lammps.Plate is needed")
    for plate in found:
        if not isinstance(plate, Plate):
            raise TypeError(f"plates: expected contactlaw.engines.lammps.Plate, got {plate!r}")
        own = plate.model
        if own is not None and (own.force_law.family, own.pair.sphere) != (
            model.force_law.family,
            model.pair.sphere,
        ):
            raise ValueError(
                f"plates: {own!r} is for another law or other beads than {model!r}; plates may "
                "differ in their own material only"
            )
    return found


def check_friction(friction: Any) -> None:
    """Refuse what is no coefficient of friction."""
    if not isinstance(friction, int | float | np.number) or isinstance(friction, bool):
        raise TypeError(f"friction: expected a number, got {friction!r}")
    if not 0.0 <= friction < math.inf:
        raise ValueError(f"friction: must be finite and not negative, got {friction!r}")
