"""Beads run down a funnel of sheet metal, whose walls differ in thickness and have friction."""

import math

import numpy as np
import pymunk

import contactlaw as cl
from contactlaw.engines.pymunk import attach

RADIUS = 1.5e-3  # [m]
WALLS = (1e-3, 4e-3)  # thickness of the left and the right wall [m]
FRICTION = 0.2  # Coulomb's coefficient, as of dry steel
STEP = 1e-5  # [s]


def main(beads=20, duration=0.4):
    """Let steel beads fall into a funnel; print the COR on each wall, and how beads spin."""
    space = pymunk.Space()
    space.gravity = (0.0, -9.81)
    model = cl.ImpactModel(cl.Pair("bearing-steel-52100-ball", "stainless-steel-304"))
    impacts = attach(space, model)

    walls = []
    for side, thickness in zip((-1.0, 1.0), WALLS, strict=True):
        wall = pymunk.Segment(space.static_body, (side * 0.08, 0.1), (side * 0.006, 0.0), 0.0)
        space.add(wall)
        impacts.add_plate(wall, thickness=thickness, friction=FRICTION)
        walls.append(wall)

    mass = 4.0 / 3.0 * math.pi * RADIUS**3 * model.pair.sphere.density
    random = np.random.default_rng(3)
    for n in range(beads):
        body = pymunk.Body(mass, moment=2.0 / 5.0 * mass * RADIUS**2)  # of a solid sphere
        body.position = float(random.uniform(-0.05, 0.05)), 0.12 + 4.0 * RADIUS * n
        bead = pymunk.Circle(body, RADIUS)
        space.add(body, bead)
        impacts.add_bead(bead)

    for _ in range(round(duration / STEP)):
        space.step(STEP)

    found = impacts.collisions()
    for n, thickness in enumerate(WALLS):
        hits = found[found["plate"] == n]
        cor, speed = hits["restitution"], hits["approach_speed"].mean()
        print(
            f"{1e3 * thickness:.0f} mm: {hits.size} impacts at {speed:.2f} m/s on average, "
            f"COR {cor.min():.3f} to {cor.max():.3f}, spin up to {abs(hits['spin_z']).max():.0f} /s"
        )
    return found


if __name__ == "__main__":
    main()
