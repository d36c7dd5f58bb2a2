"""Random pairs and impacts: answers are finite, continuous, flagged, and alike in every interface.

Moduli are drawn over six decades, Poisson's ratios to 0.49, strengths from E*/5 to E*/1e7 or none; either
body is the weaker one, or the strengths are equal but for 2e-4.
"""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import contactlaw as cl
from contactlaw import Validity

pytestmark = pytest.mark.filterwarnings("ignore:.* no solid is so strong")  # strengths are drawn up to E*/5
RADIUS = 1e-3
NEAR = 1e-4  # relative step of an input
ENERGIES = 1e-7  # tolerance of the sum of all energies
KINK = 3e-6  # a change of COR beyond this, over twice that of the steps beside it, is a jump
few = settings(max_examples=6, derandomize=True, deadline=None, suppress_health_check=list(HealthCheck))
many = settings(few, max_examples=60)


def log(low, high):
    """Draw numbers that are even in their logarithm."""
    return st.floats(math.log(low), math.log(high)).map(math.exp)


@st.composite
def pairs(draw):
    first = draw(log(1e6, 1e12))
    second = draw(st.one_of(log(0.1, 10.0).map(lambda share: min(first * share, 1e12)), log(1e6, 1e12)))
    moduli, nu = (first, second), [draw(st.floats(0.0, 0.49)) for _ in range(2)]
    weakest = draw(log(5.0, 1e7)) ** -1.0 / sum((1.0 - n**2) / e for n, e in zip(nu, moduli, strict=True))
    weakest = max(weakest, 1.1e-12 * max(moduli))  # a weaker solid is refused
    strengths = [None, None], [weakest, None], [weakest, weakest], [weakest, weakest * draw(log(1.0, 20.0))]
    strengths += ([weakest * (1.0 - NEAR), weakest * (1.0 + NEAR)],)
    order = draw(st.permutations((0, 1)))
    yields = draw(st.sampled_from(strengths))
    bodies = []
    for e, n, s in zip(moduli, nu, (yields[k] for k in order), strict=True):
        density = max(e / 4e8, 500.0) * draw(log(1.0, 40.0))  # waves are slower than 20 km/s
        bodies.append(cl.Material("own", e, n, density, yield_strength=None if s is None or s >= 0.99 * e else s))
    return cl.Pair(*bodies)


@st.composite
def cases(draw):
    """Draw a pair, speeds from well below yield up to a deep contact, and a thickness."""
    pair = draw(pairs())
    law = cl.ImpactModel(pair).force_law
    deep = min(law.scale, 0.1) if law.yields and law.scale is not None else 0.1
    slow = math.sqrt(0.8 * pair.effective_modulus * deep**2.5 / math.pi / pair.sphere.density)
    fastest = 0.1 * math.sqrt(pair.effective_modulus / pair.sphere.density)
    speed = slow * np.array([draw(log(0.3, 300.0)) for _ in range(3)])
    return pair, np.minimum(speed, fastest), RADIUS * draw(log(0.5, 30.0))


def solve(pair, speed, thickness):
    return cl.ImpactModel(pair).solve(speed, RADIUS, thickness, rtol=1e-10)


# A sphere that flows is 4 times as stiff as its plate; E*/sigma_Y of others is 2600 and 3500.
@many
@example((cl.Pair(cl.Material("a", 280e9, 0.3, 7800, 200e6), cl.Material("b", 70e9, 0.3, 2700)), [1.0], RADIUS))
@example((cl.Pair(cl.Material("a", 70e9, 0.3, 2700, 15e6), cl.Material("b", 70e9, 0.3, 2700)), [1.0], RADIUS))
@example((cl.Pair(cl.Material("a", 70e9, 0.3, 2700, 11e6), cl.Material("b", 70e9, 0.3, 2700)), [1.0], RADIUS))
@given(cases())
def test_numbers_are_finite_energies_add_up_and_untried_strengths_are_flagged(case):
    pair, speed, thickness = case
    for h in (thickness, math.inf):
        hit = solve(pair, speed, h)
        assert all(np.isfinite(getattr(hit, field.name)).all() for field in dataclasses.fields(hit))
        parts = [hit.restitution**2, hit.plastic_fraction, hit.wave_fraction, hit.other_fraction]
        assert np.min(parts) >= -ENERGIES and 0.0 <= np.min(hit.restitution) <= np.max(hit.restitution) <= 1.0
        np.testing.assert_allclose(np.sum(parts, axis=0), 1.0, rtol=0.0, atol=ENERGIES)
        # In finite elements the stronger body yields, too, up to 1/0.36 times the lower strength.
        bodies = [(body.yield_strength or math.inf, body.plane_modulus) for body in (pair.sphere, pair.plate)]
        flowing = [body for body in bodies if 0.36 * body[0] < min(bodies)[0]]
        softest, ratio = min(modulus for _, modulus in bodies), 3.5 if flowing == bodies[:1] else 12.0
        tried = all(11.0 <= pair.effective_modulus / s <= 3000.0 and m <= ratio * softest for s, m in flowing)
        untried = (hit.flags & Validity.UNTRIED_STRENGTH) != 0
        np.testing.assert_array_equal(untried, (hit.plastic_fraction > 0.0) & (not tried))
        np.testing.assert_array_equal(hit.plastic_fraction > 0.0, hit.overload > 1.0)


