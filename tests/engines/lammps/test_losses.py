"""Bodies with losses in LAMMPS: rebounds, and the account of their energy."""

import math

import lammps_box as box
import polymer
import pytest

from contactlaw.softsphere import time_step


@pytest.mark.parametrize("model", polymer.MODELS, ids=lambda model: repr(model.pair))
def test_drops_are_those_of_the_solver(model):
    for speed, radius, thickness in polymer.DROPS[:2]:
        dt = time_step(model, speed, radius, thickness, 1e-4)
        plate = box.flat(thickness, width=0.03)
        place = box.above(5.0 * dt * speed, x=plate.corner[0] + 0.015, radius=radius)
        (row,), _ = box.dropped(
            model,
            [plate],
            [place],
            [(0.0, 0.0, -speed)],
            radius=radius,
            dt=dt,
            steps=1000,
            density=model.pair.sphere.density,
        )
        hit = model.solve(speed, radius, thickness)
        energy = 0.5 * 4 / 3 * math.pi * radius**3 * model.pair.sphere.density * speed**2
        assert row["restitution"] == pytest.approx(hit.restitution, rel=3e-3)
        assert row["contact_time"] == pytest.approx(hit.contact_time, rel=3e-3)
        assert row["peak_force"] == pytest.approx(hit.peak_force, rel=3e-3)
        assert row["other_energy"] / energy == pytest.approx(hit.other_fraction, abs=3e-3)
        assert box.lost(row) == pytest.approx(energy * (1 - row["restitution"] ** 2), rel=1e-9)
        assert row["flags"] == hit.flags


def test_no_slip_is_larger_than_coulomb_allows():
    bead = {"radius": 1e-3, "density": 1200, "friction": 0.3, "dt": 2e-7}
    _, now = box.dropped(polymer.WEAK_MODEL, [box.flat(5e-3)], (0, 0, 1.1e-3), (5, 0, -3), **bead)
    x, _, z = now["v"][0]
    assert 0.29 * (3.0 + z) < 5.0 - x < 0.3 * (3.0 + z) * (1.0 + 1e-9)
