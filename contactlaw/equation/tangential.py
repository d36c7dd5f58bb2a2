"""Tangential motion of a contact whose normal history is known: springs that slide.

The method of dimensionality reduction (Popov & Hess 2015; Willert & Popov, Sci. Rep. 6 (2016) 8479)
replaces a contact of radius a by independent springs across it. Those that lie within the radius
carry the incremental stiffness k = 2 E* a of the normal contact, so k itself serves as the
coordinate across it: a spring is the part of the contact between two values of k. Each spring has
kappa = G*/E* of its normal stiffness along the surface, and Coulomb's law holds for each by itself,
with its own share of the normal force. For elastic bodies this is the solution of Cattaneo and
Mindlin, whatever the history.

If the contact unloads as F = c d^n, the shares at x, as a part of k, are proportional to 1 - x^p
with p = 1/(n - 1): Hertz's law has 2. They add up to the whole force at any load, because the
outermost spring is only as wide as the contact.

Where material flows, what it holds along the surface relaxes: the flow follows the stress, and most
of that is normal. While a contact flows the springs lose stretch, by the rate at which it deepens
and the part of the compression that is beyond yield (`kept`). The factor is fitted to finite
elements in three dimensions, as is a part of `stiffness_at`; both are judged by others of these.

Friction needs no number of its own: with speeds in mu V0 and tangential forces in mu m V0/T_H,
Coulomb's coefficient is 1.

Legend: V0 normal approach speed, T_H Hertz's time, m mass, d compression, q its root, f normal
force, y yield compression, all on Hertz's scale as in `contactlaw.equation.zener`.
"""

import math
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation import force
from contactlaw.equation.force import BlendedLaw
from contactlaw.equation.outcome import History

# What a tangential force changes at the contact point of a solid sphere, beside its centre: 1 for
# the centre and m R^2/I = 5/2 for the spin.
POINT = 3.5
SPRINGS = 64  # of a reference solution
FLATTEST = 1e-9  # least exponent of unloading, less 1; there all shares are alike
RELAXING = 1.5  # relative loss of stretch, over (1 - y/d) times the relative growth of d


class Stiffness(NamedTuple):
    """The elastic part of a contact at one moment."""

    normal: float  # k, in effect dF/dd of unloading
    power: float  # p of the shares of the normal force


@kernel(inline=True)
def share_within(x: float, power: float) -> float:
    """Share of the normal force that the part of a contact up to x, a part of k, carries."""
    if power == 2.0:
        return 1.5 * x - 0.5 * x * x * x
    return x * (1.0 + (1.0 - math.pow(x, power)) / power)


@kernel(inline=True)
def limited(wish: float, most: float) -> float:
    """Clip a number to `most` of either sign."""
    return min(max(wish, -most), most)


@kernel
def stiffness_at(law: BlendedLaw, y: float, unit: float, largest: float, d: float, f: float) -> Stiffness:
    """Elastic part of a contact that was loaded up to `largest`; y = inf follows Hertz's law.

    `unit` is K of Hertz's law. A finite sphere's centre approaches less than the half-spaces of
    Hertz would let it, by a compliance that does not depend on the contact: 2/3 s/(K d_Y^0.5), with
    s of `force.stiffening`. Together with it 1/k is that of the contact's radius, 1/(2 E* a), also
    where a body has flowed. Along the surface a finite sphere gives way more than a half-space; in
    finite elements in three dimensions by as much again.

    Bodies with losses unload along a steeper curve than the radius of their contact says: k is that
    of the curve along which they would unload without losses. Bodies that flow have less energy
    left at the largest compression, of which a part is lost before, and so give more of it back.
    """
    exponent, left = 1.5, 0.0
    if largest > y * force.leaves_hertz(law):
        curve = force.unloading(law, largest / y)
        exponent, left = 0.5 * curve.exponent, curve.residual * y
    span, work, early = force.returned(law) if left > 0.0 else (1.0, 1.0, 0.0)
    if work < 1.0:
        dm = largest / y
        if dm > 1.0:
            turned = force.deepest(law, dm)
            back = turned.force * (dm - turned.residual) / (exponent + 1.0)
            work += early * (work - back / (back + turned.loss))
        exponent = (exponent + 1.0) * work / span - 1.0
    power = 2.0 if exponent == 1.5 else 1.0 / max(exponent - 1.0, FLATTEST)
    k = span * exponent * f / (d - left) if d > left else 0.0
    missing = 2.0 * (2.0 / 3.0) * force.stiffening(law) / (unit * math.sqrt(y))
    return Stiffness(k / (1.0 + missing * k), power)


