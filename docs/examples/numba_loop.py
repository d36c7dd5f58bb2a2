"""A bead that bounces on a thin plate, impact by impact, in a compiled loop.

``model.kernel`` is a numba-jitted function of speed, radius and thickness [m/s, m, m] that gives
the COR; C and C++ codes take ``model.address``, a pointer to the same function.
"""

import numba

import contactlaw as cl

GRAVITY = 9.81  # [m/s2]


@numba.njit
def bounces(cor, drop, radius, thickness, slowest):
    """Count the bounces until the bead is slow, and the time they take [s]."""
    speed = (2.0 * GRAVITY * drop) ** 0.5
    time = speed / GRAVITY
    count = 0
    while speed > slowest:
        speed *= cor(speed, radius, thickness)
        time += 2.0 * speed / GRAVITY
        count += 1
    return count, time


def main():
    """Drop a glass bead of 1 mm radius from 0.5 m on steel plates."""
    model = cl.ImpactModel(cl.Pair("soda-lime-glass", "carbon-steel-1020"))
    found = {}
    for thickness in (0.8e-3, 2e-3, 10e-3):
        count, time = bounces(model.kernel, 0.5, 1e-3, thickness, 0.05)
        print(f"{1e3 * thickness:4.1f} mm: {count:3d} bounces in {time:.2f} s")
        found[thickness] = count
    return found


if __name__ == "__main__":
    main()
