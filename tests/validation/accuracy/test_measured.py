"""Published measurements beside the model."""

import numpy as np
import pytest

import contactlaw as cl
from validation.accuracy import measured


def test_every_source_says_where_its_numbers_come_from():
    for source in measured.sources():
        assert len(source.reference) > 40 and source.rebounds
        for one in source.rebounds:
            assert 0.0 < one.reading_error < one.restitution < 1.0
            assert 1e-5 < one.radius < 0.1 and one.thickness > one.radius and one.speed < 100.0


def test_the_measured_rebound_of_kharaz_and_others():
    """Within the errors of reading and model, added as squares, and within twice the rounding."""
    (source,) = measured.sources()
    (one,) = source.rebounds
    assert source.pair.sphere.youngs_modulus == 380e9 and source.pair.plate.density == 2500.0
    model = cl.ImpactModel(source.pair)
    low, high = measured.band(model, one.speed, one.radius, one.thickness)
    off = model.restitution(one.speed, one.radius, one.thickness) - one.restitution
    assert abs(off) < np.hypot(0.5 * (high - low), one.reading_error)
    assert abs(off) < 2.0 * one.reading_error


def test_a_band_grows_with_each_uncertainty():
    glass = cl.material("glass")
    widths = []
    for errors in ({}, {"yield_strength": 0.1}, {"yield_strength": 0.1, "density": 0.1}):
        bead = cl.Material("bead", 200e9, 0.3, 7800, 100e6, uncertainty=errors)
        low, high = measured.band(cl.ImpactModel(cl.Pair(bead, glass)), [1.0, 3.0], 1e-3, 5e-3)
        widths.append(high - low)
    # The COR goes as the strength to the power of about 0.6.
    middle = cl.ImpactModel(cl.Pair(bead, glass)).restitution(3.0, 1e-3, 5e-3)
    assert widths[1][1] == pytest.approx(0.12 * middle, rel=0.1)
    assert np.all(np.diff(widths, axis=0) > 0.0)
