"""What C has to give to the last bit: the kernels of `export.functions`, run as Python.

``python uncompiled.py IN OUT`` reads pickled bodies and impacts, a row each of speed, radius,
thickness, kind and distance of an edge, friction and time step, and writes a row of `answers` for
each impact. Numba has to be switched off.
"""

import pickle
import sys

import numpy as np

from contactlaw.export import functions
from contactlaw.stepping.spring import State

STEPS = 45
MASS, HEAVY = 5e4, 0.3  # kg/m3 of beads that are no solid spheres, those with more friction
NORMAL, LEANING, STILL = (0.0, 0.6, 0.8), (0.1, 0.0, 1.0), (0.0, 0.0, 0.0)


def answers(pair, v, r, h, edge, distance, mu, dt):
    """All fields of a rebound, flags, COR near an edge, steps with friction, a collision."""
    mass, edge = MASS * r * r * r, int(edge)
    hit = functions.rebound(pair, v, r, h)
    if mu > HEAVY:
        hit = functions.rebound_with_mass(pair, v, r, h, mass)
    found = [*hit[:-1], functions.flags_for(pair, hit, v, r, h)]
    found.append(functions.restitution(pair, v, r, h))
    found.append(functions.restitution_near(pair, v, r, h, edge, distance))
    bead = functions.at_edge(pair, functions.spring_of(pair, r, h), edge, distance)
    bead = bead._replace(mass=mass if mu > HEAVY else bead.mass)
    state, x, u = State(0.0, 0.0, 0.0), 0.0, v
    row = np.zeros(1, functions.SLIDING).view(np.recarray)[0]
    for _ in range(STEPS):
        u -= 0.5 * dt * state.force / bead.mass
        x += dt * u
        after = functions.after_step(pair, bead, state, x, dt)
        state = after if after.force >= 0.0 else state
        u -= 0.5 * dt * state.force / bead.mass
        surface = 0.3 * v, -0.7 * v, 0.1 * v
        functions.rub(pair, bead, state, row, x, dt, NORMAL, surface, mu)
        found += [after.force, state.largest_compression, *row.force]
    given = (0.4 * v, 0.1 * v, -v), (3.0, 5.0, 7.0), LEANING, STILL
    after = functions.collided(pair, *given, r, h, mu)
    return [*found, *after.velocity, *after.spin, after.status]


if __name__ == "__main__":
    np.seterr(all="ignore")
    with open(sys.argv[1], "rb") as file:
        pair, impacts = pickle.load(file)
    for kernel, plain in functions.INSTEAD.items():  # as C has it
        setattr(sys.modules[kernel.__module__], kernel.__name__, plain)
    # numpy's numbers give inf for a division by zero, as C and compiled kernels do
    made = [answers(functions.Bodies(*pair), *one) for one in np.array(impacts)]
    np.save(sys.argv[2], np.array(made, dtype=float))
