"""Loops as users write them, whose machine code is kept beside that of what they call."""

import numba
import numpy as np

from contactlaw import _jit
from contactlaw.stepping import Bead, Clock, interact
from contactlaw.walls import move


def loop(function):
    """Compile a loop that calls contactlaw alone: the folder's name is a hash of its sources."""
    made = numba.njit(function)
    _jit.keep(made)
    return made


@loop
def press(scene, time, dt, x, v, omega, radius, mass, force, torque, contacts, friction):
    """Add the force and the torque of the walls on a bead, of which vectors are arrays."""
    place, velocity, spin = (x[0], x[1], x[2]), (v[0], v[1], v[2]), (omega[0], omega[1], omega[2])
    bead = Bead(0, 0, place, velocity, spin, radius, mass, force, torque, contacts, friction)
    interact(scene, Clock(time, dt, dt, True), bead)


@loop
def fly(scene, contacts, friction, x, v, omega, mass, radius, gravity, dt, steps, kick, when):
    """Move a bead by velocity Verlet; `kick` is added to its velocity at step `when`.

    Gives kinetic energy, place, and the force of the walls in z after each step.
    """
    force, torque, path = np.zeros(3), np.zeros(3), np.zeros((steps, 5))
    for step in range(steps):
        move(scene.frames, step * dt, dt)
        v += 0.5 * dt / mass * force
        omega += 0.5 * dt / (0.4 * mass * radius**2) * torque
        x += dt * v
        force[:] = torque[:] = 0.0
        press(scene, step * dt, dt, x, v, omega, radius, mass, force, torque, contacts, friction)
        path[step, 1:4], path[step, 4] = x, force[2]
        force += mass * gravity
        v += 0.5 * dt / mass * force
        omega += 0.5 * dt / (0.4 * mass * radius**2) * torque
        path[step, 0] = 0.5 * mass * (v @ v) + 0.2 * mass * radius**2 * (omega @ omega)
        if step == when:
            v += kick
    return path
