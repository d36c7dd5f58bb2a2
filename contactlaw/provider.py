"""ImpactModel: what a bead's collision with a plate does, in SI units.

Here the two towers meet: `impact` turns speeds, radii and thicknesses into dimensionless numbers,
`lookup` and `zener` answer for those, and the answer is given its units back.
"""

from __future__ import annotations

import functools
import math
import os
from collections.abc import Callable
from typing import Any, Literal, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw import laws, lookup, store, zener
from contactlaw._jit import kernel
from contactlaw.impact import Contact, Rebound, Scales, scales, sphere_on_plate, sphere_on_sphere
from contactlaw.laws import Law
from contactlaw.materials import Material, material
from contactlaw.pair import Pair
from contactlaw.table import Table
from contactlaw.validity import Validity, limits_exceeded

Array = NDArray[np.float64]
Outside = Literal["raise", "solve", "clamp"]

_ELASTIC_EDGE = "myc"  # a law that never yields is the edge chi = 1 of any table; this one ships


class ImpactModel:
    """The modified Zener model of one pair of materials, ready to answer per collision.

    Normal impact only: the tangential part of an oblique impact, friction, adhesion, viscosity
    and strain rate are outside the model (see `Validity` for the limits that are checked).

    Parameters
    ----------
    pair : Pair
        Materials of sphere and plate.
    law : str, optional
        Normal force law: ``"myc"`` (elastic-plastic) or ``"hertz"`` (elastic, needs no yield
        strength).
    table : Table or path-like, optional
        A table to use in place of the packaged one.
    outside : {"raise", "solve", "clamp"}, optional
        What to do outside the table: refuse, integrate the equation, or take the value at the
        border (each such impact is counted in `clamped` and flagged in `Rebound.flags`).

    Attributes
    ----------
    pair : Pair
    law : str
    outside : str
    clamped : int
        Impacts answered with the value at the table's border so far.

    Raises
    ------
    ValueError
        Unknown law or `outside`; a sphere without yield strength where the law needs one; a table
        of another law.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> round(model.restitution(speed=5.0, radius=0.9e-3, thickness=1e-3), 4)
    0.8897
    >>> model.restitution([5.0, 15.0], 0.9e-3, [[1e-3], [3e-3]]).shape
    (2, 2)
    """

    def __init__(
        self,
        pair: Pair,
        law: str = "myc",
        table: Table | str | os.PathLike[str] | None = None,
        outside: Outside = "raise",
    ) -> None:
        if not isinstance(pair, Pair):
            raise TypeError(f"pair: expected a contactlaw.Pair, got {pair!r}")
        if outside not in ("raise", "solve", "clamp"):
            raise ValueError(f"outside: must be 'raise', 'solve' or 'clamp', got {outside!r}")
        self.pair = pair
        self._law = laws.law(law)
        if self._law.kinks:
            pair.sphere.require_yield_strength(law)
        self.outside: Outside = outside
        self.clamped = 0
        self._splines = _splines(self._law, table)
        self._factors = _factors(sphere_on_plate(pair, self._law, np.ones(()), np.ones(())))

    def __repr__(self) -> str:
        return f"ImpactModel({self.pair!r}, law={self.law!r}, outside={self.outside!r})"

    @property
    def law(self) -> str:
        """Name of the normal force law."""
        return self._law.name

    def restitution(
        self, speed: ArrayLike, radius: ArrayLike, thickness: ArrayLike
    ) -> float | Array:
        """Coefficient of restitution, from the table.

        Parameters
        ----------
        speed : array_like
            Normal approach speed [m/s], > 0.
        radius : array_like
            Radius of the sphere [m].
        thickness : array_like
            Thickness of the plate [m]; ``inf`` is the half-space.

        Returns
        -------
        float or ndarray of float64
            Rebound speed over approach speed, between 0 and 1; the arguments are broadcast.

        Raises
        ------
        ValueError
            An argument that is no positive number, or an impact outside the table.

        Notes
        -----
        Within 1e-6 of `solve`.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> model.restitution([2.0, 10.0], radius=0.9e-3, thickness=0.5e-3).round(4)
        array([0.7114, 0.6453])
        """
        v, r, h, shape = _broadcast(speed=speed, radius=radius, thickness=thickness)
        out = np.empty(v.size)
        if lookup.restitutions(self._splines, self._factors, v, r, h, out):
            _check(speed=v, radius=r, thickness=h)
            wrong = np.isnan(out)
            contact = sphere_on_plate(self.pair, self._law, r[wrong], h[wrong])
            out[wrong] = self._from_table(contact, v[wrong])[0][0]
        return _shaped(out, shape)

    def lookup(self, speed: ArrayLike, radius: ArrayLike, thickness: ArrayLike) -> Rebound:
        """Everything about the impact, from the table.

        Parameters, errors and broadcasting are those of `restitution`.

        Returns
        -------
        Rebound
            Within 1e-5 of `solve`, relatively; its restitution within 1e-6.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> hit = model.lookup(speed=12.0, radius=0.9e-3, thickness=1e-3)
        >>> f"{hit.peak_force:.1f} N for {hit.contact_time * 1e6:.2f} us"
        '134.3 N for 5.80 us'
        """
        v, r, h, shape = _broadcast(speed=speed, radius=radius, thickness=thickness)
        _check(speed=v, radius=r, thickness=h)
        return self._lookup(sphere_on_plate(self.pair, self._law, r, h), v, r, h, shape)

    def lookup_sphere_sphere(
        self, speed: ArrayLike, radius: ArrayLike, other_radius: ArrayLike
    ) -> Rebound:
        """Impact of two spheres of the pair's sphere material, from the table.

        The bulk limit: no energy is carried off by waves. The energy that the fractions refer to
        is that of the relative motion.

        Parameters
        ----------
        speed : array_like
            Normal approach speed of the two [m/s], > 0.
        radius, other_radius : array_like
            Radii of the spheres [m].

        Returns
        -------
        Rebound

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> float(model.lookup_sphere_sphere(10.0, 0.9e-3, 0.9e-3).wave_fraction)
        0.0
        """
        v, r, o, shape = _broadcast(speed=speed, radius=radius, other_radius=other_radius)
        _check(speed=v, radius=r, other_radius=o)
        twins = Pair(self.pair.sphere, self.pair.sphere)
        contact = sphere_on_sphere(twins, self._law, r, o)
        return self._lookup(contact, v, r, np.full_like(r, math.inf), shape)

    def solve(
        self, speed: ArrayLike, radius: ArrayLike, thickness: ArrayLike, rtol: float = 1e-10
    ) -> Rebound:
        """Everything about the impact, by integrating the equation: the reference.

        Parameters
        ----------
        speed, radius, thickness : array_like
            As in `restitution`.
        rtol : float, optional
            Error allowed in each step of the integration, between 1e-13 and 1e-4.

        Returns
        -------
        Rebound
            Its energy balance closes to about rtol.

        Raises
        ------
        ValueError
            As in `restitution`, but no table limits the range.
        RuntimeError
            If the integration takes too many steps (lambda far above 100).

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> hit = model.solve(speed=12.0, radius=0.9e-3, thickness=1e-3)
        >>> abs(1 - hit.restitution**2 - hit.plastic_fraction - hit.wave_fraction) < 1e-9
        True
        """
        if not 1e-13 <= rtol <= 1e-4:
            raise ValueError(f"rtol: must lie between 1e-13 and 1e-4, got {rtol!r}")
        v, r, h, shape = _broadcast(speed=speed, radius=radius, thickness=thickness)
        _check(speed=v, radius=r, thickness=h)
        contact = sphere_on_plate(self.pair, self._law, r, h)
        units = scales(contact, v)
        return self._rebound(units, _solve(self._law, units, rtol), v, r, h, shape, 0)

    def yield_speed(self, radius: ArrayLike, thickness: ArrayLike) -> float | Array:
        """Speed V_Y [m/s] from which the bead yields on this plate; ``inf`` for an elastic law.

        The thinner the plate, the more it gives way and the later the bead yields (Peng et al.
        2021, section 3.2, without their fit of w_m).

        Parameters
        ----------
        radius, thickness : array_like
            As in `restitution`.

        Returns
        -------
        float or ndarray of float64

        Raises
        ------
        ValueError
            An argument that is no positive number, or a plate so thin that the inelasticity at
            V_Y is outside the table.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> model.yield_speed(radius=0.9e-3, thickness=[0.5e-3, float("inf")]).round(3)
        array([9.059, 7.426])
        """
        r, h, shape = _broadcast(radius=radius, thickness=thickness)
        _check(radius=r, thickness=h)
        out = np.full(r.size, math.inf)
        if self._law.kinks:
            inelasticity = self._factors.inelasticity * (r / h) ** 2
            lookup.yield_speeds(self._splines, inelasticity, self._factors.log_overload, out)
            if np.isnan(out).any():
                n = int(np.argmax(np.isnan(out)))
                raise ValueError(
                    f"thickness: at {h[n]:g} m under a bead of radius {r[n]:g} m the inelasticity "
                    f"at yield is beyond the table's {self._splines.lam_max:g}; the plate is too "
                    "thin for the model"
                )
        return _shaped(out, shape)

    def curve(self, radius: float, thickness: float) -> Callable[[float], float]:
        """COR of one bead class on one plate, as a fast function of speed.

        Parameters
        ----------
        radius, thickness : float
            As in `restitution`.

        Returns
        -------
        callable
            ``curve(speed)`` [m/s] -> COR; it raises the same errors as `restitution`.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> curve = model.curve(radius=0.9e-3, thickness=1e-3)
        >>> curve(5.0) == model.restitution(5.0, 0.9e-3, 1e-3)
        True
        """
        r, h, _ = _broadcast(radius=radius, thickness=thickness)
        _check(radius=r, thickness=h)
        return self._curve(sphere_on_plate(self.pair, self._law, r, h))

    def sphere_sphere_curve(self, radius: float, other_radius: float) -> Callable[[float], float]:
        """COR of two beads of the pair's sphere material, as a fast function of approach speed.

        Parameters
        ----------
        radius, other_radius : float
            Radii of the beads [m].

        Returns
        -------
        callable
            ``curve(speed)`` [m/s] -> COR.
        """
        r, o, _ = _broadcast(radius=radius, other_radius=other_radius)
        _check(radius=r, other_radius=o)
        twins = Pair(self.pair.sphere, self.pair.sphere)
        return self._curve(sphere_on_sphere(twins, self._law, r, o))

    def _curve(self, contact: Contact) -> Callable[[float], float]:
        splines, factors, at = self._splines, _factors(contact), lookup.restitution

        def restitution(speed: float) -> float:
            value: float = at(splines, factors, speed)
            if math.isnan(value):
                v, _ = _broadcast(speed=speed)
                _check(speed=v)
                return float(self._from_table(contact, v)[0][0, 0])
            return value

        return restitution

    def _lookup(
        self, contact: Contact, v: Array, r: Array, h: Array, shape: tuple[int, ...] | None
    ) -> Rebound:
        values, clamped = self._from_table(contact, v)
        units = scales(contact, v)
        return self._rebound(units, values, v, r, h, shape, clamped)

    def _from_table(self, contact: Contact, speed: Array) -> tuple[Array, NDArray[np.int64]]:
        """Fields (5, n) as in `lookup.fields`, and Validity.CLAMPED where the border was taken."""
        units = scales(contact, speed)
        lam, y = np.broadcast_arrays(units.inelasticity, units.yield_ratio)
        lam, y = np.ascontiguousarray(lam), np.ascontiguousarray(y)
        out = np.empty((5, speed.size))
        clamped = np.zeros(speed.size, dtype=np.int64)
        if not lookup.fields(self._splines, lam, y, False, out):
            return out, clamped
        outside = np.isnan(out[0])
        if self.outside == "raise":
            self._refuse(units, int(np.argmax(outside)), speed)
        if self.outside == "solve":
            part = Scales(*(np.broadcast_to(value, speed.shape)[outside] for value in units))
            out[:, outside] = _solve(self._law, part, 1e-10)
        else:
            lookup.fields(self._splines, lam, y, True, out)
            clamped[outside] = int(Validity.CLAMPED)
            self.clamped += int(outside.sum())
        return out, clamped

    def _refuse(self, units: Scales, n: int, speed: Array) -> NoReturn:
        lam = np.broadcast_to(units.inelasticity, speed.shape)[n]
        y = np.broadcast_to(units.yield_ratio, speed.shape)[n]
        top = self._splines
        if not lam <= top.lam_max:
            what = f"inelasticity lambda = {lam:.4g} is above {top.lam_max:g}: the plate is too thin"
        else:
            chi = math.exp(lookup.log_elastic_compression(top, lam)) / y
            limit = math.exp(top.log_chi_max)
            what = f"overload chi = {chi:.4g} is above {limit:.4g}: the impact is too fast"
        raise ValueError(
            f"speed: at {speed[n]:g} m/s (element {n}) the impact is outside the table, its {what}. "
            'ImpactModel(..., outside="solve") integrates the equation there, "clamp" takes the '
            "value at the table's border."
        )

    def _rebound(
        self,
        units: Scales,
        values: Array,
        v: Array,
        r: Array,
        h: Array,
        shape: tuple[int, ...] | None,
        more_flags: int | NDArray[np.int64],
    ) -> Rebound:
        """Give the fields of `lookup.fields` their units back, and add what follows from them."""
        restitution, time, wave_rate, ratio, w_m = values
        y = np.broadcast_to(units.yield_ratio, v.shape)
        compression = ratio * w_m
        state = np.empty((3, v.size))
        _contact_state(
            self._law.loading, self._law.residual, self._law.dissipation, compression, y, state
        )
        force, residual, plastic = state
        contact_time = time * units.time
        speed_ratio = math.sqrt(0.8) * y**-1.25
        flags = limits_exceeded(self.pair, r, h, speed_ratio, contact_time) + more_flags
        result = {
            "restitution": restitution,
            "contact_time": contact_time,
            "peak_force": force * units.force,
            "peak_compression": compression * units.compression,
            "residual_compression": residual * units.compression,
            "plastic_fraction": plastic,
            "wave_fraction": units.inelasticity * wave_rate,
            "inelasticity": np.broadcast_to(units.inelasticity, v.shape),
            "overload": w_m / y,
        }
        shaped: dict[str, Any] = {key: _shaped(value, shape) for key, value in result.items()}
        flag = Validity(int(flags[0])) if shape is None else flags.reshape(shape)
        return Rebound(**shaped, flags=flag)


