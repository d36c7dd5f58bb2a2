"""Impacts that have happened, as files have them; each column against what was written.

`contactlaw constant` prints only what follows from the columns, so most tests read them by its function `read`.
"""

import math
import os
import random
from pathlib import Path

import numpy as np
import pytest
from command_line import run
from rains import write_rain

import contactlaw as cl
from contactlaw.cli.constant.records import read
from contactlaw.engines.record import IMPACT

PAIR = "--sphere gamma-alumina --plate glass"

pytestmark = pytest.mark.usefixtures("folder")


def impacts_of(path):
    """The impacts of a file, which are of one pair, by the names of sizes."""
    (recorded,) = read(path)
    return recorded.impacts


def recorded(kinds):
    """An engine's rows, one for each kind of contact."""
    rows = np.zeros(len(kinds), IMPACT)
    rows["approach_speed"], rows["kind"] = 1.0 + np.arange(len(kinds)), kinds
    rows["restitution"], rows["radius"], rows["thickness"] = 0.9, 1e-3, 1e-3
    rows["mass"] = 4 / 3 * math.pi * 1e-9 * cl.material("gamma-alumina").density
    return rows


SPEED, RADIUS = [0.5, 1.2, 3.0], [0.9e-3, 1.1e-3, 1.0e-3]


@pytest.mark.parametrize(
    ("head", "rows"),
    [
        ("speed_m/s,radius_m", ["0.5,0.9e-3", "1.2,1.1e-3", "3,1e-3"]),
        ("Speed [cm/s];Radius [mm]", ["50;0.9", "120;1.1", "300;1"]),
        ("Approach speed (mm/s)\tother\tRADIUS_um", ["500\tx\t900", "1200\ty\t1100", "3e3\tz\t1e3"]),
        ("v;Bead diameter [mm]", ["0.5;1.8", "1.2;2.2", "3;2"]),
        ("# normal_speed m/s, time_s, radius mm", ["0.5, 1, 0.9", "1.2, 2, 1.1", "3, 3, 1.0"]),
        ('"impact speed [km/h]","radius [cm]"', ['"1.8",0.09', "4.32,0.11", "10.8,0.1"]),
        ("\ufeffspeed_m/s,radius_mm", ["0.5,0.9", "# a remark", "1.2,1.1", "3,1", ""]),
    ],
)
def test_columns_by_name_and_unit(head, rows):
    Path("a.csv").write_text("\n".join([head, *rows]), encoding="utf-8")
    impacts = impacts_of("a.csv")
    assert impacts["speed"] == pytest.approx(SPEED, rel=1e-15)
    assert impacts["radius"] == pytest.approx(RADIUS, rel=1e-15)
    assert impacts.keys() == {"speed", "radius"}


def test_sizes_are_those_that_would_be_typed():
    """A plate of 0.9 mm in a file, or in a pipe, equals a plate of 0.9 mm on the command line."""
    text = b"no,speed,thickness_mm,weight\n0,1,0.1,3\n1,2,0.3,1.5\n2,3,0.7,1\n3,4,0.9,1\n4,5,1.1,1\n5,6,inf,1\n"
    reader, writer = os.pipe()
    os.write(writer, text)
    os.close(writer)
    impacts = impacts_of(f"/dev/fd/{reader}")
    os.close(reader)
    assert impacts["speed"].tolist() == [1, 2, 3, 4, 5, 6]
    assert impacts["thickness"].tolist() == [0.1e-3, 0.3e-3, 0.7e-3, 0.9e-3, 1.1e-3, math.inf]
    assert impacts["weights"].tolist() == [3, 1.5, 1, 1, 1, 1]


