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
    there = cl.ImpactModel(own).solve(speed, radius, thickness)
    carried = cl.ImpactModel(pair).solve(speed, radius, thickness)
    growth = own.effective_modulus / pair.effective_modulus
    assert abs(growth - 1.0) > 0.02
    assert carried.restitution == pytest.approx(there.restitution, rel=1e-2)
    assert carried.contact_time == pytest.approx(there.contact_time, rel=1e-2)
    assert carried.peak_force == pytest.approx(there.peak_force, rel=1e-2)


def test_a_loss_factor_of_nothing_changes_nothing():
    lossless, none = (replace(polymer.SOFT, loss_factor=(0.0, 1e4)), replace(polymer.SOFT, loss_factor=None))
    assert lossless == none
    little = replace(polymer.SOFT, loss_factor=(1e-6, 1e4))
    hits = [cl.ImpactModel(cl.Pair(one, "glass")).solve(2.0, 1e-3, 2e-3) for one in (none, little)]
    assert hits[0].restitution == pytest.approx(hits[1].restitution, abs=1e-5)
    assert hits[0].flags & cl.Validity.RATE_DEPENDENT and not hits[1].flags


def test_compliances_weigh_the_losses_of_two_bodies():
    """A body that is a thousand times as stiff has no say; two alike have the loss of one."""
    stiff = replace(polymer.SOFT, youngs_modulus=3e12, density=1e4, loss_factor=None)
    assert cl.Pair(polymer.SOFT, stiff).loss_factor == pytest.approx(0.2, rel=2e-3)
    assert cl.Pair(polymer.SOFT, polymer.SOFT).loss_factor == pytest.approx(0.2, rel=1e-12)
    assert cl.Pair(polymer.SOFT, polymer.FLOWING).plate.loss_factor == (0.08, 2e4)


def test_other_laws_leave_the_losses_out_and_say_so():
    model = cl.ImpactModel(polymer.PAIRS[1], law="myc")
    assert model.solve(0.4, 1e-3, math.inf).restitution > 0.99
    assert model.solve(0.4, 1e-3, math.inf).flags & cl.Validity.RATE_DEPENDENT


def test_sensitivities_are_those_of_changed_inputs():
    pair, at = polymer.PAIRS[2], (2.0, 2e-3, 4e-3)
    found, step = cl.ImpactModel(pair).sensitivity(*at), 1e-3

    def log_cor(pair, radius=2e-3):
        return math.log(cl.ImpactModel(pair).solve(2.0, radius, 4e-3, rtol=1e-12).restitution)

    larger = (log_cor(pair, 2e-3 * (1 + step)) - log_cor(pair, 2e-3 * (1 - step))) / (2 * step)
    assert found.radius == pytest.approx(larger, abs=2e-3)
    sphere = [replace(pair.sphere, density=1200 * (1 + s)) for s in (-step, step)]
    low, high = (log_cor(cl.Pair(one, "glass")) for one in sphere)
    assert found.sphere_density == pytest.approx((high - low) / (2 * step), abs=2e-3)


def test_a_fit_finds_the_loss_factor_of_a_polymer_that_has_none():
    speed = np.array([0.5, 1.0, 2.0, 3.0])
    bead = replace(polymer.SOFT, loss_factor=(0.12, 1.5e4))
    measured = cl.ImpactModel(cl.Pair(bead, "glass")).solve(speed, 2e-3, 2e-2).restitution
    data = {"speed": speed, "radius": 2e-3, "thickness": 2e-2, "restitution": measured}
    known = cl.fit(cl.Pair(replace(bead, loss_factor=(0.3, 1.5e4)), "glass"), data, "loss_factor")
    assert known.values["loss_factor"] == pytest.approx(0.12, rel=1e-3)
    unknown = cl.fit(cl.Pair(replace(bead, loss_factor=None), "glass"), data, "loss_factor")
    assert unknown.values["loss_factor"] == pytest.approx(0.12, rel=0.02)
    assert 5e3 < unknown.pair.sphere.loss_factor[1] < 4e4


