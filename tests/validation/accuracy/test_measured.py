"""Published measurements beside the model."""

import numpy as np

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
    band = model.uncertainty(one.speed, one.radius, one.thickness).restitution
    off = model.restitution(one.speed, one.radius, one.thickness) - one.restitution
    assert abs(off) < np.hypot(0.5 * (band.high - band.low), one.reading_error)
    assert abs(off) < 2.0 * one.reading_error
