"""Softened contacts and parcels in LAMMPS, beside the true impacts that they stand for."""

import math

import lammps_box as box
import numpy as np
import pytest
from lasting import long

import contactlaw as cl
from contactlaw.engines.lammps import Plate, pair_coeff
from contactlaw.engines.record import Kind
from contactlaw.softsphere import most_softening, time_step

R, SOFT, MU = box.R, 1000.0, 0.3
MODEL = cl.ImpactModel(box.PAIR)
PAIRS = (
    ("gamma-alumina", "glass", "myc"),
    ("bearing-steel-52100", "steel-s235", "fem"),  # both flow, by rates
    ("bearing-steel-52100", "aluminium-6061-t6", "jackson_green"),
    ("copper", "steel-s235", "thornton"),
    ("nylon-66", "steel-s235", "fem"),  # with losses
)
MODELS = [cl.ImpactModel(cl.Pair(*pair), law=law, outside="solve") for *pair, law in PAIRS]
pytestmark = pytest.mark.filterwarnings("ignore:softening. an impact:UserWarning")  # meant to be fast


def thrown(model, thickness, speed, sliding=0.0, *, steps=30, softening=SOFT, **options):
    """Impacts of beads in a row on a plate, and the kinetic energy that each has lost."""
    n, density = len(speed), model.pair.sphere.density
    dt = time_step(model, speed.max(), R, thickness, softening=softening) * 30 / steps
    height = R + (1.0 + np.random.default_rng(n).random(n)) * speed * dt
    place = np.column_stack([np.zeros(n), np.linspace(-0.045, 0.045, n), height])
    velocity = np.column_stack([-sliding * np.ones(n), np.zeros(n), -speed])
    steps = int(5 + 1.2 * steps * (speed.max() / speed.min()) ** 0.2)
    options |= {"dt": dt, "density": density, "steps": steps, "softening": softening}
    rows, now = box.dropped(model, [box.flat(thickness)], place, velocity, **options)
    mass = 4 / 3 * math.pi * density * R**3
    after = (now["v"] ** 2).sum(axis=1) + 0.4 * R**2 * (now["omega"] ** 2).sum(axis=1)
    return rows, 0.5 * mass * ((velocity**2).sum(axis=1) - after)


ALL = [*((one, SOFT, 1.0) for one in MODELS), (MODELS[0], 1.0, 2.0), (MODELS[0], 100.0, 2.0)]


@pytest.mark.parametrize("beads", [120, long(1000)])
@pytest.mark.parametrize(("model", "softening", "parcel"), ALL, ids=map(str, range(len(ALL))))
def test_beads_leave_as_from_the_true_impact(model, softening, parcel, beads):
    """Beads of parcels as one of those for which they stand."""
    rng, radius = np.random.default_rng(7), R / parcel
    for thickness in (0.8e-3, 3e-3):
        speed = 10 ** rng.uniform(-1.0, 0.8, beads)
        slide = MU * speed * (rng.uniform(0.0, 12.0, beads) if softening > 1.0 else 1.0)
        steps = 30 if softening == SOFT else 60
        options = {"softening": softening, "parcel": parcel, "steps": steps}
        rows, energy = thrown(model, thickness, speed, slide, friction=MU, **options)
        assert len(rows) == beads and (rows["kind"] == Kind.IMPACT).all()
        hit = model.oblique(rows["approach_speed"], rows["sliding_speed"], radius, thickness, MU, method="solve")
        # most of it is the 40 steps in which the true impact is carried out
        assert abs(rows["restitution"] - hit.restitution).max() < (1.5e-4 if parcel == 1.0 else 2e-4)
        # that of eight springs, as in contacts that are not softened
        sliding = abs(rows["sliding_speed_after"] - hit.sliding_speed) / (MU * rows["approach_speed"])
        assert sliding.max() < 0.012
        np.testing.assert_allclose(rows["contact_time"], hit.contact_time, rtol=1e-3 if parcel == 1.0 else 2e-3)
        np.testing.assert_allclose(rows["peak_force"], hit.peak_force, rtol=1e-3)
        assert (rows["radius"] == radius).all() and (rows["parcel"] == parcel).all()
        assert rows["mass"] == pytest.approx(4 / 3 * math.pi * model.pair.sphere.density * R**3)  # of all eight
        arrived = 0.5 * rows["mass"] * rows["approach_speed"] ** 2
        for channel in ("plastic", "wave", "other"):
            share = getattr(hit, f"{channel}_fraction")
            np.testing.assert_allclose(rows[f"{channel}_energy"] / arrived, share, atol=1e-3)
        np.testing.assert_allclose(box.lost(rows) + rows["friction_energy"], energy, rtol=1e-9)
        assert softening == 1.0 or not rows["scheme_energy"].any()
        friction_alone = int(cl.Validity.SLIDING_FLOW)
        assert (rows["flags"] == hit.flags & ~friction_alone).mean() > 0.98  # an impact at a limit
    assert time_step(model, 1.0, R, 1e-3, parcel=parcel) == time_step(model, 1.0, radius, 1e-3)


