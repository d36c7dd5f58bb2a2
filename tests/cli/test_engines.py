"""Commands for other people's engines: what they print and write, and their exit status."""

import csv
import io
import os
import re

import h5py
import numpy as np
import pytest
from command_line import misused, refused

import contactlaw as cl
from contactlaw import _atomic
from contactlaw.cli import main
from contactlaw.cli.parts.impacts import units

PAIR = ["--sphere", "gamma-alumina", "--plate", "glass", "--law", "myc"]
SIZES = ["--radius", "0.9mm", "--thickness", "0.5mm,inf"]
SWEEP = ["sweep", *PAIR, "--radius", "0.5mm,0.9mm", "--thickness", "0.5mm,1mm,inf", "--speed", "0.5:60:4log"]
CONSTANT = ["constant", *PAIR, *SIZES, "--speed", "1:60:30log"]


def read_csv(text):
    return list(csv.DictReader(io.StringIO(text)))


@pytest.fixture
def grid(model):
    v, r = np.geomspace(0.5, 60, 4), np.array([0.5e-3, 0.9e-3])
    h = np.array([0.5e-3, 1e-3, np.inf])
    return (r, h, v), model.lookup(v, r[:, None, None], h[:, None])


def test_a_sweep_as_hdf5(tmp_path, grid, model, capsys):
    (r, h, v), hit = grid
    out = tmp_path / "cor.h5"
    assert main([*SWEEP, "--out", str(out)]) == 0
    first, _, flag = capsys.readouterr().out.splitlines()
    assert first == f"{out}: 24 impacts, gamma-alumina on glass, law myc"
    assert flag.startswith("FAST_IMPACT, 6 of 24: ")
    with h5py.File(out) as file:
        assert dict(file.attrs) == {
            "format": "contactlaw-sweep",
            "schema": 1,
            "contactlaw_version": cl.__version__,
            "sphere": "gamma-alumina",
            "plate": "glass",
            "law": "myc",
            "outside": "raise",
        }
        fields = [*cl.Rebound.__dataclass_fields__, "yield_speed"]
        assert set(file) == {"speed", "radius", "thickness", *fields}
        for name, values in (("radius", r), ("thickness", h), ("speed", v)):
            assert file[name][()].tolist() == values.tolist()
        for name in cl.Rebound.__dataclass_fields__:
            assert file[name][()].tolist() == getattr(hit, name).tolist(), name
        assert file["yield_speed"][1, 0, 2] == model.yield_speed(0.9e-3, 0.5e-3)
        for name, dataset in file.items():
            assert dataset.attrs["units"] == (units().get(name) or "1"), name
            if dataset.ndim == 3:
                axes = [axis[0].name for axis in dataset.dims]
                assert axes == ["/radius", "/thickness", "/speed"]
        limits = {limit.name: limit.value for limit in cl.Validity}
        assert limits.items() <= dict(file["flags"].attrs).items()
    assert [path.name for path in tmp_path.iterdir()] == ["cor.h5"]


def test_a_sweep_as_csv(tmp_path, grid, capsys):
    _, hit = grid
    out = tmp_path / "cor.csv"
    assert main([*SWEEP, "--out", str(out)]) == 0
    rows = read_csv(out.read_text())
    assert len(rows) == 24
    assert list(rows[0])[:4] == ["speed_m/s", "radius_m", "thickness_m", "restitution"]
    for name, unit in (("restitution", ""), ("contact_time", "_s"), ("peak_force", "_N")):
        found = [float(row[name + unit]) for row in rows]
        assert found == np.ravel(getattr(hit, name)).tolist()
    assert [row["flags"] == "FAST_IMPACT" for row in rows].count(True) == 6
    assert rows[-1]["thickness_m"] == "inf"


def test_a_sweep_by_integration(tmp_path, model):
    one = ["sweep", *PAIR, "--radius", "0.9mm", "--thickness", "1mm", "--speed", "5", "--solve"]
    assert main([*one, "--out", str(tmp_path / "a.hdf5")]) == 0
    with h5py.File(tmp_path / "a.hdf5") as file:
        assert file["restitution"][0, 0, 0] == model.solve(5.0, 0.9e-3, 1e-3).restitution


