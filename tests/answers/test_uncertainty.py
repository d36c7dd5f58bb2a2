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
STIFF = {"youngs_modulus": 0.03, "poissons_ratio": 0.05, "density": 0.02}


def known_to(body, **errors):
    body = cl.material(body) if isinstance(body, str) else body
    return dataclasses.replace(body, uncertainty=errors)


def steel(name, strength, error):
    return cl.Material(name, 207e9, 0.3, 7800, strength, kind="metal", uncertainty={"yield_strength": error})


COPPER = cl.Material("copper", 124e9, 0.34, 8960, 90e6, kind="metal", hardening=(292e6, 0.31), rate=(0.025, 1.0))
# name: bead, plate, speeds, thicknesses for a bead of 1 mm, errors of speed, radius, thickness
CASES = {
    "the bead flows": (
        known_to("stainless-steel-304", yield_strength=0.3, **STIFF),
        known_to("soda-lime-glass", **STIFF),
        [0.1, 2.0],
        [0.4e-3, 2e-3],
        (),
    ),
    "flow begins": (
        known_to("gamma-alumina", yield_strength=0.2, youngs_modulus=0.1),
        "glass",
        [4.0, 6.0, 8.0],
        [0.8e-3, 2e-3, INF],
        (),
    ),
    "elastic, near 0 and 1": (
        known_to("soda-lime-glass", youngs_modulus=0.3),
        "alumina",
        [1.0],
        [0.3e-3, 1e-3, 6e-3],
        (0.1, 0.05, 0.1),
    ),
    "either may flow": (steel("a", 4e8, 0.2), steel("b", 4.5e8, 0.2), [2.0], [0.8e-3, 5e-3], ()),
    "hardening and rate": (
        known_to(COPPER, yield_strength=0.2, hardening=0.15, rate=0.3),
        "glass",
        [1.0],
        [2e-3],
        (0.0, 0.0, 0.05),
    ),
}

SLOW = "the bead flows", "either may flow", "hardening and rate"


def drawn(body, deviates):
    """Take an error of each number of a body from the front of a list."""
    for name, error in body.uncertainty.items():
        value, factor = getattr(body, name), math.exp(error * deviates.pop(0))
        value = (factor * value[0], value[1]) if isinstance(value, tuple) else factor * value
        body = dataclasses.replace(body, **{name: value})
    return body


@pytest.mark.parametrize(
    "case", [pytest.param(name, marks=pytest.mark.long) if name in SLOW else name for name in CASES]
)
def test_the_band_is_that_of_random_pairs(case):
    """Of 512 of a Sobol sequence, whose quantiles err less than those of 2000 independent ones."""
    bead, plate, speed, thickness, sizes = CASES[case]
    pair = cl.Pair(bead, plate)
    speed = np.array(speed)[:, None]
    count = len(pair.sphere.uncertainty) + len(pair.plate.uncertainty)
    rows = norm.ppf(qmc.Sobol(count + 4, rng=3).random(512))
    answers = "restitution", "contact_time", "peak_force"
    hits = []
    for row in rows:
        deviates, own = list(row[:count]), row[count : count + 3] * (sizes or (0, 0, 0))
        other = cl.ImpactModel(cl.Pair(drawn(pair.sphere, deviates), drawn(pair.plate, deviates)))
        v, r, h = np.exp(own)
        hit = other.solve(v * speed, r * 1e-3, h * np.array(thickness))
        hits.append([getattr(hit, name) for name in answers])
    model = cl.ImpactModel(pair)
    hit = model.solve(speed, 1e-3, thickness)
    flat = cl.Rebound(**{name: np.ravel(values) for name, values in vars(hit).items()})
    ratio = np.broadcast_to(1e-3 / np.array(thickness), np.shape(hit.flags)).ravel()
    law = law_errors.law_errors(model.force_law, pair, flat, ratio).reshape(3, *np.shape(hit.flags))
    found = np.array(hits) + law * rows[:, -1, None, None, None]
    found[:, 0] = np.clip(found[:, 0], 0.0, 1.0)
    expected = np.quantile(found, norm.cdf([-1.0, 1.0]), axis=0)
    named = dict(zip(("speed_error", "radius_error", "thickness_error"), sizes, strict=False))
    bands = model.uncertainty(speed, 1e-3, thickness, **named)
    for n, name in enumerate(answers):
        low, high = expected[:, n]
        band = getattr(bands, name)
        off = np.abs([band.low - low, band.high - high]) / (0.5 * (high - low))
        # flow that begins is not all that the overload decides
        assert off.max() < (0.15 if case == "flow begins" else 0.1), name


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
    with pytest.raises(ValueError, match="uncertainty: got 1.0; youngs_modulus is too large.*material 'w'"):
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
    found = cl.ImpactModel(own_laws.PAIR, law=law).thickness(0.6, 12.0, 0.9e-3)
    assert (found.low.tolist(), found.high.tolist()) == ([-INF], [INF])
    assert "no range, because the error of this law is not known" in bands.meaning(found.band, own_laws.PAIR)


def range_of(bead, plate, speed, law="fem"):
    return cl.ImpactModel(cl.Pair(bead, plate), law).uncertainty(speed, 1e-3, 5e-3).restitution
