"""Axisymmetric 4-node quadrilateral with one integration point, for large deformations.

The stress of a body with losses is that of a spring and of branches of spring and dashpot, see
`validation.fem.prony`; all of them turn and flow together.

Mean velocity gradient and hourglass modes as in Flanagan & Belytschko, Int. J. Numer. Methods Eng.
17 (1981) 679, whose orthogonal hourglass base makes rigid and linear fields free of hourglass
forces. The stiffness of an hourglass mode is that of the bending it stands for (Belytschko &
Bindeman, Comput. Methods Appl. Mech. Eng. 88 (1991) 311), so that a plate of few elements bends
as it should. Jaumann rate and radial return: Wilkins, Methods Comput. Phys. 3 (1964) 211; Simo &
Hughes, Computational Inelasticity (1998), section 3.3 and ch. 8.

Legend: b, c derivatives of the shape functions to r and z at the centre (those of nodes 2 and 3
are minus those of 0 and 1); d rate of deformation, w spin; s stress (rr, zz, tt, rz); q hourglass
velocities, h_r, h_z their forces; everything per radian.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from validation.fem.flow_stress import FlowStress, returned, slow_stress

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


class Body(NamedTuple):
    """Elements of one material; the first axis of each array is the element."""

    elements: Indices  # (m, 4)
    stress: Array  # (m, 4) [Pa]
    hourglass: Array  # (m, 2), forces h_r and h_z [N]
    plastic_strain: Array  # (m,), equivalent
    work: Array  # (3,), plastic, hourglass and viscous work so far [J]
    bulk: float  # Lame's lambda [Pa], of all springs together
    shear: float  # [Pa]
    bending: Array  # (m,), stiffness of the hourglass modes [Pa]
    flow: FlowStress
    branches: Array  # (m, k, 4), stresses of the branches [Pa]
    shares: Array  # (k,), their moduli over those of all springs together
    times: Array  # (k,), their relaxation times [s]
    relative: Array  # (m, 2), density and moduli of each element over those of the material


@kernel
def _relaxed(
    body: Body, e: int, fading: Array, spin: float, strain: tuple[float, float, float, float]
) -> tuple[float, float, float, float, float]:
    """Turn, strain and relax the branches of an element.

    Returns the stresses that are gone, and the work that they lose per volume. `fading` has the
    share of its stress that each branch loses in a step, and that of its energy over the branch's
    share of the moduli; `spin` is twice the rotation of the step, `strain` what it adds to the
    stress of all springs together.
    """
    rr = zz = tt = rz = lost = 0.0
    shape = 0.25 / body.shear
    size = 0.5 / (body.bulk + 2.0 / 3.0 * body.shear)
    for k in range(body.shares.size):
        s, share, gone, weight = body.branches[e, k], body.shares[k], fading[k, 0], fading[k, 1]
        s_rr = s[0] + spin * s[3] + share * strain[0]
        s_zz = s[1] - spin * s[3] + share * strain[1]
        s_tt = s[2] + share * strain[2]
        s_rz = s[3] + 0.5 * spin * (s[1] - s[0]) + share * strain[3]
        mean = (s_rr + s_zz + s_tt) / 3.0
        squares = s_rr * s_rr + s_zz * s_zz + s_tt * s_tt + 2.0 * s_rz * s_rz
        lost += weight * (shape * (squares - 3.0 * mean * mean) + size * mean * mean)
        rr, zz, tt, rz = rr + gone * s_rr, zz + gone * s_zz, tt + gone * s_tt, rz + gone * s_rz
        kept = 1.0 - gone
        s[0], s[1], s[2], s[3] = kept * s_rr, kept * s_zz, kept * s_tt, kept * s_rz
    return rr, zz, tt, rz, lost


@kernel(entry=True)
def add_forces(body: Body, x: Array, v: Array, dt: float, force: Array) -> None:
    """Advance the stress by a step of velocities v, and add what it does to the nodes."""
    plastic, hourglass, viscous = 0.0, 0.0, 0.0
    fading = np.empty((body.times.size, 2))
    for k in range(body.times.size):
        fading[k, 0] = -math.expm1(-dt / body.times[k])
        fading[k, 1] = fading[k, 0] * (2.0 - fading[k, 0]) / body.shares[k]
    for e in range(body.elements.shape[0]):
        n0, n1 = body.elements[e, 0], body.elements[e, 1]
        n2, n3 = body.elements[e, 2], body.elements[e, 3]
        r0, r1, r2, r3 = x[n0, 0], x[n1, 0], x[n2, 0], x[n3, 0]
        z0, z1, z2, z3 = x[n0, 1], x[n1, 1], x[n2, 1], x[n3, 1]
        area = 0.5 * ((r2 - r0) * (z3 - z1) + (r1 - r3) * (z2 - z0))
        r = 0.25 * (r0 + r1 + r2 + r3)
        half = 0.5 / area
        b0, b1, c0, c1 = half * (z1 - z3), half * (z2 - z0), half * (r3 - r1), half * (r0 - r2)
        u0, u1, u2, u3 = v[n0, 0], v[n1, 0], v[n2, 0], v[n3, 0]
        w0, w1, w2, w3 = v[n0, 1], v[n1, 1], v[n2, 1], v[n3, 1]
        u_r, u_z = b0 * (u0 - u2) + b1 * (u1 - u3), c0 * (u0 - u2) + c1 * (u1 - u3)
        w_r, w_z = b0 * (w0 - w2) + b1 * (w1 - w3), c0 * (w0 - w2) + c1 * (w1 - w3)
        u_t = 0.25 * (u0 + u1 + u2 + u3) / r

        # Jaumann rate
        spin = dt * (u_z - w_r)  # twice the rotation of this step
        s_rr, s_zz, s_tt, s_rz = (body.stress[e, 0], body.stress[e, 1], body.stress[e, 2], body.stress[e, 3])
        swap = spin * s_rz
        turn = 0.5 * spin * (s_zz - s_rr)
        stiff = body.relative[e, 1]
        shear = stiff * body.shear
        pressure, double = stiff * body.bulk * dt * (u_r + w_z + u_t), 2.0 * shear * dt
        strain_r, strain_z = pressure + double * u_r, pressure + double * w_z
        strain_t, slip = pressure + double * u_t, 0.5 * double * (u_z + w_r)
        s_rr += swap + strain_r
        s_zz += -swap + strain_z
        s_tt += strain_t
        s_rz += turn + slip
        if body.shares.size:
            f_rr, f_zz, f_tt, f_rz, lost = _relaxed(body, e, fading, spin, (strain_r, strain_z, strain_t, slip))
            s_rr, s_zz, s_tt, s_rz = s_rr - f_rr, s_zz - f_zz, s_tt - f_tt, s_rz - f_rz
            viscous += lost / stiff * area * r

        # radial return
        mean = (s_rr + s_zz + s_tt) / 3.0
        d_r, d_z, d_t = s_rr - mean, s_zz - mean, s_tt - mean
        mises = 1.5 * (d_r * d_r + d_z * d_z + d_t * d_t) + 3.0 * s_rz * s_rz
        strength = slow_stress(body.flow, body.plastic_strain[e])
        if mises > strength * strength:
            mises = math.sqrt(mises)
            strain, strength = returned(body.flow, mises, body.plastic_strain[e], shear, dt)
            keep = strength / mises
            for k in range(body.shares.size):
                back = body.shares[k] * (1.0 - keep)
                body.branches[e, k, 0] -= back * d_r
                body.branches[e, k, 1] -= back * d_z
                body.branches[e, k, 2] -= back * d_t
                body.branches[e, k, 3] -= back * s_rz
            s_rr, s_zz, s_tt, s_rz = (mean + keep * d_r, mean + keep * d_z, mean + keep * d_t, keep * s_rz)
            body.plastic_strain[e] += strain
            plastic += strength * strain * area * r
        body.stress[e, 0], body.stress[e, 1] = s_rr, s_zz
        body.stress[e, 2], body.stress[e, 3] = s_tt, s_rz

        # hourglass
        h_r, h_z = 0.25 * (r0 - r1 + r2 - r3), 0.25 * (z0 - z1 + z2 - z3)
        q_r = 0.25 * (u0 - u1 + u2 - u3) - h_r * u_r - h_z * u_z
        q_z = 0.25 * (w0 - w1 + w2 - w3) - h_r * w_r - h_z * w_z
        stiffness = 8.0 / 3.0 * body.bending[e] * area * r * dt
        g_r, g_z = body.hourglass[e, 0], body.hourglass[e, 1]
        new_r = g_r + stiffness * (b0 * b0 + b1 * b1) * q_r
        new_z = g_z + stiffness * (c0 * c0 + c1 * c1) * q_z
        body.hourglass[e, 0], body.hourglass[e, 1] = new_r, new_z
        hourglass += 0.5 * dt * ((g_r + new_r) * q_r + (g_z + new_z) * q_z)

        # forces: mean gradient, hoop, hourglass modes
        volume = area * r
        hoop = 0.25 * area * s_tt
        f_0 = volume * (b0 * s_rr + c0 * s_rz) - (h_r * b0 + h_z * c0) * new_r
        f_1 = volume * (b1 * s_rr + c1 * s_rz) - (h_r * b1 + h_z * c1) * new_r
        g_0 = volume * (b0 * s_rz + c0 * s_zz) - (h_r * b0 + h_z * c0) * new_z
        g_1 = volume * (b1 * s_rz + c1 * s_zz) - (h_r * b1 + h_z * c1) * new_z
        mode = 0.25 * new_r
        force[n0, 0] -= f_0 + hoop + mode
        force[n1, 0] -= f_1 + hoop - mode
        force[n2, 0] -= hoop - f_0 + mode
        force[n3, 0] -= hoop - f_1 - mode
        mode = 0.25 * new_z
        force[n0, 1] -= g_0 + mode
        force[n1, 1] -= g_1 - mode
        force[n2, 1] -= mode - g_0
        force[n3, 1] -= -mode - g_1
    body.work[0] += plastic
    body.work[1] += hourglass
    body.work[2] += viscous


def lumped_mass(elements: Indices, x: Array, density: float | Array) -> Array:
    """Mass of each node, per radian: a quarter of each of its elements.

    The volume of an element is its area times the mean radius of its nodes, since the forces of
    one integration point are the derivatives of just that volume.
    """
    mass = np.zeros(len(x))
    np.add.at(mass, elements, (0.25 * density * volumes(elements, x))[:, None])
    return mass


def volumes(elements: Indices, x: Array) -> Array:
    """Volume of each element, per radian."""
    r, z = np.moveaxis(x[elements], -1, 0)
    diagonals = (r[:, 2] - r[:, 0]) * (z[:, 3] - z[:, 1])
    diagonals += (r[:, 1] - r[:, 3]) * (z[:, 2] - z[:, 0])
    volume: Array = 0.5 * diagonals * r.mean(axis=1)
    return volume


def stable_step(body: Body, x: Array, density: float) -> float:
    """Time of the pressure wave across the smallest element [s] (Flanagan & Belytschko)."""
    r, z = np.moveaxis(x[body.elements], -1, 0)
    area = volumes(body.elements, x) / r.mean(axis=1)
    diagonals = sum((y[:, k] - y[:, k + 2]) ** 2 for y in (r, z) for k in (0, 1))
    dense, stiff = body.relative.T
    wave = np.sqrt((body.bulk + 2.0 * body.shear) * stiff / (density * dense))
    return float(np.min(area / np.sqrt(0.5 * diagonals) / wave))


def strain_energy(body: Body, x: Array) -> float:
    """Elastic energy that the stresses hold [J per radian].

    Its volumetric part is that of the law in use, p = -K ln J, at any compression J: a tenth of the
    volume is squeezed out under a contact at 7 V_Y0.
    """
    stiff = body.relative[:, 1]
    bulk, shear = stiff * (body.bulk + 2.0 / 3.0 * body.shear), stiff * body.shear
    springs = np.moveaxis(body.branches, 1, 0), body.stress - body.branches.sum(axis=1)
    shares = np.append(body.shares, 1.0 - body.shares.sum())
    density = np.zeros(len(body.stress))
    for s, share in zip([*springs[0], springs[1]], shares.tolist(), strict=True):
        if share > 0.0:
            pressure = -s[:, :3].mean(axis=1)
            squares = (s[:, :3] ** 2).sum(axis=1) + 2.0 * s[:, 3] ** 2 - 3.0 * pressure**2
            p = pressure / (share * bulk)
            density += squares / (4.0 * share * shear) + share * bulk * (np.expm1(p) - p)
    return float(density @ volumes(body.elements, x))
