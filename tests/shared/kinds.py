"""A model of every kind, of which tests ask the same: laws, losses, rates of strain, own laws."""

import functools
import math

import numpy as np
import own_laws
import polymer
from lasting import long

import contactlaw as cl

COPPER = cl.Material("copper", 124e9, 0.34, 8960, 90e6, kind="metal", rate=(0.025, 1.0))
STEEL = cl.Material("steel", 207e9, 0.29, 7850, 350e6, kind="metal", rate=(0.022, 1.0))
STEEP = cl.Material("steep", 70e9, 0.33, 2700, 300e6, kind="metal", rate=(0.08, 1.0))
HARD = cl.Material("hard", 207e9, 0.3, 7800, 1.35e9, kind="metal", rate=(0.03, 1.0))
OTHER = cl.Material("other", 70e9, 0.3, 2700, 400e6, kind="metal")
RATED = {
    "rate of the sphere": cl.Pair(COPPER, "glass"),
    "rate of the plate": cl.Pair("glass", STEEL),
    "rate of both": cl.Pair(STEEP, STEEL),
    "the other becomes the weaker": cl.Pair(STEEL, OTHER),
    "a corner of the law": cl.Pair(HARD, "glass"),
    "rate and losses": polymer.PAIRS[2],
}
PAIRS = {
    "hertz": (cl.Pair("alumina", "glass"), "hertz"),
    "myc": (cl.Pair("gamma-alumina", "glass"), "myc"),
    "fem": (cl.Pair("alumina", "aluminium-6061-t6"), "fem"),
    "losses": (polymer.PAIRS[0], "fem"),
    "losses and flow": (polymer.PAIRS[1], "fem"),
    "own": (own_laws.PAIR, own_laws.own()),
    "measured": (own_laws.PAIR, own_laws.measured()),
    **{name: (pair, "fem") for name, pair in RATED.items()},
}
# Each of these needs about ten tables; those of the others are of the same kinds.
SLOW = "rate of the plate", "a corner of the law", "rate and losses"


def params(*left_out, slow=SLOW):
    """Names of the kinds as parameters of a test, of which some take long."""
    return [long(one) if one in slow else one for one in PAIRS if one not in left_out]


@functools.cache
def model(name):
    pair, law = PAIRS[name]
    return cl.ImpactModel(pair, law)


@functools.cache
def impacts(name):
    """Random impacts inside the tables, from below yield to deep contacts."""
    rng, one, count = np.random.default_rng(5), model(name), 80 if name in RATED else 400
    usual = one.pair.yield_speed if math.isfinite(one.pair.yield_speed) else 0.1
    speed = usual * np.exp(rng.uniform(-1.0, 10.0 if name in RATED else 4.0, 10 * count))
    radius = np.exp(rng.uniform(math.log(2e-5), math.log(1e-2), speed.size))
    thickness = np.where(rng.random(speed.size) < 0.1, np.inf, radius / rng.uniform(0.05, 2.0))
    inside = [one.kernel(*at) >= 0.0 for at in zip(speed, radius, thickness, strict=True)]
    return tuple(values[inside][:count] for values in (speed, radius, thickness))
