"""Rebounds as they would be measured."""

import numpy as np

import contactlaw as cl

STEEL = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
RADIUS, THICKNESS = 1e-3, 1.2e-3
KINDS = ("restitution", "contact_time", "peak_force")


def rebounds(pair, law="fem", kinds=KINDS[:1], noise=0.0, seed=0, speed=None, without=(), thickness=THICKNESS):
    """What would be measured of a bead of 1 mm on a plate of 1.2 mm, with an error of at least 1 %."""
    v = np.geomspace(0.2, 8.0, 12) if speed is None else np.asarray(speed, dtype=float)
    hit = cl.ImpactModel(pair, law, outside="solve").solve(v, RADIUS, thickness, rtol=1e-10)
    random = np.random.default_rng(seed)
    sizes = {"radius": RADIUS, "thickness": thickness}
    data = {"speed": v} | {name: size for name, size in sizes.items() if name not in without}
    for kind in kinds:
        exact = np.asarray(getattr(hit, kind))
        data[kind] = exact * (1.0 + noise * random.standard_normal(v.size))
        data[f"{kind}_error"] = max(noise, 0.01) * exact
    return data
