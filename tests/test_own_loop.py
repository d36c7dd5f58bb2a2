"""The loop of one's own in docs/examples, beside the same scene in LAMMPS."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.engines.record import IMPACT
from contactlaw.stepping import WallContacts
from contactlaw.walls import Mesh

pytest.importorskip("trimesh", reason="trimesh is missing: pip install contactlaw[lammps]")

SCRIPT = Path(__file__).parent.parent / "docs/examples/own_loop.py"


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location(SCRIPT.stem, SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_its_rebounds_are_those_of_lammps(example, capsys):
    pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
    pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")
    import box

    from contactlaw.engines.lammps import attach

    starts, steps, loop = [], [], example.run
    example.run = lambda scene, contacts, friction, x, v, *rest: (
        starts.append((x.copy(), v.copy())),
        steps.extend(rest[-2:]),
        loop(scene, contacts, friction, x, v, *rest),
    )
    own = np.sort(example.main(), order=["bead", "time"])
    example.run = loop
    capsys.readouterr()
    lmp = box.make(*starts[0], example.RADIUS, gravity=example.GRAVITY, dt=steps[0])
    lmp.command(f"set group all density {example.PAIR.sphere.density}")
    tray = Mesh.read(example.TRAY, example.THICKNESS, scale=1e-3)
    plates = attach(lmp, cl.ImpactModel(example.PAIR), [tray], friction=example.FRICTION)
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
    with pytest.raises(
        RuntimeError, match=r"STEP_TOO_LARGE on wall 0: got 3, the limit is 2\.3\de-07"
    ):
        walls.collisions()
