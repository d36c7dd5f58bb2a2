"""Softened contacts and parcels in LAMMPS, beside the true impacts that they stand for."""

import math

import lammps_box as box
import numpy as np
import pytest

import contactlaw as cl
from contactlaw.engines.lammps import Mesh, Plate, pair_coeff
from contactlaw.engines.record import Kind
from contactlaw.softsphere import most_softening, time_step
from contactlaw.stepping.contact import CONTACT
from contactlaw.stepping.friction import FRICTION
from contactlaw.stepping.step import FIRST, WIDTH

R, SOFT, MU, ABOVE = box.R, 1000.0, 0.3, box.ABOVE
MODEL = cl.ImpactModel(box.PAIR)
PAIRS = (
    ("gamma-alumina", "glass", "myc"),
    ("bearing-steel-52100", "steel-s235", "fem"),  # both flow, by rates
    ("bearing-steel-52100", "aluminium-6061-t6", "jackson_green"),
    ("copper", "steel-s235", "thornton"),
    ("nylon-66", "steel-s235", "fem"),  # with losses
)
pytestmark = pytest.mark.filterwarnings("ignore:softening. an impact:UserWarning")  # meant to be fast


def thrown(model, thickness, speed, sliding, *, steps=30, softening=SOFT, edges=None, along=0.0, **options):
    """Impacts of beads in a row on a plate, and their kinetic energy before and after."""
    n, density = len(speed), model.pair.sphere.density
    dt = time_step(model, speed.max(), R, thickness, softening=softening) * 30 / steps
    phase = np.random.default_rng(n).random(n)
    place = np.array([(along, y, R) for y in np.linspace(-0.045, 0.045, n)])
    place[:, 2] += (1.0 + phase) * speed * dt
    velocity = np.column_stack([-sliding, np.zeros(n), -speed])
    walls = [box.flat(thickness, edges=edges)]
    steps = int(5 + 1.2 * steps * (speed.max() / speed.min()) ** 0.2)
    rows, now = box.dropped(
        model, walls, place, velocity, dt=dt, density=density, steps=steps, softening=softening, **options
    )
    mass = 4 / 3 * math.pi * density * R**3
    before = 0.5 * mass * (velocity**2).sum(axis=1)
    after = 0.5 * mass * (now["v"] ** 2).sum(axis=1) + 0.2 * mass * R**2 * (now["omega"] ** 2).sum(axis=1)
    return rows, before, after


def compare(rows, hit, friction):
    """Largest differences from the true impacts: COR, sliding speed over mu V."""
    slide = abs(rows["sliding_speed_after"] - hit.sliding_speed) / (friction * rows["approach_speed"])
    return abs(rows["restitution"] - hit.restitution).max(), slide.max()


@pytest.mark.parametrize("beads", [120, pytest.param(1000, marks=pytest.mark.long)])
@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair[2] + " " + pair[0])
def test_beads_leave_as_from_the_true_impact(pair, beads):
    model, rng = cl.ImpactModel(cl.Pair(*pair[:2]), law=pair[2], outside="solve"), np.random.default_rng(7)
    for thickness in (0.8e-3, 3e-3):
        speed = 10 ** rng.uniform(-1.0, 0.8, beads)
        slide = MU * speed * rng.uniform(0.0, 12.0, beads)
        rows, before, after = thrown(model, thickness, speed, slide, friction=MU)
        assert len(rows) == beads and (rows["kind"] == Kind.IMPACT).all()
        hit = model.oblique(rows["approach_speed"], rows["sliding_speed"], R, thickness, MU, method="solve")
        cor, sliding = compare(rows, hit, MU)
        assert cor < 1.5e-4  # most of it is the 40 steps in which the true impact is carried out
        assert sliding < 0.012  # that of eight springs, as in contacts that are not softened
        energy = 0.5 * rows["mass"] * rows["approach_speed"] ** 2
        np.testing.assert_allclose(rows["contact_time"], hit.contact_time, rtol=1e-3)
        np.testing.assert_allclose(rows["peak_force"], hit.peak_force, rtol=1e-3)
        for channel in ("plastic", "wave", "other"):
            share = getattr(hit, f"{channel}_fraction")
            np.testing.assert_allclose(rows[f"{channel}_energy"] / energy, share, atol=1e-3)
        lost = box.lost(rows) + rows["friction_energy"]
        np.testing.assert_allclose(lost, before - after, rtol=1e-10)
        assert not rows["scheme_energy"].any()
        friction_alone = int(cl.Validity.SLIDING_FLOW)
        assert (rows["flags"] == hit.flags & ~friction_alone).mean() > 0.98  # an impact at a limit


