"""Impacts near the edges of plates in pymunk, over those far from them."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pymunk

import contactlaw as cl
from contactlaw.engines.pymunk import attach
from validation.bench.row import Row

PLATES, ROUNDS = 200, 100
RADIUS, THICKNESS, LENGTH = 0.9e-3, 1e-3, 0.05  # [m]
AWAY, PLACES = LENGTH / 2.0, (4e-3, 2e-3, 1e-3, 0.5e-3)  # distances from an edge [m]


def rows() -> Iterator[Row]:
    """Measure one step in which a bead hits each plate, at places that take turns."""
    space = pymunk.Space()
    impacts = attach(space, cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc"))
    bodies = []
    for n in range(PLATES):
        plate = pymunk.Segment(space.static_body, (n, 0), (n + LENGTH, 0), 0)
        body = pymunk.Body(2.7e-6, 8.7e-13)
        bead = pymunk.Circle(body, RADIUS)
        space.add(plate, body, bead)
        impacts.add_plate(plate, THICKNESS, edge="free")
        impacts.add_bead(bead)
        bodies.append(body)
    least = dict.fromkeys((AWAY, *PLACES), float("inf"))
    for _ in range(ROUNDS):
        for place in least:
            for n, body in enumerate(bodies):
                body.position, body.velocity = (n + place, 0.99 * RADIUS), (0, -2)
            start = time.perf_counter()
            space.step(1e-5)
            least[place] = min(least[place], time.perf_counter() - start)
            for body in bodies:
                body.position = body.position.x, 3.0 * RADIUS
            space.step(1e-5)  # they leave the plates, so that the next impact is a first one
    for place in PLACES:
        yield Row(
            f"pymunk, impact {place * 1e3:g} mm from an edge", least[place] / least[AWAY], "x",
            3.0,
            note=f"{least[place] / PLATES * 1e6:.0f} us; away {least[AWAY] / PLATES * 1e6:.0f} us",
        )  # fmt: skip
