"""The fields of an impact's answer, each listed once, in the units of Hertz's scale.

Speeds in V0, time in T_H, compressions in V0 T_H, forces in m V0/T_H, energies as shares of the
initial kinetic energy. Kernels take these NamedTuples of arrays, one entry per impact, and fill
them by name.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation import force
from contactlaw.equation.force import BlendedLaw

OK, TOO_MANY_STEPS, BAD_INPUT = range(3)  # status of a solution


class Outcome(NamedTuple):
    """What tables keep of impacts, and the numbers that describe them; a `Solution` follows from it and the law."""

    restitution: Any
    contact_time: Any  # from touch to separation
    wave_rate: Any  # share of the energy in the bending wave, over lambda: it has a limit at 0
    compression_ratio: Any  # largest compression over that of an elastic impact
    elastic_compression: Any  # w_m, the largest compression of an elastic impact
    inelasticity: Any  # lambda
    yield_ratio: Any  # y, the yield compression; inf for an elastic law
    strength: Any  # ln of the strength at the impact's rate over that of a slow test


class Solution(NamedTuple):
    """Contacts that have ended, numbers or arrays; energies as shares of the initial one."""

    status: Any
    restitution: Any
    loading_time: Any  # until the largest compression; NaN of what was interpolated
    contact_time: Any
    peak_force: Any
    peak_compression: Any
    residual_compression: Any
    plastic_fraction: Any
    wave_fraction: Any
    other_fraction: Any
    wave_rate: Any  # wave_fraction / lam, which has a limit at lam = 0


class History(NamedTuple):
    """Contacts over time: samples along the last axis."""

    time: Any  # since first touch
    force: Any
    compression: Any
    impulse: Any  # integral of the force since first touch [m V0]


class Field(NamedTuple):
    """A field of an answer, as all that names fields describes it."""

    words: str
    unit: str  # in SI; 1: none
    error: float  # of a table: of COR absolute, of the others over their largest value


FIELDS = {
    "restitution": Field("rebound speed over impact speed", "1", 5e-5),
    "contact_time": Field("from touch to separation", "s", 2e-3),
    "peak_force": Field("largest contact force", "N", 1e-3),
    "peak_compression": Field("largest approach of the bodies since touch", "m", 1e-3),
    "residual_compression": Field("left after the impact", "m", 1e-3),
    "plastic_fraction": Field("share lost to plastic flow at the contact", "1", 1e-3),
    "wave_fraction": Field("share carried off by waves in the plate", "1", 1e-3),
    "other_fraction": Field("share left in vibration and locked-in stress", "1", 1e-3),
    "inelasticity": Field("lambda of the modified Zener model", "1", 0.0),
    "overload": Field("largest elastic compression over the yield compression", "1", 0.0),
}
"""Fields of `contactlaw.Rebound` except its flags; the last two are inputs, without table error."""


STORED = (
    "1 - rebound speed over impact speed [-]",
    "1 over the time from touch to separation [1/T_H]",
    "share of the energy in the bending wave, over lambda [-]",
    "largest compression over the elastic one [-]",
)
"""Fields that tables keep, in the order in which their splines are packed."""


def balance(restitution: Array, lost: Array) -> Array:
    """Factor of the shares of energy lost, by which they and that of the rebound add up to 1."""
    factor = np.ones_like(lost)
    np.divide(1.0 - restitution * restitution, lost, out=factor, where=lost > 0.0)
    return factor


def empty(count: int) -> Outcome:
    """Allocate the outcomes of impacts."""
    return Outcome(*np.empty((len(Outcome._fields), count)))


def at(inelasticity: Array, yield_ratio: Array, strength: Array | float = 0.0) -> Outcome:
    """Allocate the outcomes of impacts with these dimensionless numbers."""
    out = empty(inelasticity.size)
    out.inelasticity[:] = inelasticity
    out.yield_ratio[:] = yield_ratio
    out.strength[:] = strength
    return out


def part(arrays: Any, chosen: Any) -> Any:
    """Impacts that an index selects, of a NamedTuple of arrays with one entry for each impact."""
    return type(arrays)(*(values[chosen] for values in arrays))


def extremes(count: int) -> Solution:
    """Allocate the solutions of impacts."""
    return Solution(*np.empty((len(Solution._fields), count)))


@kernel(inline=True)
def solution(
    law: BlendedLaw,
    y: float,
    ended: bool,
    restitution: float,
    loading_time: float,
    contact_time: float,
    dm: float,
    lam: float,
    wave_rate: float,
) -> Solution:
    """Solution of a contact that has ended, from its largest compression in the law's scale."""
    turned, unit = force.deepest(law, dm), y * math.sqrt(y)  # F_Y
    per_energy = 2.0 * y * unit
    return Solution(
        float(OK if ended else TOO_MANY_STEPS),
        restitution,
        loading_time,
        contact_time,
        turned.force * unit,
        dm * y,
        turned.residual * y,
        per_energy * (turned.loss - turned.other),
        lam * wave_rate,
        per_energy * turned.other,
        wave_rate,
    )


def history(contact_time: Array, samples: int) -> History:
    """Allocate contacts at even times from touch to separation."""
    time = contact_time[:, None] * np.linspace(0.0, 1.0, samples)
    return History(time, *np.empty((len(History._fields) - 1, *time.shape)))
