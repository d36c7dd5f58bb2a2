"""Bands of the COR, contact time and peak force against random pairs, and their limits."""

import dataclasses
import math

import numpy as np
import own_laws
import pytest
from scipy.stats import norm, qmc

import contactlaw as cl
from contactlaw.answers import law_errors
from contactlaw.cli.parts import bands
from validation.accuracy import acceptance

INF = math.inf


def known_to(body, **errors):
    body = cl.material(body) if isinstance(body, str) else body
    return dataclasses.replace(body, uncertainty=errors)


def steel(name, strength, error):
    return cl.Material(name, 207e9, 0.3, 7800, strength, kind="metal", uncertainty={"yield_strength": error})


COPPER = cl.Material("copper", 124e9, 0.34, 8960, 90e6, kind="metal", hardening=(292e6, 0.31), rate=(0.025, 1.0))


def random_body(rng, yields):
    """A metal or a ceramic with errors; of the metals some harden, and of these half have a rate."""
    modulus = math.exp(rng.uniform(math.log(60e9), math.log(400e9)))
    numbers = {"youngs_modulus": modulus, "poissons_ratio": rng.uniform(0.2, 0.35), "density": rng.uniform(2300, 8500)}
    errors = {"youngs_modulus": rng.choice([0.02, 0.05, 0.15]), "poissons_ratio": 0.05, "density": 0.02}
    if yields:
        strength = modulus * math.exp(rng.uniform(-math.log(1500), -math.log(150)))
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
        value, factor = getattr(body, name), math.exp(error * deviates.pop(0))
        value = (factor * value[0], value[1]) if isinstance(value, tuple) else factor * value
        body = dataclasses.replace(body, **{name: value})
    return body


@pytest.mark.parametrize(
    "case", [1, 5, 18, *(pytest.param(n, marks=pytest.mark.long) for n in range(6, 54) if n != 18)]
)
def test_the_band_is_that_of_random_pairs(case):
    """Of 512 of a Sobol sequence, whose quantiles err less than those of 2000 independent ones.

    Every third pair is next to yield.
    """
    rng = np.random.default_rng(case)
    pair = cl.Pair(random_body(rng, rng.random() < 0.75 or case % 3 == 0), random_body(rng, rng.random() < 0.4))
    model, radius, thickness = cl.ImpactModel(pair), 1e-3, 1e-3 * rng.choice([0.4, 0.8, 1.5, 3.0, 10.0, INF])
    speed = math.exp(rng.uniform(math.log(0.05), math.log(8.0)))
    if case % 3 == 0:
        speed = model.yield_speed(radius, max(thickness, 0.8e-3)) * math.exp(rng.uniform(-0.35, 0.35))
    sizes = np.array([rng.choice([0.0, 0.02, 0.1]), rng.choice([0.0, 0.02]), rng.choice([0.0, 0.05])])
    count = len(pair.sphere.uncertainty) + len(pair.plate.uncertainty)
    hits, deviates = [], norm.ppf(qmc.Sobol(count + 4, rng=3).random(512))
    for row in deviates:
        left = list(row[:count])
        other = cl.ImpactModel(cl.Pair(drawn(pair.sphere, left), drawn(pair.plate, left)))
        hit = other.solve(*(np.exp(row[count : count + 3] * sizes) * [speed, radius, thickness]), rtol=1e-8)
        hits.append([hit.restitution, hit.contact_time, hit.peak_force])
    flat = cl.Rebound(**{name: np.ravel(one) for name, one in vars(model.solve(speed, radius, thickness)).items()})
    law = law_errors.law_errors(model.force_law, pair, flat, np.array([radius / thickness]))
    found = np.array(hits) + law.T * deviates[:, -1:]
    found[:, 0] = np.clip(found[:, 0], 0.0, 1.0)
    low, high = np.quantile(found, norm.cdf([-1.0, 1.0]), axis=0)
    names = "speed_error", "radius_error", "thickness_error"
    bands = model.uncertainty(speed, radius, thickness, **dict(zip(names, sizes.tolist(), strict=True)))
    for n, band in enumerate(vars(bands).values()):
        off = np.abs([band.low - low[n], band.high - high[n]]) / (0.5 * (high[n] - low[n]))
        assert off.max() < 0.15, n


def test_without_errors_only_the_law_is_uncertain():
    steel = dataclasses.replace(cl.material("stainless-steel-304"), uncertainty={})
    model = cl.ImpactModel(cl.Pair(steel, "glass"))
    bands, hit = model.uncertainty(3.0, 1e-3, 5e-3), model.solve(3.0, 1e-3, 5e-3)
    for (name, band), rms in zip(vars(bands).items(), law_errors.MODEL_ERRORS["fem"][0], strict=True):
        value = getattr(hit, name)
        assert band.causes == {"model": pytest.approx(rms * value, rel=1e-3)}
        assert (band.low, band.high) == pytest.approx((value * (1 - rms), value * (1 + rms)), rel=1e-4)


