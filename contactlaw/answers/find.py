"""The question turned round: which thicknesses, or which speeds, give a COR."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw._arrays import Array, Integers
from contactlaw._bisect import bisect
from contactlaw._errors import ArgumentError
from contactlaw._readable import in_unit
from contactlaw.answers.solver import Solver
from contactlaw.answers.tabulated import TableLookup
from contactlaw.physical.arguments import broadcast, check, within
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.validity import Validity
from contactlaw.table import lookup

_SAMPLES = 1500  # values between which a COR is searched, 2 % apart or less
_THICKEST = 1e4  # [radii]: the next plate is the half-space, whose COR is the same to six digits
_SLOWEST = 1e-4  # [m/s]: slower beads of millimetres stick by adhesion
_SHARES = 1e-6, 1.0 - 1e-6  # of a COR; nearer to the ends beads stick, or are elastic at any speed
PlateOf = Callable[[float], Any]  # describes a plate by the thickness that is sought


@dataclass(frozen=True, eq=False)
class Solutions:
    """Every thickness [m], or every speed [m/s], that gives a COR.

    Attributes
    ----------
    unknown : str
        ``"thickness"`` or ``"speed"``.
    restitution : float
        The COR that was asked for [-].
    value : ndarray, shape (n,)
        Solutions, rising; none if no value gives the COR; a thickness of ``inf`` is a half-space.
    flags : ndarray of int64, shape (n,)
        `Validity` limits that the impact exceeds.
    attainable, attained_at : (float, float)
        Least and largest COR within the table [-], and the values that give them.
    """

    unknown: str
    restitution: float
    value: Array
    flags: Integers
    attainable: tuple[float, float]
    attained_at: tuple[float, float]

    @property
    def remark(self) -> str:
        """Why there is no solution; empty if there is one."""
        if self.value.size:
            return ""
        over = self.restitution > self.attainable[1]
        (least, most), at = self.attainable, self.attained_at[over]
        place = "a half-space" if math.isinf(at) else in_unit(at, "m" if self.unknown == "thickness" else "m/s", 4)
        return (
            f"no {self.unknown}: {place} gives {self.attainable[over]:.4g}, the "
            f"{'largest' if over else 'least'} COR; the range is {least:.4g} to {most:.4g}"
        )


def find(
    tabulated: TableLookup, restitution: ArrayLike, sizes: Mapping[str, ArrayLike], plate: PlateOf | None = None
) -> Solutions | NDArray[np.object_]:
    """Every thickness, or every speed, that gives a COR, whichever of the two is not among the sizes."""
    wanted, *known, shape = broadcast(restitution=restitution, **sizes)
    check(**dict(zip(sizes, known, strict=True)))
    within("restitution", wanted, *_SHARES, "[-]")
    curve = functools.cache(lambda *values: _Curve(tabulated, dict(zip(sizes, values, strict=True)), plate))
    # objects, which say more of a plate that is no bare sheet than its equivalent thickness does
    objects = np.broadcast_arrays(*(np.array(one, object) for one in (restitution, *sizes.values())))[1:]
    found = np.empty(wanted.size, dtype=object)
    for n, (cor, *values) in enumerate(zip(wanted.tolist(), *(one.ravel().tolist() for one in objects), strict=True)):
        found[n] = curve(*values).solutions(cor)
    return found[0] if shape is None else found.reshape(shape)


class _Curve:
    """Integrated COR over the reciprocal of the unknown, as far as the table reaches."""

    def __init__(self, tabulated: TableLookup, sizes: dict[str, float], plate: PlateOf | None) -> None:
        self.by, self.sizes, self.plate = Solver(tabulated.bodies), sizes, plate
        self.unknown = "speed" if "thickness" in sizes else "thickness"
        ends = _SLOWEST, lookup.V_MAX
        if self.unknown == "thickness":
            thinnest = max(lookup.THINNEST * sizes["radius"], lookup.R_MIN)
            ends = (1.0 + 1e-9) * thinnest, _THICKEST * sizes["radius"]
        x = 1.0 / np.geomspace(*ends, _SAMPLES)
        x = np.append(x, 0.0) if self.unknown == "thickness" else x
        clamping = TableLookup(tabulated.bodies, tabulated.given, "clamp")
        self.x = x[np.asarray(clamping.rebounds(self.impacts(x)).flags) & Validity.CLAMPED == 0]
        if not self.x.size:
            name = "speed" if self.unknown == "thickness" else "thickness"
            raise ArgumentError(name, self.sizes[name], f"no {self.unknown} brings the impact into the table")
        self.e = self.restitution(self.x)

    def impacts(self, x: Array) -> Impacts:
        with np.errstate(divide="ignore"):
            unknown: Any = 1.0 / x
        if self.plate:
            unknown = [self.plate(h) if h < math.inf else h for h in unknown.tolist()]
        return self.by.bodies.given(**{**self.sizes, self.unknown: unknown})

    def restitution(self, x: Array) -> Array:
        return np.asarray(self.by.rebounds(self.impacts(x)).restitution)

    def solutions(self, wanted: float) -> Solutions:
        above = self.e > wanted
        at = np.flatnonzero(above[1:] != above[:-1])
        x = bisect(lambda x: (self.restitution(x) > wanted) == above[at], self.x[at], self.x[at + 1])
        last = [int(self.e.argmin()), int(self.e.argmax())]
        with np.errstate(divide="ignore"):
            value, at = 1.0 / x, 1.0 / self.x[last]
        flags = np.asarray(self.by.rebounds(self.impacts(x)).flags)
        return Solutions(self.unknown, wanted, value, flags, (*self.e[last].tolist(),), (*at.tolist(),))
