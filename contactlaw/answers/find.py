"""The question turned round: which thicknesses, or which speeds, give a COR."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw._arrays import Array, Integers
from contactlaw._errors import ArgumentError
from contactlaw._readable import scale_of
from contactlaw.answers.backend import OutsideTableError
from contactlaw.answers.derivatives import Variants
from contactlaw.answers.solver import Solver
from contactlaw.answers.tabulated import Border, TableLookup
from contactlaw.answers.uncertainty import Band, Uncertainty, uncertainty
from contactlaw.laws._branches import bisect
from contactlaw.physical.arguments import broadcast, check, within
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.materials import Material
from contactlaw.physical.plates import SHEETS, Layers, check_contact
from contactlaw.physical.validity import Validity
from contactlaw.table import lookup

_SAMPLES = 1500  # values between which a COR is searched, 2 % apart or less
_THICKEST = 1e4  # [radii]: the next plate is the half-space, whose COR is the same to six digits
_SLOWEST = 1e-4  # [m/s]: slower beads of millimetres stick by adhesion
_ROUNDING = 1e-5  # how far `ImpactModel.restitution` may be from the integrated COR
_SHARES = 1e-6, 1.0 - 1e-6  # of a COR; nearer to the ends beads stick, or are elastic at any speed
Stack = Sequence[tuple[Material | str, float | None]]  # layers, one of an unknown thickness
PlateOf = Callable[[float], Any]  # describes a plate of a thickness that is no bare sheet


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
    low, high : ndarray, shape (n,)
        Ends of the range about each solution in which the COR that was asked for lies within the
        band of `ImpactModel.uncertainty`, that of two of three impacts; -inf or inf where the band
        has no end.
    flags : ndarray of int64, shape (n,)
        `Validity` limits that the impact exceeds.
    attainable, attained_at : (float, float)
        Least and largest COR within the table [-], and the values that give them.
    band : Band or None
        Band of the COR at the solutions, and its causes.
    """

    unknown: str
    restitution: float
    value: Array
    low: Array
    high: Array
    flags: Integers
    attainable: tuple[float, float]
    attained_at: tuple[float, float]
    band: Band | None

    @property
    def remark(self) -> str:
        """Why there is no solution; empty if there is one."""
        if self.value.size:
            return ""
        over = self.restitution > self.attainable[1]
        (least, most), at = self.attainable, self.attained_at[over]
        unit, size = scale_of(at, "m" if self.unknown == "thickness" else "m/s")
        place = "a half-space" if math.isinf(at) else f"{at / size:.4g} {unit}"
        return (
            f"no {self.unknown}: {place} gives {self.attainable[over]:.4g}, the "
            f"{'largest' if over else 'least'} COR; the range is {least:.4g} to {most:.4g}"
        )


def stacked(layers: Stack, plate: Material) -> PlateOf | None:
    """Plate of these layers as a function of the thickness that is None; None without layers."""
    if not layers:
        return None

    def filled(thickness: float) -> Any:
        if thickness == math.inf:
            return thickness
        parts = [[thickness if part is None else part for part in np.ravel(np.array(one, object))] for one in layers]
        return Layers(parts)  # type: ignore[arg-type]

    check_contact(filled(1e-3), plate)
    if sum(None in one for one in layers) != 1:
        raise ArgumentError("layers", layers, "expected None for one thickness, the one that is sought")
    return filled


def described(thickness: ArrayLike, plate: Material) -> PlateOf | None:
    """Plates that a user described, as a function of their equivalent thickness; None for bare sheets."""
    check_contact(thickness, plate)
    if type(thickness) in SHEETS:
        return None
    return {float(one): one for one in np.ravel(np.array(thickness, object)).tolist()}.__getitem__


def find(
    tabulated: TableLookup,
    restitution: ArrayLike,
    sizes: Mapping[str, ArrayLike],
    plate: PlateOf | None,
    variants: Variants,
    errors: Mapping[str, float],
) -> Solutions | NDArray[np.object_]:
    """Every thickness, or every speed, that gives a COR, whichever of the two is not among the sizes."""
    wanted, *known, shape = broadcast(restitution=restitution, **sizes)
    check(**dict(zip(sizes, known, strict=True)))
    within("restitution", wanted, *_SHARES, "[-]")
    band_of = functools.partial(uncertainty, variants, sizes=errors)
    curve = functools.cache(lambda *values: _Curve(tabulated, dict(zip(sizes, values, strict=True)), plate))
    found = np.empty(wanted.size, dtype=object)
    for n, (cor, *values) in enumerate(zip(wanted.tolist(), *(one.tolist() for one in known), strict=True)):
        found[n] = curve(*values).solutions(cor, band_of)
    return found[0] if shape is None else found.reshape(shape)


