"""Files of the commands: what ``cor --out`` writes, full disks, and files that are cut or damaged."""

import errno
import math
import os

import h5py
import numpy as np
import pytest
from command_line import run
from rains import write_rain

import contactlaw as cl
from contactlaw.cli.constant.records import read
from contactlaw.cli.parts.impacts import COLUMNS

BODIES = "--sphere gamma-alumina --plate glass --law myc"
HIT = f"cor {BODIES} --radius 0.9mm --thickness 1mm --speed 5"
GRID = f"cor {BODIES} --radius 0.5mm,0.9mm --thickness 0.5mm,1mm,inf --speed 0.5:60:4log --no-band"


def test_a_grid_of_lists_is_a_file(folder, model, answer):
    """As HDF5, whose axes are the lists, and as the CSV that is printed."""
    v, r, h = np.geomspace(0.5, 60, 4), np.array([0.5e-3, 0.9e-3]), np.array([0.5e-3, 1e-3, np.inf])
    axes, hit = {"radius": r, "thickness": h, "speed": v}, model.lookup(v, r[:, None, None], h[:, None])
    words = "cor.h5: 24 rows gamma-alumina on glass, law myc a: FAST_IMPACT, 6 of 24: "
    assert answer(f"{GRID} --out cor.h5").text.startswith(words)
    with h5py.File("cor.h5") as file:
        asked = {"sphere": "gamma-alumina", "plate": "glass", "law": "myc", "outside": "raise"}
        made = {"format": "contactlaw-sweep", "schema": 1, "contactlaw_version": cl.__version__}
        assert dict(file.attrs) == asked | made
        assert set(file) == {*axes, *cl.Rebound.__dataclass_fields__}
        for name, values in (axes | vars(hit)).items():
            assert file[name][()].tolist() == values.tolist(), name
        units = {column.name: column.unit for column in COLUMNS}
        for name, dataset in file.items():
            assert dataset.attrs["units"] == (units.get(name) or "1"), name
            if dataset.ndim == 3:
                assert [axis[0].name for axis in dataset.dims] == ["/radius", "/thickness", "/speed"]
        limits = {limit.name: limit.value for limit in cl.Validity}
        assert limits.items() <= dict(file["flags"].attrs).items()
    answer(f"{GRID} --out cor.csv")
    assert (folder / "cor.csv").read_text() == answer(f"{GRID} --csv").out
    assert sorted(path.name for path in folder.iterdir()) == ["cor.csv", "cor.h5"]


@pytest.mark.parametrize("more", ["--angle 0,30,60 --friction 0.1,0.2", "--history --samples 9"])
def test_oblique_impacts_and_histories_are_csv_alone(more, folder, answer, capsys):
    assert "a.h5'; must end in .csv" in run(f"{HIT} {more} --out a.h5", capsys).err
    answer(f"{HIT} {more} --out a.csv")
    assert answer(f"{HIT} {more} --csv").out == (folder / "a.csv").read_text()
    assert [path.name for path in folder.iterdir()] == ["a.csv"]


@pytest.mark.parametrize(
    "line",
    [
        f"{GRID} --out a.csv",
        f"{GRID} --out a.h5",
        f"{HIT} --no-band --plot a.png",
        f"export header {BODIES} --table none --out a.h",
        f"export liggghts {BODIES} --out folder",
        f"explore {BODIES} --out a.html",
        "report rain.h5 --out folder",
    ],
)
def test_a_full_disk_leaves_what_was_there_and_is_named(line, pair, folder, monkeypatch, capsys, empty_pictures):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    write_rain("rain.h5", pair)
    *_, option, name = line.split()
    if name != "folder":
        (folder / name).write_text("before")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    monkeypatch.setattr(os, "fsync", full)
    made = run(line, capsys)
    assert (made.status, made.out) == (1, "")
    assert f"{option}: cannot write {folder / name}: No space left on device" in made.err
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize("name", ["rain.h5", "rain.npy"])
def test_a_record_that_is_cut_is_refused(name, folder, pair):
    write_rain("rain.h5", pair)
    np.save("rain.npy", cl.read_record("rain.h5").rows)
    content = (folder / name).read_bytes()
    for end in range(0, len(content) - 1, 97):
        (folder / name).write_bytes(content[:end])
        with pytest.raises(ValueError, match=f"^{name}: .*(damaged|no file of np.save)"):
            read(name)


TIME, BODY = "impacts/time", "impacts/bodies"
VAST = {"shape": (100_000_000_000,), "dtype": "f8", "chunks": (1000,)}  # it asks for 745 GiB and stores nothing
DAMAGES = [  # an attribute's name stands behind @; None deletes
    (TIME, None, "it has no dataset /impacts/time"),
    (TIME, {"name": "impacts/time/a", "data": 1}, "it has no dataset /impacts/time"),
    (TIME, ["a", "b"], "impacts/time has the shape (2,) and the type object, expected a column"),
    (BODY, 7.0, "impacts/bodies has the shape ()"),
    (TIME, h5py.Empty("f8"), "impacts/time has the shape None"),
    (BODY, np.zeros((5, 2)), "impacts/bodies has the shape (5, 2)"),
    (TIME, VAST, "impacts/time has the shape (100000000000,)"),
    ("impacts/plate", [1, 1], "expected a column of numbers, 4 rows as in the other columns"),
    (BODY, [2, 0, 1, 0], "impacts/bodies has 2 in row 0, expected a whole number from 0 to 1"),
    (BODY, [0.5, 0, 1, 0], "impacts/bodies has 0.5 in row 0"),
    ("impacts/plate", [math.nan, 1, -1, 0], "plate of row 0 is nan, expected a whole number"),
    ("impacts/approach_speed", [math.nan, 1, 1, 1], "speed: got nan"),
    ("impacts/radius", [-1.0, 1, 1, 1], "radius: got -1.0"),
    ("impacts", None, "it has no group /impacts"),
    ("bodies/1/sphere", None, "it has no group /bodies/1/sphere"),
    ("bodies/0", [1.0], "it has no group /bodies/0"),
    ("bodies/0@law", None, "no HDF5 file, or a damaged one: "),
    ("bodies/0@law", "hertzian", "got 'hertzian'; unknown law"),
    ("/@format", [1, 2], "no contactlaw record of schema 1"),
    ("/@format", None, "no contactlaw record of schema 1, but format None"),
    ("/@schema", 2, "no contactlaw record of schema 1"),
    ("bodies/0/plate@density", None, "missing 1 required positional argument: 'density'"),
    ("bodies/0/plate@youngs_modulus", "soft", "must be a number in [Pa] (material 'glass')"),
    ("bodies/0/sphere@kind", 4, "must be one of metal, ceramic"),
]


@pytest.mark.parametrize(("place", "value", "message"), DAMAGES, ids=str)
def test_a_damaged_record_is_refused_in_words(place, value, message, folder, pair, capsys):
    """What is not damaged is read in test_records.py."""
    write_rain("rain.h5", pair)
    with h5py.File("rain.h5", "r+") as file:
        holder, name = file, place
        if "@" in place:
            place, name = place.split("@")
            holder = file[place].attrs
        holder.pop(name, None)
        if isinstance(value, dict):
            file.create_dataset(**{"name": name} | value)
        elif value is not None:
            holder[name] = value
    made = run("constant rain.h5 --csv", capsys)
    assert (made.status, made.out) == (1, "")
    assert message in made.err and made.err.count("\n") == 1 and len(made.err) < 400
    assert "rain.h5" in made.err or value == "hertzian"  # --law is named
