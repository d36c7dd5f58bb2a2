"""Commands for other people's engines: what they print and write, and their exit status."""

import csv
import io
import os
import re

import numpy as np
import pytest
from command_line import misused, refused

from contactlaw.cli import main

PAIR = ["--sphere", "gamma-alumina", "--plate", "glass", "--law", "myc"]
SIZES = ["--radius", "0.9mm", "--thickness", "0.5mm,inf"]
CONSTANT = ["constant", *PAIR, *SIZES, "--speed", "1:60:30log"]


def read_csv(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_a_constant_has_its_errors_beside_it(model, capsys):
    assert main(CONSTANT) == 0
    asked, names, units, thin, thick, _, flag, *meaning = capsys.readouterr().out.splitlines()
    assert re.split(r"  +", names) == ["thickness", "impacts", "COR", "energy error", "height error", "flags"]
    assert units.split() == ["[mm]", "[-]", "[-]", "[%]", "[%]"]
    best, other = (model.constant(np.geomspace(1, 60, 30), 0.9e-3, h) for h in (0.5e-3, np.inf))
    height = f"{100 * best.rebound_error:.3g}"
    assert thin.split() == ["0.5", "30", f"{best.restitution:.4f}", "0.00", height, "a"]
    assert thick.split()[0] == "inf"
    assert flag.startswith("a: FAST_IMPACT, 4 of 60: ")
    text = " ".join(meaning)
    assert "height error: for 95 % of beads the rebound height is wrong by less than this." in text
    ends = " to ".join(f"{100 * e:.2f}" for e in sorted([best.mean_energy_error, other.mean_energy_error]))
    assert f"With the plain mean of the CORs the energy error would be {ends} %." in text


def test_a_constant_as_csv(model, capsys):
    assert main([*CONSTANT, "--csv"]) == 0
    rows = read_csv(capsys.readouterr().out)
    for row, thickness in zip(rows, (0.5e-3, np.inf), strict=True):
        best = model.constant(np.geomspace(1, 60, 30), 0.9e-3, thickness)
        assert float(row["thickness_m"]) == thickness
        assert (int(row["impacts"]), row["flags"]) == (30, "FAST_IMPACT")
        for name in ("restitution", "spread", "energy_error", "rebound_error", "mean", "mean_energy_error"):
            assert float(row[name]) == pytest.approx(getattr(best, name), rel=1e-12, abs=1e-13)


def test_a_constant_from_a_table_of_ones_own(tmp_path, model, capsys):
    path = tmp_path / "impacts.csv"
    path.write_text("Speed [cm/s];weight\n50;3\n800;2\n")
    assert main(["constant", *PAIR, *SIZES, str(path), "--csv"]) == 0
    thin, thick = read_csv(capsys.readouterr().out)
    for row, thickness in ((thin, 0.5e-3), (thick, np.inf)):  # every impact happens on both
        best = model.constant([0.5, 8.0], 0.9e-3, thickness, weights=[3, 2])
        assert float(row["restitution"]) == pytest.approx(best.restitution, rel=1e-12)


TABLE = ["constant", *PAIR, "--radius", "0.9mm", "--thickness", "1mm", "--table"]


def test_a_table_over_speed(model, capsys):
    assert main([*TABLE, "--error", "1e-4", "--speed", "216km/h,0.1m/s,7m/s"]) == 0
    captured = capsys.readouterr()
    asked, head, *rows = captured.out.splitlines()
    assert asked == "# gamma-alumina on glass, law myc, radius 0.9 mm, thickness 1 mm, error 0.0001"
    assert head == "speed_m/s,restitution"
    found = np.array([row.split(",") for row in rows], dtype=float)
    wanted = model.speed_table(0.9e-3, 1e-3, 1e-4, fastest=60.0)
    assert found.T.tolist() == [wanted.speed.tolist(), wanted.restitution.tolist()]
    (count,) = wanted.flags.values()
    assert f"warning: FAST_IMPACT, {count} of {len(rows)} rows: faster than" in captured.err
    assert main([*TABLE, "--speed", "0.1,10"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 2 + len(model.speed_table(0.9e-3, 1e-3).speed)


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["constant", *SIZES, "--speed", "1"], "--sphere: has to be given, no record or file says it"),
        (["constant", *PAIR, "--speed", "1", *SIZES[:2]], "--thickness: has to be given"),
        ([*CONSTANT, "--speed", "1,1e4"], "10000 m/s, radius 0.9 mm, thickness 0.5 mm: outside"),
        (["constant", *PAIR, "no.csv"], "no.csv: No such file or directory"),
        (["constant", *PAIR, "no.h5", "no.npy"], "no.h5: No such file or directory"),
        (["constant", *PAIR, "--radius", "1mm", os.devnull], f"{os.devnull}: "),
        (["constant", *PAIR, "a.h5", "--table"], "--table: give the least and the largest speed, as in --speed 0.1"),
        ([*TABLE, "--speed", "2"], "--table: give the least and the largest speed, as in --speed 0.1"),
        ([*TABLE, "--speed", "2,2"], "--table: give the least and the largest speed, as in --speed 0.1"),
        ([*TABLE, "--speed", "1,2", "--thickness", "1mm,2mm"], "--thickness: --table takes one value"),
        ([*TABLE[:5], "constant", "--table", "--speed", "1,2"][5:], "--sphere: has to be given"),
        ([*TABLE, "--speed", "1,2", "--radius", "1mm,2mm"], "--radius: --table takes one value"),
        ([*TABLE, "--error", "1", "--speed", "1,2"], "--error: got 1.0; must lie between 1e-05 and 0.1"),
        ([*CONSTANT, "--error", "1e-4"], "--error: got 0.0001; only --table takes it"),
        ([*TABLE, "--speed", "1,0"], "--speed: got '0'; must lie"),
        ([*TABLE, "--speed", "1,1e4"], "10000 m/s, radius 0.9 mm, thickness 1 mm: outside the "),
        (["export", "lammps", "--out", "no/where"], "--out: there is no folder no"),
        (["export", "header", "--sphere", "steal", "--plate", "glass"], "--sphere: unknown material 'steal'"),
    ],
)
def test_refused_physics_is_status_1_and_one_sentence(argv, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    refused(argv, message, capsys=capsys)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "argv",
    [
        ["constant", *PAIR, *SIZES],
        [*CONSTANT, "a.csv"],
        [*CONSTANT, "--yade"],
        [*CONSTANT, "--csv", "--table"],
        [*CONSTANT, "--spead", "1"],
        [*TABLE, "--error", "small", "--speed", "1,2"],
        ["table"],
        ["table", "infos"],
        ["export", "lammps", *PAIR],
        ["export", "headers"],
        ["materials", "glass", "pom"],
    ],
)
def test_wrong_usage_is_status_2(argv, capsys):
    misused(argv, "", capsys)
