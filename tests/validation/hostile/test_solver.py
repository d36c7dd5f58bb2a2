"""Random impacts come to an end when they are integrated: a part of the campaign."""

from validation.hostile import solver


def test_random_impacts_come_to_an_end():
    assert list(solver.faults(40_000, seed=2)) == []
