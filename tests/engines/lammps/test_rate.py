"""A pair with a rate of strain in LAMMPS: the record, moving plates and friction."""

import dataclasses

import lammps_box as box
import metal
import numpy as np
import pytest

import contactlaw as cl
from contactlaw.engines.lammps import Translation
from contactlaw.softsphere import time_step

MASS = 4 / 3 * np.pi * metal.PAIR.sphere.density


def dropped(model, radius, drops, rising=0.0, along=0.0, friction=0.0):
    """Record of beads that hit plates of their own at these speeds, plates that may rise."""
    motion = Translation((0.0, 0.0, rising)) if rising else None
    plates = [box.flat(h, x=0.01 * n - 0.05, width=0.008, motion=motion) for n, (h, _) in enumerate(drops)]
    dt = min(time_step(model, v, radius, h, 1e-4) for h, v in drops)
    gap = 5.0 * dt * min(v for _, v in drops)
    places = [box.above(gap, x=plate.corner[0] + 0.004, radius=radius) for plate in plates]
    rows, _ = box.dropped(
        model,
        plates,
        places,
        [(along, 0.0, rising - v) for _, v in drops],
        radius=radius,
        dt=dt,
        steps=int(4e-5 * (radius / 1e-3) / dt) + 100,
        friction=friction,
        density=metal.PAIR.sphere.density,
    )
    return np.sort(rows, order="bead")


@pytest.mark.parametrize("radius", [1e-3, 0.2e-3])
@pytest.mark.parametrize("rising", [0.0, 1.5])
def test_drops_are_those_of_the_pair_at_its_strength(radius, rising):
    drops = [(h, v) for r, h, v in metal.DROPS if r == radius]
    rows = dropped(metal.MODEL, radius, drops, rising)
    assert (rows["kind"] == 0).all()
    for row, (h, v) in zip(rows, drops, strict=True):
        assert row["approach_speed"] == pytest.approx(v, rel=1e-9)
        hit = metal.at_strength(v, radius).solve(v, radius, h)
        plain = cl.ImpactModel(metal.PLAIN).solve(v, radius, h)
        energy = 0.5 * MASS * radius**3 * v**2
        assert row["restitution"] == pytest.approx(hit.restitution, rel=2e-3)
        assert hit.restitution > 1.01 * plain.restitution
        assert row["contact_time"] == pytest.approx(hit.contact_time, rel=2e-3)
        assert row["peak_force"] == pytest.approx(hit.peak_force, rel=3e-3)
        for channel in ("plastic", "wave", "other"):
            share = row[f"{channel}_energy"] / energy
            assert share == pytest.approx(getattr(hit, f"{channel}_fraction"), abs=4e-3)
        assert box.lost(row) == pytest.approx(energy * (1 - row["restitution"] ** 2), rel=1e-9)


def test_friction_is_that_of_the_pair_at_its_strength():
    v, mu, along = 3.0, 0.2, 1.0
    (row,) = dropped(metal.MODEL, 1e-3, [(5e-3, v)], along=along, friction=mu)
    hit = metal.at_strength(v, 1e-3).oblique(v, along, 1e-3, 5e-3, mu, method="solve")
    assert row["sliding_speed_after"] == pytest.approx(hit.sliding_speed, abs=0.015 * mu * v)
    assert row["restitution"] == pytest.approx(hit.restitution, rel=2e-3)


def test_a_type_of_beads_is_another_with_another_rate():
    """A bead that changes its type in contact was taken for the same."""
    steel = dataclasses.replace(metal.PAIR.sphere, rate=(0.0701, 1.0))
    other = cl.ImpactModel(cl.Pair(steel, "glass"))
    lmp = box.quiet(box.BOX.format(processors="* * *").replace("create_box 1", "create_box 2"))
    contacts = box.attach(lmp, {1: metal.MODEL, 2: other}, [box.flat(1e-3)])
    rows = contacts._contacts.scene.plate_rows
    assert rows["alike"][0, 0] != rows["alike"][1, 0]
    lmp.close()
