"""Pairs of materials, and the paper's yield speed."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import contactlaw as cl


def test_effective_modulus():
    # two equal bodies: half of E/(1 - nu^2)
    steel = cl.material("stainless-steel-304")
    assert cl.Pair(steel, steel).effective_modulus == pytest.approx(
        steel.youngs_modulus / (1 - steel.poissons_ratio**2) / 2, rel=1e-15
    )


def test_yield_speed_of_the_paper(pair):
    """Eq. 4 with its printed, rounded factor 0.552 gives the paper's 7.426 m/s.

    The definition, V_Y0^2 = (4/5) K dY^2.5/m, has sqrt(0.8) 0.68^1.25 = 0.55229 in its place.
    """
    alumina = pair.sphere
    rest = math.sqrt(math.pi**4 * alumina.yield_strength**5 / (alumina.density * pair.effective_modulus**4))
    assert 0.552 * rest == pytest.approx(7.426, abs=5e-4)
    assert pair.yield_speed == pytest.approx(math.sqrt(0.8) * 0.68**1.25 * rest, rel=1e-14)
    assert pair.yield_speed == pytest.approx(7.426, rel=0.0005 / 0.552)  # the factor's rounding


def test_yield_speed_is_that_of_the_weaker_body(pair):
    steel, aluminium = cl.material("bearing-steel-52100"), cl.material("aluminium-6061-t6")
    both = cl.Pair(steel, aluminium)
    alone = cl.Pair(dataclasses.replace(steel, yield_strength=None), aluminium)
    assert both.yield_speed == alone.yield_speed
    weak = dataclasses.replace(steel, yield_strength=aluminium.yield_strength)
    hard = dataclasses.replace(aluminium, yield_strength=None)
    assert both.yield_speed == cl.Pair(weak, hard).yield_speed
    assert both.yield_speed < 0.1 * cl.Pair(steel, hard).yield_speed


def test_bodies_without_yield_strength_never_yield():
    glass = cl.Pair("glass", "glass")
    assert glass.yield_speed == cl.ImpactModel(glass).yield_speed(1e-3, 1e-3) == math.inf


def test_names_and_materials_are_taken():
    assert cl.Pair("glass", "glass") == cl.Pair(cl.material("glass"), "glass")
    assert len({cl.Pair("glass", "glass"), cl.Pair("glass", "glass")}) == 1
    assert cl.Pair("gamma-alumina", "glass") != cl.Pair("glass", "gamma-alumina")


def test_anything_else_is_refused():
    with pytest.raises(TypeError, match="plate: expected a Material or a name.*42"):
        cl.Pair("glass", 42)
    with pytest.raises(ValueError, match="glas"):
        cl.Pair("glas", "glass")


@pytest.mark.parametrize(("ratio", "stiffer"), [(2.0, 1.010), (3.0, 1.025), (5.0, 1.054)])
def test_two_radii_act_as_the_root_of_their_product(ratio, stiffer):
    """Hertz's contact of an ellipse (Johnson 1985, 4.2), as docs/laws.md says of bodies that are no spheres."""

    def ellipse(axes):
        """Ratio of the radii by that of the axes, shorter over longer, and how much stiffer the contact is."""
        k, e = ellipk(1.0 - axes**2), ellipe(1.0 - axes**2)
        size = (4.0 / (np.pi * (1.0 - axes**2)) * axes**1.5 * np.sqrt((e / axes**2 - k) * (k - e))) ** (1.0 / 3.0)
        return (e / axes**2 - k) / (k - e), (2.0 / np.pi * np.sqrt(axes) / size * k) ** -1.5

    exact = ellipse(brentq(lambda axes: ellipse(axes)[0] - ratio, 0.01, 0.999))[1]
    assert exact == pytest.approx(stiffer, abs=5e-4)
    model = cl.ImpactModel(cl.Pair("glass", "glass"), law="hertz")
    mass = 4.0 / 3.0 * np.pi * 1e-9 * model.pair.sphere.density
    radius, thickness = 1e-3 * np.array([1.0, exact**2]), np.geomspace(0.3e-3, 3e-3, 20)[:, None]
    cor = model.solve(1.0, radius, thickness, mass=mass).restitution
    assert (cor[:, 0] > cor[:, 1]).all()
    assert ratio > 3.0 or np.ptp(cor, axis=1).max() < 0.004