@pytest.mark.parametrize(("pair", "thickness"), [(PAIRS[0], 1e-3), (PAIRS[1], 0.25e-3)])  # COR 0.9; < 0.02
def test_no_step_and_no_softening_changes_the_cor(pair, thickness):
    model, speed = cl.ImpactModel(cl.Pair(*pair[:2]), law=pair[2], outside="solve"), np.geomspace(0.3, 5.0, 40)
    hit = model.solve(speed, R, thickness)
    for steps, softening in ((21, SOFT), (30, 10.0), (50, 1e4)):
        rows, _, _ = thrown(model, thickness, speed, 0.0 * speed, steps=steps, softening=softening)
        np.testing.assert_allclose(rows["restitution"], hit.restitution, atol=4e-5)


def test_the_edge_of_a_plate_acts_as_in_the_true_impact():
    speed, thickness, far = np.full(4, 2.0), 0.5e-3, MODEL.solve(2.0, R, 0.5e-3).restitution
    for distance, change in ((1.2e-3, 0.08), (2e-3, 0.008), (4e-3, 0.0)):
        rows, _, _ = thrown(MODEL, thickness, speed, 0.0 * speed, edges="free", along=0.05 - distance)
        hit = MODEL.solve(2.0, R, thickness, edge_distance=distance)
        np.testing.assert_allclose(rows["restitution"][1:3], hit.restitution, atol=3e-3)
        true, _, _ = thrown(
            MODEL, thickness, speed, 0.0 * speed, edges="free", along=0.05 - distance, softening=1.0, steps=60
        )
        np.testing.assert_allclose(rows["restitution"], true["restitution"], atol=3e-4)
        assert abs(hit.restitution - far) >= change


def test_no_bead_leaves_a_groove_without_a_row():
    """Where it turns from one face to the other as it leaves, and has arrived on the first alone."""
    turn, x = math.radians(159.5 / 2), np.linspace(-6e-4, 6e-4, 200)
    up, out = 0.02 * math.cos(turn), 0.02 * math.sin(turn)
    corners = [(0, -0.09, 0), (0, 0.09, 0), (out, -0.09, up), (out, 0.09, up), (-out, -0.09, up), (-out, 0.09, up)]
    faces = Mesh(corners, [(0, 2, 3), (0, 3, 1), (0, 5, 4), (0, 1, 5)], 1e-3)
    place = np.column_stack([x, np.linspace(-0.04, 0.04, x.size), np.full(x.size, R / math.sin(turn) + 3e-4)])
    dt = time_step(MODEL, 2.0, R, 1e-3, softening=100.0)
    rows, now = box.dropped(MODEL, [faces], place, (0.3, 0.1, -1.0), dt=dt, softening=100.0, steps=1500)
    assert set(rows["bead"]) == set(range(1, x.size + 1))
    lost = np.bincount(rows["bead"] - 1, box.lost(rows))
    before, after = 0.5 * box.MASS * 1.1, 0.5 * box.MASS * (now["v"] ** 2).sum(axis=1)
    np.testing.assert_allclose((after + lost) / before, 1.0, rtol=1e-3)


def resting(lmp, walls, beads):
    """Weight that the wall z = 0 and friction on the others bear, over that of all beads; rms speed; heights."""
    now = box.state(lmp)
    last = FIRST + walls._contacts.places * WIDTH
    contacts = now["d2_contactlaw"][:, FIRST:last].copy().view(CONTACT)
    floor = abs(contacts["facet"]) == 1.0
    push = (contacts["push"][..., 2] * floor).sum()
    if last < now["d2_contactlaw"].shape[1]:
        push += now["d2_contactlaw"][:, last:].copy().view(FRICTION)["force"][..., 2].sum()
    return push / (beads * box.MASS * 9.81), math.sqrt((now["v"] ** 2).sum() / beads), now["x"][:, 2]