def restitution_sphere_sphere(
    sphere: Material | str,
    other: Material | str,
    speed: ArrayLike,
    radius: ArrayLike,
    other_radius: ArrayLike,
    *,
    law: str = "myc",
) -> float | Array:
    """Coefficient of restitution of bead on bead: the bulk limit.

    Parameters
    ----------
    sphere, other : Material or str
        Materials of the two spheres; the weaker one yields.
    speed : array_like
        Normal approach speed [m/s].
    radius, other_radius : array_like
        Radii [m].
    law : str, optional
        Normal force law, as in `ImpactModel`.

    Returns
    -------
    float or ndarray of float64

    Raises
    ------
    ValueError
        As `ImpactModel` and `ImpactModel.restitution` do.

    Notes
    -----
    The plate's law with lambda = 0, R* = R1 R2/(R1 + R2) and m* = m1 m2/(m1 + m2): no wave carries
    energy off.

    Examples
    --------
    >>> import contactlaw as cl
    >>> bead = "gamma-alumina"
    >>> cl.restitution_sphere_sphere(bead, bead, [20.0, 80.0], 1e-3, 1e-3).round(4)
    array([1.    , 0.8836])
    """
    pair = Pair(sphere, other)
    v, r, o, shape = _broadcast(speed=speed, radius=radius, other_radius=other_radius)
    _check(speed=v, radius=r, other_radius=o)
    if (pair.plate.yield_strength or math.inf) < (pair.sphere.yield_strength or math.inf):
        pair, r, o = Pair(pair.plate, pair.sphere), o, r
    model = ImpactModel(pair, law)
    contact = sphere_on_sphere(pair, model._law, r, o)
    return _shaped(model._from_table(contact, v)[0][0], shape)