def test_no_bead_leaves_a_groove_without_a_row():
    """Where it turns from one face to the other as it leaves, and has arrived on the first alone."""
    turn, x = math.radians(159.5 / 2), np.linspace(-6e-4, 6e-4, 200)
    faces = [
        Plate((0, -0.05, 0), (a, 0, 0.02 * math.cos(turn)), (0, 0.1, 0), 1e-3)
        for a in (-0.02 * math.sin(turn), 0.02 * math.sin(turn))
    ]
    place = np.column_stack([x, np.linspace(-0.04, 0.04, x.size), np.full(x.size, R / math.sin(turn) + 3e-4)])
    dt = time_step(MODEL, 2.0, R, 1e-3, softening=100.0)
    rows, _ = box.dropped(MODEL, faces, place, (0.3, 0.1, -1.0), dt=dt, softening=100.0, steps=1500)
    assert set(rows["bead"]) == set(range(1, x.size + 1))


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
    lmp, walls = box.scene(MODEL, None, box.ABOVE, (0, 0, -1), dt=dt, softening=SOFT)
    while not walls.collisions().size:
        lmp.command("run 1")
    lmp.commands_string("velocity all set 0 0 -2\nrun 200")
    assert walls.collisions()["kind"].tolist() == [Kind.IMPACT, Kind.STRUCK]


def test_the_slowest_speed_that_a_softening_allows():
    """Seen from the surface of the wall, the rebound of a slow bead is lower, by as much as is said."""
    model, slow, height = MODELS[1], 0.05, 0.5e-3
    softening = most_softening(model, 2 * slow, R, slowest=slow)
    assert 1.0 < softening < most_softening(model, 2 * slow, R, slowest=2 * slow)
    of_parcel, of_bead = most_softening(model, 1.0, 2 * R, 1.0, parcel=2.0), most_softening(model, 1.0, R, 1.0)
    assert of_parcel == pytest.approx(2.0**2.5 * of_bead, rel=1e-5)
    dt = time_step(model, slow, R, height, softening=softening)
    bead = {"gravity": 9.81, "dt": dt, "density": model.pair.sphere.density, "softening": softening}
    lmp, walls = box.scene(model, [box.flat(height)], box.above(slow * dt), (0, 0, -slow), **bead)
    while (now := box.state(lmp))["v"][0, 2] < 0.0 or now["x"][0, 2] < R:
        lmp.command("run 1")
    came = slow**2 + 2 * 9.81 * slow * dt
    left = now["v"][0, 2] ** 2 + 2 * 9.81 * (now["x"][0, 2] - R)
    true, seen = model.solve(came**0.5, R, height).restitution, (left / came) ** 0.5
    assert 0.2 < (true - seen) / (0.005 * (1 - true**2) / true) < 1.05


def test_a_contact_that_is_too_soft_is_told():
    lmp, walls = box.scene(MODEL, velocity=(0, 0, -3), dt=2e-6, softening=SOFT)
    with pytest.warns(UserWarning, match=r"an impact at 3 m/s had an overlap of 9\.\d% .* take at most 19\.\d$"):
        lmp.command("run 300")
    with pytest.warns(UserWarning, match="an impact at 20 m/s had an overlap of 4"):
        lmp.commands_string("set group all z 0.001 vz -20\nrun 300")
    assert walls.softening == SOFT
    lmp, _ = box.scene(MODEL, velocity=(0, 0, -20), softening=1e9)
    with pytest.raises(RuntimeError, match="its centre went through the wall at 20 m/s"):
        lmp.command("run 900")


def test_two_parcels_touch_as_long_as_two_beads():
    """LAMMPS's Hertzian contact: the same deceleration at the same overlap."""
    one, many = (
        float(pair_coeff("gamma-alumina", radius=R, speed=1.0, parcel=parcel, softening=10.0).split()[4])
        for parcel in (1.0, 2.0)
    )
    assert many * math.sqrt(2 * R) / (one * math.sqrt(R)) == pytest.approx(2.0**3, rel=1e-3)
    with pytest.raises(ValueError, match="parcel: "):
        pair_coeff("gamma-alumina", radius=R, speed=1.0, parcel=0.0)
