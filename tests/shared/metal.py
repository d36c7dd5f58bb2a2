"""A pair whose metal has a rate of strain, and its impacts by the solver, each at its strength."""

import dataclasses

import contactlaw as cl
from contactlaw.physical import rate

METAL = dataclasses.replace(cl.material("stainless-steel-304"), hardening=(300e6, 0.4))
PLAIN = cl.Pair(METAL, "glass")
PAIR = cl.Pair(dataclasses.replace(METAL, rate=(0.07, 1.0)), "glass")
MODEL = cl.ImpactModel(PAIR)
# the sphere's strength begins to grow where its plate's has long done so, and grows far faster
FLOW = {"hardening": (196e6, 0.97), "rate": (0.265, 7712.0)}
QUICK = cl.Material("quick", 200e9, 0.34, 8900, yield_strength=315e6, kind="metal", **FLOW)
STEEP = cl.Pair(QUICK, "aluminium-2024-t351")
# radius, thickness and speed: factors of 1.05 to 1.43, COR 0.33 to 0.94
DROPS = [(r, h, v) for r, h in ((1e-3, 5e-3), (0.2e-3, 1e-3)) for v in (0.1, 2.0, 15.0)]


def at_strength(speed, radius):
    """Model of the pair without a rate that is as strong as this impact makes it."""
    return cl.ImpactModel(rate.strengthened(PAIR, float(rate.factors(PAIR, speed, radius))))
