"""Spheres that hit a cup or a dome: ``python -m validation.fem.curved`` prints what R* is worth.

In a simulation the law takes R* for the radius of a bead on a round wall. Finite elements of the
same impacts, some seconds each, have no R*. Error is the COR of the model less theirs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import contactlaw as cl
from contactlaw.softsphere import PARTED, advance, law_of, resized, unit_spring
from contactlaw.stepping.spring import curved
from validation.fem.impact import impact

RADIUS, THICKNESS = 1e-3, 4e-3  # [m]
PAIR = cl.Pair("aluminium-6061-t6", "bearing-steel-52100")
SPEEDS = 1.0, 5.0, 20.0  # [m/s]
WALLS = math.inf, 8.0, 4.0, 2.0, -4.0, -2.0  # radius of the wall [R]; negative: a dome
_STEPS = 500  # of a contact


def rebound(speed: float, star: float) -> tuple[float, float]:
    """COR and peak force [N] in a simulation with small steps, from R*/R."""
    model = cl.ImpactModel(PAIR)
    law, spring = law_of(model), curved(resized(unit_spring(model, THICKNESS), RADIUS), star)
    step = float(model.solve(speed, RADIUS, THICKNESS).contact_time) / _STEPS
    x, u, state, peak = 0.0, speed, PARTED, 0.0
    while u > 0.0 or state.force > 0.0:
        u -= 0.5 * step * state.force / spring.mass
        x += u * step
        state = advance(law, spring, state, x, step)
        u -= 0.5 * step * state.force / spring.mass
        peak = max(peak, state.force)
    return -u / speed, peak


def compared(
    speed: float, walls: tuple[float, ...] = WALLS, size: float = 0.008
) -> Iterator[tuple[float, float, float, float]]:
    """Radius of each wall [R], COR of finite elements, errors of the model's COR and peak force.

    The error of the force is relative; `size` is that of the smallest element over the radius.
    """
    for wall in walls:
        found = impact(PAIR, speed, RADIUS, THICKNESS, size=size, friction=0.0, wall=wall * RADIUS)
        restitution, force = rebound(speed, 1.0 / (1.0 - 1.0 / wall))
        yield wall, found.restitution, restitution - found.restitution, force / found.peak_force - 1.0


def main() -> None:
    """Print a table."""
    for speed in SPEEDS:
        for wall, elements, error, force in compared(speed):
            found = f"COR {elements:.3f}, of the model {error:+.3f}, its peak force {force:+.1%}"
            print(f"{speed:4.0f} m/s, wall {wall:4.0f} R: {found}", flush=True)


if __name__ == "__main__":
    main()
