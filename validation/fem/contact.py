"""Contact of two surfaces: no penetration, and Coulomb friction.

Nodes of the sphere's surface against segments of the plate's. The impulses of a step are those
that leave no node inside the other body at the step's end (forward increment Lagrange multipliers:
Carpenter, Taylor, Katona, Int. J. Numer. Methods Eng. 32 (1991) 103): a penalty whose stiffness
is m/dt^2, so there is neither a penetration to choose nor a shorter step. They are found by
projected Gauss-Seidel sweeps, since neighbours share a segment.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

SWEEPS = 12  # our choice; the force changes by less than 1e-4 beyond it


class Surfaces(NamedTuple):
    """Two surfaces that may touch, and room for their impulses."""

    slave: Indices  # (s,), nodes from the axis outwards
    master: Indices  # (m,), likewise
    segment: Indices  # (s,), the master's segment below each slave
    share: Array  # (s,), where on the segment, 0 to 1
    gap: Array  # (s,), from the segment up to the slave [m]
    before: Array  # (s, 2), velocity of slave less segment half a step ago [m/s]
    impulse: Array  # (s, 2), normal and tangential [N s]
    work: Array  # (2,), loss in normal contact and in friction so far [J]
    friction: float  # coefficient
    reach: float  # a gap that cannot close within a step [m]


@kernel(entry=True)
def approach(pair: Surfaces, x: Array, v: Array) -> int:
    """Find the segment below each slave; return how many slaves are near enough to touch.

    To be called before the velocities take their step: it keeps the old ones for the work.
    """
    k, last = 0, pair.master.size - 2
    for i in range(pair.slave.size):
        s = pair.slave[i]
        while k < last and x[pair.master[k + 1], 0] < x[s, 0]:
            k += 1
        while k > 0 and x[pair.master[k], 0] > x[s, 0]:
            k -= 1
        a, b = pair.master[k], pair.master[k + 1]
        t = (x[s, 0] - x[a, 0]) / (x[b, 0] - x[a, 0])
        pair.segment[i], pair.share[i] = k, t
        for j in range(2):
            pair.impulse[i, j] = 0.0
            pair.before[i, j] = v[s, j] - (1.0 - t) * v[a, j] - t * v[b, j]
        pair.gap[i] = x[s, 1] - (1.0 - t) * x[a, 1] - t * x[b, 1]
        if pair.gap[i] > pair.reach:
            return i
    return pair.slave.size


@kernel(entry=True)
def resolve(pair: Surfaces, x: Array, v: Array, inverse_mass: Array, dt: float, count: int) -> float:
    """Correct the new velocities for contact; return the force that lifts the slaves [N/rad]."""
    for _ in range(SWEEPS):
        for i in range(count):
            s, t = pair.slave[i], pair.share[i]
            a, b = pair.master[pair.segment[i]], pair.master[pair.segment[i] + 1]
            e_r, e_z = _direction(x, a, b)
            u_r = v[s, 0] - (1.0 - t) * v[a, 0] - t * v[b, 0]
            u_z = v[s, 1] - (1.0 - t) * v[a, 1] - t * v[b, 1]
            m, m_a, m_b = inverse_mass[s], inverse_mass[a], inverse_mass[b]
            i_r = m[0] + (1.0 - t) ** 2 * m_a[0] + t * t * m_b[0]
            i_z = m[1] + (1.0 - t) ** 2 * m_a[1] + t * t * m_b[1]
            i_n, i_t = e_z * e_z * i_r + e_r * e_r * i_z, e_r * e_r * i_r + e_z * e_z * i_z
            depth = e_r * (u_z + pair.gap[i] / dt) - e_z * u_r
            normal = max(pair.impulse[i, 0] - depth / i_n, 0.0)
            limit = pair.friction * normal
            slip = (e_r * u_r + e_z * u_z) / i_t if i_r > 0.0 else 0.0  # 0 on the axis
            along = min(max(pair.impulse[i, 1] - slip, -limit), limit)
            j_n, j_t = normal - pair.impulse[i, 0], along - pair.impulse[i, 1]
            pair.impulse[i, 0], pair.impulse[i, 1] = normal, along
            j_r, j_z = e_r * j_t - e_z * j_n, e_z * j_t + e_r * j_n
            v[s, 0] += j_r * m[0]
            v[s, 1] += j_z * m[1]
            v[a, 0] -= (1.0 - t) * j_r * m_a[0]
            v[a, 1] -= (1.0 - t) * j_z * m_a[1]
            v[b, 0] -= t * j_r * m_b[0]
            v[b, 1] -= t * j_z * m_b[1]
    lift = 0.0
    for i in range(count):
        s, t = pair.slave[i], pair.share[i]
        a, b = pair.master[pair.segment[i]], pair.master[pair.segment[i] + 1]
        e_r, e_z = _direction(x, a, b)
        u_r = 0.5 * (v[s, 0] - (1.0 - t) * v[a, 0] - t * v[b, 0] + pair.before[i, 0])
        u_z = 0.5 * (v[s, 1] - (1.0 - t) * v[a, 1] - t * v[b, 1] + pair.before[i, 1])
        normal, along = pair.impulse[i, 0], pair.impulse[i, 1]
        pair.work[0] -= normal * (e_r * u_z - e_z * u_r)
        pair.work[1] -= along * (e_r * u_r + e_z * u_z)
        lift += (e_z * along + e_r * normal) / dt
    return lift


@kernel(entry=True)
def _direction(x: Array, a: int, b: int) -> tuple[float, float]:
    """Return the unit vector (e_r, e_z) along a segment; (-e_z, e_r) is its normal."""
    e_r, e_z = x[b, 0] - x[a, 0], x[b, 1] - x[a, 1]
    length = math.sqrt(e_r * e_r + e_z * e_z)
    return e_r / length, e_z / length
