"""Impacts that have happened, as files have them; each column against what was written."""

import math
import os
import random
from pathlib import Path

import h5py
import numpy as np
import pytest
from rains import write_rain

import contactlaw as cl
from contactlaw import cli as cli_of_contactlaw
from contactlaw.cli.constant.records import completed, read
from contactlaw.engines.record import IMPACT


def one(path):
    """The impacts of a file, which are of one pair, by the names of sizes."""
    (found,) = read(path)
    return found.impacts


SPEED, RADIUS = [0.5, 1.2, 3.0], [0.9e-3, 1.1e-3, 1.0e-3]


@pytest.mark.parametrize(
    ("head", "rows"),
    [
        ("speed_m/s,radius_m", ["0.5,0.9e-3", "1.2,1.1e-3", "3,1e-3"]),
        ("speed,radius", ["0.5,0.0009", "1.2,0.0011", "3.0,0.001"]),
        ("Speed [cm/s];Radius [mm]", ["50;0.9", "120;1.1", "300;1"]),
        ("Approach speed (mm/s)\tother\tRADIUS_um", ["500\tx\t900", "1200\ty\t1100", "3e3\tz\t1e3"]),
        ("v;Bead diameter [mm]", ["0.5;1.8", "1.2;2.2", "3;2"]),
        ("# normal_speed m/s, time_s, radius mm", ["0.5, 1, 0.9", "1.2, 2, 1.1", "3, 3, 1.0"]),
        ('"impact speed [km/h]","radius [cm]"', ['"1.8",0.09', "4.32,0.11", "10.8,0.1"]),
        ("\\ufeffspeed_m/s,radius_mm", ["0.5,0.9", "# a remark", "1.2,1.1", "3,1", ""]),
    ],
)
def test_columns_by_name_and_unit(head, rows, tmp_path):
    path = tmp_path / "impacts.csv"
    path.write_text("\n".join([head.replace("\\ufeff", "\ufeff"), *rows]), encoding="utf-8")
    found = one(path)
    assert found["speed"] == pytest.approx(SPEED, rel=1e-15)
    assert found["radius"] == pytest.approx(RADIUS, rel=1e-15)
    assert found.keys() == {"speed", "radius"}


def test_sizes_are_those_that_would_be_typed(tmp_path):
    """A plate of 0.9 mm in a file equals a plate of 0.9 mm on the command line."""
    (tmp_path / "a.csv").write_text(
        "speed,thickness_mm\n" + "\n".join(f"1,{size}" for size in (0.1, 0.3, 0.7, 0.9, 1.1))
    )
    found = one(tmp_path / "a.csv")["thickness"].tolist()
    assert found == [0.1e-3, 0.3e-3, 0.7e-3, 0.9e-3, 1.1e-3]


def test_a_pipe_is_read_to_its_end():
    reader, writer = os.pipe()
    os.write(writer, b"speed_m/s,radius_mm\n0.5,0.9\n1.2,1.1\n")
    os.close(writer)
    assert one(f"/dev/fd/{reader}")["speed"].tolist() == [0.5, 1.2]
    os.close(reader)


def test_weights_and_a_half_space(tmp_path):
    (tmp_path / "a.csv").write_text("no,speed,thickness_mm,weight\n0,1,0.5,3\n1,2,inf,1.5\n")
    found = one(tmp_path / "a.csv")
    assert found["speed"].tolist() == [1, 2]
    assert found["thickness"].tolist() == [0.5e-3, math.inf]
    assert found["weights"].tolist() == [3, 1.5]


def test_a_record_of_an_engine(tmp_path):
    rows = np.zeros(3, IMPACT)
    rows["approach_speed"], rows["plate"], rows["mass"] = SPEED, [1, -1, 0], 1e-6
    rows["radius"], rows["thickness"] = RADIUS, [1e-3, 0.0, math.inf]
    np.save(tmp_path / "impacts.npy", rows)
    found = one(tmp_path / "impacts.npy")
    assert found["speed"].tolist() == [0.5, 3.0]
    assert found["radius"].tolist() == [RADIUS[0], RADIUS[2]]
    assert found["thickness"].tolist() == [1e-3, math.inf]
    rows["parcel"], rows["mass"], rows["thickness"] = [2.0, 1.0, 3.0], [8.0, 1.0, 54.0], 1e-3
    cl.Record(rows).save(tmp_path / "impacts.h5")
    found = one(tmp_path / "impacts.h5")  # a parcel stands for as many beads as fit into it
    assert found["weights"].tolist() == [8.0, 27.0] and found["mass"].tolist() == [1.0, 2.0]


