"""The stored finite elements beside the model; what the docs say of them."""

import re
import signal
import subprocess
import sys

import numpy as np
import pytest
from places import ROOT

import contactlaw as cl
from validation.accuracy import compare
from validation.accuracy.compare import force_at
from validation.fem import calculix, solver, store
from validation.fem.__main__ import main as command
from validation.fem.impact import impact
from validation.fem.studies import STUDIES
from validation.paper import setting

SAID = " ".join((ROOT / "docs/how_sure.md").read_text().split())


@pytest.fixture(scope="module")
def matrix():
    return compare.comparison("matrix")


@pytest.mark.parametrize("name", STUDIES)
def test_every_result_says_what_made_it(name):
    attributes = store.read(name).attributes
    assert {"about", "command", "date", "mesh"} <= set(attributes)
    assert attributes["command"] == f"python -m validation.fem {name}"
    pressed = "calculix", "calculix_block", "calculix_hardening"
    made = dict.fromkeys(pressed, calculix.SETTINGS)
    made["calculix_impact"] = calculix.IMPACT_SETTINGS
    settings = made.get(name, solver.SETTINGS)  # as they are now
    assert {key: attributes[key] for key in settings} == settings


@pytest.mark.parametrize(
    ("force", "units", "message"),
    [(np.nan, {}, "force.*'bad'.*not finite"), (1.0, {}, "force.*'bad'.*no unit"), ("m", {}, "no native HDF5")],
)
def test_a_wrong_result_is_refused_and_leaves_nothing(force, units, message, tmp_path, monkeypatch):
    monkeypatch.setattr(store, "FOLDER", tmp_path)
    with pytest.raises((ValueError, TypeError), match=message):
        store.write("bad", "", {"force": np.array([force])}, units, mesh=object())
    assert not list(tmp_path.iterdir())
    with pytest.raises(FileNotFoundError, match="python -m validation.fem bad"):
        store.read("bad")


STUDY = """
import os, pathlib, shutil, sys, time
from validation.fem import __main__ as command, cases, store
shutil.copy(store.path("limits"), {folder!r})
store.FOLDER = pathlib.Path({folder!r})
def slow(case):
    os.write(1, b"inside\\n")  # one write keeps the lines of two workers whole
    {deed}
cases.solve = slow
sys.exit(command.main(["limits", "--processes", "2"]))
"""


@pytest.mark.parametrize(
    ("deed", "signals", "status", "message"),
    [
        ("time.sleep(60)", True, 130, "interrupted; the studies that were finished are kept"),
        ("os.kill(os.getpid(), 9)", False, 1, "validation.fem: limits: .*process pool"),
    ],
)
def test_ctrl_c_or_a_killed_worker_ends_a_study_at_once(deed, signals, status, message, tmp_path):
    """Its workers end too, which would otherwise keep the pipe open."""
    code = [sys.executable, "-c", STUDY.format(deed=deed, folder=str(tmp_path))]
    process = subprocess.Popen(code, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "inside\n"
    if signals:
        process.send_signal(signal.SIGINT)
    errors = process.communicate(timeout=40)[1]
    assert process.returncode == status
    assert re.match(message, errors) and "Traceback" not in errors
    assert (tmp_path / "fem_limits.h5").read_bytes() == store.path("limits").read_bytes()


def test_a_folder_that_cannot_be_written_is_refused_at_once(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(store, "FOLDER", tmp_path / "none")
    with pytest.raises(SystemExit):
        command(["edge"])
    assert "results cannot be written there" in capsys.readouterr().err


def test_discretisation_error():
    """The error is estimated from three meshes and the plate's far mesh, as the docs say."""
    found = compare.discretisation()
    assert all(off.max() < 0.007 for off in found.values())
    stated = re.search(r"error of (\S+) % in COR, (\S+) % in peak force, (\S+) % in contact time and (\S+) %", SAID)
    for value, name in zip(stated.groups(), found, strict=True):
        assert float(value) == pytest.approx(100 * found[name].max(), abs=0.006), name


def test_stored_impacts_keep_their_energy_and_hear_no_edge():
    for name in ("verification", "matrix", "pairs", "limits"):
        data = store.read(name).data
        assert data["balance"].max() < 0.01, name
        assert data["hourglass"].max() < 0.02, name
    data = store.read("verification").data
    near, far = data["restitution"][data["check"] == "width"]  # of a plate twice as wide
    assert near == pytest.approx(far, rel=1e-5)


def test_indentation_is_static_and_agrees_with_calculix():
    data = store.read("indentation").data
    assert max(v for k, v in data.items() if k.startswith("kinetic")) < 0.01
    way = np.linspace(0.5, 9.8, 100)
    peak = compare.indentation("calculix")[1].max()
    for loading in (True, False):
        ours = force_at("10_calculix_mesh", way, loading=loading)
        assert np.abs(ours - force_at("calculix", way, loading=loading)).max() < 0.015 * peak
    slow = force_at("10_twice_as_slow", way)
    assert force_at("10", way) == pytest.approx(slow, rel=0.015)


@pytest.mark.long
def test_impact_agrees_with_calculix():
    """CalculiX, an implicit program, runs the same meshes; finer meshes agree better."""
    theirs, made = store.read("calculix_impact")
    apart = {}
    for n, size in enumerate(theirs["size"]):
        ours = impact(
            setting.PAIR, made["speed"], made["radius"], made["thickness"], size=size, friction=made["friction"]
        )
        sphere, plate = ours.system.sphere.elements, ours.system.plate.elements
        assert len(sphere) + len(plate) == theirs["elements"][n]
        apart[size] = [
            abs(theirs[key][n] / getattr(ours, key) - 1) for key in ("restitution", "peak_force", "contact_time")
        ]
        assert apart[size][1] < 0.02
        assert apart[size][2] < 0.015  # the time comes in increments of 0.009
    assert apart[0.03][0] < 0.01
    assert apart[0.03][0] < 0.5 * apart[0.06][0]
    stated = re.search(r"within (\d\.\d), (\d\.\d) and (\d\.\d) %", SAID)
    assert [float(x) for x in stated.groups()] == [round(100 * x, 1) for x in apart[0.03]]


def test_an_edge_beyond_the_edge_distance_is_not_felt():
    data = store.read("edge").data
    thickness = data["thickness"][0]
    free = cl.ImpactModel(setting.PAIR, law="myc").lookup(data["speed"][0], data["radius"][0], thickness)
    distance = cl.edge_distance(setting.PAIR.plate, thickness, free.contact_time)
    ratio, cor = data["width"] / distance, data["restitution"]
    assert cor[ratio > 0.99] == pytest.approx(cor[-1], rel=0.002)
    (nearer,) = cor[np.isclose(ratio, 1 / 1.5, atol=0.01)]
    assert abs(nearer / cor[-1] - 1) == pytest.approx(0.023, abs=0.003)  # as its docstring says


def test_the_docs_state_what_was_measured(matrix):
    largest, rms = 100 * compare.errors(matrix)["modified Zener"]
    stated = re.search(r"within (\d\.\d) % of them \(rms (\d\.\d) %\)", SAID)
    assert [float(x) for x in stated.groups()] == [round(largest, 1), round(rms, 1)]
    pairs = compare.comparison("pairs")
    steel = np.char.startswith(pairs.fem["sphere"].astype(str), "bearing")
    fast = np.isclose(pairs.speed_ratio, 7.0)
    low = 1 - (pairs.model["restitution"] / pairs.fem["restitution"])[steel & fast]
    assert f"COR is {100 * low.min():.0f} to {100 * low.max():.0f} % too low" in SAID