@functools.cache
def _packaged_splines(law: str) -> lookup.Splines:
    return store.packaged(law).splines()


def _splines(law: Law, table: Table | str | os.PathLike[str] | None) -> lookup.Splines:
    name = law.name if law.kinks else _ELASTIC_EDGE
    if table is None:
        return _packaged_splines(name)
    if not isinstance(table, Table):
        table = store.read(table)
    if table.law != name:
        raise ValueError(f"table: it belongs to law {table.law!r}, the model needs one of {name!r}")
    return table.splines()


def _factors(contact: Contact) -> lookup.Factors:
    """Factors of the powers of speed: lambda and ln(chi/w_m) at 1 m/s."""
    units = scales(contact, np.ones(()))
    return lookup.Factors(units.inelasticity.item(), -math.log(units.yield_ratio.item()))


_LIMITS = {
    "speed": (math.ulp(0.0), lookup.V_MAX, "m/s, positive: the approach speed along the normal"),
    "radius": (lookup.R_MIN, lookup.R_MAX, "metres"),
    "other_radius": (lookup.R_MIN, lookup.R_MAX, "metres"),
    "thickness": (lookup.R_MIN, math.inf, "metres; inf is the half-space"),
}


def _broadcast(**arguments: ArrayLike) -> Any:
    """Flat float64 arrays of one length, and their common shape (None for scalars)."""
    arrays = []
    for name, value in arguments.items():
        array = np.asarray(value)
        if array.dtype.kind not in "iuf":
            raise ValueError(f"{name}: expected a number or an array of numbers, got {value!r}")
        arrays.append(array.astype(np.float64, copy=False))
    try:
        arrays = np.broadcast_arrays(*arrays)
    except ValueError:
        shapes = ", ".join(f"{n} {np.shape(v)}" for n, v in arguments.items())
        raise ValueError(f"{next(iter(arguments))}: shapes do not broadcast: {shapes}") from None
    shape = arrays[0].shape
    return *(np.ravel(a) for a in arrays), None if shape == () else shape