def test_a_bead_comes_to_rest_and_weighs_what_it_weighs():
    dt = time_step(MODEL, 0.3, R, 1e-3, softening=SOFT)
    lmp, walls = box.scene(MODEL, None, box.above(1e-3), (0, 0, 0), gravity=9.81, dt=dt, softening=SOFT)
    lmp.command(f"run {round(6.0 / dt)}")
    weight, speed, _ = resting(lmp, walls, 1)
    assert weight == pytest.approx(1.0, abs=1e-9) and speed < 1e-12
    first, *others = walls.collisions()
    hit = MODEL.solve(first["approach_speed"], R, 1e-3)
    assert first["restitution"] == pytest.approx(hit.restitution, abs=1e-3)
    assert len(others) > 5


def test_a_bead_that_rolls_into_a_wall_rebounds_as_one_that_flies():
    """Friction of the floor takes nothing of the motion along the wall's normal."""
    dt, place = time_step(MODEL, 1.5, R, 1e-3, softening=300.0), (0.009 - R, 0, R - 1e-8)
    walls = [box.flat(1e-3), Plate((0.01, -0.05, 0), (0, 0.1, 0), (0, 0, 0.04), 1e-3)]
    lmp, walls = box.scene(MODEL, walls, place, (1, 0, 0), gravity=9.81, dt=dt, friction=0.3, softening=300.0)
    lmp.commands_string(f"set group all omega 0 {1.0 / R} 0\nrun {round(4e-3 / dt)}")
    (row,) = walls.collisions()[walls.collisions()["plate"] == 1]
    assert row["restitution"] == pytest.approx(MODEL.solve(1.0, R, 1e-3).restitution, abs=1e-4)
    assert row["kind"] == Kind.SLIDING_ON


def test_a_bead_that_is_hit_in_its_dent_is_struck():
    dt = time_step(MODEL, 1.0, R, 1e-3, softening=SOFT)
    lmp, walls = box.scene(MODEL, None, ABOVE, (0, 0, -1), dt=dt, softening=SOFT)
    while not walls.collisions().size:
        lmp.command("run 1")
    lmp.commands_string("velocity all set 0 0 -2\nrun 200")
    first, second = walls.collisions()
    assert (first["kind"], second["kind"]) == (Kind.IMPACT, Kind.STRUCK)


@pytest.mark.parametrize(("friction", "angle"), [(0.3, 0.2), (0.1, 0.6), (0.5, 1.0)])
def test_a_bead_rolls_or_slides_down_an_incline(friction, angle):
    lmp, walls = box.scene(
        MODEL, None, box.above(1e-8), (0, 0, 0), gravity=9.81, dt=2e-6, friction=friction, softening=SOFT
    )
    lmp.command(f"fix gravity all gravity 9.81 vector {math.sin(angle)} 0 {-math.cos(angle)}")
    lmp.command("run 20000")
    rolls = math.tan(angle) < 3.5 * friction
    slides = 9.81 * (math.sin(angle) - friction * math.cos(angle))
    expected = 0.04 * (5 / 7 * 9.81 * math.sin(angle) if rolls else slides)
    assert box.state(lmp)["v"][0, 0] == pytest.approx(expected, rel=1e-6 if rolls else 1e-3)


