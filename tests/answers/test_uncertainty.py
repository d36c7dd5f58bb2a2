"""Bands of the COR, contact time and peak force against random pairs, and their limits."""

import dataclasses
import math

import numpy as np
import own_laws
import pytest
from lasting import long
from scipy.stats import norm, qmc

import contactlaw as cl
from contactlaw.answers import law_errors
from contactlaw.cli.parts import bands

INF = math.inf


def known_to(body, **errors):
    return dataclasses.replace(cl.material(body) if isinstance(body, str) else body, uncertainty=errors)


COPPER = cl.Material("copper", 124e9, 0.34, 8960, 90e6, kind="metal", hardening=(292e6, 0.31), rate=(0.025, 1.0))
HARD = cl.Material("hard", 124e9, 0.34, 8960, kind="metal", hardness=1e9, hardening=0.3)


def random_body(rng, yields):
    """A metal or a ceramic with errors; of the metals some harden, and of these half have a rate."""
    modulus = math.exp(rng.uniform(math.log(60e9), math.log(400e9)))
    numbers = {"youngs_modulus": modulus, "poissons_ratio": rng.uniform(0.2, 0.35), "density": rng.uniform(2300, 8500)}
    errors = {"youngs_modulus": rng.choice([0.02, 0.05, 0.15]), "poissons_ratio": 0.05, "density": 0.02}
    if yields:
        strength = modulus * math.exp(-rng.uniform(5.0, 7.3))
        numbers["yield_strength"], errors["yield_strength"] = strength, rng.choice([0.05, 0.1, 0.2, 0.3])
        if rng.random() < 0.15:
            numbers["hardening"] = strength * rng.uniform(0.3, 2.0), rng.uniform(0.2, 0.6)
            errors["hardening"] = 0.15
            if rng.random() < 0.5:
                numbers["rate"], errors["rate"] = (rng.uniform(0.01, 0.05), 1.0), 0.2
    return cl.Material("random", kind="metal" if yields else "ceramic", uncertainty=errors, **numbers)


def drawn(body, deviates):
    """Take an error of each number of a body from the front of a list."""
    for name, error in body.uncertainty.items():
        value, factor, flow = getattr(body, name), math.exp(error * deviates.pop(0)), body.flow
        if name == "hardening" and isinstance(value, float):  # it follows from a hardness
            body, value = dataclasses.replace(body, yield_strength=flow.strength), (flow.hardening, value)
        value = (factor * value[0], value[1]) if isinstance(value, tuple) else factor * value
        body = dataclasses.replace(body, **{name: value})
    return body


@pytest.mark.parametrize("seed", [36, *(long(n) for n in range(50, 100))])
def test_the_band_is_that_of_random_pairs(seed):
    """Of 512 of a Sobol sequence, whose quantiles err less than those of 2000 independent ones.

    Every third pair is next to yield, where the COR has a corner and twice as many are needed. Every fifth has one
    material, which errs alike in both bodies.
    """
    rng, radius = np.random.default_rng(seed), 1e-3
    sphere, plate = random_body(rng, seed % 3 == 0 or rng.random() < 0.75), random_body(rng, rng.random() < 0.4)
    pair = cl.Pair(sphere, sphere if seed % 5 == 0 else plate)
    model, thickness = cl.ImpactModel(pair), radius * rng.choice([0.4, 0.8, 1.5, 3.0, 10.0, INF])
    speed = math.exp(rng.uniform(-3.0, 2.1))
    if seed % 3 == 0:
        speed = model.yield_speed(radius, max(thickness, 0.8e-3)) * math.exp(rng.uniform(-0.35, 0.35))
    errors = {"speed_error": rng.choice([0.0, 0.02, 0.1]), "radius_error": rng.choice([0.0, 0.02])}
    errors["thickness_error"] = rng.choice([0.0, 0.05])
    hits, deviates = [], norm.ppf(qmc.Sobol(16, rng=3).random(1024 if seed % 3 == 0 else 512))
    for row in deviates:
        left, sizes = list(row[4:]), np.exp(row[:3] * [*errors.values()]) * [speed, radius, thickness]
        bead = drawn(sphere, left)
        other = cl.ImpactModel(cl.Pair(bead, bead if pair.plate == sphere else drawn(plate, left)))
        hit = other.solve(*sizes)
        hits.append([hit.restitution, hit.contact_time, hit.peak_force])
    hit = model.solve([speed], radius, thickness)
    law = law_errors.law_errors(model.force_law, pair, hit, np.array([radius / thickness]))
    wide = np.array(hits) + law.T * deviates[:, 3:4]
    wide[:, 0] = np.clip(wide[:, 0], 0.0, 1.0)
    low, high = np.quantile(wide, norm.cdf([-1.0, 1.0]), axis=0)
    for n, band in enumerate(vars(model.uncertainty(speed, radius, thickness, **errors)).values()):
        off = np.abs([band.low - low[n], band.high - high[n]]) / (0.5 * (high[n] - low[n]))
        assert off.max() < 0.15, n


