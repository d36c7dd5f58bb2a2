"""What a sensor under a plate feels of a rain of beads, and how many of them it counts.

A force sensor feels the load of the beads, pulses of some microseconds. `contactlaw.load_signal`
averages it over each sample, so that no impulse is lost between two samples. A vibration sensor
feels the bending waves that arrive at its place. `contactlaw.plate_signal` has them.
"""

import numpy as np

import contactlaw as cl
from contactlaw.engines.record import IMPACT, fill

PAIR = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
RADIUS, THICKNESS, WIDTH = 0.5e-3, 2e-3, 0.2  # [m]
BEADS, DURATION = 1000, 0.5  # [-], [s]
RATE = 1e5  # samples per second
CALM = 0.2e-3  # [s] for which the plate has to be below the threshold before the next count


def main():
    """Let steel beads fall on an aluminium plate; compare the load, and count them."""
    model, random = cl.ImpactModel(PAIR), np.random.default_rng(1)
    rows = np.zeros(BEADS, IMPACT)
    rows["time"] = np.sort(random.uniform(0.0, DURATION, BEADS))
    rows["x"], rows["y"] = random.uniform(-WIDTH / 2, WIDTH / 2, (2, BEADS))
    rows["approach_speed"], rows["radius"], rows["thickness"] = random.normal(3.0, 0.3, BEADS), RADIUS, THICKNESS
    rows["mass"] = 4.0 / 3.0 * np.pi * RADIUS**3 * PAIR.sphere.density
    speed = rows["approach_speed"]
    hit = model.lookup(speed, RADIUS, THICKNESS)
    fill(rows, hit, 0.5 * rows["mass"] * speed**2)

    load = cl.load_signal(rows["time"], speed, RADIUS, THICKNESS, model=model, rate=RATE)
    momentum, impulse = (rows["mass"] * speed * (1.0 + hit.restitution)).sum(), load.force.sum() / RATE
    print(f"largest sample {load.force.max():.3g} N, mean {impulse / DURATION:.3g} N")
    print(f"impulse {impulse:.4g} N s, the beads' change of momentum {momentum:.4g} N s")

    signal = cl.plate_signal(cl.Record(rows, [cl.Bodies(PAIR, "fem")]), wall=0, at=(0.0, 0.0, 0.0), rate=RATE)
    for threshold in (1e-3, 2e-3, 4e-3, 8e-3):
        above = signal.time[abs(signal.value) > threshold]
        print(f"above {1e3 * threshold:g} mm/s: {1 + (np.diff(above) > CALM).sum()} of {BEADS} beads are counted")
    return impulse, momentum


if __name__ == "__main__":
    main()
