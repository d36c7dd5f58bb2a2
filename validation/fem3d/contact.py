"""Contact of two surfaces in three dimensions: no penetration, and Coulomb friction.

The nodes of the sphere's surface against the faces of the plate's, as in `validation.fem.contact`:
the impulses of a step are those that leave no node inside the other body, and none that slides
unless its tangential impulse is the coefficient of friction times the normal one. They have neither
a penalty nor a stiffness of sticking to choose, and are found by projected Gauss-Seidel sweeps.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from validation.fem3d.hexahedra import Vector, cross, dot

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

SWEEPS = 12  # our choice, as in the plane
_ITERATIONS = 3  # of Newton's method for the place on a face, which is nearly a parallelogram
_WALK = 20  # faces that a node may cross in a step


class Surfaces(NamedTuple):
    """Two surfaces that may touch, and room for their impulses; s nodes, m faces."""

    slave: Indices  # (s,), nodes of the sphere
    faces: Indices  # (m, 4), of the plate; node k at xi, eta as bits 0, 1 of k say
    beside: Indices  # (m, 4), the faces across xi = -1, xi = 1, eta = -1, eta = 1; -1: none
    face: Indices  # (s,), the one below each slave
    weight: Array  # (s, 4), of the face's nodes at the slave's foot
    base: Array  # (s, 3, 3), normal and two tangents
    mobility: Array  # (s, 3), change of the relative velocity by a unit impulse along each [1/kg]
    gap: Array  # (s,), from the face up to the slave [m]
    before: Array  # (s, 3), velocity of slave less face half a step ago [m/s]
    impulse: Array  # (s, 3), normal and tangential [N s]
    near: Indices  # (s,), slaves that may touch in this step come first
    work: Array  # (2,), loss in normal contact and in friction so far [J]
    friction: float  # coefficient
    reach: float  # a gap that cannot close within a step [m]


@kernel(inline=True)
def _relative(pair: Surfaces, v: Array, i: int) -> Vector:
    """Velocity of a slave less that of its foot on the face."""
    s, w, f = pair.slave[i], pair.weight[i], pair.faces[pair.face[i]]
    a, b, c, d = f[0], f[1], f[2], f[3]
    return (
        v[s, 0] - w[0] * v[a, 0] - w[1] * v[b, 0] - w[2] * v[c, 0] - w[3] * v[d, 0],
        v[s, 1] - w[0] * v[a, 1] - w[1] * v[b, 1] - w[2] * v[c, 1] - w[3] * v[d, 1],
        v[s, 2] - w[0] * v[a, 2] - w[1] * v[b, 2] - w[2] * v[c, 2] - w[3] * v[d, 2],
    )


@kernel(inline=True)
def _place(pair: Surfaces, x: Array, i: int) -> tuple[float, float]:
    """Find the face below a slave, and xi and eta of the foot on it."""
    s, q = pair.slave[i], pair.face[i]
    xi, eta = 0.0, 0.0
    for _ in range(_WALK):
        a, b, c, d = pair.faces[q, 0], pair.faces[q, 1], pair.faces[q, 2], pair.faces[q, 3]
        xa, xb, xc, xd = x[a, 0], x[b, 0], x[c, 0], x[d, 0]
        ya, yb, yc, yd = x[a, 1], x[b, 1], x[c, 1], x[d, 1]
        x1, x2, x3 = xb - xa + xd - xc, xc - xa + xd - xb, xd - xc - xb + xa
        y1, y2, y3 = yb - ya + yd - yc, yc - ya + yd - yb, yd - yc - yb + ya
        to_x, to_y = 4.0 * x[s, 0] - xa - xb - xc - xd, 4.0 * x[s, 1] - ya - yb - yc - yd
        xi, eta = 0.0, 0.0
        for _ in range(_ITERATIONS):
            r_x = to_x - x1 * xi - x2 * eta - x3 * xi * eta
            r_y = to_y - y1 * xi - y2 * eta - y3 * xi * eta
            p, q1 = x1 + x3 * eta, x2 + x3 * xi
            r, t = y1 + y3 * eta, y2 + y3 * xi
            inverse = 1.0 / (p * t - q1 * r)
            xi += inverse * (t * r_x - q1 * r_y)
            eta += inverse * (p * r_y - r * r_x)
        over_xi, over_eta = abs(xi) - 1.0, abs(eta) - 1.0
        side = (1 if xi > 0.0 else 0) if over_xi > over_eta else (3 if eta > 0.0 else 2)
        if max(over_xi, over_eta) <= 0.0 or pair.beside[q, side] < 0:
            break
        q = pair.beside[q, side]
    pair.face[i] = q
    return min(max(xi, -1.0), 1.0), min(max(eta, -1.0), 1.0)


@kernel(entry=True)
def approach(pair: Surfaces, x: Array, v: Array, inverse_mass: Array) -> int:
    """Find the foot of each slave; return how many slaves are near enough to touch.

    To be called before the velocities take their step: it keeps the old ones for the work.
    """
    count = 0
    for i in range(pair.slave.size):
        xi, eta = _place(pair, x, i)
        f, w = pair.faces[pair.face[i]], pair.weight[i]
        for k in range(4):
            w[k] = 0.25 * (1.0 + (2 * (k & 1) - 1) * xi) * (1.0 + (2 * (k >> 1) - 1) * eta)
        apart = _relative(pair, x, i)
        if apart[2] > pair.reach:
            continue
        p, q = 0.5 * (1.0 + eta), 0.5 * (1.0 + xi)
        g = (
            (1.0 - p) * (x[f[1], 0] - x[f[0], 0]) + p * (x[f[3], 0] - x[f[2], 0]),
            (1.0 - p) * (x[f[1], 1] - x[f[0], 1]) + p * (x[f[3], 1] - x[f[2], 1]),
            (1.0 - p) * (x[f[1], 2] - x[f[0], 2]) + p * (x[f[3], 2] - x[f[2], 2]),
        )
        h = (
            (1.0 - q) * (x[f[2], 0] - x[f[0], 0]) + q * (x[f[3], 0] - x[f[1], 0]),
            (1.0 - q) * (x[f[2], 1] - x[f[0], 1]) + q * (x[f[3], 1] - x[f[1], 1]),
            (1.0 - q) * (x[f[2], 2] - x[f[0], 2]) + q * (x[f[3], 2] - x[f[1], 2]),
        )
        normal = cross(g, h, 1.0)
        size = math.copysign(1.0 / math.sqrt(dot(normal, normal)), normal[2])
        normal = (size * normal[0], size * normal[1], size * normal[2])
        flat = 1.0 / math.sqrt(normal[0] ** 2 + normal[2] ** 2)
        along = (flat * normal[2], 0.0, -flat * normal[0])
        across = cross(normal, along, 1.0)
        before = _relative(pair, v, i)
        for k in range(3):
            pair.base[i, 0, k], pair.base[i, 1, k], pair.base[i, 2, k] = (normal[k], along[k], across[k])
            pair.before[i, k] = before[k]
            pair.impulse[i, k] = 0.0
        for k in range(3):
            total = 0.0
            for j in range(3):
                mobile = inverse_mass[pair.slave[i], j]
                for c in range(4):
                    mobile += w[c] * w[c] * inverse_mass[f[c], j]
                total += pair.base[i, k, j] ** 2 * mobile
            pair.mobility[i, k] = total
        if inverse_mass[pair.slave[i], 1] == 0.0:
            pair.mobility[i, 2] = math.inf  # in the plane of symmetry nothing slides across it
        pair.gap[i] = dot(apart, normal)
        pair.near[count] = i
        count += 1
    return count


@kernel(entry=True)
def resolve(pair: Surfaces, v: Array, inverse_mass: Array, dt: float, count: int, total: Array) -> bool:
    """Correct the new velocities for contact, and add the impulse upon the sphere to `total`."""
    for _ in range(SWEEPS):
        for k in range(count):
            i = pair.near[k]
            u, base = _relative(pair, v, i), pair.base[i]
            mobility, impulse = pair.mobility[i], pair.impulse[i]
            u_n = u[0] * base[0, 0] + u[1] * base[0, 1] + u[2] * base[0, 2]
            u_1 = u[0] * base[1, 0] + u[1] * base[1, 1] + u[2] * base[1, 2]
            u_2 = u[0] * base[2, 0] + u[1] * base[2, 1] + u[2] * base[2, 2]
            normal = max(impulse[0] - (u_n + pair.gap[i] / dt) / mobility[0], 0.0)
            p_1, p_2 = impulse[1] - u_1 / mobility[1], impulse[2] - u_2 / mobility[2]
            limit, size = pair.friction * normal, math.sqrt(p_1 * p_1 + p_2 * p_2)
            if size > limit:
                p_1, p_2 = p_1 * limit / size, p_2 * limit / size
            j_n, j_1, j_2 = normal - impulse[0], p_1 - impulse[1], p_2 - impulse[2]
            impulse[0], impulse[1], impulse[2] = normal, p_1, p_2
            s, f, w = pair.slave[i], pair.faces[pair.face[i]], pair.weight[i]
            for j in range(3):
                push = j_n * base[0, j] + j_1 * base[1, j] + j_2 * base[2, j]
                v[s, j] += push * inverse_mass[s, j]
                for c in range(4):
                    v[f[c], j] -= w[c] * push * inverse_mass[f[c], j]
    touches = False
    for k in range(count):
        i = pair.near[k]
        impulse, base = pair.impulse[i], pair.base[i]
        if impulse[0] == 0.0:
            continue
        touches = True
        u = _relative(pair, v, i)
        for j in range(3):
            mean = 0.5 * (u[j] + pair.before[i, j])
            along = impulse[1] * base[1, j] + impulse[2] * base[2, j]
            pair.work[0] -= mean * impulse[0] * base[0, j]
            pair.work[1] -= mean * along
            total[j] += impulse[0] * base[0, j] + along
    return touches


def pair_up(slave: Indices, faces: Indices, x: Array, friction: float, reach: float) -> Surfaces:
    """Put the nodes of one surface above the faces of another."""
    edges: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for m, face in enumerate(faces):
        for side, (a, b) in enumerate(((0, 2), (1, 3), (0, 1), (2, 3))):
            ends = sorted((int(face[a]), int(face[b])))
            edges.setdefault((ends[0], ends[1]), []).append((m, side))
    beside = np.full(faces.shape, -1)
    for shared in edges.values():
        if len(shared) == 2:
            (m, side), (other, its_side) = shared
            beside[m, side], beside[other, its_side] = other, m
    centres = x[faces].mean(axis=1)[:, :2]
    apart = ((x[slave, None, :2] - centres) ** 2).sum(axis=2)
    s = slave.size
    return Surfaces(
        slave,
        faces,
        beside,
        apart.argmin(axis=1),
        np.zeros((s, 4)),
        np.zeros((s, 3, 3)),
        np.zeros((s, 3)),
        np.zeros(s),
        np.zeros((s, 3)),
        np.zeros((s, 3)),
        np.zeros(s, dtype=np.int64),
        np.zeros(2),
        friction,
        reach,
    )
