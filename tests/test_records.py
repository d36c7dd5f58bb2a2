"""Impacts that have happened, as files have them; each column against what was written."""

import math

import h5py
import numpy as np
import pytest

from contactlaw.command.records import Recorded, combined, completed, read
from contactlaw.engines.record import IMPACT
from dem_demo import cli, reader

SPEED, RADIUS = [0.5, 1.2, 3.0], [0.9e-3, 1.1e-3, 1.0e-3]


@pytest.mark.parametrize(
    ("head", "rows"),
    [
        ("speed_m/s,radius_m", ["0.5,0.9e-3", "1.2,1.1e-3", "3,1e-3"]),
        ("speed,radius", ["0.5,0.0009", "1.2,0.0011", "3.0,0.001"]),
        ("Speed [cm/s];Radius [mm]", ["50;0.9", "120;1.1", "300;1"]),
        (
            "Approach speed (mm/s)\tother\tRADIUS_um",
            ["500\tx\t900", "1200\ty\t1100", "3e3\tz\t1e3"],
        ),
        ("# normal_speed m/s, time_s, radius mm", ["0.5, 1, 0.9", "1.2, 2, 1.1", "3, 3, 1.0"]),
        ('"impact speed [km/h]","radius [cm]"', ['"1.8",0.09', "4.32,0.11", "10.8,0.1"]),
        ("\\ufeffspeed_m/s,radius_mm", ["0.5,0.9", "# a remark", "1.2,1.1", "3,1", ""]),
    ],
)
def test_columns_by_name_and_unit(head, rows, tmp_path):
    path = tmp_path / "impacts.csv"
    path.write_text("\n".join([head.replace("\\ufeff", "\ufeff"), *rows]), encoding="utf-8")
    found = read(path)
    assert found.speed == pytest.approx(SPEED, rel=1e-15)
    assert found.radius == pytest.approx(RADIUS, rel=1e-15)
    assert (found.thickness, found.weights, found.plate, found.pair) == (None, None, None, None)


def test_sizes_are_those_that_would_be_typed(tmp_path):
    """Plates of 0.9 mm in a file and on the command line are one plate."""
    (tmp_path / "a.csv").write_text("speed,thickness_mm\n" + "\n".join(
        f"1,{size}" for size in (0.1, 0.3, 0.7, 0.9, 1.1)))  # fmt: skip
    found = read(tmp_path / "a.csv").thickness.tolist()
    assert found == [0.1e-3, 0.3e-3, 0.7e-3, 0.9e-3, 1.1e-3]


def test_weights_and_plates_and_a_half_space(tmp_path):
    text = "plate,speed,thickness_mm,weight\n0,1,0.5,3\n-1,9,9,9\n1,2,inf,1.5\n"
    (tmp_path / "a.csv").write_text(text)
    found = read(tmp_path / "a.csv")
    assert found.speed.tolist() == [1, 2]  # bead on bead is left out
    assert found.thickness.tolist() == [0.5e-3, math.inf]
    assert found.weights.tolist() == [3, 1.5]
    assert found.plate.tolist() == [0, 1]


def test_a_record_of_an_engine(tmp_path):
    rows = np.zeros(3, IMPACT)
    rows["approach_speed"], rows["plate"] = SPEED, [1, -1, 0]
    np.save(tmp_path / "impacts.npy", rows)
    found = read(tmp_path / "impacts.npy")
    assert found.speed.tolist() == [0.5, 3.0]
    assert found.plate.tolist() == [1, 0]


