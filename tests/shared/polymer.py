"""Pairs of bodies with losses: elastic bead, flowing bead and plate, both with a rate of strain."""

import dataclasses
import math

import contactlaw as cl

SOFT = cl.Material("soft", 3e9, 0.35, 1200, loss_factor=(0.2, 2e4), kind="polymer")
FLOWING = dataclasses.replace(SOFT, name="flowing", yield_strength=80e6, loss_factor=(0.08, 5e3))
RATED = dataclasses.replace(FLOWING, name="rated", rate=(0.04, 1.0))
WEAK = dataclasses.replace(SOFT, name="weak", yield_strength=20e6, loss_factor=(0.7, 2e4))
PAIRS = [cl.Pair(SOFT, "carbon-steel-1020"), cl.Pair(FLOWING, SOFT), cl.Pair(RATED, "glass")]
MODELS = [cl.ImpactModel(pair) for pair in PAIRS]
WEAK_MODEL = cl.ImpactModel(cl.Pair(WEAK, "glass"), outside="solve")
# speed, radius and thickness: frequencies of 2 to 60 kHz
DROPS = [(0.4, 0.5e-3, 2e-3), (2.0, 1e-3, 1.5e-3), (5.0, 4e-3, 2e-2)]


def at_impact(pair, speed, radius):
    """The same pair, its moduli given at the frequency of an impact."""
    for _ in range(50):
        time = radius * (math.pi * pair.sphere.density / pair.effective_modulus / speed**0.5) ** 0.4
        frequency = 0.5 / (3.2181 * time)
        pair = cl.Pair(pair.sphere.at_frequency(frequency), pair.plate.at_frequency(frequency))
    return pair
