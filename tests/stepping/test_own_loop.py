"""The time loop without an engine in docs/examples, beside the solver; dents."""

from runpy import run_path
from types import SimpleNamespace

import lammps_box as box
import numpy as np
import pytest
from places import ROOT

import contactlaw as cl
from contactlaw.engines.record import IMPACT
from contactlaw.stepping import WallContacts
from contactlaw.walls import Mesh, Sphere

pytest.importorskip("trimesh", reason="trimesh is missing: pip install contactlaw[lammps]")

EXAMPLE = SimpleNamespace(**run_path(ROOT / "docs/examples/own_loop.py"))


def test_its_rebounds_are_those_of_the_integration(capsys):
    rows = EXAMPLE.main()
    assert len(capsys.readouterr().out.splitlines()) == 2  # it prints what it found
    assert len(rows) > EXAMPLE.BEADS and {*rows["triangle"]} >= {0, 1, 2, 3}
    v, sizes = rows["approach_speed"], (EXAMPLE.RADIUS, EXAMPLE.THICKNESS)
    hit = cl.ImpactModel(EXAMPLE.PAIR).oblique(v, rows["sliding_speed"], *sizes, EXAMPLE.FRICTION, "solve")
    np.testing.assert_allclose(rows["restitution"], hit.restitution, atol=1e-4)
    assert np.abs((rows["sliding_speed_after"] - hit.sliding_speed) / v).max() < 0.012 * EXAMPLE.FRICTION


def test_it_stops_at_a_step_that_is_too_long():
    model = cl.ImpactModel(EXAMPLE.PAIR)
    tray = Mesh.read(EXAMPLE.TRAY, EXAMPLE.THICKNESS, scale=1e-3)
    walls = WallContacts([tray], model, EXAMPLE.RADIUS, np.zeros(9, IMPACT), friction=0.1)
    x, v = np.array([[0.0, 0.0, 1.01e-3]]), np.array([[0.0, 0.0, -3.0]])
    mass = 4 / 3 * np.pi * EXAMPLE.RADIUS**3 * EXAMPLE.PAIR.sphere.density
    EXAMPLE.run(walls.scene, *walls.memory(1), x, v, mass, EXAMPLE.RADIUS, 2e-6, 20)
    with pytest.raises(RuntimeError, match=r"on wall 0: timestep: too large .* 3 m/s, .* take 2\.3e-07 s or less"):
        walls.collisions()


def test_an_impact_in_a_dent_does_not_know_the_last_ones_friction():
    """Springs that were left stretched pushed a bead that does not slide."""
    model = cl.ImpactModel(cl.Pair("stainless-steel-304", "glass"))
    bead = {"radius": 1e-3, "density": model.pair.sphere.density, "dt": 2e-8, "friction": 0.3}
    lmp, walls = box.scene(model, [box.flat(1e-2)], (0, 0, 1e-3), (2.0, 0, -5.0), **bead)
    while not walls.collisions().size or lmp.numpy.extract_atom("f")[0].any():
        lmp.command("run 1")
    depth = 1e-3 - box.state(lmp)["x"][0, 2]
    assert depth > 1e-6
    lmp.commands_string("set group all vx 0 vz -0.02 omega 0 0 0\nrun 3000")
    assert len(walls.collisions()) == 2
    assert box.state(lmp)["v"][0, 0] == 0.0


def test_a_bead_that_hops_along_does_not_come_down_in_its_dent():
    """Its hops along the inside of a sphere soon are lower than its first dent is deep."""
    model, r, a = cl.ImpactModel(cl.Pair("lead", "glass"), outside="solve"), 1e-3, 0.02
    bead = {"radius": r, "density": model.pair.sphere.density, "dt": 8e-7, "steps": 3750}
    rows, _ = box.dropped(model, [Sphere((0, 0, a), a, 2e-3)], (0, 0, a - 0.98 * (a - r)), (2.0, 0, 0), **bead)
    hit = model.solve(rows["approach_speed"][:3], r, 2e-3)
    assert rows["approach_speed"][2] < 0.03
    assert rows["restitution"][:3] == pytest.approx(hit.restitution, abs=0.06)


@pytest.mark.parametrize("speed", [0.0, 1e-20, 1e-300])
def test_a_bead_that_was_put_down_at_next_to_no_speed(speed):
    """Springs without a width were joined for ever."""
    lmp, _ = box.scene(cl.ImpactModel(box.PAIR), None, (0, 0, box.R - 1e-8), (1e-3, 0, -speed), friction=0.3, dt=1e-8)
    lmp.command("run 1")
    x, _, z = lmp.numpy.extract_atom("f")[0]
    assert z > 0.0
    assert -0.3 * z * (1 + 1e-12) <= x < 0.0