def test_a_rain_of_the_demo(tmp_path):
    rain = ["rain", "--beads", "12", "--plates", "0.5e-3,inf", "--duration", "0.2", "--seed", "3"]
    assert cli.main([*rain, "--out", str(tmp_path / "rain")]) == 0
    found, run = read(tmp_path / "rain/rain.h5"), reader.read(tmp_path / "rain/rain.h5")
    rows = run.collisions[run.collisions["plate"] >= 0]
    assert rows.size > 5
    assert found.speed.tolist() == rows["approach_speed"].tolist()
    assert found.radius.tolist() == run.scene.beads.radius[rows["bead"]].tolist()
    plates = np.array([0.5e-3, math.inf])
    assert found.thickness.tolist() == plates[rows["plate"]].tolist()
    assert found.pair == run.model.pair
    assert found.law == run.law


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        (
            "a.csv",
            "velocity,radius\n1,2\n",
            "no column of speeds in its first line, 'velocity, rad",
        ),
        ("a.csv", "", "no column of speeds in its first line, ''"),
        ("a.csv", "speed_m/s\n", "it has no impact on a plate"),
        ("a.csv", "speed,plate\n1,-1\n", "it has no impact on a plate"),
        ("a.csv", "speed_m/s\n1\nfast\n", "could not convert string 'fast'"),
        ("a.csv", "speed_m/s\n1\n-2\n", r"speed: got -2.0 \(element 1\); must lie between"),
        ("a.csv", "speed_m/s\n1\nnan\n", "speed: got nan"),
        ("a.csv", "speed,radius_mm\n1,900000000\n", "radius: got 900000.0"),
        (
            "a.csv",
            "speed [mph]\n1\n",
            r"'speed \[mph\]': 'mph' is no unit of speed; take m/s, cm/s",
        ),
        ("a.csv", "speed,normal speed\n1,2\n", "two columns of speed, 'speed' and 'normal speed'"),
        ("a.csv", b"\xff\xfe\x00\x01speed", "neither text, nor HDF5"),
        ("a.npy", b"speed", "no file of np.save"),
        ("a.h5", b"speed", "no HDF5 file, or a damaged one"),
        ("a.h5", None, "no record of dem-demo, whose format is 'contactlaw-rain'"),
    ],
)
def test_what_is_refused(name, content, message, tmp_path):
    path = tmp_path / name
    if content is None:
        h5py.File(path, "w").close()
    else:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ValueError, match=message) as refused:
        read(path)
    assert str(refused.value).startswith(str(path))


def test_a_file_that_is_not_there(tmp_path):
    for name in ("a.csv", "a.h5", "a.npy"):
        with pytest.raises(OSError, match="No such file"):
            read(tmp_path / name)


def test_combinations_and_completions():
    every = combined([1.0, 2.0], [1e-3, 2e-3], [5e-4])
    assert every.speed.tolist() == [1, 2, 1, 2]
    assert every.radius.tolist() == [1e-3, 1e-3, 2e-3, 2e-3]
    assert every.weights.tolist() == [1] * 4
    run = Recorded(np.array([1.0, 2.0, 3.0]), plate=np.array([0, 1, 0]))
    assert completed(run, [1e-3], [5e-4]).thickness.tolist() == [5e-4] * 3
    assert completed(run, [1e-3], [5e-4, 2e-3]).thickness.tolist() == [5e-4, 2e-3, 5e-4]


@pytest.mark.parametrize(
    ("radii", "thicknesses", "message"),
    [
        (None, [1e-3], "radius: has to be given, no record says it"),
        ([1e-3], None, "thickness: has to be given"),
        ([1e-3, 2e-3], [1e-3], "radius: got 2 values for 1 in the record"),
        ([1e-3], [1e-3, 2e-3, 3e-3], "thickness: got 3 values for 2 in the record"),
    ],
)
def test_what_a_record_does_not_say_has_to_be_given(radii, thicknesses, message):
    run = Recorded(np.array([1.0, 2.0]), plate=np.array([0, 1]))
    with pytest.raises(ValueError, match=message):
        completed(run, radii, thicknesses)
    whole = Recorded(np.ones(1), np.full(1, 1e-3), np.full(1, 2e-3))
    with pytest.raises(ValueError, match="radius: the record has its own: leave this one out"):
        completed(whole, [1e-3], None)
