"""The question turned round: which thicknesses, or which speeds, give a COR."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw._arrays import Array, Integers
from contactlaw._errors import ArgumentError
from contactlaw._readable import scale_of
from contactlaw.answers.backend import OutsideTableError
from contactlaw.answers.solver import Solver
from contactlaw.answers.tabulated import Border, TableLookup
from contactlaw.answers.uncertainty import Band, Uncertain
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
Stack = Sequence[tuple[Material | str, float | None]]  # layers, one of an unknown thickness
PlateOf = Callable[[float], Any]  # describes a plate of a thickness that is no bare sheet
_SHARES = 1e-6, 1.0 - 1e-6  # of a COR; nearer to the ends beads stick, or are elastic at any speed


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


class _Curve:
    """COR over the reciprocal of the unknown, where the table reaches, but integrated."""

    def __init__(self, by: Solver, border: TableLookup, plate: PlateOf | None, sizes: tuple[float | None, ...]) -> None:
        self.by, self.plate, self.sizes = by, plate, sizes
        slowest, radius = _SLOWEST, sizes[1] or 0.0
        x = 1.0 / np.geomspace(slowest, lookup.V_MAX, _SAMPLES)
        if sizes[0] is not None:
            thinnest = (1.0 + 1e-9) * max(lookup.THINNEST * radius, lookup.R_MIN)
            x = np.append(1.0 / np.geomspace(thinnest, _THICKEST * radius, _SAMPLES), 0.0)
        flags = np.asarray(border.rebounds(self.impacts(x)).flags)
        self.x = x[flags & Validity.CLAMPED == 0]
        if not self.x.size:
            self._refuse(border, x)
        self.e = self.restitution(self.x)

    def _refuse(self, border: TableLookup, x: Array) -> None:
        """Say why even the impact that is nearest to the table is outside of it."""
        name, where, nearest = "speed", "on a half-space", x[-1:]
        if self.sizes[0] is None:
            name, where, nearest = "thickness", f"at {_SLOWEST:g} m/s", x[:1]
        try:
            strict = TableLookup(border.bodies, border.given, Border("raise"))
            strict.rebounds(self.impacts(nearest))
        except OutsideTableError as error:
            reason = f"even {where} the impact is outside the table, {error.reason}"
            raise ArgumentError(name, None, reason) from None

    def impacts(self, x: Array) -> Impacts:
        with np.errstate(divide="ignore"):
            value = 1.0 / x
        v, r, h = (value if size is None else np.full_like(x, size) for size in self.sizes)
        if self.plate:
            plates = [one if one == math.inf else self.plate(one) for one in h.tolist()]
            return self.by.bodies.given(v, r, plates)
        return Impacts(v, r, h, (x.size,))

    def restitution(self, x: Array) -> Array:
        return np.asarray(self.by.rebounds(self.impacts(x)).restitution)

    def solutions(self, wanted: float) -> Any:
        """Reciprocals of the values that give a COR."""
        above = self.e > wanted
        at = np.flatnonzero(above[1:] != above[:-1])
        nearest = int(np.argmin(np.abs(self.e - wanted)))
        if not at.size:  # a COR that was looked up may just miss the largest one
            return self.x[[nearest]][np.abs(self.e[[nearest]] - wanted) < _ROUNDING]
        ends = self.x[at], self.x[at + 1]
        return bisect(lambda x: (self.restitution(x) > wanted) == above[at], *ends)

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


def _filled(layers: Stack, thickness: float) -> Layers:
    pairs: Any = [
        [thickness if part is None else part for part in np.ravel(np.array(layer, object))] for layer in layers
    ]
    return Layers(pairs)


class Inverse(Uncertain):
    """Thicknesses and speeds that give a COR, by one model."""

    _tabulated: TableLookup

    def thickness(
        self,
        restitution: ArrayLike,
        speed: ArrayLike,
        radius: ArrayLike,
        *,
        layers: Stack = (),
        speed_error: float = 0.0,
        radius_error: float = 0.0,
    ) -> Solutions | NDArray[np.object_]:
        """Every thickness of the plate that gives a COR; the COR may pass through a maximum.

        Parameters
        ----------
        restitution : array_like
            Coefficients of restitution [-], between 0 and 1.
        speed, radius : array_like
            As in `restitution`; all three are broadcast.
        layers : sequence of (Material or str, float or None), optional
            Of a plate that is lined or clad, as in `Layers`, with None for the thickness that is
            sought: that of a liner, or of what lies under it.
        speed_error, radius_error : float, optional
            Relative standard errors, as in `uncertainty`.

        Returns
        -------
        Solutions or ndarray of Solutions
            One for each question. Those outside the table are not searched, whatever `outside` is.

        Raises
        ------
        ValueError
            An argument out of its range; an impact that no thickness brings into the table.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6"))
        >>> found = model.thickness(0.5, speed=2.0, radius=1.5e-3)
        >>> (1e3 * found.value).round(2), (1e3 * found.low).round(2), (1e3 * found.high).round(2)
        (array([2.84]), array([2.78]), array([2.9]))
        >>> model.thickness(0.8, speed=2.0, radius=1.5e-3).remark
        'no thickness: a half-space gives 0.6106, the largest COR; the range is 1.59e-06 to 0.6106'
        >>> clad = [("aluminium-6061-t6", None), ("steel-s235", 1e-3)]
        >>> (1e3 * model.thickness(0.5, speed=2.0, radius=1.5e-3, layers=clad).value).round(2)
        array([1.15])
        """
        e, v, r, shape = broadcast(restitution=restitution, speed=speed, radius=radius)
        check(speed=v, radius=r)
        plate = functools.partial(_filled, layers) if layers else None
        if plate:
            check_contact(plate(1e-3), self._bodies.pair.given[1])
            if sum(None in one for one in layers) != 1:
                raise ArgumentError("layers", layers, "expected None for one thickness, the one that is sought")
        errors = {"speed_error": speed_error, "radius_error": radius_error}
        return self._inverse("thickness", e, [(*size, None) for size in zip(v, r, strict=True)], shape, errors, plate)

    def speed(
        self,
        restitution: ArrayLike,
        radius: ArrayLike,
        thickness: ArrayLike,
        *,
        radius_error: float = 0.0,
        thickness_error: float = 0.0,
    ) -> Solutions | NDArray[np.object_]:
        """Every impact speed, from 0.1 mm/s, that gives a COR; all else is as in `thickness`.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6"))
        >>> model.speed(0.5, radius=1.5e-3, thickness=3e-3).value.round(3)
        array([2.2])
        """
        e, r, h, shape = broadcast(restitution=restitution, radius=radius, thickness=thickness)
        check(radius=r, thickness=h)
        check_contact(thickness, self._bodies.pair.given[1])
        named = {float(one): one for one in np.ravel(np.array(thickness, object)).tolist()}
        plate = None if type(thickness) in SHEETS else named.__getitem__
        errors = {"radius_error": radius_error, "thickness_error": thickness_error}
        return self._inverse("speed", e, [(None, *size) for size in zip(r, h, strict=True)], shape, errors, plate)

    def _inverse(
        self,
        unknown: str,
        wanted: Array,
        sizes: list[tuple[float | None, ...]],
        shape: tuple[int, ...] | None,
        errors: dict[str, float],
        plate: PlateOf | None = None,
    ) -> Solutions | NDArray[np.object_]:
        within("restitution", wanted, *_SHARES, "[-]")
        by = Solver(self._bodies)
        border = TableLookup(self._bodies, self._tabulated.given, Border("clamp"))
        curve = functools.cache(functools.partial(_Curve, by, border, plate))
        found = np.empty(wanted.size, dtype=object)
        for n, (cor, size) in enumerate(zip(wanted.tolist(), sizes, strict=True)):
            found[n] = self._solutions(unknown, cor, curve(size), errors)
        return found[0] if shape is None else found.reshape(shape)

    def _solutions(self, unknown: str, wanted: float, curve: _Curve, errors: dict[str, float]) -> Solutions:
        x = curve.solutions(wanted)
        impacts, ends, band = curve.impacts(x), np.empty((2, x.size)), None
        if x.size:
            band = self.uncertainty(impacts.speed, impacts.radius, impacts.thickness, **errors).restitution
            least = np.minimum(2.0 * wanted - band.high, wanted)
            most = np.maximum(2.0 * wanted - band.low, wanted)
            for n, solution in enumerate(zip(x, least, most, strict=True)):
                ends[:, n] = [curve.leaves(wanted, *solution, up=up) for up in (False, True)]
        last = [int(curve.e.argmin()), int(curve.e.argmax())]
        with np.errstate(divide="ignore"):
            value, low, high, at = 1.0 / x, *(1.0 / ends), 1.0 / curve.x[last]
        flags = np.asarray(curve.by.rebounds(impacts).flags)
        extremes = (*curve.e[last].tolist(),), (*at.tolist(),)
        return Solutions(unknown, wanted, value, low, high, flags, *extremes, band)