def test_files_of_several_ranks_are_one_run(tmp_path, capsys):
    """Rows of two ranks, one of which has a parcel, beside one file with all of them."""
    rows = recorded(tmp_path / "all.npy", [0, 0, 2, 0])
    rows["time"], rows["parcel"] = np.arange(4), [1.0, 1.0, 1.0, 2.0]
    rows["mass"] *= rows["parcel"] ** 3
    np.save(tmp_path / "all.npy", rows)
    for rank in range(2):
        np.save(tmp_path / f"hits.{rank}.npy", rows[rank::2])
    pair = ["--sphere", "gamma-alumina", "--plate", "glass", "--csv"]
    answers = []
    for names in (["all.npy"], ["hits.0.npy", "hits.1.npy"]):
        assert cli_of_contactlaw.main(["constant", *(str(tmp_path / name) for name in names), *pair]) == 0
        said = capsys.readouterr()
        assert "Of 4 contacts, 25 % left over the edge of a wall; their COR" in said.err
        answers.append(said.out)
    assert answers[0] == answers[1]
    assert one(tmp_path / "all.npy")["weights"].tolist() == [1.0, 1.0, 8.0]
    (tmp_path / "a.csv").write_text("speed_m/s,radius_mm\n1,1\n")
    assert cli_of_contactlaw.main(["constant", str(tmp_path / "a.csv"), str(tmp_path / "all.npy"), *pair]) == 1
    assert f"{tmp_path / 'all.npy'}: only the files of one record are put together" in capsys.readouterr().err


def recorded(path, kinds):
    """An engine's record, a row for each kind, as a file of numpy."""
    rows = np.zeros(len(kinds), IMPACT)
    rows["approach_speed"], rows["kind"] = 1.0 + np.arange(len(kinds)), kinds
    rows["restitution"], rows["radius"], rows["thickness"] = 0.9, 1e-3, 1e-3
    rows["mass"] = 4 / 3 * math.pi * 1e-9 * cl.material("gamma-alumina").density
    np.save(path, rows)
    return rows


def test_what_is_no_impact_is_left_out_and_said(tmp_path, capsys):
    name = "a.npy"
    recorded(tmp_path / name, [0, 2, 0, 4, 2, 0])
    assert one(tmp_path / name)["speed"].tolist() == [1.0, 3.0, 6.0]
    words = "Of 6 contacts, 33 % left over the edge of a wall and 17 % stayed as under their weight; their COR"
    pair = ["--sphere", "gamma-alumina", "--plate", "glass"]
    command = ["constant", *pair, str(tmp_path / name)]
    assert cli_of_contactlaw.main(command) == 0
    assert words in capsys.readouterr().err
    recorded(tmp_path / name, [0, 0])
    assert cli_of_contactlaw.main(command) == 0
    assert capsys.readouterr().err == ""
    recorded(tmp_path / name, [1, 1])
    assert cli_of_contactlaw.main(command) == 1
    words = "it has no impact on a plate: Of 2 contacts, 100 % slid on from another wall; their COR"
    assert words in capsys.readouterr().err


