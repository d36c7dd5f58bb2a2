"""Bodies with losses: what they lose, and moduli at the frequency of the impact."""

import math
from dataclasses import replace

import numpy as np
import polymer
import pytest

import contactlaw as cl


@pytest.mark.parametrize("pair", polymer.PAIRS, ids=repr)
@pytest.mark.parametrize(("speed", "radius", "thickness"), polymer.DROPS)
def test_the_moduli_are_those_at_the_frequency_of_the_impact(pair, speed, radius, thickness):
    """Given at that frequency they are not carried; what differs is the law's depth, by 1 %."""
    own = polymer.at_impact(pair, speed, radius)
    there, carried = (cl.ImpactModel(one).solve(speed, radius, thickness) for one in (own, pair))
    assert abs(own.effective_modulus / pair.effective_modulus - 1.0) > 0.02
    for name in ("restitution", "contact_time", "peak_force"):
        assert getattr(carried, name) == pytest.approx(getattr(there, name), rel=1e-2)


def test_a_loss_factor_of_nothing_changes_nothing():
    none = replace(polymer.SOFT, loss_factor=None)
    assert replace(polymer.SOFT, loss_factor=(0.0, 1e4)) == none
    beads = none, replace(polymer.SOFT, loss_factor=(1e-6, 1e4))
    without, little = (cl.ImpactModel(cl.Pair(bead, "glass")).solve(2.0, 1e-3, 2e-3) for bead in beads)
    assert without.restitution == pytest.approx(little.restitution, abs=1e-5)
    assert without.flags & cl.Validity.RATE_DEPENDENT and not little.flags


def test_compliances_weigh_the_losses_of_two_bodies():
    """A body that is a thousand times as stiff has no say; two alike have the loss of one."""
    stiff = replace(polymer.SOFT, youngs_modulus=3e12, density=1e4, loss_factor=None)
    assert cl.Pair(polymer.SOFT, stiff).loss_factor == pytest.approx(0.2, rel=2e-3)
    assert cl.Pair(polymer.SOFT, polymer.SOFT).loss_factor == pytest.approx(0.2, rel=1e-12)


def test_other_laws_leave_the_losses_out_and_say_so():
    hit = cl.ImpactModel(polymer.PAIRS[1], law="myc").solve(0.4, 1e-3, math.inf)
    assert hit.restitution > 0.99 and hit.flags & cl.Validity.RATE_DEPENDENT


def test_oblique_impacts_from_the_table_are_those_of_the_solver():
    """Springs of contacts too shallow for a loss had a negative exponent: speeds grew to 1e45."""
    bead = replace(polymer.FLOWING, youngs_modulus=2e9, loss_factor=(0.2, 1e4))
    sliding = np.array([1e-4, 1e-2, 0.3, 1.0, 3.0, 10.0]) * 0.09
    at, model = (0.3, sliding, 1e-3, 3e-3, 0.3), cl.ImpactModel(cl.Pair(bead, "glass"))
    table, exact = (model.oblique(*at, method=method) for method in ("table", "solve"))
    np.testing.assert_allclose(table.sliding_speed, exact.sliding_speed, atol=2e-3 * 0.09)
    assert (np.abs(exact.sliding_speed) < sliding).all() and (exact.friction_energy > 0.0).all()


def test_the_slowest_impacts_lose_what_slow_ones_do():
    """Their compression is below the smallest one of which the law knows the loss."""
    speed, radius = np.array([1e-5, 1e-7, 1e-12]), np.array([1.5, 1e-2, 100.0])
    for answer in (polymer.WEAK_MODEL.solve, polymer.WEAK_MODEL.lookup):
        assert answer(speed, radius, 3.0 * radius).restitution == pytest.approx(0.438, abs=1e-3)


def test_errors_of_a_plate_are_those_of_the_material_given():
    """Its modulus is carried to the bead's frequency, by the loss factor that is uncertain."""
    plate = replace(polymer.SOFT, name="p", loss_factor=(0.5, 1e2), uncertainty={"loss_factor": 0.2})

    def model(z):
        return cl.ImpactModel(cl.Pair(polymer.SOFT, replace(plate, loss_factor=(0.5 * math.exp(z), 1e2))))

    low, high = (model(z).solve(1.0, 1e-3, 5e-3).restitution for z in (-0.2, 0.2))
    causes = model(0.0).uncertainty(1.0, 1e-3, 5e-3).restitution.causes
    assert causes["loss factor of the plate"] == pytest.approx(0.5 * abs(high - low), rel=1e-3)
