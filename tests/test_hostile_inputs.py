"""A coarse part of the campaign of random impacts; `python -m validation.hostile inputs` has all."""

from validation.hostile import inputs


def test_impacts_of_any_size_are_answered_alike_or_refused():
    assert list(inputs.faults(30_000, seed=1)) == []