def test_rows_with_beads_of_two_materials_are_refused(tmp_path, capsys):
    """Rows alone do not say which materials these are; the mass of each bead is that of its row."""
    rows = recorded(tmp_path / "a.npy", [0] * 5)
    rows["mass"][3:] *= 2.0
    np.save(tmp_path / "a.npy", rows)
    command = ["constant", "--sphere", "gamma-alumina", "--plate", "glass", "--csv", str(tmp_path / "a.npy")]
    assert cli_of_contactlaw.main(command) == 0
    head, row = (line.split(",") for line in capsys.readouterr().out.splitlines())
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    best = model.constant(rows["approach_speed"], 1e-3, 1e-3, mass=rows["mass"]).restitution
    assert float(row[head.index("restitution")]) == pytest.approx(best, rel=1e-12)
    rows["material"][3:] = 1
    np.save(tmp_path / "a.npy", rows)
    assert cli_of_contactlaw.main(command) == 1
    assert "a.npy: it has beads of several materials: save the record as .h5" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.csv", "time,radius\n1,2\n", "no column of speeds in its first line, 'time, rad"),
        ("a.csv", "", "no column of speeds in its first line, ''"),
        ("a.csv", "speed_m/s\n", "it has no impact on a plate"),
        ("a.csv", "speed,plate\n1,-1\n", "a column plate: remove it"),
        ("a.csv", "speed_m/s\n1\nfast\n", "line 3, column 'speed_m/s': 'fast' is no number"),
        ("a.csv", "speed_m/s\n1\n-2\n", r"speed: got -2.0 \(element 1\); must lie between"),
        ("a.csv", "speed_m/s\n1\nnan\n", "speed: got nan"),
        ("a.csv", "speed,radius_mm\n1,900000000\n", "radius: got 900000.0"),
        ("a.csv", "speed [mph]\n1\n", r"no column of speeds in its first line, 'speed \[mph\]': call one speed_m/s"),
        ("a.csv", "speed,normal speed\n1,2\n", "two columns of speed, 'speed' and 'normal speed'"),
        ("a.csv", b"\xff\xfe\x00\x01speed", "a binary file, expected a table of text"),
        ("a.npy", b"speed", "no file of np.save"),
        ("a.h5", b"speed", "no HDF5 file, or a damaged one"),
        ("a.h5", None, "no contactlaw record of schema 1, but format None, schema None: run it again"),
    ],
)
def test_what_is_refused(name, content, message, tmp_path):
    path = tmp_path / name
    if content is None:
        h5py.File(path, "w").close()
    else:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ValueError, match=message) as refused:
        one(path)
    assert str(refused.value).startswith(str(path))


def test_a_file_that_is_not_there(tmp_path):
    for name in ("a.csv", "a.h5", "a.npy"):
        with pytest.raises(OSError, match="No such file"):
            one(tmp_path / name)


def test_sizes_that_a_record_lacks_are_combined_with_its_impacts():
    every = completed({"speed": np.array([1.0, 2.0])}, radius=[1e-3, 2e-3], thickness=[5e-4])
    assert every["speed"].tolist() == [1, 2, 1, 2]
    assert every["radius"].tolist() == [1e-3, 1e-3, 2e-3, 2e-3]
    assert every["thickness"].tolist() == [5e-4] * 4
    run = {"speed": np.array([1.0, 2.0]), "radius": np.array([1e-3, 2e-3])}
    assert completed(run, radius=None, thickness=[5e-4, 2e-3])["radius"].tolist() == [1e-3, 2e-3] * 2


@pytest.mark.parametrize(
    ("sizes", "message"),
    [
        ({"radius": None}, "radius: has to be given, no record says it"),
        ({"radius": [1e-3], "thickness": None}, "thickness: has to be given"),
        ({"speed": [1.0]}, "speed: the record has its own: leave this one out"),
    ],
)
def test_what_a_record_does_not_say_has_to_be_given(sizes, message):
    with pytest.raises(ValueError, match=message):
        completed({"speed": np.array([1.0, 2.0])}, **sizes)


@pytest.fixture(scope="module")
def rain(tmp_path_factory, pair):
    path = tmp_path_factory.mktemp("rain") / "rain.h5"
    write_rain(path, pair)
    return path.read_bytes()


def test_what_the_damaged_rains_are_made_of_is_read(rain, pair, tmp_path):
    (tmp_path / "rain.h5").write_bytes(rain)
    (whole,) = read(tmp_path / "rain.h5")
    found = whole.impacts
    assert found["speed"].tolist() == [1.0, 2.0, 3.0]
    assert found["radius"].tolist() == [0.9e-3, 1.1e-3, 1e-3]
    assert found["thickness"].tolist() == [0.5e-3, math.inf, 0.5e-3]
    assert (whole.pair, whole.law) == (pair, "hertz")


def absent(file, name):
    del file[name]


def put(values, **options):
    """Give a function that puts another dataset into a place."""

    def replace(file, name):
        del file[name]
        file.create_dataset(name, data=values, **options)

    return replace


def another(change):
    """Give a function that changes the first value of a column."""

    def replace(file, name):
        values = file[name][()]
        values = values.astype(type(change)) if isinstance(change, float) else values
        values[0] = change
        put(values)(file, name)

    return replace


def as_group(file, name):
    del file[name]
    file.create_group(name)


