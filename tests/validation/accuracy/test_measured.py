"""Published measurements beside the model."""

from validation.accuracy import measured


def test_every_source_says_where_its_numbers_come_from_and_agrees():
    for source in measured.sources():
        assert len(source.reference) > 40
        one = source.rebounds
        assert ((one.restitution_error > 0.0) & (one.restitution_error < one.restitution)).all()
        assert (one.restitution < 1.0).all() and (one.radius > 1e-5).all() and (one.radius < 0.1).all()
        assert (one.thickness > one.radius).all() and (one.speed < 100.0).all()
        assert source.compared().probability > 0.3, source.title
