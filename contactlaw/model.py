"""ImpactModel: what a bead's collision with a plate does, in SI units.

Here the two towers meet: `physical` turns speeds, radii and thicknesses into dimensionless numbers,
`table` and `equation` answer for those, and the answer is given its units back.
"""

from __future__ import annotations

import functools
import math
import os
import threading
from collections.abc import Callable
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw._jit import enable_caching
from contactlaw.compiled import c_function, entries, jitted
from contactlaw.constant import Constant, Keep, constant
from contactlaw.equation import outcome
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import Outcome
from contactlaw.evaluation import (
    RTOL,
    Flags,
    Outside,
    complete,
    histories_by_solver,
    histories_by_table,
    largest_inelasticity,
    solved,
    table_for,
    tabulated,
    with_plates,
)
from contactlaw.laws import DEFAULT, Law
from contactlaw.physical.arguments import broadcast, check, scalars, shaped
from contactlaw.physical.history import ForceHistory, with_units
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.physical.rebound import Impacts, Rebound, rebound
from contactlaw.physical.scaling import (
    Contact,
    factors,
    law_of,
    log_overload,
    scales,
    sphere_on_plate,
    sphere_on_sphere,
    yield_share,
)
from contactlaw.physical.validity import Limits, limits
from contactlaw.sensitivity import (
    Sensitivity,
    by_inputs,
    by_modulus_ratio,
    by_solver,
    by_table,
    elasticities,
    follows,
)
from contactlaw.speedtable import SpeedTable, speed_table
from contactlaw.table import Settings, Table, lookup

Array = NDArray[np.float64]

_MOST_SAMPLES = 1_000_000