def test_a_record_of_an_engine(pair):
    rows = np.zeros(3, IMPACT)
    rows["approach_speed"], rows["plate"], rows["mass"] = SPEED, [1, -1, 0], 1e-6
    rows["radius"], rows["thickness"] = RADIUS, [1e-3, 0.0, math.inf]
    np.save("impacts.npy", rows)
    impacts = impacts_of("impacts.npy")
    assert impacts["speed"].tolist() == [0.5, 3.0]
    assert impacts["radius"].tolist() == [RADIUS[0], RADIUS[2]]
    assert impacts["thickness"].tolist() == [1e-3, math.inf]
    rows["parcel"], rows["mass"], rows["thickness"] = [2.0, 1.0, 3.0], [8.0, 1.0, 54.0], 1e-3
    cl.Record(rows).save("impacts.h5")
    impacts = impacts_of("impacts.h5")  # a parcel stands for as many beads as fit into it
    assert impacts["weights"].tolist() == [8.0, 27.0] and impacts["mass"].tolist() == [1.0, 2.0]
    write_rain("rain.h5", pair)
    (rain,) = read("rain.h5")
    assert (rain.pair, rain.law) == (pair, "hertz")


def test_files_of_several_ranks_are_one_run(answer):
    rows = recorded([0, 0, 2, 0])
    rows["time"] = np.arange(4)
    np.save("all.npy", rows)
    for rank in range(2):
        np.save(f"hits.{rank}.npy", rows[rank::2])
    whole, ranks = (answer(f"constant {files} {PAIR} --csv").out for files in ("all.npy", "hits.0.npy hits.1.npy"))
    assert whole == ranks


def test_what_is_no_impact_is_left_out_and_said(answer, capsys):
    np.save("a.npy", recorded([0, 2, 0, 4, 2, 0]))
    assert impacts_of("a.npy")["speed"].tolist() == [1.0, 3.0, 6.0]
    words = "Of 6 contacts, 33 % left over the edge of a wall and 17 % stayed as under their weight; their COR"
    assert words in answer(f"constant a.npy {PAIR}").err
    np.save("a.npy", recorded([0, 0]))
    assert answer(f"constant a.npy {PAIR}").err == ""
    words = "--radius: the record has its own: leave this one out"
    assert words in run(f"constant a.npy {PAIR} --radius 1mm", capsys).err
    np.save("a.npy", recorded([1, 1]))
    words = "it has no impact on a plate: Of 2 contacts, 100 % slid on from another wall; their COR"
    assert words in run(f"constant a.npy {PAIR}", capsys).err


def test_rows_with_beads_of_two_materials_are_refused(answer, capsys):
    """Rows alone do not say which materials these are; the mass of each bead is that of its row."""
    rows = recorded([0] * 5)
    rows["mass"][3:] *= 2.0
    np.save("a.npy", rows)
    (row,) = answer(f"constant a.npy {PAIR} --csv").rows
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    best = model.constant(rows["approach_speed"], 1e-3, 1e-3, mass=rows["mass"]).restitution
    assert float(row["restitution"]) == pytest.approx(best, rel=1e-12)
    rows["material"][3:] = 1
    np.save("a.npy", rows)
    words = "a.npy: it has beads of several materials: save the record as .h5"
    assert words in run(f"constant a.npy {PAIR}", capsys).err


GOOD = {
    f"constant {PAIR} --law myc --radius 1mm --thickness 1mm --csv": b"v,weight,other\n1,1,0\n2.5,3,1\n",
    "materials --materials": b"# harmless here\n[a]\nlike = 'gamma-alumina'\nhardness = '60 HV'  # and here\n",
}
TOKENS = [b"", b"\0", b"nan", b"-1", b"1e999", b"[" * 3000, b"\xff", b"'", b",", b"=", b"\n", b"x"]


@pytest.mark.parametrize("line", GOOD)
def test_damaged_texts_are_answered_or_refused_by_name(line, capsys):
    choose, good, refused = random.Random(1), GOOD[line], 0
    for _ in range(40):
        place = choose.randrange(len(good))
        end = good[place + choose.randrange(3) :] * choose.randrange(3)
        Path("text").write_bytes(good[:place] + choose.choice(TOKENS) + end)
        made = run(f"{line} text", capsys)
        assert "nan" not in made.out and (made.status == 0 or "text: " in made.err)
        refused += made.status != 0
    assert 10 < refused < 40