@pytest.mark.parametrize("name", ["cor.csv", "cor.h5"])
def test_a_sweep_is_written_whole_or_not_at_all(name, tmp_path, monkeypatch, capsys):
    (tmp_path / name).write_text("before")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(_atomic.os, "fsync", full)
    assert main([*SWEEP, "--out", str(tmp_path / name)]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert f"--out: cannot write {tmp_path / name}: No space left" in captured.err
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [(name, "before")]


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


def test_walls_are_named_by_the_numbers_of_the_record(tmp_path, capsys):
    path = tmp_path / "impacts.csv"
    path.write_text("speed_m/s,thickness_mm,plate\n" + "\n".join(f"1,{1 + n // 9},{n}" for n in range(10)))
    assert main(["constant", *PAIR, *SIZES[:2], str(path)]) == 0
    _, names, _, thin, thick, *_ = capsys.readouterr().out.splitlines()
    assert names.split()[:2] == ["plates", "thickness"]
    assert thin.split()[:5] == ["0,", "1,", "2,", "...", "1"] and thick.split()[:2] == ["9", "2"]
    assert main(["constant", *PAIR, *SIZES[:2], str(path), "--lammps"]) == 0
    assert "# wall2, plate of 2 mm, in the record 9: COR 0." in capsys.readouterr().out


@pytest.mark.parametrize("keep", ["energy", "momentum"])
def test_a_constant_as_csv(keep, model, capsys):
    assert main([*CONSTANT, "--keep", keep, "--csv"]) == 0
    rows = read_csv(capsys.readouterr().out)
    for row, thickness in zip(rows, (0.5e-3, np.inf), strict=True):
        best = model.constant(np.geomspace(1, 60, 30), 0.9e-3, thickness, keep)
        assert float(row["thickness_m"]) == thickness
        assert (row["keep"], int(row["impacts"]), row["flags"]) == (keep, 30, "FAST_IMPACT:2")
        for name in ("restitution", "spread", "energy_error", "rebound_error", "mean", "mean_energy_error"):
            assert float(row[name]) == pytest.approx(getattr(best, name), rel=1e-12, abs=1e-13)


def test_a_constant_from_a_table_of_ones_own(tmp_path, model, capsys):
    path = tmp_path / "impacts.csv"
    path.write_text("Speed [cm/s];weight;plate\n50;3;0\n900;1;1\n800;2;0\n")
    assert main(["constant", *PAIR, *SIZES, str(path), "--csv"]) == 0
    thin, thick = read_csv(capsys.readouterr().out)
    best = model.constant([0.5, 8.0], 0.9e-3, 0.5e-3, weights=[3, 2])
    assert float(thin["restitution"]) == pytest.approx(best.restitution, rel=1e-12)
    assert float(thick["restitution"]) == pytest.approx(model.restitution(9.0, 0.9e-3, np.inf), rel=1e-12)


TABLE = ["constant", *PAIR, "--radius", "0.9mm", "--thickness", "1mm", "--table"]


def test_a_table_over_speed(model, capsys):
    assert main([*TABLE, "--error", "1e-4", "--speed", "216km/h,0.1m/s,7m/s"]) == 0
    captured = capsys.readouterr()
    asked, head, *rows = captured.out.splitlines()
    assert asked == "# gamma-alumina on glass, law myc, radius 0.0009 m, thickness 0.001 m, error 0.0001"
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
        ([*SWEEP, "--out", "cor.xls"], "--out: got 'cor.xls'; must end in .csv, .h5 or .hdf5"),
        ([*SWEEP, "--out", "nowhere/cor.h5"], "--out: there is no folder nowhere"),
        ([*SWEEP, "--speed", "1e4", "--out", "cor.h5"], "10000 m/s, radius 0.5 mm, thickness 0.5 "),
        ([*SWEEP, "--speed", "0", "--out", "cor.h5"], "--speed: got 0.0; must lie"),
        (["constant", *SIZES, "--speed", "1"], "--sphere: has to be given, no record or file says it"),
        (["constant", *PAIR, "--speed", "1", *SIZES[:2]], "--thickness: has to be given"),
        ([*CONSTANT, "--speed", "1,1e4"], "10000 m/s, radius 0.9 mm, thickness 0.5 mm: outside"),
        (["constant", *PAIR, "no.csv"], "no.csv: No such file or directory"),
        (["constant", *PAIR, "no.h5", "no.npy"], "no.h5: No such file or directory"),
        (["constant", *PAIR, "--radius", "1mm", os.devnull], f"{os.devnull}: "),
        (["constant", *PAIR, "a.h5", "--table"], "--table: give the least and the largest speed, as in --speed 0.1"),
        ([*TABLE, "--speed", "2"], "--table: give the least and the largest speed, as in --speed 0.1,10, and no FILE"),
        ([*TABLE, "--speed", "2,2"], "--table: give the least and the largest speed"),
        ([*TABLE, "--speed", "1,2", "--thickness", "1mm,2mm"], "--thickness: --table takes one value"),
        ([*TABLE[:5], "constant", "--table", "--speed", "1,2"][5:], "--radius: --table takes one value"),
        ([*TABLE, "--error", "1", "--speed", "1,2"], "--error: got 1.0; must lie between 1e-05 and 0.1"),
        ([*CONSTANT, "--error", "1e-3"], "--error: got 0.001; only --table takes it"),
        ([*TABLE, "--speed", "1,0"], "--speed: got 0.0; must lie"),
        ([*TABLE, "--speed", "1,1e4"], "10000 m/s, radius 0.9 mm, thickness 1 mm: outside the "),
        (["materials", "glas"], "unknown material 'glas'"),
        (["export", "lammps", *PAIR[:4], "--out", "no/where"], "--out: there is no folder no"),
        (["export", "header", "--sphere", "steal", "--plate", "glass"], "--sphere: unknown material 'steal'"),
        (["table", "check", "--points", "5"], "--points: got 5; at least 100"),
        (["table", "info", "missing.h5"], "missing.h5"),
        ([*CONSTANT, "--thickness", "1mm:2mm:101"], "--thickness: 101 different ones, 100 is the most"),
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
        SWEEP,
        [*CONSTANT, "--lammps", "--yade"],
        [*CONSTANT, "--lammps", "--table"],
        [*CONSTANT, "--keep", "mass"],
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


@pytest.mark.parametrize(
    "words",
    [
        [*CONSTANT, "--keep", "momentum"],
        *([*CONSTANT, option] for option in ("--lammps", "--liggghts", "--yade")),
        ["constant", "--help"],
        ["table", "info"],
        ["table", "info", "--law", "fem", "--sphere", "stainless-steel-304", "--plate", "copper-ofhc-annealed"],
        ["table", "--help"],
        ["table", "check", "--help"],
        ["materials"],
        ["materials", "copper-ofhc-annealed"],
        ["materials", "--help"],
        ["export", "--help"],
        ["export", "header", "--help"],
    ],
    ids=" ".join,
)
def test_what_people_read_fits_a_terminal(words, capsys, monkeypatch):
    """Lines for engines, which are no comments, may be longer."""
    monkeypatch.setenv("COLUMNS", "80")
    try:
        assert main(words) == 0
    except SystemExit as stop:
        assert stop.code == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(len(line) for line in lines if not line.startswith(("pair_coeff", "fix", "betan"))) <= 80
