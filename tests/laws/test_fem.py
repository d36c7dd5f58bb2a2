"""The law fem where people meet it: flags of other laws, energies, tables, engines, two beads."""

import dataclasses
import math

import numpy as np
import pytest

import contactlaw as cl
from contactlaw import Validity, explain, laws
from contactlaw.physical.law import law_of

R = 1e-3


# Pairs and speeds for which a user chose a law that does not suit them.


@pytest.mark.parametrize(
    ("modulus", "density", "kind", "depends"),
    [
        (2.9e9, 1410.0, None, True),  # POM without a kind
        (2.9e9, 1410.0, "polymer", True),
        (12e9, 1410.0, "polymer", True),
        (2.9e9, 1410.0, "ceramic", False),  # a porous granule, say
        (2.9e9, 7850.0, None, False),  # steel, softened for DEM
        (12.23e9, 879.0, None, False),  # gamma-alumina
    ],
)
@pytest.mark.parametrize("body", ["sphere", "plate"])
def test_what_is_as_soft_and_light_as_a_polymer_is_taken_for_one(modulus, density, kind, depends, body):
    own = cl.Material("POM", modulus, 0.37, density, yield_strength=65e6, kind=kind)
    pair = cl.Pair(**({"sphere": "glass", "plate": "glass"} | {body: own}))
    flags = cl.ImpactModel(pair, law="hertz").lookup(0.1, R, 5e-3).flags
    assert bool(flags & Validity.RATE_DEPENDENT) == depends


def test_glass_may_break_under_alumina():
    model = cl.ImpactModel(cl.Pair("alumina", "soda-lime-glass"))
    assert not model.lookup(1.0, R, 5e-3).flags & Validity.DAMAGE
    hard = model.lookup(10.0, R, 5e-3).flags
    assert hard & Validity.DAMAGE and not hard & Validity.DAMAGE & Validity.ACCURACY
    assert "break" in " ".join(explain(hard))


# The law itself.


def test_it_takes_its_numbers_from_the_pair():
    pair = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
    law = law_of(pair, "fem")
    assert law.from_pair == laws.parameters("fem")
    ratios = [pair.effective_modulus / body.yield_strength for body in (pair.sphere, pair.plate)]
    share = pair.effective_modulus / pair.plate.plane_modulus
    numbers = (*ratios, share, pair.sphere.poissons_ratio, pair.plate.poissons_ratio)
    assert law.name == f"fem({','.join(f'{number:.6g}' for number in numbers)})"
    assert law == laws.law(law.name)


# Beyond the campaign of finite elements.


def answered(pair, speed, thickness=math.inf):
    """Integrate impacts of beads of a millimetre, without a table."""
    return cl.ImpactModel(pair).solve(speed, R, thickness, rtol=1e-10)


def soft(strength):
    """Indium of some strength under bearing steel."""
    return cl.Pair("bearing-steel-52100", cl.Material("indium", 12.7e9, 0.45, 7310, yield_strength=strength))


def test_soft_bodies_follow_the_slope_of_the_law():
    """Contacts of one depth cost the more of the COR the weaker the body is: e^2 goes as sigma_Y/E.

    Complete flow is rigid-plastic: force and depth go by the strength alone, and what comes back
    of a depth by the strength over the modulus.
    """
    cor = []
    for strength in (7e6, 1e6, 1e5, 1e3, 1.0):
        pair = soft(strength)
        # the speed that leads a third of the way, in depth, to where the law ends
        law = law_of(pair, "fem")
        speed = np.geomspace(1e-3, 1.0, 3000) * 3.0 * math.sqrt(strength / 1e6)
        hit = answered(pair, speed)
        at = np.argmin(np.abs(np.asarray(hit.peak_compression) - 0.03 * R))
        assert hit.peak_compression[at] == pytest.approx(0.03 * R, rel=0.01)
        assert 0.03 < law.range[1] * law.scale
        cor.append(hit.restitution[at] / math.sqrt(strength))
        slope = np.diff(np.log(hit.restitution)) / np.diff(np.log(speed))
        assert (slope[at - 300 : at] < -0.2).all()  # Johnson's -1/4, and more for a flattened body
    assert cor == pytest.approx(np.full(5, cor[-1]), rel=0.05)


def test_nothing_jumps_where_a_body_is_so_strong_that_it_does_not_yield():
    """A body that would yield near the end of the law is elastic; the other side hardly differs."""
    steel = cl.Material("a", 200e9, 0.3, 7800)
    modulus = cl.Pair(steel, steel).effective_modulus
    speed, cor, yields = np.linspace(300.0, 700.0, 5), [], []
    for ratio in np.linspace(5.5, 5.95, 46):
        pair = cl.Pair(dataclasses.replace(steel, yield_strength=modulus / ratio), steel)
        hit = answered(pair, speed)
        yields.append(law_of(pair, "fem").yields)
        cor.append(hit.restitution)
    assert not yields[0] and yields[-1]
    assert np.abs(np.diff(cor, axis=0)).max() < 1e-3
    assert np.abs(np.diff(cor, n=2, axis=0)).max() < 2e-4


# Two beads.


def test_equal_beads_both_yield():
    """Their law is that of two equal bodies, whatever the plate of the pair is made of."""
    steel, speed = "carbon-steel-1020", np.array([0.1, 1.0, 5.0])
    hit = cl.ImpactModel(cl.Pair(steel, "soda-lime-glass")).lookup_sphere_sphere(speed, R, R)
    same = cl.restitution_sphere_sphere(steel, steel, speed, R, R, law="fem")
    assert hit.restitution.tolist() == same.tolist()
    assert (hit.plastic_fraction > 0.1).all() and (hit.wave_fraction == 0.0).all()
    lost = hit.plastic_fraction + hit.other_fraction
    assert hit.restitution**2 + lost == pytest.approx(np.ones(3), abs=1e-4)  # the table's
    # beside one that is as stiff but does not yield, one flows where two did
    hard = dataclasses.replace(cl.material(steel), yield_strength=None)
    alone = [cl.restitution_sphere_sphere(*pair, speed[:2], R, R, law="fem") for pair in ((steel, hard), (hard, steel))]
    assert alone[0].tolist() == alone[1].tolist()
    assert (alone[0] > same[:2] + 0.005).all()
