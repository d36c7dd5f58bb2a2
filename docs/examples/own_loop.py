"""Beads that fall into a tray, a mesh from a file, in a DEM loop in numba without an engine."""

from pathlib import Path

import numba
import numpy as np

import contactlaw as cl
from contactlaw.engines.record import IMPACT
from contactlaw.softsphere import time_step
from contactlaw.stepping import Bead, Clock, WallContacts, interact
from contactlaw.walls import Mesh

PAIR = cl.Pair("soda-lime-glass", "carbon-steel-1020")
TRAY, THICKNESS = Path(__file__).with_name("tray.stl"), 1e-3  # [m]; the drawing is in millimetres
RADIUS, SPEED, FRICTION, GRAVITY = 1e-3, 3.0, 0.2, 9.81  # [m], [m/s], [-], [m/s2]
BEADS, DURATION = 25, 0.02  # [-], [s]


@numba.njit
def run(scene, contacts, friction, x, v, mass, radius, dt, steps):
    """Integrate the beads by velocity Verlet, without contacts of beads with each other."""
    force, torque, omega = np.zeros(x.shape), np.zeros(x.shape), np.zeros(x.shape)
    force[:, 2] = -mass * GRAVITY
    for step in range(1, steps + 1):
        clock = Clock(step * dt, dt, dt, True)
        for i in range(len(x)):
            v[i] += 0.5 * dt * force[i] / mass
            omega[i] += 0.5 * dt * torque[i] / (0.4 * mass * radius**2)
            x[i] += dt * v[i]
            force[i], torque[i] = 0.0, 0.0
            force[i, 2] = -mass * GRAVITY
            place, speed = (x[i, 0], x[i, 1], x[i, 2]), (v[i, 0], v[i, 1], v[i, 2])
            spin = (omega[i, 0], omega[i, 1], omega[i, 2])
            bead = Bead(i, 0, place, speed, spin, radius, mass, force[i], torque[i], contacts[i], friction[i])
            interact(scene, clock, bead)
            v[i] += 0.5 * dt * force[i] / mass
            omega[i] += 0.5 * dt * torque[i] / (0.4 * mass * radius**2)


def main():
    """Throw the beads into the tray; print the range of the COR on its floor and its sides."""
    model = cl.ImpactModel(PAIR)
    tray = Mesh.read(TRAY, THICKNESS, scale=1e-3)
    walls = WallContacts([tray], model, RADIUS, np.zeros(1000, IMPACT), friction=FRICTION)
    side = np.linspace(-0.028, 0.028, round(BEADS**0.5))
    x = np.array([(a, b, 0.012) for a in side for b in side])
    v = np.full(x.shape, (0.1, 0.2, -SPEED))
    dt = time_step(model, 2 * SPEED, RADIUS, THICKNESS)
    mass = 4 / 3 * np.pi * RADIUS**3 * PAIR.sphere.density
    run(walls.scene, *walls.memory(BEADS), x, v, mass, RADIUS, dt, round(DURATION / dt))
    hits = walls.collisions()
    for name, own in (("floor", hits["triangle"] < 2), ("sides", hits["triangle"] >= 2)):
        cor = hits["restitution"][own]
        print(f"{name}: {len(cor)} impacts, COR {cor.min():.3f} to {cor.max():.3f}")
    return hits


if __name__ == "__main__":
    main()