class _Curve:
    """COR over the reciprocal of the unknown, where the table reaches, but integrated."""

    def __init__(self, tabulated: TableLookup, sizes: dict[str, float], plate: PlateOf | None) -> None:
        self.by, self.sizes, self.plate = Solver(tabulated.bodies), sizes, plate
        self.unknown = "speed" if "thickness" in sizes else "thickness"
        ends = _SLOWEST, lookup.V_MAX
        if self.unknown == "thickness":
            thinnest = max(lookup.THINNEST * sizes["radius"], lookup.R_MIN)
            ends = (1.0 + 1e-9) * thinnest, _THICKEST * sizes["radius"]
        x = 1.0 / np.geomspace(*ends, _SAMPLES)
        x = np.append(x, 0.0) if self.unknown == "thickness" else x
        border, strict = (TableLookup(tabulated.bodies, tabulated.given, Border(how)) for how in ("clamp", "raise"))
        self.x = x[np.asarray(border.rebounds(self.impacts(x)).flags) & Validity.CLAMPED == 0]
        if not self.x.size:
            name, nearest = ("speed", x[-1:]) if self.unknown == "thickness" else ("thickness", x[:1])
            try:
                strict.rebounds(self.impacts(nearest))
            except OutsideTableError as error:
                reason = f"no {self.unknown} brings the impact into the table: even then {error.reason}"
                raise ArgumentError(name, None, reason) from None
        self.e = self.restitution(self.x)

    def impacts(self, x: Array) -> Impacts:
        with np.errstate(divide="ignore"):
            sizes: dict[str, Any] = {**self.sizes, self.unknown: 1.0 / x}
        if self.plate:
            sizes["thickness"] = [self.plate(one) for one in np.ravel(sizes["thickness"]).tolist()]
        return self.by.bodies.given(**sizes)

    def restitution(self, x: Array) -> Array:
        return np.asarray(self.by.rebounds(self.impacts(x)).restitution)

    def roots(self, wanted: float) -> Array:
        """Reciprocals of the values that give a COR."""
        above = self.e > wanted
        at = np.flatnonzero(above[1:] != above[:-1])
        if at.size:
            ends = self.x[at], self.x[at + 1]
            return np.asarray(bisect(lambda x: (self.restitution(x) > wanted) == above[at], *ends))
        nearest = [int(np.argmin(np.abs(self.e - wanted)))]
        # a COR that was looked up may just miss the largest one
        return np.asarray(self.x[nearest][np.abs(self.e[nearest] - wanted) < _ROUNDING])

    def leaves(self, wanted: float, start: float, least: float, most: float, up: bool) -> float:
        """First place above or below a solution at which the COR leaves a range; else the last."""
        side, order = (self.x < start, 1) if up else (self.x > start, -1)
        x = np.append(start, self.x[side][::order])
        e = np.append(wanted, self.e[side][::order])
        out = np.flatnonzero((e < least) | (e > most))
        if not out.size:
            known = math.isfinite(most - least)
            return float(x[-1]) if known else math.copysign(0.0, 1.0 if up else -1.0)  # of inf, -inf
        n = int(out[0])
        share = ((least if e[n] < least else most) - e[n - 1]) / (e[n] - e[n - 1])
        return float(x[n - 1] + share * (x[n] - x[n - 1]))

    def solutions(self, wanted: float, band_of: Callable[[Impacts], Uncertainty]) -> Solutions:
        x = self.roots(wanted)
        impacts, ends, band = self.impacts(x), np.empty((2, x.size)), None
        if x.size:
            band = band_of(impacts).restitution
            least = np.minimum(2.0 * wanted - band.high, wanted)
            most = np.maximum(2.0 * wanted - band.low, wanted)
            for n, solution in enumerate(zip(x, least, most, strict=True)):
                ends[:, n] = [self.leaves(wanted, *solution, up=up) for up in (False, True)]
        last = [int(self.e.argmin()), int(self.e.argmax())]
        with np.errstate(divide="ignore"):
            value, low, high, at = 1.0 / x, *(1.0 / ends), 1.0 / self.x[last]
        flags = np.asarray(self.by.rebounds(impacts).flags)
        extremes = (*self.e[last].tolist(),), (*at.tolist(),)
        return Solutions(self.unknown, wanted, value, low, high, flags, *extremes, band)
