"""8-node hexahedron with one integration point, for large rotations and moderate strains.

The stress at the centre stands for the element (Flanagan & Belytschko, Int. J. Numer. Methods Eng.
17 (1981) 679). Twelve hourglass strains are what the centre does not see: six of bending, three of
torsion and three of the mode xi eta zeta. They are scalars in the covariant base of the element, so
that rotations leave them alone, and have the stiffness of the strains that they stand for, without
the parasitic shear of bending (Belytschko & Bindeman, Comput. Methods Appl. Mech. Eng. 105 (1993)
225). Jaumann rate and radial return as in `validation.fem.elements`.

Legend: g1, g2, g3 covariant base (derivatives of the position to xi, eta, zeta), c1, c2, c3 the
contravariant one; names that end in _a, _b, _c, _d belong to the modes xi eta, eta zeta, zeta xi,
xi eta zeta.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Vector = tuple[float, float, float]
Modes = tuple[Vector, Vector, Vector, Vector, Vector, Vector, Vector]

HOURGLASSES = 12


class Body(NamedTuple):
    """Elements of one material; the first axis of each array is the element."""

    elements: Indices  # (m, 8), see `validation.fem3d.mesh.Mesh`
    stress: Array  # (m, 6), xx, yy, zz, xy, yz, zx [Pa]
    hourglass: Array  # (m, 12), what the hourglass strains push with [J/m2]
    plastic_strain: Array  # (m,), equivalent
    stiffness: Array  # (m,), of the hourglass strains over that of elastic ones
    work: Array  # (2,), plastic and hourglass work so far [J]
    bulk: float  # Lame's lambda [Pa]
    shear: float  # [Pa]
    strength: float  # yield strength [Pa]; inf: elastic


@kernel(inline=True)
def dot(a: Vector, b: Vector) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel(inline=True)
def cross(a: Vector, b: Vector, factor: float) -> Vector:
    """Vector product times a factor."""
    return (
        factor * (a[1] * b[2] - a[2] * b[1]),
        factor * (a[2] * b[0] - a[0] * b[2]),
        factor * (a[0] * b[1] - a[1] * b[0]),
    )


@kernel(inline=True)
def _component(x: Array, n: Indices, j: int) -> tuple[float, ...]:
    """Modes of one component: the linear ones, then the hourglass ones."""
    x0, x1, x2, x3 = x[n[0], j], x[n[1], j], x[n[2], j], x[n[3], j]
    x4, x5, x6, x7 = x[n[4], j], x[n[5], j], x[n[6], j], x[n[7], j]
    s0, s1, s2, s3 = x1 + x0, x3 + x2, x5 + x4, x7 + x6
    d0, d1, d2, d3 = x1 - x0, x3 - x2, x5 - x4, x7 - x6
    return (
        0.125 * (d0 + d1 + d2 + d3),
        0.125 * (s1 - s0 + s3 - s2),
        0.125 * (s2 + s3 - s0 - s1),
        0.125 * (d1 - d0 + d3 - d2),
        0.125 * (s3 - s2 - s1 + s0),
        0.125 * (d2 + d3 - d0 - d1),
        0.125 * (d3 - d2 - d1 + d0),
    )


@kernel(inline=True)
def _modes(x: Array, n: Indices) -> Modes:
    p, q, r = _component(x, n, 0), _component(x, n, 1), _component(x, n, 2)
    return (
        (p[0], q[0], r[0]),
        (p[1], q[1], r[1]),
        (p[2], q[2], r[2]),
        (p[3], q[3], r[3]),
        (p[4], q[4], r[4]),
        (p[5], q[5], r[5]),
        (p[6], q[6], r[6]),
    )


@kernel(inline=True)
def _spread(force: Array, n: Indices, j: int, p: tuple[float, ...]) -> None:
    """Take one component of the forces of the modes off the nodes."""
    a, b, c, d = 0.125 * p[1], 0.125 * p[2], 0.125 * p[4], 0.125 * p[0]
    e, f, g = 0.125 * p[3], 0.125 * p[5], 0.125 * p[6]
    s0, s1, s2, s3 = -a - b + c, a - b - c, -a + b - c, a + b + c
    d0, d1, d2, d3 = d - e - f + g, d + e - f - g, d - e + f - g, d + e + f + g
    force[n[0], j] -= s0 - d0
    force[n[1], j] -= s0 + d0
    force[n[2], j] -= s1 - d1
    force[n[3], j] -= s1 + d1
    force[n[4], j] -= s2 - d2
    force[n[5], j] -= s2 + d2
    force[n[6], j] -= s3 - d3
    force[n[7], j] -= s3 + d3


@kernel(inline=True)
def _beyond(v: Vector, v1: Vector, v2: Vector, v3: Vector, k: Vector) -> Vector:
    """Part of an hourglass velocity that the mean velocity gradient does not explain."""
    return (
        v[0] - v1[0] * k[0] - v2[0] * k[1] - v3[0] * k[2],
        v[1] - v1[1] * k[0] - v2[1] * k[1] - v3[1] * k[2],
        v[2] - v1[2] * k[0] - v2[2] * k[1] - v3[2] * k[2],
    )


@kernel(entry=True)
def add_forces(body: Body, x: Array, v: Array, dt: float, force: Array) -> None:
    """Advance the stress by a step of velocities v, and add what it does to the nodes."""
    plastic, work = 0.0, 0.0
    shear, bending = body.shear, body.shear * (2.0 * body.shear + 2.0 * body.bulk)
    bending *= 2.0 / (2.0 * body.shear + body.bulk)  # E/(1 - nu^2)
    for e in range(body.elements.shape[0]):
        n = body.elements[e]
        g1, g2, g3, x_a, x_b, x_c, x_d = _modes(x, n)
        v1, v2, v3, v_a, v_b, v_c, v_d = _modes(v, n)
        c1 = cross(g2, g3, 1.0)
        det = dot(g1, c1)
        inverse, volume = 1.0 / det, 8.0 * det
        c1 = (c1[0] * inverse, c1[1] * inverse, c1[2] * inverse)
        c2, c3 = cross(g3, g1, inverse), cross(g1, g2, inverse)

        # velocity gradient
        l_xx = v1[0] * c1[0] + v2[0] * c2[0] + v3[0] * c3[0]
        l_xy = v1[0] * c1[1] + v2[0] * c2[1] + v3[0] * c3[1]
        l_xz = v1[0] * c1[2] + v2[0] * c2[2] + v3[0] * c3[2]
        l_yx = v1[1] * c1[0] + v2[1] * c2[0] + v3[1] * c3[0]
        l_yy = v1[1] * c1[1] + v2[1] * c2[1] + v3[1] * c3[1]
        l_yz = v1[1] * c1[2] + v2[1] * c2[2] + v3[1] * c3[2]
        l_zx = v1[2] * c1[0] + v2[2] * c2[0] + v3[2] * c3[0]
        l_zy = v1[2] * c1[1] + v2[2] * c2[1] + v3[2] * c3[1]
        l_zz = v1[2] * c1[2] + v2[2] * c2[2] + v3[2] * c3[2]

        # Jaumann rate
        a, b, c = 0.5 * dt * (l_xy - l_yx), 0.5 * dt * (l_xz - l_zx), 0.5 * dt * (l_yz - l_zy)
        s = body.stress[e]
        xx, yy, zz, xy, yz, zx = s[0], s[1], s[2], s[3], s[4], s[5]
        pressure, double = body.bulk * dt * (l_xx + l_yy + l_zz), 2.0 * shear * dt
        s_xx = xx + 2.0 * (a * xy + b * zx) + pressure + double * l_xx
        s_yy = yy + 2.0 * (c * yz - a * xy) + pressure + double * l_yy
        s_zz = zz - 2.0 * (b * zx + c * yz) + pressure + double * l_zz
        s_xy = xy + a * (yy - xx) + b * yz + c * zx + 0.5 * double * (l_xy + l_yx)
        s_yz = yz + c * (zz - yy) - a * zx - b * xy + 0.5 * double * (l_yz + l_zy)
        s_zx = zx + b * (zz - xx) + a * yz - c * xy + 0.5 * double * (l_zx + l_xz)

        # radial return
        mean = (s_xx + s_yy + s_zz) / 3.0
        d_x, d_y, d_z = s_xx - mean, s_yy - mean, s_zz - mean
        mises = 1.5 * (d_x * d_x + d_y * d_y + d_z * d_z)
        mises += 3.0 * (s_xy * s_xy + s_yz * s_yz + s_zx * s_zx)
        if mises > body.strength * body.strength:
            mises = math.sqrt(mises)
            keep = body.strength / mises
            s_xx, s_yy, s_zz = mean + keep * d_x, mean + keep * d_y, mean + keep * d_z
            s_xy, s_yz, s_zx = keep * s_xy, keep * s_yz, keep * s_zx
            strain = (mises - body.strength) / (3.0 * shear)
            body.plastic_strain[e] += strain
            plastic += body.strength * strain * volume
        s[0], s[1], s[2], s[3], s[4], s[5] = s_xx, s_yy, s_zz, s_xy, s_yz, s_zx

        # hourglass strains, and their forces on the modes
        k_a = (dot(c1, x_a), dot(c2, x_a), dot(c3, x_a))
        k_b = (dot(c1, x_b), dot(c2, x_b), dot(c3, x_b))
        k_c = (dot(c1, x_c), dot(c2, x_c), dot(c3, x_c))
        k_d = (dot(c1, x_d), dot(c2, x_d), dot(c3, x_d))
        q_a, q_b = _beyond(v_a, v1, v2, v3, k_a), _beyond(v_b, v1, v2, v3, k_b)
        q_c, q_d = _beyond(v_c, v1, v2, v3, k_c), _beyond(v_d, v1, v2, v3, k_d)
        i1, i2, i3 = 1.0 / dot(g1, g1), 1.0 / dot(g2, g2), 1.0 / dot(g3, g3)
        third = body.stiffness[e] * volume * dt / 3.0
        m, k = shear * third, bending * third
        k_1, k_2, k_3 = k * i1 * i1, k * i2 * i2, k * i3 * i3
        stiffness = (
            k_1,
            k_1,
            k_2,
            k_2,
            k_3,
            k_3,
            k_1 / 3.0,
            k_2 / 3.0,
            k_3 / 3.0,
            m * i1 * i2,
            m * i2 * i3,
            m * i3 * i1,
        )
        t_1, t_2, t_3 = dot(g1, q_b), dot(g2, q_c), dot(g3, q_a)
        rate = (
            dot(g1, q_a),
            dot(g1, q_c),
            dot(g2, q_a),
            dot(g2, q_b),
            dot(g3, q_b),
            dot(g3, q_c),
            dot(g1, q_d),
            dot(g2, q_d),
            dot(g3, q_d),
            t_1 + t_2,
            t_2 + t_3,
            t_3 + t_1,
        )
        h = body.hourglass[e]
        for i in range(HOURGLASSES):
            added = stiffness[i] * rate[i]
            work += dt * rate[i] * (h[i] + 0.5 * added)
            h[i] += added
        u1, u2, u3 = h[9] + h[11], h[9] + h[10], h[10] + h[11]
        for j in range(3):
            f_a = h[0] * g1[j] + h[2] * g2[j] + u3 * g3[j]
            f_b = u1 * g1[j] + h[3] * g2[j] + h[4] * g3[j]
            f_c = h[1] * g1[j] + u2 * g2[j] + h[5] * g3[j]
            f_d = h[6] * g1[j] + h[7] * g2[j] + h[8] * g3[j]
            s_x, s_y, s_z = s_xx, s_xy, s_zx
            if j == 1:
                s_x, s_y, s_z = s_xy, s_yy, s_yz
            elif j == 2:
                s_x, s_y, s_z = s_zx, s_yz, s_zz
            row = (s_x * volume, s_y * volume, s_z * volume)
            f_1 = dot(row, c1) - f_a * k_a[0] - f_b * k_b[0] - f_c * k_c[0] - f_d * k_d[0]
            f_2 = dot(row, c2) - f_a * k_a[1] - f_b * k_b[1] - f_c * k_c[1] - f_d * k_d[1]
            f_3 = dot(row, c3) - f_a * k_a[2] - f_b * k_b[2] - f_c * k_c[2] - f_d * k_d[2]
            _spread(force, n, j, (f_1, f_2, f_3, f_a, f_b, f_c, f_d))
    body.work[0] += plastic
    body.work[1] += work


def _base(elements: Indices, x: Array) -> Array:
    """Covariant bases at the centres, (m, 3, 3): row k is the derivative to coordinate k."""
    sign = np.array([[2.0 * (k >> axis & 1) - 1.0 for k in range(8)] for axis in range(3)])
    found: Array = np.einsum("ak,mkj->maj", sign, x[elements]) / 8.0
    return found


def volumes(elements: Indices, x: Array) -> Array:
    """Volumes of elements, as their one integration point sees them."""
    found: Array = 8.0 * np.linalg.det(_base(elements, x))
    return found


def lumped_mass(elements: Indices, x: Array, density: float) -> Array:
    """Mass of each node: an eighth of each of its elements."""
    mass = np.zeros(len(x))
    np.add.at(mass, elements, (density / 8.0 * volumes(elements, x))[:, None])
    return mass


def stable_step(body: Body, x: Array, density: float) -> float:
    """Shortest period of any element by itself, over pi [s]: central differences are stable below.

    An eigenvalue of B^T C B is at most lambda tr S + 2 mu times the largest eigenvalue of S, the
    sum of the squares of the derivatives of the shape functions, here half the metric.
    """
    base = np.linalg.inv(_base(body.elements, x))
    squares = 0.125 * np.einsum("mjk,mik->mji", base, base)
    largest = np.linalg.eigvalsh(squares)
    square = body.bulk * largest.sum(axis=1) + 2.0 * body.shear * largest[:, -1]
    return float(2.0 / np.sqrt(8.0 * square.max() / density))


def strain_energy(body: Body, x: Array) -> float:
    """Elastic energy that the stresses hold [J]; p = -K ln J at a compression J."""
    s = body.stress
    bulk = body.bulk + 2.0 / 3.0 * body.shear
    pressure = -s[:, :3].mean(axis=1)
    squares = (s[:, :3] ** 2).sum(axis=1) + 2.0 * (s[:, 3:] ** 2).sum(axis=1) - 3.0 * pressure**2
    p = pressure / bulk
    density = squares / (4.0 * body.shear) + bulk * (np.expm1(p) - p)
    return float(density @ volumes(body.elements, x))
