"""Points on the path of a contact, between the steps of an integration.

Between two steps the compression and the sphere's speed are cubics in time, through their values at
both ends and with their rates there: those of the compression are dq/ds, those of the speed -f.

Legend, as in `contactlaw.equation.motion`: d compression, q root compression, u speed, f force,
t time, y yield compression.
"""

import math
from typing import Any, NamedTuple

from contactlaw._jit import kernel
from contactlaw.equation import force
from contactlaw.equation.force import BlendedLaw, UnloadingCurve
from contactlaw.equation.motion import ScaledState

# How far an integration goes, and where it notes points.
TO_THE_TOP, TO_THE_END, AT_TIMES, AT_COMPRESSIONS = range(4)


class Notes(NamedTuple):
    """Points on the paths of contacts, a row for each contact."""

    # Where they are: rising times [T_H], or compressions, first rising ones, the last of which is
    # infinity for the largest compression, then as many falling ones, the last 0 for separation.
    at: Any
    time: Any
    speed: Any  # of the sphere
    force: Any
    compression: Any


@kernel(inline=True)
def coefficients(rise: float, rate: float, last: float) -> tuple[float, float]:
    """Coefficients of x^2 and x^3 of a cubic, from its whole change and its rates per step at both ends."""
    return 3.0 * rise - 2.0 * rate - last, rate + last - 2.0 * rise


@kernel(inline=True)
def cubic(rise: float, rate: float, last: float, x: float) -> float:
    """Change of a value in the share x of a step."""
    c2, c3 = coefficients(rise, rate, last)
    return x * (rate + x * (c2 + x * c3))


@kernel
def share_at(rise: float, rate: float, last: float, change: float) -> float:
    """Share of a step in which a value changes by this, by Newton's method from the secant."""
    secant = x = change / rise
    c2, c3 = coefficients(rise, rate, last)
    for _ in range(3):
        x -= (((c3 * x + c2) * x + rate) * x - change) / ((3.0 * c3 * x + 2.0 * c2) * x + rate)
    return x if 0.0 < x < 1.0 else secant  # near a turn Newton's method may leave the step


@kernel
def note(
    goal: int,
    notes: Notes,
    n: int,
    first: int,
    most: int,
    law: BlendedLaw,
    curve: UnloadingCurve,
    y: float,
    a: ScaledState,
    b: ScaledState,
    ends: bool,
) -> int:
    """Note points of row n from `first` on that lie between two states; return how many points are noted then.

    Where the path ends, all points up to `most` are noted there.
    """
    y4 = math.sqrt(math.sqrt(y))
    before, span, rise = a.q * a.q, b.t - a.t, b.q * b.q - a.q * a.q
    for k in range(first, most):
        if goal == AT_TIMES:
            x = (notes.at[n, k] * y4 - a.t) / span
        else:
            x = (notes.at[n, k] / y - curve.residual - before) / rise
        if not (ends or x <= 1.0):
            return k
        if not x < 1.0:
            x = 1.0
        elif goal == AT_COMPRESSIONS:
            x = share_at(rise, span * a.dq, span * b.dq, x * rise)
        d = max(before + cubic(rise, span * a.dq, span * b.dq, x), 0.0)
        notes.time[n, k] = (a.t + x * span) / y4
        notes.speed[n, k] = (a.u + cubic(b.u - a.u, -span * a.f, -span * b.f, x)) * y * y4
        notes.force[n, k] = force.unloading_force(law, curve, math.sqrt(d)) * y * math.sqrt(y)
        notes.compression[n, k] = (d + curve.residual) * y
    return most
