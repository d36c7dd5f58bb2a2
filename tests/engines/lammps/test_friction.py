"""Friction between beads and walls in LAMMPS: against integration, on inclines, in mid-contact."""

import math

import lammps_box as box
import metal
import numpy as np
import polymer
import pytest
from lammps_box import R, above, attach, flat, make, scene, state

import contactlaw as cl
from contactlaw.engines.lammps import Tabulated, Translation

MODELS = {
    "myc": cl.ImpactModel(box.PAIR, law="myc"),
    "fem": cl.ImpactModel(cl.Pair("stainless-steel-304", "glass")),
    "rate": metal.MODEL,
}
PSI = np.array([0.1, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0])
MU = 0.2


def slid(model, thickness, speed, steps):
    """Sliding speeds after impacts that came with PSI, in mu V0."""
    dt = float(model.solve(speed, R, thickness).contact_time) / steps
    places = [above(3.3 * dt * speed, x=0.008 * n - 0.036) for n in range(PSI.size)]
    along = np.column_stack((PSI * MU * speed, 0 * PSI, -speed + 0 * PSI))
    density = model.pair.sphere.density
    lmp, _ = scene(model, [flat(thickness)], places, along, friction=MU, dt=dt, density=density)
    lmp.command(f"run {int(1.2 * steps) + 8}")
    now = state(lmp)
    assert (now["v"][:, 2] > 0).all()
    return (now["v"][:, 0] - R * now["omega"][:, 1]) / (MU * speed)


@pytest.mark.parametrize("law", MODELS)
@pytest.mark.parametrize(("thickness", "speed"), [(math.inf, 2.0), (1e-3, 5.0), (0.5e-3, 3.0)])
def test_sliding_speed_is_that_of_the_integration(law, thickness, speed):
    model = MODELS[law]
    exact = model.oblique(speed, PSI * MU * speed, R, thickness, MU, method="solve").sliding_speed
    # with a rate 0.0097 are left on the thin plate
    for steps, bound in ((50, 0.012), (100, 0.012 if law == "rate" else 0.008)):
        error = slid(model, thickness, speed, steps) - exact / (MU * speed)
        assert np.abs(error).max() < bound


@pytest.mark.parametrize("share", [0.97, 1.03, *(pytest.param(far, marks=pytest.mark.long) for far in (0.5, 2.0))])
@pytest.mark.parametrize("thickness", [0.5e-3, math.inf])
def test_a_bead_that_cannot_roll_rests_on_an_incline_or_slides(share, thickness):
    """On the half-space, which takes no energy, it jumps and creeps by 1e-9 R a step for ever."""
    slope, g, dt, steps = math.atan(MU * share), 9.81, 2e-7, 100_000
    lmp = make([above(1e-9)], (0, 0, 0), dt=dt)
    down = f"{math.sin(slope)!r} 0 {-math.cos(slope)!r}"
    lmp.commands_string(f"unfix move\nunfix gravity\nfix move all nve\nfix tilt all gravity {g} vector {down}")
    attach(lmp, MODELS["myc"], [flat(thickness)], friction=MU, records=10_000)
    lmp.command(f"run {steps}")
    now = state(lmp)
    pulled = g * (math.sin(slope) - MU * math.cos(slope)) * steps * dt
    if share > 1.0:
        assert now["v"][0, 0] == pytest.approx(pulled, rel=0.08 if share < 1.1 else 0.01)
    else:
        assert abs(now["x"][0, 0]) < (2e-4 if thickness == math.inf else 1e-5) * R
        assert abs(now["v"][0, 0]) < 1e-3 * g * steps * dt


