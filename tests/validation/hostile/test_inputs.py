"""Part of the campaign of random impacts; the whole: `python -m validation.hostile inputs`."""

from validation.hostile import inputs


def test_impacts_of_any_size_are_answered_alike_or_refused():
    assert list(inputs.faults(8_000, seed=1)) == []