def vast(file, name):
    """Column that asks for 745 GiB and stores nothing."""
    del file[name]
    file.create_dataset(name, (100_000_000_000,), "f8", chunks=(1000,), compression="gzip")


def objects(file, name):
    del file[name]
    file.create_dataset(name, data=["a", "b"], dtype=h5py.string_dtype())


def attribute(name, value):
    def replace(file, place):
        if value is None:
            del file[place].attrs[name]
        else:
            file[place].attrs[name] = value

    return replace


COLUMNS = ["impacts/time", "impacts/bodies"]
DAMAGES = [
    *((absent, place, f"it has no dataset /{place}") for place in COLUMNS),
    *((as_group, place, f"it has no dataset /{place}") for place in COLUMNS),
    *((objects, place, f"{place} has the shape (2,) and the type object, expected a column") for place in COLUMNS),
    *((put(7.0), place, f"{place} has the shape ()") for place in COLUMNS),
    *((put(h5py.Empty("f8")), place, f"{place} has the shape None") for place in COLUMNS),
    *((put(np.zeros((5, 2))), place, f"{place} has the shape (5, 2)") for place in COLUMNS),
    *((vast, place, f"{place} has the shape (100000000000,)") for place in COLUMNS),
    (put([1, 1]), "impacts/plate", "expected a column of numbers, 4 rows as in the other columns"),
    (another(9), "impacts/bodies", "impacts/bodies has 9 in row 0, expected a whole number"),
    (another(2), "impacts/bodies", "impacts/bodies has 2 in row 0, expected a whole number from 0 to 1"),
    (another(0.5), "impacts/bodies", "impacts/bodies has 0.5 in row 0"),
    (another(math.nan), "impacts/plate", "plate of row 0 is nan, expected a whole number"),
    (another(math.nan), "impacts/approach_speed", "speed: got nan"),
    (another(-1.0), "impacts/radius", "radius: got -1.0"),
    *((absent, place, f"it has no group /{place}") for place in ("impacts", "bodies/0", "bodies/1/sphere")),
    *((put([1.0]), place, f"it has no group /{place}") for place in ("impacts", "bodies", "bodies/0/plate")),
    (attribute("law", None), "bodies/0", "no HDF5 file, or a damaged one: "),
    (attribute("law", "hertzian"), "bodies/0", "got 'hertzian'; unknown law"),
    (attribute("format", [1, 2]), "/", "no contactlaw record of schema 1"),
    (attribute("schema", 2), "/", "no contactlaw record of schema 1"),
    (attribute("density", None), "bodies/0/plate", "missing 1 required positional argument: 'density'"),
    (attribute("youngs_modulus", "soft"), "bodies/0/plate", "must be a number in [Pa] (material 'glass')"),
    (attribute("yield_strength", [1.0, 2.0]), "bodies/0/sphere", "must be a number in [Pa] (material"),
    (
        attribute("hardening", [1e6, 0.3, 1.0]),
        "bodies/0/sphere",
        "must be (B, n), B in Pa, or n alone (material 'gamma-alumina')",
    ),
    (attribute("rate", "slow"), "bodies/0/sphere", "must be (C, rate0), rate0 in 1/s"),
    (attribute("kind", 4), "bodies/0/sphere", "must be one of metal, ceramic"),
    (attribute("name", 4.0), "bodies/0/sphere", "must be a non-empty string"),
    (attribute("density", -1.0), "bodies/0/plate", "density: got -1.0; must be positive"),
]


@pytest.mark.parametrize(("damage", "place", "message"), DAMAGES)
def test_a_damaged_rain_is_refused_in_words(damage, place, message, rain, tmp_path, capsys):
    path = tmp_path / "rain.h5"
    path.write_bytes(rain)
    with h5py.File(path, "r+") as file:
        damage(file, place)
    commands = [["constant", "--csv"], ["report", "--out", str(tmp_path / "out")]]
    if "got" in message or "hertzian" in message:  # a report takes any number and any law's name
        commands.pop()
    for command in commands:
        assert cli_of_contactlaw.main([*command, str(path)]) == 1
        captured = capsys.readouterr()
        assert captured.out == "" and message in captured.err
        assert len(captured.err) < 400 and captured.err.count("\n") == 1
        assert str(path) in captured.err or "hertzian" in message  # --law is named