def test_oblique_impacts_from_the_table_are_those_of_the_solver():
    """Springs of contacts too shallow for a loss had a negative exponent: speeds grew to 1e45."""
    bead = replace(polymer.FLOWING, youngs_modulus=2e9, loss_factor=(0.2, 1e4))
    model = cl.ImpactModel(cl.Pair(bead, "glass"))
    speed, mu = 0.3, 0.3
    sliding = np.array([1e-4, 1e-2, 0.3, 1.0, 3.0, 10.0]) * mu * speed
    table, exact = (model.oblique(speed, sliding, 1e-3, 3e-3, mu, method=method) for method in ("table", "solve"))
    np.testing.assert_allclose(table.sliding_speed, exact.sliding_speed, atol=2e-3 * mu * speed)
    assert (np.abs(exact.sliding_speed) < sliding).all() and (exact.friction_energy > 0.0).all()


def test_the_slowest_impacts_lose_what_slow_ones_do():
    """Their compression is below the smallest one of which the law knows the loss."""
    model = polymer.WEAK_MODEL
    speed, radius = np.array([1e-5, 1e-7, 1e-12]), np.array([1.5, 1e-2, 100.0])
    for hit in (model.solve(speed, radius, 3.0 * radius), model.lookup(speed, radius, 3.0 * radius)):
        assert hit.restitution == pytest.approx(0.438, abs=1e-3)


@pytest.mark.parametrize("loss", [0.1, 0.35, 0.7, 0.9])
@pytest.mark.parametrize("strength", [5e6, 20e6, 50e6])
def test_friction_of_bodies_that_flow_obeys_coulomb(loss, strength):
    pair = cl.Pair(replace(polymer.WEAK, yield_strength=strength, loss_factor=(loss, 2e4)), "glass")
    speed, sliding = np.meshgrid([0.5, 3.0, 10.0], [0.3, 1.0, 5.0, 20.0])
    hit = cl.ImpactModel(pair).oblique(speed, sliding, 1e-3, 5e-3, 0.3, method="solve")
    assert (hit.impulse_ratio <= 0.3 * (1.0 + 1e-9)).all() and (hit.friction_energy > 0.0).all()


def test_an_answer_that_is_not_finite_names_its_impact(monkeypatch):
    monkeypatch.setattr("contactlaw.table.slides.after", lambda *given, **more: given[3] * np.nan)
    with pytest.raises(RuntimeError, match="'weak', 'glass'. at 3 m/s, radius 0.001 m, thickness"):
        polymer.WEAK_MODEL.oblique(3.0, 1.0, 1e-3, 5e-3, 0.3, method="solve")


def test_errors_of_a_plate_are_those_of_the_material_given():
    """Its modulus is carried to the bead's frequency, by the loss factor that is uncertain."""
    plate = replace(polymer.SOFT, name="p", loss_factor=(0.5, 1e2), uncertainty={"loss_factor": 0.2})
    found = cl.ImpactModel(cl.Pair(polymer.SOFT, plate)).uncertainty(1.0, 1e-3, 5e-3).restitution
    ends = [
        cl.ImpactModel(cl.Pair(polymer.SOFT, replace(plate, loss_factor=(0.5 * math.exp(z), 1e2))))
        .solve(1.0, 1e-3, 5e-3)
        .restitution
        for z in (-0.2, 0.2)
    ]
    width = 0.5 * abs(ends[1] - ends[0])
    assert found.causes["loss factor of the plate"] == pytest.approx(width, rel=1e-3)


def test_a_prior_needs_a_loss_factor_that_was_given():
    data = {"speed": [1.0, 2.0], "radius": 1e-3, "thickness": 1e-2, "restitution": [0.8, 0.79]}
    pair = cl.Pair(replace(polymer.SOFT, loss_factor=None), "glass")
    with pytest.raises(ValueError, match="loss_factor has no value"):
        cl.fit(pair, data, "loss_factor", priors={"loss_factor": 0.01})