def test_the_slowest_speed_that_a_softening_allows():
    """Seen from the surface of the wall, the rebound of a slow bead is lower, by as much as is said."""
    model = cl.ImpactModel(cl.Pair("bearing-steel-52100", "steel-s235"), outside="solve")
    slow, height = 0.05, 0.5e-3
    softening = most_softening(model, 2 * slow, R, slowest=slow)
    assert 1.0 < softening < most_softening(model, 2 * slow, R, slowest=2 * slow)
    assert most_softening(model, 1.0, 2 * R, 1.0, parcel=2.0) == pytest.approx(
        2.0**2.5 * most_softening(model, 1.0, R, 1.0), rel=1e-5
    )
    true = model.solve(slow, R, height).restitution
    dt = time_step(model, slow, R, height, softening=softening)
    fall = slow * 20 * dt
    at_start = math.sqrt(slow**2 - 2 * 9.81 * fall)
    lmp, walls = box.scene(
        model,
        [box.flat(height)],
        box.above(fall),
        (0, 0, -at_start),
        gravity=9.81,
        dt=dt,
        density=model.pair.sphere.density,
        softening=softening,
    )
    while (now := box.state(lmp))["v"][0, 2] < 0.0 or now["x"][0, 2] < R:
        lmp.command("run 1 pre no post no") if walls.collisions().size else lmp.command("run 10")
    z, v = now["x"][0, 2] - R, now["v"][0, 2]
    seen = math.sqrt(v * v + 2 * 9.81 * z) / slow
    assert 0.2 < (true - seen) / (0.005 * (1 - true**2) / true) < 1.05


def test_a_contact_that_is_too_soft_is_told():
    lmp, walls = box.scene(MODEL, velocity=(0, 0, -3), dt=2e-6, softening=SOFT)
    with pytest.warns(UserWarning, match=r"an impact at 3 m/s had an overlap of 9\.\d% .* take at most 19\.\d$"):
        lmp.command("run 300")
    with pytest.warns(UserWarning, match="an impact at 20 m/s had an overlap of 4"):
        lmp.commands_string("set group all z 0.001 vz -20\nrun 300")
    assert walls.softening == SOFT


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"softening": 0.5}, "softening: got 0.5; must be finite and at least 1"),
        ({"softening": math.inf}, "softening: got inf; must be finite"),
        ({"softening": math.nan}, "softening: "),
        ({"parcel": 0.0}, "parcel: got 0.0; must be finite and at least 1"),
    ],
)
def test_what_is_refused(given, says):
    lmp = box.make(box.ABOVE)
    with pytest.raises(ValueError, match=says):
        box.attach(lmp, MODEL, [box.flat(1e-3)], **given)
    with pytest.raises(ValueError, match="softening: "):
        pair_coeff("gamma-alumina", radius=R, speed=1.0, softening=0.0)
    with pytest.raises(ValueError, match="parcel: "):
        time_step(MODEL, 1.0, R, 1e-3, parcel=0.5)


def test_a_restart_with_other_contacts_is_refused(tmp_path):
    lmp, _ = box.scene(MODEL, dt=5e-7, softening=20.0)
    lmp.command("run 50")
    assert box.state(lmp)["d2_contactlaw"][0, box.PLATE] != 0.0
    lmp.command(f"write_restart {tmp_path / 'soft.restart'}")
    for given in ({"softening": 30.0}, {}, {"softening": 20.0, "parcel": 2.0}):
        again = box.restarted(tmp_path / "soft.restart")
        box.attach(again, MODEL, [box.flat(1e-3)], **given)
        with pytest.raises(RuntimeError, match="a wall with softening 20, parcel 1; give the walls these numbers"):
            again.command("run 0")


@pytest.mark.parametrize("softening", [1.0, 100.0])
def test_a_parcel_rebounds_as_the_beads_that_it_stands_for(softening):
    speed = np.geomspace(0.5, 5.0, 20)
    rows, before, after = thrown(MODEL, 1e-3, speed, MU * speed, softening=softening, parcel=2.0, friction=MU, steps=60)
    hit = MODEL.oblique(rows["approach_speed"], rows["sliding_speed"], R / 2, 1e-3, MU, method="solve")
    cor, sliding = compare(rows, hit, MU)
    assert cor < 2e-4 and sliding < 0.012
    assert np.all(rows["radius"] == R / 2) and np.all(rows["parcel"] == 2.0)
    assert rows["mass"] == pytest.approx(box.MASS)  # of all eight
    np.testing.assert_allclose(rows["peak_force"], hit.peak_force, rtol=1e-3)
    np.testing.assert_allclose(rows["contact_time"], hit.contact_time, rtol=2e-3)
    np.testing.assert_allclose(box.lost(rows) + rows["friction_energy"], before - after, rtol=1e-9)
    assert time_step(MODEL, 1.0, R, 1e-3, parcel=2.0) == time_step(MODEL, 1.0, R / 2, 1e-3)


