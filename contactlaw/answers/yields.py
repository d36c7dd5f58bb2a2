"""The speed from which sphere or plate yields, without integration."""

import math

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.answers.backend import UnsolvedError
from contactlaw.answers.tabulated import TableLookup
from contactlaw.equation import force, zener
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.scaling import numbers_of, yield_share

_CONVERGED = 1e-11  # largest size of ln(largest compression/d_Y) at the yield speed found
_ROUNDS = 1000  # where flow depends on the rate, the compression may hardly outgrow d_Y
_SLOPE = 0.75  # d ln(largest compression/d_Y)/d ln(speed); most impacts have 2/3 to 4/5


def yield_speeds(tabulated: TableLookup, impacts: Impacts) -> Array:
    """Speeds [m/s] from which sphere or plate yields; inf where neither does.

    There the largest compression is that of first flow. Its logarithm is nearly linear in that of
    the speed. It starts at the yield speed on a half-space, which is the lowest of all plates.
    Impacts whose lambda is beyond the table's are refused.
    """
    bodies, most = tabulated.bodies, tabulated.largest_inelasticity
    laws, constants, impact = bodies.data, bodies.constants, bodies.impact(impacts)
    share, rated = yield_share(bodies.pair, bodies.law), constants.plate.rate.slope > 0.0
    if math.isinf(share):
        return np.full_like(impacts.speed, math.inf)
    if not rated:
        constants = constants._replace(yield_compression=share)
    at_one = numbers_of(constants, laws, impact._replace(speed=np.ones_like(impacts.speed)))
    log_speed = 1.25 * np.log(at_one.yield_ratio) - 0.5 * math.log(1.25)  # 1.25 ln w_m of a half-space
    never = np.zeros_like(log_speed, bool)
    for _ in range(_ROUNDS):
        units = numbers_of(constants, laws, impact._replace(speed=np.exp(log_speed)))
        lam, s = units.inelasticity, units.strength
        onset = np.log([force.scale_at(laws, one, force.LOG_ONSET) / force.growth_at(laws, one) for one in s])
        never |= rated & (onset >= -math.log(share))  # the strength has outgrown the load
        gap = np.log(zener.elastic_compression(laws, lam, s) / units.yield_ratio) - onset
        gap[never] = 0.0
        if np.abs(gap).max(initial=0.0) < _CONVERGED:
            break
        log_speed -= gap / _SLOPE
    else:
        n = int(np.abs(gap).argmax())
        raise UnsolvedError(n, f"lambda = {lam[n]:.6g}", "no speed was found at which it yields")
    for n in np.flatnonzero((lam > most) & ~never)[:1]:
        reason = f"too thin for the table: under a bead of {impacts.radius[n]:g} m the inelasticity at yield is "
        raise ArgumentError("thickness", impacts.thickness[n], f"{reason}above {most:.4g}")
    return np.where(never, math.inf, np.exp(log_speed))
