"""Files of ``contactlaw cor --out``: the lists as a grid."""

import csv
import io

import h5py
import numpy as np
import pytest

import contactlaw as cl
from contactlaw import _atomic
from contactlaw.cli import main
from contactlaw.cli.parts.impacts import COLUMNS

PAIR = ["cor", "--sphere", "gamma-alumina", "--plate", "glass", "--law", "myc"]
GRID = [*PAIR, "--radius", "0.5mm,0.9mm", "--thickness", "0.5mm,1mm,inf", "--speed", "0.5:60:4log", "--no-band"]


@pytest.fixture
def grid(model):
    v, r = np.geomspace(0.5, 60, 4), np.array([0.5e-3, 0.9e-3])
    h = np.array([0.5e-3, 1e-3, np.inf])
    return {"radius": r, "thickness": h, "speed": v}, model.lookup(v, r[:, None, None], h[:, None])


def test_a_grid_as_hdf5(tmp_path, grid, capsys):
    axes, hit = grid
    out = tmp_path / "cor.h5"
    assert main([*GRID, "--out", str(out)]) == 0
    text = " ".join(capsys.readouterr().out.split())
    assert text.startswith(f"{out}: 24 rows gamma-alumina on glass, law myc a: FAST_IMPACT, 6 of 24: ")
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
        assert set(file) == {*axes, *cl.Rebound.__dataclass_fields__}
        for name, values in axes.items():
            assert file[name][()].tolist() == values.tolist()
        for name in cl.Rebound.__dataclass_fields__:
            assert file[name][()].tolist() == getattr(hit, name).tolist(), name
        units = {column.name: column.unit for column in COLUMNS}
        for name, dataset in file.items():
            assert dataset.attrs["units"] == (units.get(name) or "1"), name
            if dataset.ndim == 3:
                assert [axis[0].name for axis in dataset.dims] == ["/radius", "/thickness", "/speed"]
        limits = {limit.name: limit.value for limit in cl.Validity}
        assert limits.items() <= dict(file["flags"].attrs).items()
    assert [path.name for path in tmp_path.iterdir()] == ["cor.h5"]


def test_a_grid_as_csv_is_what_is_printed(tmp_path, grid, capsys):
    _, hit = grid
    out = tmp_path / "cor.csv"
    assert main([*GRID, "--out", str(out)]) == 0
    capsys.readouterr()
    rows = list(csv.DictReader(io.StringIO(out.read_text())))
    for name, unit in (("restitution", ""), ("contact_time", "_s"), ("peak_force", "_N")):
        assert [float(row[name + unit]) for row in rows] == np.ravel(getattr(hit, name)).tolist()
    assert [row["flags"] == "FAST_IMPACT" for row in rows].count(True) == 6
    assert rows[-1]["thickness_m"] == "inf"
    assert main([*GRID, "--csv"]) == 0
    assert capsys.readouterr().out == out.read_text()


@pytest.mark.parametrize("more", [["--angle", "0,30,60", "--friction", "0.1,0.2"], ["--history", "--samples", "9"]])
def test_oblique_impacts_and_histories_are_csv_alone(more, tmp_path, capsys):
    hit = [*PAIR, "--radius", "0.9mm", "--thickness", "1mm", "--speed", "5", *more]
    assert main([*hit, "--out", str(tmp_path / "a.h5")]) == 1
    assert "a.h5'; must end in .csv" in capsys.readouterr().err
    assert main([*hit, "--out", str(tmp_path / "a.csv")]) == 0
    capsys.readouterr()
    assert main([*hit, "--csv"]) == 0
    assert capsys.readouterr().out == (tmp_path / "a.csv").read_text()
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"]


def test_a_file_has_the_band(tmp_path):
    hit = [*PAIR, "--radius", "0.9mm", "--thickness", "1mm", "--speed", "5,6", "--law", "fem"]
    assert main([*hit, "--out", str(tmp_path / "a.h5")]) == 0
    band = cl.ImpactModel(cl.Pair("gamma-alumina", "glass")).uncertainty([5.0, 6.0], 0.9e-3, 1e-3).contact_time
    with h5py.File(tmp_path / "a.h5") as file:
        assert file["contact_time_high"][0, 0].tolist() == pytest.approx(band.high)
        assert file["contact_time_high"].attrs["units"] == "s"


@pytest.mark.parametrize("name", ["cor.csv", "cor.h5"])
def test_a_file_is_written_whole_or_not_at_all(name, tmp_path, monkeypatch, capsys):
    (tmp_path / name).write_text("before")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(_atomic.os, "fsync", full)
    assert main([*GRID, "--out", str(tmp_path / name)]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert f"--out: cannot write {tmp_path / name}: No space left" in captured.err
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [(name, "before")]