@pytest.mark.parametrize("softening", [1.0, 30.0])
def test_a_rain_of_parcels_dissipates_as_that_of_their_beads(softening):
    """Per mass, over some bounces of each, with friction and spin."""
    rng, lost = np.random.default_rng(2), []
    fall, velocity = (
        rng.uniform(1e-4, 2e-3, 60),
        np.column_stack([rng.uniform(-0.15, 0.15, (60, 2)), rng.uniform(-1, 0, 60)]),
    )
    for parcel in (1.0, 2.0):
        radius = parcel * R / 2
        place = np.column_stack([np.linspace(-0.03, 0.03, 60), np.zeros(60), radius + fall])
        dt = time_step(MODEL, 1.2, radius, 0.4e-3, softening=softening, parcel=parcel)
        lmp, walls = box.scene(
            MODEL,
            [box.flat(0.4e-3)],
            place,
            velocity,
            radius=radius,
            gravity=9.81,
            dt=dt,
            friction=0.3,
            softening=softening,
            parcel=parcel,
        )
        lmp.command(f"run {round(0.12 / dt)}")
        rows = walls.collisions()
        assert len(rows) > 100
        lost.append((box.lost(rows) + rows["friction_energy"]).sum() / rows["mass"][0])
    assert lost[1] == pytest.approx(lost[0], rel=0.02)


def test_two_parcels_touch_as_long_as_two_beads():
    """LAMMPS's Hertzian contact: the same deceleration at the same overlap."""
    one, many = (
        float(pair_coeff("gamma-alumina", radius=R, speed=1.0, parcel=parcel, softening=10.0).split()[4])
        for parcel in (1.0, 2.0)
    )
    force = many * math.sqrt(2 * R) / (one * math.sqrt(R))
    assert force == pytest.approx(2.0**3, rel=1e-3)


@pytest.mark.long
def test_a_bed_comes_to_rest_and_stays():
    """1,000 beads that are poured on a sheet between walls, and 1e5 steps more."""
    side, friction = 10, 0.3
    dt = time_step(MODEL, 1.0, R, 1e-3, softening=SOFT)
    width = 2.3e-3 * side / 2 + 0.3e-3
    grid = np.indices((side, side, side)).reshape(3, -1).T * 2.3e-3
    grid += np.random.default_rng(5).uniform(-1e-4, 1e-4, grid.shape) + (
        1.15e-3 - width + 0.3e-3,
        1.15e-3 - width + 0.3e-3,
        1.5e-3,
    )
    lmp = box.make(grid, (0, 0, -0.2), gravity=9.81, dt=dt)
    pair = pair_coeff("gamma-alumina", radius=R, speed=0.3, friction=friction, softening=SOFT)
    lmp.commands_string(f"comm_modify vel yes\npair_style granular\n{pair}")
    sides = [Plate((-width, -width, 0), (0, 2 * width, 0), (0, 0, 0.06), 1e-3)]
    sides += [Plate((width, -width, 0), (0, 2 * width, 0), (0, 0, 0.06), 1e-3)]
    sides += [Plate((-width, y, 0), (2 * width, 0, 0), (0, 0, 0.06), 1e-3) for y in (-width, width)]
    walls = box.attach(lmp, MODEL, [box.flat(1e-3), *sides], friction=friction, softening=SOFT)
    lmp.command("run 150000")
    _, _, before = resting(lmp, walls, len(grid))
    lmp.command("run 100000")
    weight, speed, after = resting(lmp, walls, len(grid))
    assert speed < 1e-4
    assert abs(after - before).max() < 1e-4 * R and after.min() > 0.99 * R
    assert weight == pytest.approx(1.0, abs=1e-3)
