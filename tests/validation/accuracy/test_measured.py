"""Published measurements beside the model."""

import numpy as np

from validation.accuracy import measured


def test_every_source_says_where_its_numbers_come_from():
    for source in measured.sources():
        assert len(source.reference) > 40
        one = source.rebounds
        assert ((one.restitution_error > 0.0) & (one.restitution_error < one.restitution)).all()
        assert (one.restitution < 1.0).all() and (one.radius > 1e-5).all() and (one.radius < 0.1).all()
        assert (one.thickness > one.radius).all() and (one.speed < 100.0).all()


def test_the_measured_rebound_of_kharaz_and_others():
    """Within the errors of reading and model, added as squares, and within twice the rounding."""
    (source,) = (one for one in measured.sources() if "Kharaz, Gorham" in one.reference)
    assert source.pair.sphere.youngs_modulus == 380e9 and source.pair.plate.density == 2500.0
    found, error = source.compared(), source.rebounds.restitution_error[0]
    off = found.restitution[0] - source.rebounds.restitution[0]
    assert abs(off) < np.hypot(0.5 * (found.band.high - found.band.low)[0], error)
    assert found.chi_squared < 1.0 and abs(off) < 2.0 * error


def test_all_agree_within_the_errors_of_what_is_known():
    for source in measured.sources():
        assert source.compared().probability > 0.3, source.title
