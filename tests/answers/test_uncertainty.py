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
    return dataclasses.replace(cl.material(body) if isinstance(body, str) else body, uncertainty=errors)


STEEL = cl.Material("steel", 207e9, 0.3, 7800, 4e8, kind="metal")
COPPER = cl.Material("copper", 124e9, 0.34, 8960, 90e6, kind="metal", hardening=(292e6, 0.31), rate=(0.025, 1.0))
ELASTIC = {"youngs_modulus": 0.05, "poissons_ratio": 0.05, "density": 0.02}
CERAMIC = cl.Material("ceramic", 300e9, 0.22, 3900, kind="ceramic", uncertainty=ELASTIC)
UNCERTAIN = {
    "steel": known_to(STEEL, **ELASTIC, yield_strength=0.2),
    "ceramic": CERAMIC,
    "hardening": known_to(dataclasses.replace(COPPER, rate=None), **ELASTIC, yield_strength=0.1, hardening=0.15),
}


def drawn(body, deviates):
    """Take an error of each number of a body from the front of a list."""
    for name, error in body.uncertainty.items():
        value, factor = getattr(body, name), math.exp(error * deviates.pop(0))
        value = (factor * value[0], value[1]) if isinstance(value, tuple) else factor * value
        body = dataclasses.replace(body, **{name: value})
    return body


@pytest.mark.parametrize(
    ("bead", "plate", "speed", "thickness", "size_errors"),
    [
        ("steel", "ceramic", 3.0, 1.5e-3, (0.02, 0.02, 0.05)),
        ("ceramic", "hardening", 5.0, INF, (0.0, 0.02, 0.05)),
        ("steel", "steel", 0.1, 0.8e-3, (0.1, 0.0, 0.05)),
        ("ceramic", "steel", "next to yield", 1.5e-3, (0.0, 0.0, 0.0)),
    ],
    ids=["ideal", "half-space", "both bodies", "next to yield"],
)
def test_the_band_is_that_of_random_pairs(bead, plate, speed, thickness, size_errors):
    """Of 512 of a Sobol sequence, whose quantiles err less than those of 2000 independent ones."""
    pair, radius = cl.Pair(UNCERTAIN[bead], UNCERTAIN[plate]), 1e-3
    model = cl.ImpactModel(pair)
    if speed == "next to yield":
        speed = 1.1 * model.yield_speed(radius, thickness)
    same = bead == plate  # one material errs alike in both bodies
    count = len(pair.sphere.uncertainty) + (0 if same else len(pair.plate.uncertainty))
    hits, deviates = [], norm.ppf(qmc.Sobol(count + 4, rng=3).random(512))
    for row in deviates:
        left = list(row[:count])
        sphere = drawn(pair.sphere, left)
        other = cl.ImpactModel(cl.Pair(sphere, sphere if same else drawn(pair.plate, left)))
        hit = other.solve(*(np.exp(row[count : count + 3] * size_errors) * [speed, radius, thickness]), rtol=1e-8)
        hits.append([hit.restitution, hit.contact_time, hit.peak_force])
    flat = cl.Rebound(**{name: np.ravel(one) for name, one in vars(model.solve(speed, radius, thickness)).items()})
    law = law_errors.law_errors(model.force_law, pair, flat, np.array([radius / thickness]))
    wide = np.array(hits) + law.T * deviates[:, -1:]
    wide[:, 0] = np.clip(wide[:, 0], 0.0, 1.0)
    low, high = np.quantile(wide, norm.cdf([-1.0, 1.0]), axis=0)
    names = "speed_error", "radius_error", "thickness_error"
    bands = model.uncertainty(speed, radius, thickness, **dict(zip(names, size_errors, strict=True)))
    for n, band in enumerate(vars(bands).values()):
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
    steel = known_to(STEEL, yield_strength=0.2)
    alike, apart = (range_of(steel, plate, 2.0) for plate in (steel, dataclasses.replace(steel, name="other")))
    assert list(alike.causes) == ["yield strength of both bodies", "model"]
    parts = [apart.causes[f"yield strength of {body}"] for body in ("the bead", "the plate")]
    assert alike.causes["yield strength of both bodies"] == pytest.approx(sum(parts), rel=0.1)
    assert apart.high - apart.low < 0.9 * (alike.high - alike.low)


def test_a_number_that_follows_from_the_hardness_has_an_error_too():
    errors = {"hardness": 0.1, "hardening": 0.1}
    body = cl.Material("h", 124e9, 0.34, 8960, kind="metal", hardness=1e9, hardening=0.3, uncertainty=errors)
    causes = range_of(body, "glass", 3.0).causes
    assert causes["hardness of the bead"] > causes["hardening of the bead"] > 0.01


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
