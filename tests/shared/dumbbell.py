"""A rigid dumbbell of two touching spheres that hits a plate, in small steps that share no code with us.

Hertz's force, a thin plate as a dashpot, and Coulomb's friction by the method of dimensionality
reduction (Popov, Contact Mechanics and Friction, chapter 19): springs beside each other, of which
those within the share s of the contact radius bear (3 s - s^3)/2 of the load.
"""

import numpy as np
from lammps_box import MASS, PAIR, R

UP = np.array([0.0, 0.0, 1.0])
ALONG, ACROSS = 0.8 * MASS * R**2, 2.8 * MASS * R**2  # moments about the axis and across it [kg m2]
STIFFNESS = 4.0 / 3.0 * PAIR.effective_modulus * R**0.5
KAPPA = 4.0 * PAIR.effective_shear_modulus / PAIR.effective_modulus
LEAST = 1e-30  # of a divisor


def hertz(depth):
    return STIFFNESS * max(depth, 0.0) ** 1.5


def response(axis):
    """1/mass that answers at the lower sphere, to which the axis points, to a force along `UP` [1/kg]."""
    arm = np.cross(R * axis, UP)
    return 0.5 / MASS + arm @ arm / ACROSS  # the arm is across the axis


def impact(thickness, axis, velocity, friction, dt=1e-8, springs=60):
    """Velocity of the contact point [m/s], and contact time [s]; `axis` points to the lower sphere."""
    plate, force, x = 0.0, 0.0, 0.0
    mobility = 0.125 / thickness**2 / np.sqrt(PAIR.plate.plane_modulus / 12.0 * PAIR.plate.density)
    widest = 1.5 * STIFFNESS * (2.5 * MASS * velocity[2] ** 2 / STIFFNESS) ** 0.2
    edges, stretch, before = np.linspace(0.0, widest, springs + 1), np.zeros((springs, 2)), np.zeros(springs)
    velocity, momentum, push = np.array(velocity, float), np.zeros(3), np.zeros(3)
    for step in range(100_000):  # velocities are of the middle of a step
        arm = R * (axis - UP)
        velocity, momentum = velocity + 0.5 * dt * push / MASS, momentum + dt * np.cross(arm, push)
        along = momentum @ axis * axis
        spin = along / ALONG + (momentum - along) / ACROSS
        slip = velocity + np.cross(spin, arm)
        x -= dt * slip[2]
        axis = axis + dt * np.cross(spin, axis)
        axis /= np.linalg.norm(axis)
        plate += 0.5 * dt * mobility * (force + hertz(x - plate - dt * mobility * force))
        last, force = force, hertz(x - plate)
        if force == 0.0 and last > 0.0:
            return slip, step * dt
        push = force * UP
        if friction and force > 0.0:
            stiffness = 1.5 * STIFFNESS * (x - plate) ** 0.5
            share = np.minimum(edges / stiffness, 1.0)
            part, most = stiffness * np.diff(share), friction * force * np.diff(1.5 * share - 0.5 * share**3)
            # what a spring grows by has no stretch yet
            stretch *= (np.minimum(before, part) / np.maximum(part, LEAST))[:, None]
            stretch += dt * slip[:2]
            pull = np.hypot(*stretch.T) * KAPPA * part
            stretch *= np.minimum(most / np.maximum(pull, LEAST), 1.0)[:, None]
            push[:2] -= KAPPA * part @ stretch
            before = part
    raise AssertionError("the dumbbell stays")
