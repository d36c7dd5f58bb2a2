"""Law fem of bodies with losses, beside the impact of a body with memory, which shares no code."""

import math
from dataclasses import replace
from types import SimpleNamespace

import pytest

import contactlaw as cl
from contactlaw.equation import force, tangential, zener
from contactlaw.equation.corrections import CONTACT_TIME
from contactlaw.laws.fem import friction_loss
from contactlaw.physical.scaling import modulus_growth
from validation.fem.viscoelastic import ELASTIC_TIME, power_law, rebound, wave

SOFT = cl.Material("soft", 3e6, 0.35, 1200.0, kind="polymer")
HARD = cl.Material("hard", 3e11, 0.35, 9000.0)


@pytest.mark.parametrize("nu", [0.1, 0.3, 0.45])
def test_bodies_of_one_material_do_not_slip_on_each_other(nu):
    """Their surfaces stretch alike, so friction takes only the part that no mismatch makes."""
    alike = SimpleNamespace(modulus_share=0.5, poissons_ratio=nu, plate_poissons_ratio=nu)
    assert friction_loss(alike, [0.002, 0.0, 0.05]) == pytest.approx(0.002, rel=1e-12)


def solved(loss, lam, plate_loss):
    """Impact of a body with losses on a plate of this lambda, by the law."""
    sphere = replace(SOFT, loss_factor=(loss, 1e3))
    pair = cl.Pair(sphere, sphere if plate_loss else HARD)
    law = cl.ImpactModel(pair).force_law
    growth = modulus_growth(pair, law)
    lam *= math.exp(growth.wave + growth.wave_slope * min(lam, 1.0))
    # so shallow that the stiffening of a finite sphere does not matter
    return zener.solve(law.data, lam, 1e6, 1e-9)


@pytest.mark.parametrize("loss", [0.02, 0.1, 0.2, 0.4, 0.6])
def test_a_rebound_is_that_of_a_body_with_memory(loss):
    ours, memory = solved(loss, 0.0, 0.0), rebound(power_law(loss), 2000)
    assert ours.restitution == pytest.approx(memory.restitution, rel=5e-3)  # friction takes 3e-3
    assert ours.contact_time / CONTACT_TIME == pytest.approx(memory.contact_time / ELASTIC_TIME, rel=5e-3)
    left = memory.last_approach / memory.peak_approach
    assert ours.residual_compression / ours.peak_compression == pytest.approx(left, abs=2e-3)


@pytest.mark.parametrize("loss", [0.1, 0.2, 0.4])
@pytest.mark.parametrize("lossy_plate", [False, True])
def test_a_plate_takes_as_much_as_of_a_body_with_memory(loss, lossy_plate):
    for lam in (0.1, 0.3, 0.6):
        plate_loss = loss * lossy_plate
        memory = rebound(power_law(loss), 1000, wave(lam, plate_loss)).restitution
        held, without = (rebound(power_law(x), 1000, wave(lam)).restitution for x in (loss, 1e-6))
        ours = solved(loss, lam, plate_loss).restitution
        assert ours == pytest.approx(memory, rel=0.01, abs=0.004)
        assert memory < 0.97 * without and (held > memory) == lossy_plate


@pytest.mark.parametrize(("loss", "strength"), [(1e-3, 1e3), (0.1, 80e3), (0.7, 20e3), (1.0, 1e3)])
def test_the_springs_of_friction_are_those_of_the_same_flow_without_losses(loss, strength):
    bead = replace(SOFT, yield_strength=strength, loss_factor=(loss, 1e3))
    law = cl.ImpactModel(cl.Pair(bead, HARD)).force_law
    given = cl.laws.fem.Given(**law.parameters)
    ratio = given.sphere_ratio * math.exp(-cl.laws.fem.fitted()["pressure"] * given.relaxation)
    pair = law, cl.laws.fem.law(*given._replace(sphere_ratio=ratio, loss_factor=0.0))
    for d in [law.range[1] / 1.7**n for n in range(30)]:
        ours, same = (tangential.stiffness_at(force.alone(one.data), 1.0, math.inf, d, d, 1.0) for one in pair)
        assert (ours[0] / same[0], 1 / ours[1] - 1 / same[1]) == pytest.approx((1, 0), abs=0.016)