@pytest.mark.parametrize(
    ("body", "number", "error", "within"),
    [
        ("stainless-steel-304", "yield_strength", 0.2, 1e-5),
        (COPPER, "hardening", 0.15, 1e-4),
        (COPPER, "rate", 0.3, 2e-3),
    ],
    ids=["strength", "hardening", "rate"],
)
def test_one_number_alone_makes_the_band_of_its_ends(body, number, error, within):
    bead = known_to(body, **{number: error, "density": 0.0})
    at = 3.0, 1e-3, [2e-3, INF]
    cor = cl.ImpactModel(cl.Pair(bead, "glass")).uncertainty(*at).restitution
    cause = f"{number.replace('_', ' ')} of the bead"
    assert list(cor.causes) == [cause, "model"]
    low, high = (cl.ImpactModel(cl.Pair(drawn(bead, [z, 0.0]), "glass")).solve(*at).restitution for z in (-1.0, 1.0))
    width = 0.5 * abs(high - low)
    assert cor.causes[cause] == pytest.approx(width, rel=within)
    if body is not COPPER:
        assert 0.5 * (cor.high - cor.low) == pytest.approx(np.hypot(width, cor.causes["model"]), rel=0.02)


def test_one_material_errs_alike_in_both_bodies():
    one, other = steel("a", 4e8, 0.2), steel("b", 4e8, 0.2)
    alike, apart = (
        cl.ImpactModel(cl.Pair(one, plate)).uncertainty(2.0, 1e-3, 5e-3).restitution for plate in (one, other)
    )
    assert list(alike.causes) == ["yield strength of both bodies", "model"]
    parts = [apart.causes[f"yield strength of {body}"] for body in ("the bead", "the plate")]
    assert alike.causes["yield strength of both bodies"] == pytest.approx(sum(parts), rel=0.1)
    assert apart.high - apart.low < 0.9 * (alike.high - alike.low)


def test_a_number_that_follows_from_the_hardness_has_an_error_too():
    body = cl.Material(
        "h",
        124e9,
        0.34,
        8960,
        kind="metal",
        hardness=1e9,
        hardening=0.3,
        uncertainty={"hardness": 0.1, "hardening": 0.1},
    )
    causes = cl.ImpactModel(cl.Pair(body, "glass")).uncertainty(3.0, 1e-3, 5e-3).restitution.causes
    assert causes["hardness of the bead"] > causes["hardening of the bead"] > 0.01


def test_shapes_and_refusals():
    lossy = cl.Material(
        "pom",
        2.9e9,
        0.49,
        1410,
        kind="polymer",
        loss_factor=(0.9, 1e4),
        uncertainty={"loss_factor": 0.3, "poissons_ratio": 0.3},
    )
    model = cl.ImpactModel(cl.Pair(lossy, "glass"))
    bands = model.uncertainty([1.0, 2.0], 1e-3, [[1e-3], [2e-3], [INF]], thickness_error=0.1)
    for band in vars(bands).values():
        assert band.low.shape == band.causes["loss factor of the bead"].shape == (3, 2)
        assert (band.causes["thickness"][-1] == 0.0).all() and (band.low < band.high).all()
    assert isinstance(model.uncertainty(1.0, 1e-3, 1e-3).restitution.low, float)
    assert model.uncertainty([], 1e-3, 1e-3).peak_force.high.shape == (0,)
    with pytest.raises(ValueError, match="speed_error: got 5.0; must lie between 0 and 1"):
        model.uncertainty(1.0, 1e-3, 1e-3, speed_error=5.0)
    foam = cl.Material("w", 600e9, 0.2, 2500, kind="ceramic", uncertainty={"youngs_modulus": 1.0})
    with pytest.raises(ValueError, match="material 'w'"):
        cl.ImpactModel(cl.Pair(foam, "glass")).uncertainty(1.0, 1e-3, 1e-3)


def test_the_stated_errors_of_metals_that_harden_are_those_beside_finite_elements():
    found = [one for name in ("metals", "bodies") for one in acceptance.rows([name])[name].counted]
    rms = np.sqrt(np.mean(np.array([one.errors[:3] for one in found]) ** 2, axis=0))
    assert rms == pytest.approx(law_errors.HARDENING_ERRORS, rel=0.01)


def test_the_stated_errors_of_soft_bodies_are_those_beside_finite_elements():
    """Bodies as soft as lead, which no fit has seen."""
    found = acceptance.members(acceptance.TARGETS["bodies"]._replace(studies=("bodies_soft",)))
    errors = np.array([one.errors[:3] for one in found if not one.flagged])  # one bends its plate
    assert np.sqrt(np.mean(errors**2, axis=0)) == pytest.approx(law_errors.SOFT_ERRORS, rel=0.01)
    assert np.abs(errors[:, 0]).max() < 0.026


def test_the_range_of_a_cor_near_zero_is_as_wide_as_the_law_is_wrong():
    """It was 1e-52 to 1 where the law's error is larger than the COR."""
    steel = dataclasses.replace(cl.material("carbon-steel-1020"), uncertainty={})
    cor = cl.ImpactModel(cl.Pair(steel, "glass")).uncertainty(1.0, 1e-3, 0.25e-3).restitution
    assert cor.low < 1e-3 and 0.0 < cor.high < 0.006
    assert cor.causes == {"model": pytest.approx(0.0169 * 0.3)}


@pytest.mark.parametrize("law", [own_laws.own(), own_laws.measured()], ids=["own", "measured"])
def test_a_law_whose_errors_nobody_knows_has_no_range(law):
    band = range_of(*own_laws.PAIR.given, 12.0, law)
    assert (band.low, band.high, band.causes) == (-INF, INF, {"model": INF})
    assert "no range, because the error of this law is not known" in bands.meaning(band, own_laws.PAIR)


def range_of(bead, plate, speed, law="fem"):
    return cl.ImpactModel(cl.Pair(bead, plate), law).uncertainty(speed, 1e-3, 5e-3).restitution
