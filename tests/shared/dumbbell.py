"""A rigid dumbbell of two spheres that hits a plate, in small steps that share no code with us.

Hertz's force, a thin plate as a dashpot, and Coulomb's friction by the method of dimensionality
reduction (Popov, Contact Mechanics and Friction, chapter 19): springs beside each other, of which
those within the share s of the contact radius bear (3 s - s^3)/2 of the load.
"""

from typing import NamedTuple

import numpy as np

UP = np.array([0.0, 0.0, 1.0])


class Dumbbell(NamedTuple):
    """Two touching spheres: masses [kg], moments about the axis and across it [kg m2]."""

    radius: float
    mass: float
    along: float
    across: float

    @classmethod
    def of(cls, density, radius):
        m = 4.0 / 3.0 * np.pi * radius**3 * density
        return cls(radius, 2.0 * m, 0.8 * m * radius**2, 2.8 * m * radius**2)

    def spin(self, axis, momentum):
        along = momentum @ axis
        return momentum / self.across + (1.0 / self.along - 1.0 / self.across) * along * axis

    def response(self, axis):
        """1/mass that answers at the lower sphere to a force along `UP` [1/kg]."""
        arm = np.cross(self.radius * axis, UP)
        return 1.0 / self.mass + arm @ arm / self.across  # the arm is across the axis


def impact(body, pair, thickness, axis, velocity, friction, dt=1e-8, springs=60):
    """Velocity of the contact point [m/s], and contact time [s]; `axis` points to the lower sphere."""
    one, two = pair.sphere, pair.plate
    modulus = pair.effective_modulus
    shear = [b.youngs_modulus / (2.0 * (1.0 + b.poissons_ratio)) for b in (one, two)]
    kappa = 4.0 / sum((2.0 - b.poissons_ratio) / g for b, g in zip((one, two), shear, strict=True)) / modulus
    stiffness, r = 4.0 / 3.0 * modulus * body.radius**0.5, body.radius
    rigidity = two.youngs_modulus * thickness**3 / (12.0 * (1.0 - two.poissons_ratio**2))
    mobility = 1.0 / (8.0 * np.sqrt(rigidity * two.density * thickness))
    depth = (1.25 * body.mass * velocity[2] ** 2 / stiffness) ** 0.4
    width = 1.5 * stiffness * depth**0.5 / springs
    place, stretch, before = np.arange(springs) * width, np.zeros((springs, 2)), 0.0
    height, plate, force = r, 0.0, 0.0
    velocity, momentum, push, torque = np.array(velocity, float), np.zeros(3), np.zeros(3), np.zeros(3)
    for step in range(1, 100_000):
        velocity, momentum = velocity + 0.5 * dt * push / body.mass, momentum + 0.5 * dt * torque
        middle = axis + 0.5 * dt * np.cross(body.spin(axis, momentum), axis)
        spin = body.spin(middle / np.linalg.norm(middle), momentum)
        height += dt * (velocity + np.cross(spin, r * middle))[2]
        axis = axis + dt * np.cross(spin, middle)
        axis /= np.linalg.norm(axis)
        known, last = plate + 0.5 * dt * mobility * force, force
        for _ in range(5):
            deep = r - height - known - 0.5 * dt * mobility * force
            force = stiffness * max(deep, 0.0) ** 1.5
        if force == 0.0 and last > 0.0:
            return velocity + np.cross(body.spin(axis, momentum), r * axis - r * UP), step * dt
        plate, push, arm = known + 0.5 * dt * mobility * force, force * UP, r * axis - r * UP
        if friction and force > 0.0:
            slip, k = (velocity + np.cross(spin, arm))[:2], 1.5 * stiffness * deep**0.5
            part, was = np.clip(k - place, 0.0, width), np.clip(before - place, 0.0, width)
            before, pressed = k, part > 0.0
            share = lambda s: 1.5 * s - 0.5 * s**3  # noqa: E731
            most = friction * force * (share(np.minimum((place + part) / k, 1)) - share(np.minimum(place / k, 1)))
            # what a spring grows by has no stretch yet
            stretch *= (np.minimum(was, part) / np.where(pressed, part, 1.0))[:, None]
            stretch[pressed] += dt * slip
            pull = np.hypot(*stretch.T) * kappa * part
            stretch *= np.where(pull > most, most / np.where(pull > 0.0, pull, 1.0), 1.0)[:, None]
            push[:2] -= kappa * part @ stretch
        torque = np.cross(arm, push)
        velocity, momentum = velocity + 0.5 * dt * push / body.mass, momentum + 0.5 * dt * torque
    raise AssertionError("the dumbbell stays")