class ImpactModel:
    """The modified Zener model of one pair of materials, ready to answer per collision.

    Normal impact only: the tangential part of an oblique impact, friction, adhesion, viscosity
    and strain rate are outside the model (see `Validity` for the limits that are checked).

    Parameters
    ----------
    pair : Pair
        Materials of sphere and plate.
    law : str or Law, optional
        Normal force law: ``"fem"``, read off finite elements, for metals, ceramics and glasses,
        of which either, both or neither body may yield; ``"myc"``, the paper's; another of
        `contactlaw.laws.names`; or a `contactlaw.laws.Law` of your own.
        A table for it is built when it is first asked, in less than a second, and kept in the
        user's cache folder; `solve`, soft spheres and LAMMPS need none.
    table : Table, path-like or Settings, optional
        A table to use in place of the law's own; `contactlaw.table.Settings` of a larger or
        finer one are built, in less than a second as a rule, and kept in the user's cache folder.
    outside : {"raise", "solve", "clamp"}, optional
        What to do outside the table: refuse, integrate the equation, or take the value at the
        border (each such impact is counted in `clamped` and flagged in `Rebound.flags`).

    Attributes
    ----------
    pair, law, outside
        As given; fixed. A law that takes numbers from the pair has them in its name.
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
    0.8966
    >>> model.restitution([5.0, 15.0], 0.9e-3, [[1e-3], [3e-3]]).shape
    (2, 2)
    """

    def __init__(
        self,
        pair: Pair,
        law: str | Law = DEFAULT,
        table: Table | Settings | str | os.PathLike[str] | None = None,
        outside: Outside = "raise",
    ) -> None:
        if not isinstance(pair, Pair):
            raise TypeError(f"pair: expected a contactlaw.Pair, got {pair!r}")
        if outside not in ("raise", "solve", "clamp"):
            raise ValueError(f"outside: must be 'raise', 'solve' or 'clamp', got {outside!r}")
        self._pair = pair
        self._law = law_of(pair, law)
        self._limits = limits(pair, self._law)
        self._outside: Outside = outside
        self._on_plate, self._at = entries()
        self._clamping = threading.Lock()
        self._clamped = 0
        self._given_table = table
        self._factors = factors(pair, self._law)
        self._c_lam, self._c_chi = self._factors.plate.inelasticity, self._factors.log_overload
        enable_caching()
        if table is not None:
            self.table  # noqa: B018 - what is wrong with it is said here, not at the first impact

    def __reduce__(self) -> tuple[Any, ...]:
        # compiled functions do not travel; the receiving process has its own
        return ImpactModel, (self.pair, self._law, self._given_table, self.outside)

    def __repr__(self) -> str:
        return f"ImpactModel({self.pair!r}, law={self._law.family!r}, outside={self.outside!r})"

    @property
    def pair(self) -> Pair:
        """Materials of sphere and plate."""
        return self._pair

    @property
    def outside(self) -> Outside:
        """What to do outside the table."""
        return self._outside

    @property
    def law(self) -> str:
        """Name of the normal force law."""
        return self._law.name

    @property
    def force_law(self) -> Law:
        """The normal force law itself, as data."""
        return self._law

    @functools.cached_property
    def table(self) -> Table:
        """The table that answers; for Hertz's law that of MYC, whose edge it is.

        It is made when it is first asked for: `solve` and soft spheres need none.
        """
        return table_for(self._law, self._given_table)

    @functools.cached_property
    def _table(self) -> Array:
        """What kernels look up in: the table, with the plates of the pair."""
        return with_plates(self.table, self._factors)

    @property
    def largest_inelasticity(self) -> float:
        """Largest lambda that the table answers, known before it is made."""
        if self._given_table is None:
            return largest_inelasticity(self._law)
        return lookup.lam_max(self.table.packed)

    @property
    def limits(self) -> Limits:
        """Limits of the model for this pair, as kernels take them."""
        return self._limits

    @property
    def clamped(self) -> int:
        """Impacts answered with the value at the table's border so far; may be set."""
        return self._clamped

    @clamped.setter
    def clamped(self, count: int) -> None:
        with self._clamping:
            self._clamped = count

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
        Within 1e-5 of `solve`, at kinks of the law too, and within 1e-6 as a rule; a table that
        errs more warns when it is made. For gamma-alumina on glass the largest
        errors are 4e-7 (``"stronge"``), 2e-7 (the other laws) and 5e-8 (``"myc"``).

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> model.restitution([2.0, 10.0], radius=0.9e-3, thickness=0.5e-3).round(4)
        array([0.7156, 0.6211])
        """
        # per collision, from Python
        if isinstance(speed, float) and isinstance(radius, float) and isinstance(thickness, float):
            value = self._on_plate(self._table, self._c_lam, self._c_chi, speed, radius, thickness)
            if value == value:  # not NaN
                return value
        v, r, h, shape = broadcast(speed=speed, radius=radius, thickness=thickness)
        out = np.empty(v.size)
        if lookup.restitutions(self._table, self._c_lam, self._c_chi, v, r, h, out):
            check(speed=v, radius=r, thickness=h)
            out = self._outcomes(v, r, h)[0].restitution
        return shaped(out, shape)

    def lookup(self, speed: ArrayLike, radius: ArrayLike, thickness: ArrayLike) -> Rebound:
        """Everything about the impact, from the table.

        Parameters
        ----------
        speed, radius, thickness : array_like
            As in `restitution`.

        Returns
        -------
        Rebound
            Within 5e-4 of `solve`, relatively, contact times within 5e-3, and within 1e-5 as a
            rule; its restitution as in `restitution`. Just above
            yield, where plastic share and residual compression begin as (chi - 1)^2 or faster,
            that takes a `solve` with an rtol below 1e-5 (chi - 1).

        Raises
        ------
        ValueError
            As in `restitution`.

        Notes
        -----
        So are those of the other laws, but for plastic share and residual compression with
        ``"stronge"`` next to yield: up to 1e-3 there, relatively.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> hit = model.lookup(speed=12.0, radius=0.9e-3, thickness=1e-3)
        >>> f"{hit.peak_force:.1f} N for {hit.contact_time * 1e6:.2f} us"
        '28.3 N for 3.92 us'
        """
        v, r, h, shape = broadcast(speed=speed, radius=radius, thickness=thickness)
        check(speed=v, radius=r, thickness=h)
        found, flags, asked, root = self._outcomes(v, r, h)
        time, mass = self._factors.time * r / root, self._factors.mass * (r * r * r)
        return rebound(
            self._law.data, self._limits, Impacts(v, r, h, shape), time, mass, asked, found, flags
        )

    def lookup_sphere_sphere(
        self,
        speed: ArrayLike,
        radius: ArrayLike,
        other_radius: ArrayLike,
        other: Material | str | None = None,
    ) -> Rebound:
        """Impact of the pair's sphere and another sphere, from the table.

        The bulk limit: no energy is carried off by waves. The energy that the fractions refer to
        is that of the relative motion.

        Parameters
        ----------
        speed : array_like
            Normal approach speed of the two [m/s], > 0.
        radius, other_radius : array_like
            Radii of the spheres [m].
        other : Material or str, optional
            Material of the other sphere, without it that of the pair's sphere.

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
        v, r, o, shape = broadcast(speed=speed, radius=radius, other_radius=other_radius)
        check(speed=v, radius=r, other_radius=o)
        beads, law, table, swapped = self._beads(other)
        contact = sphere_on_sphere(beads, law, *((o, r) if swapped else (r, o)))
        units = scales(contact, v)
        found, flags = self._fields(units, law, table.packed)
        impacts = Impacts(v, r * o / (r + o), np.full_like(r, math.inf), shape)
        return self._rebound(beads, law, contact, units, impacts, found, flags)

    def solve(
        self, speed: ArrayLike, radius: ArrayLike, thickness: ArrayLike, rtol: float = 1e-10
    ) -> Rebound:
        """Everything about the impact, by integrating the equation: the reference.

        Parameters
        ----------
        speed, radius, thickness : array_like
            As in `restitution`.
        rtol : float, optional
            Error allowed in each step of the integration, between 1e-13 and 1e-6.

        Returns
        -------
        Rebound
            Its energy balance closes to 1e-9 at the default rtol, and to 30 rtol at any.

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
        >>> lost = hit.plastic_fraction + hit.wave_fraction + hit.other_fraction
        >>> abs(1 - hit.restitution**2 - lost) < 1e-9
        True
        """
        if not isinstance(rtol, float) or not 1e-13 <= rtol <= 1e-6:
            raise ValueError(f"rtol: must be a float between 1e-13 and 1e-6, got {rtol!r}")
        v, r, h, shape = broadcast(speed=speed, radius=radius, thickness=thickness)
        check(speed=v, radius=r, thickness=h)
        contact = sphere_on_plate(self.pair, self._law, r, h)
        units = scales(contact, v)
        found = solved(self._law, units, rtol)
        flags = np.zeros(v.size, dtype=np.int64)
        impacts = Impacts(v, r, h, shape)
        return self._rebound(self.pair, self._law, contact, units, impacts, found, flags)

    def force_history(
        self,
        speed: ArrayLike,
        radius: ArrayLike,
        thickness: ArrayLike,
        samples: int = 256,
        method: Literal["table", "solve"] = "table",
    ) -> ForceHistory:
        """Force, compression, impulse and displacement of the plate over contacts.

        Parameters
        ----------
        speed, radius, thickness : array_like
            As in `restitution`.
        samples : int, optional
            Number of even times from first touch to separation, at least 2.
        method : {"table", "solve"}, optional
            Shapes of contacts kept in the table, or integration of the equation.

        Returns
        -------
        ForceHistory
            Arrays with the samples along the last axis. By ``"table"`` within 1e-4 of the peak
            force of those by ``"solve"``.

        Raises
        ------
        ValueError
            As in `restitution`; too few samples, or an unknown method.

        Notes
        -----
        The integral of the force, `ForceHistory.impulse`, ends at the change of the sphere's
        momentum, m V0 (1 + e). Contacts that come back along a capped law's loading curve
        (``"stronge"`` up to 2.15 yield compressions) are integrated by ``"table"`` too.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> contact = model.force_history(speed=12.0, radius=0.9e-3, thickness=1e-3, samples=5)
        >>> contact.force.round(1)
        array([ 0. , 16.9, 28.2, 15.1,  0. ])
        >>> model.force_history([5.0, 12.0, 15.0], 0.9e-3, 1e-3).time.shape
        (3, 256)
        """
        if not (isinstance(samples, int | np.integer) and 2 <= samples <= _MOST_SAMPLES):
            raise ValueError(f"samples: must be an integer from 2 to 1 000 000, got {samples!r}")
        if method not in ("table", "solve"):
            raise ValueError(f"method: must be 'table' or 'solve', got {method!r}")
        v, r, h, shape = broadcast(speed=speed, radius=radius, thickness=thickness)
        check(speed=v, radius=r, thickness=h)
        contact = sphere_on_plate(self.pair, self._law, r, h)
        units = scales(contact, v)
        if method == "solve":
            contacts = histories_by_solver(self._law, solved(self._law, units, RTOL), samples)
        else:
            found, _ = self._fields(units, self._law, self._table)
            contacts = histories_by_table(self._law, self.table, found, samples)
        return with_units(contacts, units, contact.mobility, shape)

    def yield_speed(self, radius: ArrayLike, thickness: ArrayLike) -> float | Array:
        """Speed V_Y [m/s] from which bead or plate yields, whichever is first; ``inf`` for neither.

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
        array([7.594, 6.156])
        """
        r, h, shape = broadcast(radius=radius, thickness=thickness)
        check(radius=r, thickness=h)
        out = np.full(r.size, math.inf)
        share = yield_share(self.pair, self._law)
        if share < math.inf:
            c_chi = log_overload(self._factors, share)
            lookup.yield_speeds(self._table, self._c_lam, c_chi, r / h, out)
            if np.isnan(out).any():
                n = int(np.argmax(np.isnan(out)))
                raise ValueError(
                    f"thickness: at {h[n]:g} m under a bead of radius {r[n]:g} m the inelasticity "
                    f"at yield is beyond the table's {lookup.lam_max(self._table):.4g}; the plate "
                    "is too thin for the model"
                )
        return shaped(out, shape)

    def sensitivity(self, speed: ArrayLike, radius: ArrayLike, thickness: ArrayLike) -> Sensitivity:
        """How much the COR moves with each input: elasticities d ln e/d ln x.

        Parameters
        ----------
        speed, radius, thickness : array_like
            As in `restitution`.

        Returns
        -------
        Sensitivity
            By how many per cent the COR rises with one per cent of each input [-]; an input that is
            known to 10 % leaves the COR uncertain by ten times that. Within 1e-4 for lambda up to
            1, 1e-3 up to 2, 2e-2 up to 5, by the table's derivatives; with ``"myc"`` and
            ``"hertz"`` within 3e-5, 6e-4 and 5e-3.

        Raises
        ------
        ValueError
            As in `restitution`; outside the table whatever `outside` says.

        Notes
        -----
        Impacts that turn nearer than 5e-4 (relatively) to a kink of the law, where the derivatives
        may jump, are up to 5e-3 off. Laws whose loading curves have corners (``"stronge"``,
        ``"kogut_etsion"``, ``"jackson_green"``) are integrated, four times an impact: within 1e-4
        for lambda up to 5. So are those whose table exceeds its bound for the COR (of coarse
        `Settings`), and the dependence on E*/sigma_Y of ``"jackson_green"``, which takes it from
        the pair; numbers that were given in the name of a law are held fixed. With ``"fem"``, of
        which all inputs change the law or the plate, everything is integrated, ten times an impact,
        within 1e-5; its yield strength is that of all bodies that yield, together.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> moved = model.sensitivity(speed=12.0, radius=0.9e-3, thickness=1e-3)
        >>> round(moved.thickness, 3), round(moved.yield_strength, 3)
        (0.239, 0.176)
        """
        v, r, h, shape = broadcast(speed=speed, radius=radius, thickness=thickness)
        check(speed=v, radius=r, thickness=h)
        units = scales(sphere_on_plate(self.pair, self._law, r, h), v)
        found, _ = tabulated(self._law, self._table, units, "raise")
        if self._law.waves:
            return by_inputs(self.pair, self._law, (v, r, h), found, shape)
        if follows(self.table):
            by_lam, by_y = by_table(self._table, found)
        else:
            by_lam, by_y = by_solver(self._law, found)
        by_ratio = by_modulus_ratio(self.pair, self._law, found)
        return elasticities(self.pair, by_lam, by_y, by_ratio, shape)

    def constant(
        self,
        speed: ArrayLike,
        radius: ArrayLike,
        thickness: ArrayLike,
        keep: Keep = "energy",
        weights: ArrayLike = 1.0,
    ) -> Constant:
        """One COR in place of those of many impacts, for engines that take nothing else.

        Parameters
        ----------
        speed, radius, thickness : array_like
            Of the impacts that happen on a wall, as in `restitution`: samples, or values that
            `weights` belong to.
        keep : {"energy", "momentum"}, optional
            What the wall takes in all with this COR as it does with each impact's own: the
            dissipated energy, e^2 = sum(w R^3 V^2 e_i^2)/sum(w R^3 V^2), or the momentum,
            e = sum(w R^3 V e_i)/sum(w R^3 V).
        weights : array_like, optional
            How often each impact happens, in any unit; broadcast with the others.

        Returns
        -------
        Constant
            The COR, what it gets wrong in all and for single beads, what the plain mean of the
            CORs would, and how many impacts exceed which limit.

        Raises
        ------
        ValueError
            As in `restitution`; no impact, another `keep`, or weights that are negative, not
            finite or all zero.

        Notes
        -----
        The impacts are taken as they are. Where beads bounce again and again, a simulation with
        another COR has other impacts: take those of its own record, and repeat.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> best = model.constant([0.1, 1.0, 10.0], radius=0.9e-3, thickness=0.5e-3)
        >>> round(best.restitution, 4), round(best.mean, 4)
        (0.6225, 0.7343)
        >>> round(best.energy_error, 4), round(best.mean_energy_error, 4)
        (0.0, -0.2477)
        >>> f"single beads rebound to within {best.rebound_error:.0%} of their height"
        'single beads rebound to within 44% of their height'
        """
        v, r, h, w, _ = broadcast(speed=speed, radius=radius, thickness=thickness, weights=weights)
        return constant(v, r, w, self.lookup(v, r, h), keep)

    def speed_table(
        self,
        radius: float,
        thickness: float,
        error: float = 1e-3,
        slowest: float = 0.1,
        fastest: float = 10.0,
    ) -> SpeedTable:
        """COR over speed in the fewest rows, for engines that interpolate in a table.

        Parameters
        ----------
        radius, thickness : float
            As in `restitution`.
        error : float, optional
            Largest error of the COR between rows, from 1e-5 to 0.1.
        slowest, fastest : float, optional
            First and last speed of the table [m/s].

        Returns
        -------
        SpeedTable
            Speeds and their own CORs. No other choice among 4000 logarithmically spaced speeds has
            fewer rows and lets straight lines between them err no more than `error`.

        Raises
        ------
        ValueError
            As in `restitution`; an error out of its range, a first speed above the last, or a
            range too wide for the error.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> rows = model.speed_table(radius=0.9e-3, thickness=1e-3, error=5e-3)
        >>> rows.speed.round(2), rows.restitution.round(3)
        (array([ 0.1 ,  0.15,  1.24, 10.  ]), array([0.952, 0.948, 0.922, 0.871]))
        """
        r, h = scalars(radius=radius, thickness=thickness)
        return speed_table(lambda v: self.lookup(v, r, h), error, (slowest, fastest))

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
        >>> round(curve(5.0), 4)
        0.8966
        """
        r, h = scalars(radius=radius, thickness=thickness)
        return self._curve(
            self._law,
            self._table,
            self._c_lam,
            self._c_chi,
            r.item() / h.item(),
            lambda: sphere_on_plate(self.pair, self._law, r, h),
        )

    def sphere_sphere_curve(
        self, radius: float, other_radius: float, other: Material | str | None = None
    ) -> Callable[[float], float]:
        """COR of the pair's sphere and another one, as a fast function of approach speed.

        Parameters
        ----------
        radius, other_radius : float
            Radii of the beads [m].
        other : Material or str, optional
            Material of the other bead, without it that of the pair's sphere.

        Returns
        -------
        callable
            ``curve(speed)`` [m/s] -> COR; it raises the same errors as `restitution`.

        Examples
        --------
        >>> import contactlaw as cl
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> round(model.sphere_sphere_curve(1e-3, 1e-3)(20.0), 4)
        0.9616
        """
        r, o = scalars(radius=radius, other_radius=other_radius)
        beads, law, table, swapped = self._beads(other)
        contact = sphere_on_sphere(beads, law, *((o, r) if swapped else (r, o)))
        units = scales(contact, np.ones(()))
        c_chi = -math.log(units.yield_ratio.item())
        return self._curve(law, table.packed, 0.0, c_chi, 0.0, lambda: contact)

    @functools.cached_property
    def kernel(self) -> Callable[[float, float, float], float]:
        """COR as a numba-jitted ``f(speed, radius, thickness)`` for loops of one's own [m/s, m, m].

        It holds the table as a constant and does what `restitution` does for three floats, but
        cannot raise (a raise would make a parallel loop serial): bad input and an impact outside
        the table give NaN, whatever `outside` says. Test for it with ``e != e``. Numba does not
        keep a caller of it on disk (``cache=True`` is without effect, with a NumbaWarning): the
        table is part of the machine code.

        Examples
        --------
        >>> import contactlaw as cl, numba
        >>> cor = cl.ImpactModel(cl.Pair("gamma-alumina", "glass")).kernel
        >>> @numba.njit
        ... def rebound_speeds(speed, radius, thickness):
        ...     return [cor(v, radius, thickness) * v for v in speed]
        >>> [round(u, 3) for u in rebound_speeds((1.0, 5.0), 0.9e-3, 1e-3)]
        [0.925, 4.483]
        """
        return jitted(self._table, self._c_lam, self._c_chi)

    @functools.cached_property
    def _c_function(self) -> Any:
        return c_function(self.kernel)

    @property
    def address(self) -> int:
        """Address of a C function ``double f(double speed, double radius, double thickness)``.

        For engines in C and C++: `kernel` behind a plain function pointer, valid as long as this
        model lives, callable from any thread. It gives NaN where `kernel` does.

        Examples
        --------
        >>> import contactlaw as cl, ctypes
        >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
        >>> double = ctypes.c_double
        >>> f = ctypes.CFUNCTYPE(double, double, double, double)(model.address)
        >>> round(f(5.0, 0.9e-3, 1e-3), 4)
        0.8966
        """
        return int(self._c_function.address)

    def _beads(self, other: Material | str | None) -> tuple[Pair, Law, Table, bool]:
        """Two spheres, the weaker one first, their law, its table, and whether they are swapped."""
        sphere = self.pair.sphere
        if other is None or other == sphere:
            return *self._twins, False
        pair = Pair(sphere, other)
        swapped = (pair.plate.yield_strength or math.inf) < (sphere.yield_strength or math.inf)
        return *self._of_beads(Pair(pair.plate, sphere) if swapped else pair), swapped

    @functools.cached_property
    def _twins(self) -> tuple[Pair, Law, Table]:
        return self._of_beads(Pair(self.pair.sphere, self.pair.sphere))

    def _of_beads(self, pair: Pair) -> tuple[Pair, Law, Table]:
        """Two spheres, their law and its table.

        A law that takes numbers from the pair takes those of the two spheres. Numbers that the user
        gave in its name hold for them as they do for the plate.
        """
        law = law_of(pair, self._law.family) if self._law.from_pair else self._law
        same = self.table.law.follows(law) or law == self._law
        return pair, law, self.table if same else table_for(law, None)

    def _curve(
        self,
        law: Law,
        table: Array,
        c_lam: float,
        c_chi: float,
        ratio: float,
        contact: Callable[[], Contact],
    ) -> Callable[[float], float]:
        at = self._at

        def restitution(speed: float) -> float:
            if not isinstance(speed, float):  # the entry would take "5" and True for numbers
                speed = scalars(speed=speed)[0].item()
            value = at(table, c_lam, c_chi, speed, ratio)
            if value != value:  # NaN; half the time of a call of isnan
                (v,) = scalars(speed=speed)
                return float(self._fields(scales(contact(), v), law, table)[0].restitution[0])
            return value

        return restitution

    def _outcomes(
        self, v: Array, r: Array, h: Array
    ) -> tuple[Outcome, Flags, tuple[Array, Array], Array]:
        """Outcomes of spheres on plates, flags of the clamped ones, what was asked, V^(1/5)."""
        found, root = outcome.empty(v.size), np.empty(v.size)
        flags = np.zeros(v.size, dtype=np.int64)
        c_lam, c_chi = self._c_lam, self._c_chi
        beyond = lookup.outcomes(self._table, c_lam, c_chi, v, r, h, found, root)
        asked = found.inelasticity, found.yield_ratio
        if beyond:
            asked = asked[0].copy(), asked[1].copy()
            outside = np.isnan(found.restitution)
            units = scales(sphere_on_plate(self.pair, self._law, r, h), v)
            flags[outside] = complete(self._law, self._table, units, self.outside, outside, found)
            self._count(flags)
        return found, flags, asked, root

    def _fields(self, units: Numbers, law: Law, table: Array) -> tuple[Outcome, Flags]:
        found, flags = tabulated(law, table, units, self.outside)
        self._count(flags)
        return found, flags

    def _count(self, flags: Flags) -> None:
        """Add to the impacts that were clamped."""
        count = int(np.count_nonzero(flags))
        if count:
            with self._clamping:
                self._clamped += count

    def _rebound(
        self,
        pair: Pair,
        law: Law,
        contact: Contact,
        units: Numbers,
        impacts: Impacts,
        found: Outcome,
        flags: Flags,
    ) -> Rebound:
        """Give outcomes their units, whatever the bodies."""
        shape = impacts.speed.shape
        asked = (
            np.ascontiguousarray(np.broadcast_to(units.inelasticity, shape)),
            np.ascontiguousarray(np.broadcast_to(units.yield_ratio, shape)),
        )
        bounds = self._limits if pair is self.pair else limits(pair, law)
        return rebound(law.data, bounds, impacts, units.time, contact.mass, asked, found, flags)