@kernel(inline=True)
def kept(y: float, largest: float, d: float) -> float:
    """Share of their stretch that springs keep while the largest compression grows to d."""
    if not d > max(largest, y):
        return 1.0
    before = max(largest, y)
    return math.exp(RELAXING * (math.log(before / d) - y / d + y / before))


@kernel(inline=True)
def part_of(spring: int, springs: int, width: float, k: float) -> float:
    """Width in k of a spring that touches: the last one is as wide as it has to be."""
    wide = max(k - spring * width, 0.0)
    return wide if spring == springs - 1 else min(width, wide)


@kernel
def pull(
    stretch: Array,
    width: float,
    kappa: float,
    before: float,
    now: Stiffness,
    f: float,
    left: float,
    path: Array,
    total: Array,
) -> None:
    """Move springs (springs, impacts) along the surface by each impact's path; total their force.

    A spring is `width` wide in k, `before` is k at the last call, and `left` is what flow has left
    of the stretch. Parts that have joined since then share half the path, and flow relaxes half of
    it. Parts that have parted take their force with them: their energy is lost, and no step makes
    any.
    """
    springs, within, k = stretch.shape[0], 0.0, now.normal
    total[:] = 0.0
    for n in range(springs):
        wide = part_of(n, springs, width, k)
        if wide == 0.0:
            stretch[n] = 0.0
            continue
        held = min(part_of(n, springs, width, before), wide)
        share = share_within((n * width + wide) / k, now.power)
        most = f * (share - within)
        within = share
        old, new = kappa * held * left, 0.25 * kappa * (1.0 + left) * (wide + held)
        per_force = 1.0 / (kappa * wide)
        for i in range(path.size):
            pulled = limited(old * stretch[n, i] + new * path[i], most)
            stretch[n, i] = pulled * per_force
            total[i] += pulled


@kernel
def slide(law: BlendedLaw, y: float, kappa: float, path: History, speed: Array, stretch: Array) -> None:
    """Turn speeds of the contact point before an impact into those after it [mu V0].

    All have the same normal history, `path`. In each step the impulse of the normal force, which
    the history knows exactly, is multiplied by the mean of the ratios of tangential and normal
    force at either end: a contact that slides all the time gets mu times the normal impulse.
    """
    time, f, d = path.time, path.force, path.compression
    peak = 0.0
    for i in range(time.size):
        peak = max(peak, stiffness_at(law, y, 1.0, d[i], d[i], f[i]).normal)
    width = peak / stretch.shape[0]
    stretch[:] = 0.0
    ratio, moved = np.empty(speed.size), np.empty(speed.size)
    for n in range(speed.size):  # a contact that just begins either slides or sticks as a whole
        ratio[n] = limited(kappa * speed[n], 1.0)
    largest, before = 0.0, 0.0
    for i in range(1, time.size):
        half, step = 0.5 * POINT * (path.impulse[i] - path.impulse[i - 1]), time[i] - time[i - 1]
        for n in range(speed.size):
            speed[n] -= half * ratio[n]
            moved[n] = step * speed[n]
        left = kept(y, largest, d[i])
        largest = max(largest, d[i])
        if f[i] > 0.0:
            now = stiffness_at(law, y, 1.0, largest, d[i], f[i])
            pull(stretch, width, kappa, before, now, f[i], left, moved, ratio)
            before = now.normal
            for n in range(speed.size):
                ratio[n] /= f[i]
        for n in range(speed.size):
            speed[n] -= half * ratio[n]


@kernel(cache=True)
def slide_all(laws: Array, y: Array, s: Array, kappa: float, paths: History, speed: Array, springs: int) -> None:
    """`slide` for speeds (histories, speeds); s is the strength of the impacts."""
    stretch = np.empty((springs, speed.shape[1]))
    for n in range(speed.shape[0]):
        path = History(paths.time[n], paths.force[n], paths.compression[n], paths.impulse[n])
        slide(force.at_strength(laws, s[n]), y[n], kappa, path, speed[n], stretch)
