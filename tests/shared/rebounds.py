"""Rebounds as they would be measured."""

import numpy as np

import contactlaw as cl
from contactlaw.fitting.predictions import impacts
from contactlaw.fitting.unknowns import Setting
from contactlaw.physical.law import law_of

STEEL = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
RADIUS, THICKNESS = 1e-3, 1.2e-3
KINDS = ("restitution", "contact_time", "peak_force")


def rebounds(pair, law="fem", kinds=KINDS[:1], noise=0.0, seed=0, speed=None, without=()):
    """What would be measured of a bead of 1 mm on a plate of 1.2 mm."""
    v = np.geomspace(0.2, 8.0, 12) if speed is None else np.asarray(speed, dtype=float)
    size = np.ones_like(v)
    hit = impacts(Setting(pair, v, RADIUS * size, THICKNESS * size), law_of(pair, law))
    random = np.random.default_rng(seed)
    sizes = {"radius": RADIUS, "thickness": THICKNESS}
    data = {"speed": v} | {name: size for name, size in sizes.items() if name not in without}
    for kind in kinds:
        exact = np.asarray(getattr(hit, kind))
        data[kind] = exact * (1.0 + noise * random.standard_normal(v.size))
        data[f"{kind}_error"] = max(noise, 0.01) * exact
    return data