def test_beads_struck_in_mid_contact_gain_no_energy():
    """What the tangential motion has at the end is what it came with and what the blows gave."""
    count, generator = 60, np.random.default_rng(0)
    model, dt = MODELS["myc"], 5e-8
    places = [above(1e-6, x=0.008 * (n % 8) - 0.03, y=0.008 * (n // 8) - 0.03) for n in range(count)]
    start = generator.normal(size=(count, 3)) * (2, 2, 0) - (0, 0, 5)
    lmp, _ = scene(model, [flat(1e-3)], places, start, friction=0.4, dt=dt)
    lmp.command("run 0")
    v, omega = (lmp.numpy.extract_atom(name) for name in ("v", "omega"))

    def energy():
        """Tangential kinetic energy of each bead over its mass, with spin."""
        return 0.5 * (v[:count, :2] ** 2).sum(axis=1) + 0.2 * R**2 * (omega[:count] ** 2).sum(axis=1)

    held = energy()
    for _ in range(30):
        lmp.command("run 10 post no")
        before = energy()
        v[:count] += generator.normal(size=(count, 3)) * (1, 1, 2)
        omega[:count, :2] += generator.normal(size=(count, 2)) / R
        held += energy() - before
    lmp.commands_string("velocity all set NULL NULL 5\nrun 300")
    assert (state(lmp)["x"][:, 2] > R).all()
    assert (energy() <= held + 1e-9).all()
    assert (energy() < 0.9 * held).sum() > 20


MOTIONS = {
    "none": None,
    "vibration": box.Vibration((2e-4, 1e-4, 5e-5), 500.0),
    "translation": Translation((1.0, 0.5, 2.0)),
    "rotation": box.Rotation((0, -1, 0), 30.0, (-0.06, 0, 0)),
    # its speed jumps in mid-contact, and energy that is lost then is not restored
    "table": Tabulated([0.0, 4e-6, 7e-6], [[0, 0, 0], [0, 0, 4e-6], [0, 0, 13e-6]]),
}


@pytest.mark.parametrize("thickness", [1e-3, math.inf])  # parted at the last push, or not
@pytest.mark.parametrize("name", MOTIONS)
def test_the_record_accounts_for_all_energy(name, thickness):
    """Spinning beads that hit a plate at 45 to 85 degrees, one impact each where it moves evenly."""
    model, count, generator = MODELS["fem"], 96, np.random.default_rng(1)
    angle, turn = np.radians(generator.uniform((45.0, 0.0), (85.0, 360.0), (count, 2))).T
    start = 5.0 * np.column_stack((np.sin(angle) * np.cos(turn), np.sin(angle) * np.sin(turn), -np.cos(angle)))
    places = [above(2e-6, x=0.01 * (n % 10) - 0.045, y=0.01 * (n // 10) - 0.045) for n in range(count)]
    plate, density = flat(thickness, motion=MOTIONS[name]), model.pair.sphere.density
    lmp, plates = scene(model, [plate], places, start, friction=0.3, dt=5e-8, density=density)
    lmp.command("run 0")
    spin = lmp.numpy.extract_atom("omega")[:count]
    spin[:] = generator.normal(size=(count, 3)) * 3.0 / R
    mass = lmp.numpy.extract_atom("rmass")[0]

    def energy():
        now = state(lmp)
        return 0.5 * mass * ((now["v"] ** 2).sum(1) + 0.4 * R**2 * (now["omega"] ** 2).sum(1))

    before = energy()
    came = state(lmp)
    lmp.command("run 1500")
    rows, now, lost = np.sort(plates.collisions(), order="bead"), state(lmp), before - energy()
    assert rows["friction_energy"].sum() > 0.4 * np.abs(lost).sum()
    recorded = box.lost(rows) + rows["friction_energy"] - rows["wall_work"]
    bound = 1e-3 if name == "table" else 1e-10
    assert lost == pytest.approx(np.bincount(rows["bead"] - 1, recorded, count), abs=bound * before.min())
    if name == "table":
        return
    assert (rows["bead"] == np.arange(1, count + 1)).all() and (rows["kind"] == 0).all()
    assert (name == "none") == (not rows["wall_work"].any())
    assert now["omega"] == pytest.approx(np.stack([rows[f"spin_{x}"] for x in "xyz"], 1), rel=1e-9)
    if name == "none":
        slides = [b["v"][:, :2] - R * b["omega"][:, 1::-1] * (1, -1) for b in (came, now)]
        size = np.linalg.norm(slides[0], axis=1)
        assert rows["sliding_speed"] == pytest.approx(size, rel=1e-9)
        after = (slides[0] * slides[1]).sum(axis=1) / size
        assert rows["sliding_speed_after"] == pytest.approx(after, abs=1e-9)


@pytest.mark.parametrize("normal", [(0, 0, 1), (1, 1, 1), (1, 0, 0), (-0.6, 0.64, 0.48)])
def test_friction_does_nothing_to_a_bead_that_does_not_slide(normal):
    """Nor to its place: a direction along the wall is needed, and there is none to follow."""
    n = np.array(normal) / np.linalg.norm(normal)
    a = np.cross(n, (0.3, -0.5, 0.8))
    a /= np.linalg.norm(a)
    b = np.cross(n, a)
    plate = box.Plate(0.01 * (-a - b), 0.02 * a, 0.02 * b, 1e-3)
    ends = []
    for friction in (0.0, 0.5):
        _, now = box.dropped(MODELS["myc"], [plate], (R + 2e-6) * n, -5 * n, friction=friction)
        ends.append(np.concatenate((now["x"], now["v"], R * now["omega"])))
    assert ends[1] == pytest.approx(ends[0], abs=1e-7)  # of 5 m/s; without a direction it is NaN


def test_no_slip_of_a_body_with_losses_is_larger_than_coulomb_allows():
    bead = {"radius": 1e-3, "density": 1200, "friction": 0.3, "dt": 2e-7}
    _, now = box.dropped(polymer.WEAK_MODEL, [flat(5e-3)], (0, 0, 1.1e-3), (5, 0, -3), **bead)
    x, _, z = now["v"][0]
    assert 0.29 * (3.0 + z) < 5.0 - x < 0.3 * (3.0 + z) * (1.0 + 1e-9)
