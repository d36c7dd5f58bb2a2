"""The C header of a pair with a rate of strain: each impact has its own strength."""

import dataclasses

import header
import metal
import numpy as np
import pytest

import contactlaw as cl


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return header.Library(tmp_path_factory.mktemp("header"), metal.MODEL)


@pytest.mark.parametrize(("radius", "thickness", "speed"), metal.DROPS)
def test_an_impact_is_that_of_the_pair_at_its_strength(radius, thickness, speed, library):
    at, one = (speed, radius, thickness), metal.at_strength(speed, radius)
    hit = one.solve(*at)
    assert hit.restitution > 1.01 * cl.ImpactModel(metal.PLAIN).restitution(*at)
    for name in ("looked_up", "rebounds", "drops"):
        assert library(name, *at) == pytest.approx(hit.restitution, rel=2e-3), name
    assert library("kept", *at) == pytest.approx(1.0, abs=1e-7)
    assert library("time_of", *at) == pytest.approx(hit.contact_time, rel=2e-3)
    slid = one.oblique(speed, 1.0, radius, thickness, 0.2, method="solve").sliding_speed
    assert library("slides", *at) == pytest.approx(slid, abs=5e-3 * 0.2 * speed)


def test_it_says_what_it_is(library):
    text = library.text
    assert len(text) < 500_000
    said = " ".join(line.strip(" *") for line in text.splitlines()[:14])
    assert "2.05e+08 Pa, hardening 3e+08 Pa and 0.4, rate 0.07 above 1 1/s" in said
    assert text.count("table of COR at") == 4
    assert np.isnan(library("looked_up", 1.0, 1e-3, 1e-5))


@pytest.mark.parametrize("other_rate", [None, (0.02, 1.0)])
def test_a_table_is_refused_where_another_body_comes_to_yield(other_rate, tmp_path):
    """Its COR was wrong by 0.014."""
    other = dataclasses.replace(metal.PLAIN.sphere, yield_strength=300e6, rate=other_rate)
    model = cl.ImpactModel(cl.Pair(metal.PAIR.sphere, other))
    with pytest.raises(ValueError, match=r"another body may yield.*contactlaw_rebound"):
        cl.export.header(tmp_path / "contactlaw.h", model)
    cl.export.header(tmp_path / "contactlaw.h", model, table="none")


def test_a_header_is_refused_where_one_body_far_outgrows_the_other(tmp_path):
    """The few laws that it had for such pairs knew the rate of the weaker body alone."""
    with pytest.raises(ValueError, match="above 500000.*a rate for one of two bodies"):
        cl.export.header(tmp_path / "contactlaw.h", cl.ImpactModel(metal.STEEP), "none")
