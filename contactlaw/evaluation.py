"""From the dimensionless numbers of impacts to answers in SI units: by table or by integration."""

from __future__ import annotations

import functools
import math
import os
import warnings
from typing import Literal, NamedTuple, NoReturn

import numpy as np
from numpy.typing import NDArray

from contactlaw import laws, lookup, store, zener
from contactlaw._jit import enable_caching
from contactlaw.arguments import shaped
from contactlaw.cache import cached
from contactlaw.impact import Contact, Rebound, Scales, scales
from contactlaw.laws import Law
from contactlaw.pair import Pair
from contactlaw.table import BOUNDS, Settings, Table
from contactlaw.validity import Validity, limits_exceeded

Array = NDArray[np.float64]
Flags = NDArray[np.int64]
Outside = Literal["raise", "solve", "clamp"]

_ELASTIC_EDGE = "myc"  # a law that never yields is the edge chi = 1 of any table; this one ships
RTOL = 1e-10  # of an integration for which the user names no other


class Impact(NamedTuple):
    """Flat arrays of what the user asked for, and the shape of the answer (None: scalars)."""

    speed: Array
    radius: Array
    thickness: Array
    shape: tuple[int, ...] | None


@functools.cache
def _default(law: str) -> Table:
    """Table that ships with the package, or that of the user's cache."""
    return store.packaged(law) or cached(law)


def table_for(law: Law, table: Table | Settings | str | os.PathLike[str] | None) -> Table:
    """Table that serves a law: the user's, or the packaged one."""
    enable_caching()
    name = law.name if law.kinks else _ELASTIC_EDGE
    if table is None:
        return _default(name)
    if isinstance(table, Settings):
        table = cached(name, table)
    elif not isinstance(table, Table):
        table = store.read(table)
    if table.certificate is not None and table.certificate.exceeded:
        warnings.warn(
            f"the table is less accurate than contactlaw promises; its largest errors "
            f"{table.certificate.exceeded} are above {BOUNDS}: take finer Settings",
            stacklevel=3,
        )
    if table.law != name:
        raise ValueError(f"table: it belongs to law {table.law!r}, the model needs one of {name!r}")
    return table


def factors(contact: Contact) -> tuple[float, float]:
    """c_lam and c_chi of `lookup`: lambda and ln(chi/w_m) at 1 m/s."""
    units = scales(contact, np.ones(()))
    return units.inelasticity.item(), -math.log(units.yield_ratio.item())


def _coordinates(units: Scales) -> tuple[Array, Array]:
    lam, y = np.broadcast_arrays(units.inelasticity, units.yield_ratio, units.time)[:2]
    return np.ascontiguousarray(lam), np.ascontiguousarray(y)


def solved(law: Law, units: Scales, rtol: float) -> Array:
    """Fields (7, n) by integration: those of `zener.solve_all`, lambda and y."""
    lam, y = _coordinates(units)
    out = np.empty((7, lam.size))
    out[5:] = lam, y
    hertz = laws.law("hertz").functions
    status, n = zener.solve_all(law.functions, hertz, lam, y, rtol, out[:5])
    if status != zener.OK:
        raise RuntimeError(
            f"the equation did not solve at lambda = {lam[n]:.6g}, d_Y/(V0 T_H) = {y[n]:.6g} "
            f"(element {n}): {zener.MESSAGES[status]}"
        )
    return out


def tabulated(law: Law, table: Array, units: Scales, outside: Outside) -> tuple[Array, Flags]:
    """Fields (7, n): those of `solved`, and the lambda and y that they belong to.

    Beside them Validity.CLAMPED where the border of the table was taken.
    """
    lam, y = _coordinates(units)
    out = np.empty((7, lam.size))
    out[5:] = lam, y
    clamped = np.zeros(lam.size, dtype=np.int64)
    if not lookup.fields(table, out[5], out[6], False, out[:5]):
        return out, clamped
    beyond = np.isnan(out[0])
    if outside == "raise":
        n = int(np.argmax(beyond))
        _refuse(table, float(lam[n]), float(y[n]), n)
    if outside == "solve":
        part = Scales(*(np.broadcast_to(value, lam.shape)[beyond] for value in units))
        out[:, beyond] = solved(law, part, RTOL)
    else:
        lookup.fields(table, out[5], out[6], True, out[:5])
        clamped[beyond] = int(Validity.CLAMPED)
    return out, clamped


def _refuse(table: Array, lam: float, y: float, n: int) -> NoReturn:
    limit = lookup.lam_max(table)
    if lam > limit:
        what = (
            f"its inelasticity lambda = {lam:.4g} is above {limit:.4g}: the plate is too thin for "
            "the bead"
        )
    else:
        chi = math.exp(lookup.log_elastic_compression(table, lam)) / y
        limit = lookup.chi_max(table)
        what = f"its overload chi = {chi:.4g} is above {limit:.4g}: the impact is too fast"
    raise ValueError(
        f"speed, radius, thickness: impact {n} is outside the table, {what}. "
        'ImpactModel(..., outside="solve") integrates the equation there, "clamp" takes the '
        "value at the table's border."
    )


def rebound(
    pair: Pair, law: Law, units: Scales, fields: Array, impact: Impact, flags: Flags | int = 0
) -> Rebound:
    """Give fields (7, n) their units back and add what follows from them."""
    restitution, time, wave_rate, ratio, w_m, lam, y = fields
    compression = ratio * w_m
    state = np.empty((3, compression.size))
    zener.contact_state(law.functions, compression, y, state)
    force, residual, plastic = state
    contact_time = time * units.time
    asked_lam, asked_y = _coordinates(units)  # others than lam and y where those were clamped
    # V0/V_Y0 = (5/4)^(1/2) y^(-5/4): a half-space impact at V_Y0 has w_m = y = (5/4)^(2/5)
    speed_ratio = math.sqrt(1.25) / (asked_y * np.sqrt(np.sqrt(asked_y)))
    flags = flags | limits_exceeded(
        pair, law, impact.radius, impact.thickness, speed_ratio, contact_time
    )
    shape = impact.shape
    return Rebound(
        restitution=shaped(restitution, shape),
        contact_time=shaped(contact_time, shape),
        peak_force=shaped(force * units.force, shape),
        peak_compression=shaped(compression * units.compression, shape),
        residual_compression=shaped(residual * units.compression, shape),
        plastic_fraction=shaped(plastic, shape),
        wave_fraction=shaped(lam * wave_rate, shape),
        inelasticity=shaped(asked_lam, shape),
        overload=shaped(w_m / asked_y, shape),
        flags=Validity(int(flags[0])) if shape is None else flags.reshape(shape),
    )
