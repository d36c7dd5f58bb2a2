"""Records of impacts on one pair's walls, as engines fill them."""

import math

import numpy as np

import contactlaw as cl
from contactlaw.engines.record import IMPACT, fill

PAIR = cl.Pair("bearing-steel-52100", "glass")


def impacted(law, **columns):
    """Record of impacts with these columns, of solid beads by a law."""
    rows = np.zeros(np.size(columns["approach_speed"]), IMPACT)
    for name, values in columns.items():
        rows[name] = values
    rows["mass"] = 4 / 3 * math.pi * rows["radius"] ** 3 * PAIR.sphere.density
    model = cl.ImpactModel(PAIR, law, outside="solve")
    hit = model.lookup(rows["approach_speed"], rows["radius"], rows["thickness"])
    fill(rows, hit, 0.5 * rows["mass"] * rows["approach_speed"] ** 2)
    return cl.Record(rows, [cl.Bodies(PAIR, law)])


def thin_plate(thickness):
    """Mobility, sqrt(D/m) and mass per area m of an endless plate."""
    plate = PAIR.plate
    stiffness = plate.youngs_modulus * thickness**3 / 12 / (1 - plate.poissons_ratio**2)
    areal = plate.density * thickness
    return 1 / (8 * np.sqrt(stiffness * areal)), np.sqrt(stiffness / areal), areal