def replaced(pair, body, **changed):
    bodies = {"sphere": pair.sphere, "plate": pair.plate}
    return cl.Pair(**bodies | {body: dataclasses.replace(bodies[body], **changed)})


def neighbours(pair):
    """Yield four pairs along each input, and four across equal strengths."""
    at = NEAR * np.array([-1.5, -0.5, 0.5, 1.5])
    for body, field in itertools.product(("sphere", "plate"), ("youngs_modulus", "poissons_ratio", "yield_strength")):
        value = getattr(getattr(pair, body), field)
        if value is not None and not (field == "poissons_ratio" and not 1e-3 < value < 0.489):
            yield [replaced(pair, body, **{field: value * (1 + d)}) for d in at]
    if None not in (strengths := (pair.sphere.yield_strength, pair.plate.yield_strength)):
        low = min(strengths)
        moved = [replaced(pair, "sphere", yield_strength=low * (1 + d)) for d in at]
        yield [replaced(one, "plate", yield_strength=low * (1 - d)) for one, d in zip(moved, at, strict=True)]


@few
@given(cases())
def test_no_input_makes_the_cor_jump(case):
    pair, speed, thickness = case
    for moved in neighbours(pair):
        change = np.abs(np.diff([solve(one, speed, thickness).restitution for one in moved], axis=0))
        assert (change[1] - 2.0 * np.maximum(change[0], change[2])).max() <= KINK


# Elastic spheres at a tenth of sqrt(E*/rho1), faster than the waves of these soft plates.
@few
@example((cl.Pair(cl.Material("a", 547e9, 0.341, 1374), cl.Material("b", 50.7e6, 0.143, 18135)), [19.4], RADIUS))
@example((cl.Pair(cl.Material("a", 29.6e9, 0.273, 879), cl.Material("b", 10.8e6, 0.375, 19641)), [11.9], RADIUS))
@example((cl.Pair(cl.Material("a", 132e9, 0.214, 573), cl.Material("b", 4.43e9, 0.0879, 8517)), [275.0], RADIUS))
@given(cases())
def test_a_thicker_plate_takes_less(case):
    """Without yield; the COR rises but for friction: deeper contacts slip more."""
    pair, speed, _ = case
    elastic = replaced(replaced(pair, "sphere", yield_strength=None), "plate", yield_strength=None)
    hit = solve(elastic, speed[:1], RADIUS * np.geomspace(0.2, 100.0, 200))
    assert (np.diff(hit.inelasticity) <= 1e-9 * hit.inelasticity[1:]).all()
    assert (np.diff(hit.wave_fraction) <= ENERGIES).all()
    assert (np.diff(hit.restitution**2) >= -np.abs(np.diff(hit.other_fraction)) - ENERGIES).all()


def test_what_the_kernel_does_not_know_is_clamped_to_an_answer_in_range():
    """Speeds and sizes are drawn over seven decades and more."""
    clamping, random, count = (
        cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), outside="clamp"),
        np.random.default_rng(0),
        2000,
    )
    v, r = 10.0 ** random.uniform([[-10.0], [-9.0]], [[5.0], [3.0]], (2, count))
    h = np.maximum(r / 10.0 ** random.uniform(-3, np.log10(cl.table.lookup.THINNEST), count), 1e-9)
    hit = clamping.lookup(v, r, h)
    clamped = np.isnan([clamping.kernel(*impact) for impact in zip(v, r, h, strict=True)])
    np.testing.assert_array_equal((hit.flags & int(Validity.CLAMPED)) != 0, clamped)
    assert 0.1 < clamped.mean() < 0.9
    for name in ("restitution", "plastic_fraction", "wave_fraction", "other_fraction"):
        assert -1e-6 <= getattr(hit, name).min() <= getattr(hit, name).max() <= 1.0 + 1e-4
    for name in ("contact_time", "peak_force", "peak_compression", "inelasticity"):
        assert ((getattr(hit, name) >= 0.0) & (getattr(hit, name) < math.inf)).all()


@settings(few, max_examples=20)
@given(pairs(), st.integers(0, 2**32 - 1))
def test_impacts_come_to_an_end(pair, seed):
    """Speeds span nine decades, plates go to a fifth of the radius."""
    random = np.random.default_rng(seed)
    speed, ratio = (np.exp(random.uniform(*np.log(ends), 500)) for ends in ((1e-6, 1e3), (1e-3, 5.0)))
    at_one = float(solve(pair, 1e-3, RADIUS).inelasticity)
    known = at_one * (speed / 1e-3) ** 0.2 * ratio**2 < 25.0  # beyond, an impact takes thousands of time steps
    hit = solve(pair, speed[known], RADIUS / ratio[known])
    assert all(np.isfinite(getattr(hit, field.name)).all() for field in dataclasses.fields(hit))