def _check(**arrays: Array) -> None:
    for name, values in arrays.items():
        low, high, unit = _LIMITS[name]
        wrong = ~((low <= values) & (values <= high))
        if wrong.any():
            n = int(np.argmax(wrong))
            where = f" (element {n})" if values.size > 1 else ""
            bounds = f"between {low:g} and {high:g}" if name != "speed" else f"above 0, to {high:g}"
            raise ValueError(f"{name}: got {values[n]!r}{where}; must lie {bounds} {unit}")


def _shaped(values: Array, shape: tuple[int, ...] | None) -> float | Array:
    return float(values[0]) if shape is None else np.ascontiguousarray(values).reshape(shape)


@kernel
def _contact_state(
    loading: Callable[[float], float],
    residual: Callable[[float], float],
    dissipation: Callable[[float], float],
    compression: Array,
    yield_ratio: Array,
    out: Array,
) -> None:
    """Peak force, residual compression [Hertz's scale] and plastic share into out (3, n)."""
    for n in range(compression.size):
        y, w = yield_ratio[n], compression[n]
        if w <= y:  # every law is Hertz's below yield; y may be inf here
            out[0, n], out[1, n], out[2, n] = w * math.sqrt(w), 0.0, 0.0
            continue
        dm = w / y
        out[0, n] = loading(math.sqrt(dm)) * y * math.sqrt(y)
        out[1, n] = residual(dm) * y
        out[2, n] = 2.0 * dissipation(dm) * y * y * math.sqrt(y)