def test_a_rain_that_ends_early(rain, tmp_path):
    path = tmp_path / "rain.h5"
    for end in range(0, len(rain) - 1, 97):
        path.write_bytes(rain[:end])
        with pytest.raises(ValueError, match="no HDF5 file, or a damaged one"):
            one(path)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (np.array([object()]), "a damaged file of np.save, or one of objects"),
        (np.zeros(3), r"an array of shape \(3,\) and type float64, expected rows with named"),
        (np.zeros((2, 2), IMPACT), "expected rows with named columns"),
        (np.zeros(2, [("approach_speed", "f8")]), "one of them time"),
        (np.zeros(2, [("time", "f8"), ("approach_speed", "U4")]), "approach_speed holds values of type <U4"),
        (np.zeros(2, [("time", "f8"), ("approach_speed", "f8", 3)]), r"holds values of type float64, shape \(2, 3\)"),
        (np.array([(1.0, 0.5)], [("time", "f8"), ("plate", "f8")]), "plate of row 0 is 0.5, expected a whole"),
        (np.array([(1.0, np.nan)], [("time", "f8"), ("plate", "f8")]), "plate of row 0 is nan, expected a whole"),
    ],
)
def test_arrays_that_are_no_record(rows, message, tmp_path):
    np.save(tmp_path / "a.npy", rows, allow_pickle=True)
    with pytest.raises(ValueError, match=message) as refused:
        read(tmp_path / "a.npy")
    assert str(refused.value).startswith(str(tmp_path))


def test_a_short_array_that_asks_for_much_memory(tmp_path):
    np.save(tmp_path / "a.npy", np.ones(10, [("speed", "f8")]))
    content = (tmp_path / "a.npy").read_bytes()
    vast = content.replace(b"(10,), }" + 10 * b" ", b"(100000000000,), }")
    assert len(vast) == len(content) != content.count(b"(10")
    for damaged in (vast, content[:-8], content[:40]):
        (tmp_path / "b.npy").write_bytes(damaged)
        with pytest.raises(ValueError, match="a damaged file of np.save"):
            read(tmp_path / "b.npy")


@pytest.mark.parametrize("head", [b"((((((", b"{'descr': '<f8', "])
def test_a_damaged_head_of_an_array_is_refused_in_words(head, tmp_path):
    (tmp_path / "a.npy").write_bytes(b"\x93NUMPY\x01\x00\x40\x00" + head.ljust(64))
    with pytest.raises(ValueError, match="damaged file of np.save"):
        read(tmp_path / "a.npy")


ASKED = ["--sphere", "gamma-alumina", "--plate", "glass", "--law", "myc", "--radius", "1mm"]
ASKED += ["--thickness", "1mm", "--csv"]
GOOD = {
    "a.csv": (["constant", *ASKED], b"v,weight,other\n1,1,0\n2.5,3,1\n"),
    "a.toml": (
        ["cor", *ASKED, "--speed", "1", "--materials"],
        b"# harmless here\n[a]\nlike = 'glass'\nhardness = '60 HV'  # and here\n",
    ),
    "a.npy": (["report"], b""),
}
TOKENS = [b"", b"\0", b"nan", b"-1", b"1e999", b"[" * 3000, b"\xff", b"'", b",", b"=", b"\n", b"x"]


@pytest.mark.parametrize("name", GOOD)
def test_damaged_files_are_answered_or_refused_by_name(name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("contactlaw.reporting.figures.modules", dict)  # these take seconds
    rows, choose, refused = recorded(Path("whole.npy"), [0] * 3), random.Random(1), 0
    for _ in range(60):
        if name == "a.npy":
            kind, column = choose.choice(["f8", ">f4", "S9", "c16"]), choose.choice(IMPACT.names)
            other = rows.astype([(n, kind if n == column else IMPACT[n]) for n in IMPACT.names])
            other[column] = choose.choice([math.nan, math.inf, -1.0, 0.0, 0.5, 300.0, 1e12])
            np.save(name, other)
        else:
            good, at = GOOD[name][1], choose.randrange(len(GOOD[name][1]))
            end = good[at + choose.randrange(3) :] * choose.randrange(3)
            Path(name).write_bytes(good[:at] + choose.choice(TOKENS) + end)
        try:
            status = cli_of_contactlaw.main([*GOOD[name][0], name])
        except SystemExit as stop:
            status = stop.code
        said = capsys.readouterr()
        assert "nan" not in said.out and (status == 0 or name in said.err), said
        refused += status != 0
    assert 10 < refused < 60
