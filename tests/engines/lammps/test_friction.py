"""Friction between beads and walls in LAMMPS: against integration, on inclines, in mid-contact."""

import math

import lammps_box as box
import metal
import numpy as np
import polymer
import pytest
from lammps_box import R, above, flat, scene, state

import contactlaw as cl
from contactlaw.engines.lammps import Rotation, Tabulated, Translation, Vibration

MYC, FEM = cl.ImpactModel(box.PAIR, law="myc"), cl.ImpactModel(cl.Pair("stainless-steel-304", "glass"))
PSI, MU = np.array([0.1, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0]), 0.2


def places(count, gap=2e-6):
    return [above(gap, x=0.01 * (n % 10) - 0.045, y=0.01 * (n // 10) - 0.045) for n in range(count)]


@pytest.mark.parametrize("model", [MYC, FEM, metal.MODEL], ids=["myc", "fem", "rate"])
@pytest.mark.parametrize(("thickness", "speed"), [(math.inf, 2.0), (1e-3, 5.0), (0.5e-3, 3.0)])
def test_sliding_speed_is_that_of_the_integration(model, thickness, speed):
    """Of impacts that come with PSI, in mu V0."""
    exact = model.oblique(speed, PSI * MU * speed, R, thickness, MU, method="solve").sliding_speed
    # with a rate 0.0097 are left on the thin plate
    for steps, bound in ((50, 0.012), (100, 0.012 if model is metal.MODEL else 0.008)):
        dt = float(model.solve(speed, R, thickness).contact_time) / steps
        along = np.column_stack((PSI * MU * speed, 0 * PSI, -speed + 0 * PSI))
        bead = {"friction": MU, "dt": dt, "density": model.pair.sphere.density, "steps": int(1.2 * steps) + 8}
        rows, _ = box.dropped(model, [flat(thickness)], places(10, 3.3 * dt * speed), along, **bead)
        assert np.abs(rows["sliding_speed_after"] - exact).max() < bound * MU * speed


@pytest.mark.parametrize("softening", [1.0, 1000.0])
@pytest.mark.parametrize(("friction", "angle"), [(0.3, 0.2), (0.1, 0.6), (0.5, 1.0)])
def test_a_bead_rolls_or_slides_down_an_incline(friction, angle, softening):
    dt = 2e-7 if softening == 1.0 else 2e-6
    options = {"dt": dt, "friction": friction, "softening": softening}
    lmp, walls = scene(MYC, None, above(1e-8), (0, 0, 0), **options)
    lmp.command(f"fix gravity all gravity 9.81 vector {math.sin(angle)} 0 {-math.cos(angle)}")
    lmp.command(f"run {round(0.04 / dt)}")
    rolls = math.tan(angle) < 3.5 * friction
    slides = 9.81 * (math.sin(angle) - friction * math.cos(angle))
    expected = 0.04 * (5 / 7 * 9.81 * math.sin(angle) if rolls else slides)
    assert state(lmp)["v"][0, 0] == pytest.approx(expected, rel=1e-6 if rolls else 1e-3)


def energy(now, mass=1.0, of=(1, 1, 1)):
    """Kinetic energy of each bead, with spin, of its motion in some directions."""
    return 0.5 * mass * ((now["v"] ** 2 * of).sum(axis=1) + 0.4 * R**2 * (now["omega"] ** 2).sum(axis=1))


def test_beads_struck_in_mid_contact_gain_no_energy():
    """What the tangential motion has at the end is what it came with and what the blows gave."""
    count, generator = 60, np.random.default_rng(0)
    start = generator.normal(size=(count, 3)) * (2, 2, 0) - (0, 0, 5)
    lmp, _ = scene(MYC, None, places(count), start, friction=0.4, dt=5e-8)
    lmp.command("run 0")
    now = {name: lmp.numpy.extract_atom(name)[:count] for name in ("v", "omega")}
    held = energy(now, of=(1, 1, 0))
    for _ in range(30):
        lmp.command("run 10 post no")
        held -= energy(now, of=(1, 1, 0))
        now["v"] += generator.normal(size=(count, 3)) * (1, 1, 2)
        now["omega"][:, :2] += generator.normal(size=(count, 2)) / R
        held += energy(now, of=(1, 1, 0))
    lmp.commands_string("velocity all set NULL NULL 5\nrun 300")
    assert (state(lmp)["x"][:, 2] > R).all()
    kept = energy(now, of=(1, 1, 0))
    assert (kept <= held + 1e-9).all() and (kept < 0.9 * held).sum() > 20


MOTIONS = {
    "none": None,
    "vibration": Vibration((2e-4, 1e-4, 5e-5), 500.0),
    "translation": Translation((1.0, 0.5, 2.0)),
    "rotation": Rotation((0, -1, 0), 30.0, (-0.06, 0, 0)),
    # its speed jumps in mid-contact, and energy that is lost then is not restored
    "table": Tabulated([0.0, 4e-6, 7e-6], [[0, 0, 0], [0, 0, 4e-6], [0, 0, 13e-6]]),
}


@pytest.mark.parametrize("thickness", [1e-3, math.inf])  # parted at the last push, or not
@pytest.mark.parametrize("name", MOTIONS)
def test_the_record_accounts_for_all_energy(name, thickness):
    """Spinning beads that hit a plate at an angle, one impact each where it moves evenly."""
    model, count, generator = FEM, 96, np.random.default_rng(1)
    start = generator.normal(size=(count, 3)) * (3, 3, 0)
    start[:, 2] = -generator.uniform(0.4, 3.5, count)
    bead = {"friction": 0.3, "dt": 5e-8, "density": model.pair.sphere.density}
    lmp, plates = scene(model, [flat(thickness, motion=MOTIONS[name])], places(count), start, **bead)
    lmp.command("run 0")
    lmp.numpy.extract_atom("omega")[:count] = generator.normal(size=(count, 3)) * 3.0 / R
    came = state(lmp)
    lmp.command("run 1500")
    rows, now = np.sort(plates.collisions(), order="bead"), state(lmp)
    before, after = (energy(one, rows["mass"][0]) for one in (came, now))
    assert rows["friction_energy"].sum() > 0.4 * np.abs(before - after).sum()
    recorded = np.bincount(rows["bead"] - 1, box.lost(rows) + rows["friction_energy"] - rows["wall_work"], count)
    bound = 1e-3 if name == "table" else 1e-10
    assert before - after == pytest.approx(recorded, abs=bound * before.min())
    if name == "table":
        return
    assert (rows["bead"] == np.arange(1, count + 1)).all() and (rows["kind"] == 0).all()
    assert (name == "none") == (not rows["wall_work"].any())
    assert now["omega"] == pytest.approx(np.stack([rows[f"spin_{x}"] for x in "xyz"], 1), rel=1e-9)


def test_no_slip_of_a_body_with_losses_is_larger_than_coulomb_allows():
    bead = {"radius": 1e-3, "density": 1200, "friction": 0.3, "dt": 2e-7}
    _, now = box.dropped(polymer.WEAK_MODEL, [flat(5e-3)], (0, 0, 1.1e-3), (5, 0, -3), **bead)
    x, _, z = now["v"][0]
    assert 0.29 * (3.0 + z) < 5.0 - x < 0.3 * (3.0 + z) * (1.0 + 1e-9)