@kernel
def _solve_many(
    loading: Callable[[float], float],
    residual: Callable[[float], float],
    unloading: Callable[[float, float], float],
    dissipation: Callable[[float], float],
    kinks: tuple[float, ...],
    hertz_loading: Callable[[float], float],
    hertz_unloading: Callable[[float, float], float],
    lam: Array,
    yield_ratio: Array,
    rtol: float,
    out: Array,
) -> tuple[int, int]:
    """The fields of `lookup.fields` by integration; status and index of the first failure."""
    for n in range(lam.size):
        y = yield_ratio[n] if yield_ratio[n] < math.inf else 1.0  # 1: a scale for elastic laws
        one = zener.solve(
            loading, residual, unloading, dissipation, kinks, lam[n], y, rtol
        )
        status, w_m = one.status, one.peak_compression
        if status == zener.OK and w_m > kinks[0] * y:
            status, w_m = zener.elastic_compression(hertz_loading, hertz_unloading, lam[n], rtol)
        if status != zener.OK:
            return status, n
        out[0, n] = one.restitution
        out[1, n] = one.contact_time
        out[2, n] = one.wave_rate
        out[3, n] = one.peak_compression / w_m
        out[4, n] = w_m
    return zener.OK, 0


def _solve(law: Law, units: Scales, rtol: float) -> Array:
    lam, y = (
        np.ascontiguousarray(a) for a in np.broadcast_arrays(units.inelasticity, units.yield_ratio)
    )
    out = np.empty((5, lam.size))
    elastic = laws.law("hertz")
    status, n = _solve_many(
        *law.arguments, elastic.loading, elastic.unloading, lam, y, rtol, out
    )
    if status != zener.OK:
        raise RuntimeError(
            f"the equation did not solve at lambda = {lam[n]:.6g}, d_Y/(V0 T_H) = {y[n]:.6g} "
            f"(element {n}): {zener.MESSAGES[status]}"
        )
    return out
