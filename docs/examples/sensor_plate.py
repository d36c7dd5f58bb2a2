"""The load that a rain of beads puts on a force sensor under its plate.

Each impact is a pulse of some microseconds. `contactlaw.load_signal` averages the force over each
sample of the sensor, so that no impulse is lost between two samples.
"""

import numpy as np

import contactlaw as cl

RADIUS, THICKNESS = 0.5e-3, 2e-3  # [m]
BEADS, DURATION = 1000, 0.5  # [-], [s]
RATE = 1e5  # samples per second


def main():
    """Let steel beads fall on an aluminium plate and compare the mean load with their momentum."""
    model = cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6"))
    random = np.random.default_rng(1)
    times = np.sort(random.uniform(0.0, DURATION, BEADS))
    speed = random.normal(3.0, 0.3, BEADS)
    load = cl.load_signal(times, speed, RADIUS, THICKNESS, model=model, rate=RATE)
    mass = 4.0 / 3.0 * np.pi * RADIUS**3 * model.pair.sphere.density
    momentum = mass * (speed * (1.0 + model.restitution(speed, RADIUS, THICKNESS))).sum()
    impulse = load.force.sum() / RATE
    print(f"largest sample {load.force.max():.3g} N, mean {impulse / DURATION:.3g} N")
    print(f"impulse {impulse:.4g} N s, the beads' change of momentum {momentum:.4g} N s")
    return impulse, momentum


if __name__ == "__main__":
    main()