def test_without_errors_only_the_law_is_uncertain():
    model = cl.ImpactModel(cl.Pair(known_to("stainless-steel-304"), "glass"))
    bands, hit = model.uncertainty(3.0, 1e-3, 5e-3), model.solve(3.0, 1e-3, 5e-3)
    for (name, band), rms in zip(vars(bands).items(), law_errors.MODEL_ERRORS["fem"][0], strict=True):
        value = getattr(hit, name)
        assert band.causes == {"model": pytest.approx(rms * value, rel=1e-3)}
        assert (band.low, band.high) == pytest.approx((value * (1 - rms), value * (1 + rms)), rel=1e-4)


@pytest.mark.parametrize(
    ("bead", "plate", "number", "error", "within"),
    [
        ("stainless-steel-304", "glass", "yield_strength", 0.2, 1e-5),
        ("stainless-steel-304", "stainless-steel-304", "yield_strength", 0.2, 1e-5),
        (COPPER, "glass", "hardening", 0.15, 1e-4),
        (COPPER, "glass", "rate", 0.3, 2e-3),
        (HARD, "glass", "hardness", 0.1, 1e-5),
        (HARD, "glass", "hardening", 0.1, 1e-5),
    ],
)
def test_one_number_alone_makes_the_band_of_its_ends(bead, plate, number, error, within):
    """One material errs alike in both bodies. Other numbers may follow from a hardness."""
    known, at = known_to(bead, **{number: error, "density": 0.0}), (3.0, 1e-3, [2e-3, INF])

    def model(body):
        return cl.ImpactModel(cl.Pair(body, body if plate == bead else plate))

    cor = model(known).uncertainty(*at).restitution
    cause = f"{number.replace('_', ' ')} of {'both bodies' if plate == bead else 'the bead'}"
    assert list(cor.causes) == [cause, "model"]
    low, high = (model(drawn(known, [z, 0.0])).solve(*at).restitution for z in (-1.0, 1.0))
    width = 0.5 * abs(high - low)
    assert cor.causes[cause] == pytest.approx(width, rel=within)
    if number not in ("hardening", "rate"):
        assert 0.5 * (cor.high - cor.low) == pytest.approx(np.hypot(width, cor.causes["model"]), rel=0.02)


def test_the_range_of_a_cor_near_zero_is_as_wide_as_the_law_is_wrong():
    """It was 1e-52 to 1 where the law's error is larger than the COR."""
    cor = range_of(known_to("carbon-steel-1020"), "glass", 1.0, thickness=0.25e-3)
    assert cor.low < 1e-3 and 0.0 < cor.high < 0.006
    assert cor.causes == {"model": pytest.approx(0.0169 * 0.3)}


@pytest.mark.parametrize("law", [own_laws.own(), own_laws.measured()], ids=["own", "measured"])
def test_a_law_whose_errors_nobody_knows_has_no_range(law):
    band = range_of(own_laws.PAIR.sphere, own_laws.PAIR.plate, 12.0, law)
    assert (band.low, band.high, band.causes) == (-INF, INF, {"model": INF})
    assert "no range, because the error of this law is not known" in bands.meaning(band, own_laws.PAIR)


def range_of(bead, plate, speed, law="fem", thickness=5e-3):
    return cl.ImpactModel(cl.Pair(bead, plate), law).uncertainty(speed, 1e-3, thickness).restitution
