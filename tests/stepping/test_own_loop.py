"""The time loop without an engine in docs/examples, beside the same scene in LAMMPS."""

import importlib.util
import math

import numpy as np
import pytest
from loops import fly, loop, press
from places import ROOT

import contactlaw as cl
from contactlaw.engines.record import IMPACT
from contactlaw.stepping import WallContacts
from contactlaw.walls import Mesh, Plate, Sphere

pytest.importorskip("trimesh", reason="trimesh is missing: pip install contactlaw[lammps]")

SCRIPT = ROOT / "docs/examples/own_loop.py"


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location(SCRIPT.stem, SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_its_rebounds_are_those_of_lammps(example, capsys):
    import lammps_box as box

    starts, steps, loop = [], [], example.run
    example.run = lambda scene, contacts, friction, x, v, *rest: (
        starts.append((x.copy(), v.copy())),
        steps.extend(rest[-2:]),
        loop(scene, contacts, friction, x, v, *rest),
    )
    own = np.sort(example.main(), order=["bead", "time"])
    example.run = loop
    assert len(capsys.readouterr().out.splitlines()) >= 2  # it prints what it found
    lmp = box.make(*starts[0], example.RADIUS, gravity=example.GRAVITY, dt=steps[0])
    lmp.command(f"set group all density {example.PAIR.sphere.density}")
    tray = Mesh.read(example.TRAY, example.THICKNESS, scale=1e-3)
    plates = box.attach(lmp, cl.ImpactModel(example.PAIR), [tray], friction=example.FRICTION)
    lmp.command(f"run {steps[1]}")
    there = np.sort(plates.collisions(), order=["bead", "time"])
    lmp.close()
    assert len(own) == len(there) > example.BEADS
    assert set(own["triangle"]) >= {0, 1, 2, 3}
    assert (own["bead"] + 1 == there["bead"]).all()
    assert (own["triangle"] == there["triangle"]).all()
    for name in ("restitution", "approach_speed", "contact_time", "peak_force", "wave_energy"):
        assert own[name] == pytest.approx(there[name], rel=1e-9), name


def test_it_stops_at_a_step_that_is_too_long(example):
    model = cl.ImpactModel(example.PAIR)
    tray = Mesh.read(example.TRAY, example.THICKNESS, scale=1e-3)
    walls = WallContacts([tray], model, example.RADIUS, np.zeros(9, IMPACT), friction=0.1)
    x, v = np.array([[0.0, 0.0, 1.01e-3]]), np.array([[0.0, 0.0, -3.0]])
    mass = 4 / 3 * np.pi * example.RADIUS**3 * example.PAIR.sphere.density
    example.run(walls.scene, *walls.memory(1), x, v, mass, example.RADIUS, 2e-6, 20)
    with pytest.raises(RuntimeError, match=r"on wall 0: timestep: too large .* 3 m/s, .* take 2\.3e-07 s or less"):
        walls.collisions()


@loop
def strike_in_dent(scene, contacts, friction, mass, radius, dt, steps):
    """A bead that slides over the plate z = 0 and, in its dent, is thrown back without sliding.

    Its speed along the plate at the end, and the overlap at which it was thrown back.
    """
    x, v, omega = np.array([0.0, 0.0, radius]), np.array([2.0, 0.0, -5.0]), np.zeros(3)
    force, torque, depth = np.zeros(3), np.zeros(3), 0.0
    for step in range(steps):
        x += dt * v
        force[:] = torque[:] = 0.0
        press(scene, step * dt, dt, x, v, omega, radius, mass, force, torque, contacts, friction)
        v += dt / mass * force
        omega += dt / (0.4 * mass * radius**2) * torque
        if depth == 0.0 and v[2] > 0.0 and contacts[0].force == 0.0:
            depth, omega[:] = radius - x[2], 0.0
            v[:] = (0.0, 0.0, -0.02)
    return v[0], depth


def test_an_impact_in_a_dent_does_not_know_the_last_ones_friction():
    """Springs that were left stretched pushed a bead that does not slide."""
    model, r = cl.ImpactModel(cl.Pair("stainless-steel-304", "glass")), 1e-3
    plate = Plate((-0.05, -0.05, 0.0), (0.1, 0.0, 0.0), (0.0, 0.1, 0.0), 1e-2)
    walls = WallContacts([plate], model, r, np.zeros(9, IMPACT), friction=0.3)
    mass = 4 / 3 * math.pi * r**3 * model.pair.sphere.density
    along, depth = strike_in_dent(walls.scene, *(a for (a,) in walls.memory(1)), mass, r, 2e-8, 999)
    assert depth > 1e-6
    assert len(walls.collisions()) == 2
    assert along == 0.0


def test_a_bead_that_hops_along_does_not_come_down_in_its_dent():
    """Its hops along the inside of a sphere soon are lower than its first dent is deep."""
    model, r, a, dt = cl.ImpactModel(cl.Pair("lead", "glass"), outside="solve"), 1e-3, 0.02, 8e-7
    walls = WallContacts([Sphere((0.0, 0.0, 0.0), a, 2e-3)], model, r, np.zeros(99, IMPACT))
    mass, still = 4 / 3 * math.pi * r**3 * model.pair.sphere.density, np.zeros(3)
    x, v = np.array([0.0, 0.0, -0.98 * (a - r)]), np.array([2.0, 0.0, 0.0])
    memory = (rows for (rows,) in walls.memory(1))
    fly(walls.scene, *memory, x, v, np.zeros(3), mass, r, still, dt, 3750, still, -1)
    rows = walls.collisions()[:3]
    hit = model.solve(rows["approach_speed"], r, 2e-3)
    assert rows["approach_speed"][2] < 0.03
    assert rows["restitution"] == pytest.approx(hit.restitution, abs=0.06)


@pytest.mark.parametrize("speed", [0.0, 1e-20, 1e-300])
def test_a_bead_that_was_put_down_at_next_to_no_speed(example, speed):
    """Springs without a width were joined for ever."""
    model, r = cl.ImpactModel(example.PAIR), 1e-3
    plate = Plate((-0.05, -0.05, 0.0), (0.1, 0.0, 0.0), (0.0, 0.1, 0.0), 1e-3)
    walls = WallContacts([plate], model, r, np.zeros(9, IMPACT), friction=0.3)
    (contacts,), (friction,) = walls.memory(1)
    mass = 4 / 3 * math.pi * r**3 * example.PAIR.sphere.density
    x, v, (omega, force, torque) = np.array([0.0, 0.0, r - 1e-8]), np.array([1e-3, 0.0, -speed]), np.zeros((3, 3))
    press(walls.scene, 0.0, 1e-8, x, v, omega, r, mass, force, torque, contacts, friction)
    assert force[2] > 0.0
    assert -0.3 * force[2] * (1 + 1e-12) <= force[0] < 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"friction": math.nan}, "friction: got nan; must be finite"),
        ({"models": {2: None}}, "models"),
        ({"models": "glass"}, "model"),
    ],
)
def test_what_it_refuses(example, change, message):
    model = cl.ImpactModel(example.PAIR)
    if change.get("models") == {2: None}:
        change = {"models": {2: model}}
    plate = Plate((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.1, 0.0), 1e-3)
    given = {"models": model, **change}
    with pytest.raises((TypeError, ValueError), match=message):
        WallContacts([plate], largest=1e-3, impacts=np.zeros(9, IMPACT), **given)
