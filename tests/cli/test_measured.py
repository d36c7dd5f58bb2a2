"""`fit` and `compare` of files with mistakes: which rows are used, and what is said of the others."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.engines.record import IMPACT

PAIR = ["--sphere", "gamma-alumina", "--plate", "glass"]
BEAD = [*PAIR, "--radius", "0.9mm", "--thickness", "2mm"]
HEAD = "speed_m/s,COR,COR_error"
GOOD = ["1,0.96,0.01", "2,0.95,0.01", "3,0.94,0.01", "4,0.94,0.01"]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Work in an empty folder."""
    monkeypatch.chdir(tmp_path)


def write(name, *lines):
    Path(name).write_text("\n".join(lines), "utf-8")


def ran(capsys, *words):
    """Exit status, standard output and standard error of a command line."""
    try:
        status = main([*words])
    except SystemExit as stop:
        status = stop.code
    said = capsys.readouterr()
    return status, said.out, said.err


DATA = {"speed": 6.0, "radius": 0.9e-3, "thickness": 0.6e-3, "restitution": 0.1, "restitution_error": 0.01}
WRONG_ROWS = [
    ("5,0.9", "line 4 fills 2 of 3 columns, '5,0.9'"),
    ("5,0.9,lost", "line 4, column 'COR_error': 'lost' is no number such as 1.5"),
    ("5,0.9 %,0.01", "line 4, column 'COR': '0.9 %' is no number such as 1.5"),
    ("5,85,0.01", "line 4: restitution: got 85.0; must lie between 0.001 and 1.2"),
    (",0.9,0.01", "line 4: speed: got nan"),
    ("-5,0.9,0.01", "line 4: speed: got -5.0"),
    ("5,0.9,", "line 4: restitution_error: got nan"),
    ("5,0.9,-0.01", "line 4: restitution_error: got -0.01"),
]


@pytest.mark.parametrize(("row", "said"), WRONG_ROWS)
@pytest.mark.parametrize("asked", [["fit", "--unknown", "thickness"], ["compare"]], ids=["fit", "compare"])
def test_a_wrong_row_is_named_and_does_not_end_the_table_of_the_others(asked, row, said, capsys):
    command, *more = asked
    more += BEAD[:-2] if more else BEAD
    write("good.csv", HEAD, *GOOD[:2], "", *GOOD[2:])
    write("hits.csv", HEAD, *GOOD[:2], row, *GOOD[2:])
    status, wanted, err = ran(capsys, command, "good.csv", *more, "--json")
    assert (status, err) == (0, "")
    status, printed, err = ran(capsys, command, "hits.csv", *more, "--json")
    assert status == 0 and json.loads(printed) == json.loads(wanted)
    assert err.startswith(f"contactlaw: warning: hits.csv: left out: {said}") and err.count("\n") == 1


@pytest.mark.parametrize(("row", "said"), WRONG_ROWS)
def test_a_table_with_as_many_wrong_rows_as_good_ones_is_refused(row, said, capsys):
    write("hits.csv", HEAD, GOOD[0], "", row, GOOD[1], row)
    status, out, err = ran(capsys, "compare", "hits.csv", *BEAD)
    assert (status, out) == (1, "") and f"contactlaw: hits.csv: {said}" in err
    assert err.endswith("(half of all rows or more are wrong)\n")


def test_a_row_of_a_plate_that_is_too_thin_is_left_out_too(capsys):
    write("hits.csv", "v,COR,COR_error,thickness_mm", "1,0.9,0.01,2", "2,0.5,0.01,0.001", "3,0.9,0.01,2")
    status, out, err = ran(capsys, "compare", "hits.csv", *BEAD[:-2])
    assert status == 0 and "Chi-squared is" in out and "for 2 rebounds" in out
    assert "hits.csv: left out: line 3: thickness: got 1e-06; R/H is 900 beside a radius of 0.0009" in err


def test_a_wrong_drop_is_named_by_its_line_though_its_bounces_are_rows_of_their_own(capsys):
    rows = "30,440,400,5", "30,440,400,6", "30,400,420,7", "30,440,400,8", "30,440,400,0.0001", "30,440,400,9"
    write("drops.csv", "# ours", "drop_cm,t1_ms,t2_ms,thickness_mm", *rows)
    asked = ["--radius", "5mm", "--unknown", "plate_youngs_modulus", "--json"]
    status, out, err = ran(capsys, "fit", "drops.csv", *PAIR, *asked)
    first, second = (line for line in err.splitlines() if "left out" in line)
    assert "drops.csv: left out: line 5: t2: got 0.42; a bead that arrives at" in first
    assert "drops.csv: left out: line 7: thickness: got 1.0000000000000001e-07; R/H" in second
    assert status == 0 and len(json.loads(out)["flags"]) == 8


ODD = {
    "fit none.csv --unknown thickness": (1, "none.csv: No such file or directory"),
    "fit none.h5 --unknown thickness": (1, "none.h5: No such file or directory"),
    "fit folder --unknown thickness": (1, "folder: it is no regular file"),
    "fit empty.csv --unknown thickness": (1, "empty.csv: no column of speeds in its first line, ''"),
    "fit binary.csv --unknown thickness": (1, "binary.csv: a binary file, expected a table of text"),
    "fit binary.h5 --unknown thickness": (1, "binary.h5: no HDF5 file, or a damaged one"),
    "fit unit.csv --unknown thickness": (
        1,
        "unit.csv: no column of speeds in its first line, 'speed [furlong], COR': call one",
    ),
    "fit toml.csv --unknown thickness": (1, "toml.csv: the lines with # above its table are no TOML"),
    "fit size.csv --unknown thickness": (1, "size.csv: diameter in its head: got '6 inch': 'inch' is no unit"),
    "fit key.csv --unknown thickness": (1, "key.csv: unknown 'diametre'; did you mean diameter?"),
    "fit head.csv --unknown thickness": (1, "head.csv: data: got no rebound, at least one is needed"),
    "fit comma.csv --unknown thickness": (1, "comma.csv: line 2 fills 4 of 2 columns, '1,5,0,9': a decimal comma?"),
    "fit good.csv good.csv --unknown thickness": (1, "good.csv: only the files of one record"),
    "fit good.npy good.csv --unknown thickness": (1, "good.csv: no HDF5 file"),
    "fit --unknown thickness": (2, "the following arguments are required: FILE"),
    "fit good.csv": (2, "--unknown"),
    "fit good.csv --unknown thicknes": (2, "unknown 'thicknes'; did you mean thickness?"),
    "fit good.csv --unknown plate-yeld-strength": (2, "did you mean plate_yield_strength?"),
    "fit good.csv --unknown xyz": (2, "unknown 'xyz'; known: yield_strength, "),
    "fit good.csv --unknown thickness,thickness": (1, "--unknown: got ['thickness', 'thickness']; must be one to 3"),
    "fit good.csv --unknown=": (2, "unknown ''; known: yield_strength"),
    "fit good.csv --unknown thickness --prior radiu=1mm": (2, "unknown 'radiu'; did you mean radius?"),
    "fit good.csv --unknown thickness --prior radius": (2, "got 'radius', expected NAME=ERROR"),
    "fit good.csv --unknown thickness --prior radius=": (2, "got 'radius=', expected NAME=ERROR"),
    "fit good.csv --unknown thickness --prior radius=1kg": (2, "'kg' is no unit of length"),
    "fit good.csv --unknown thickness --prior radius=-1mm": (1, "--prior: got -0.001; the standard error of radius"),
    "fit good.csv --unknown thickness --plot fit.txt": (1, "--plot: got 'fit.txt'; must end in .png"),
    "fit good.csv --unknown thickness --plot none/fit.png": (1, "--plot: there is no folder none"),
    "fit good.csv --unknown thickness --json --plot fit.png": (2, "not allowed with"),
    "fit good.csv --unknown thickness --sphere steel": (1, "did you mean 'carbon-steel-1020'"),
    "compare": (2, "FILE"),
    "compare exact.csv": (1, "restitution_error: has to be given for each rebound"),
    "compare times.csv": (1, "radius: has to be given with heights or times"),
    "compare good.csv good.csv": (2, "unrecognized arguments: good.csv"),
    "compare good.csv --law fme": (1, "--law: got 'fme'; unknown law; did you mean 'fem'"),
    "compare good.csv --radius 1": (1, "R/H is 500 beside a radius of 1.0"),
    "compare good.csv --csv --json": (2, "not allowed with"),
    "compare good.csv --plate galss": (1, "did you mean 'glass'"),
}


@pytest.mark.parametrize("line", ODD)
def test_odd_command_lines_are_answered_in_words(line, capsys):
    Path("folder").mkdir()
    write("empty.csv")
    write("unit.csv", "speed [furlong],COR", "1,0.9")
    write("toml.csv", "# title = steel", "speed,COR", "1,0.9")
    write("size.csv", '# diameter = "6 inch"', "speed,COR", "1,0.9")
    write("key.csv", '# diametre = "6mm"', "speed,COR", "1,0.9")
    write("head.csv", HEAD)
    write("comma.csv", "speed,COR", "1,5,0,9")
    write("exact.csv", "speed,COR", "1,0.9")
    write("times.csv", "drop_cm,t1_ms", "30,400")
    write("good.csv", HEAD, *GOOD)
    for name in ("binary.csv", "binary.h5"):
        Path(name).write_bytes(bytes(range(256)))
    np.save("good.npy", np.zeros(2, IMPACT))
    command, *words = line.split()
    sizes = [] if "times" in line or "--radius" in line else ["--radius", "0.9mm"]
    sizes += ["--thickness", "2mm"] if command == "compare" and words and "--thickness" not in line else []
    bodies = {"--sphere": "gamma-alumina", "--plate": "glass"}
    missing = [word for option, name in bodies.items() if option not in line for word in (option, name)]
    status, words_needed = ODD[line]
    found = ran(capsys, command, *words, *sizes, *missing)
    assert found[:2] == (status, "") and words_needed in " ".join(found[2].split()), found
    assert "Traceback" not in found[2] and not Path("fit.png").exists()


def test_no_line_on_a_terminal_is_wider_than_80_columns(capsys):
    names = "my own aluminium from the shop at the corner", "soda-lime-glass"
    write(
        "wide.csv",
        f'# title = "{"A title that goes on and on. " * 8}"',
        '# sphere = "pom"',
        "speed_m/s,angle_deg,radius_mm,thickness_mm,COR,COR_error,contact_time_us,peak_force_N,beta",
        *(
            f"{v},{a},2.123,{h},0.81,0.03,{30 * v**-0.2},{20 * v**1.2},0.3"
            for v, a, h in zip((1, 2, 3, 4), (30, 40, 50, 60), (3, 3, 4, "inf"), strict=True)
        ),
    )
    body = f"name={names[0]} E=70GPa nu=0.33 rho=2700 yield=250MPa kind=metal"
    for command in (
        ["fit", "--unknown", "youngs_modulus", "--friction", "0.2", "--plate", "glass"],
        ["compare"],
        ["compare", "--law", "hertz"],
    ):
        plate = [] if "--plate" in command else ["--plate", body]
        status, out, err = ran(capsys, command[0], "wide.csv", *command[1:], *plate)
        assert status == 0, err
        assert out and max(map(len, out.splitlines())) <= 80, [one for one in out.splitlines() if len(one) > 80]


def test_a_law_that_passes_by_its_own_large_error_is_said_to(capsys):
    """Data far from law fem, as its own error is small, are within that of Hertz's."""
    write("hits.csv", HEAD, *(f"{v},{0.955 - 0.003 * v},0.003" for v in (1, 2, 3, 4)))
    status, out, _ = ran(capsys, "compare", "hits.csv", *BEAD)
    words = " ".join(out.split())
    assert status == 0 and "the data differ from the model by more than the stated errors explain" in words
    passing = re.search(r"nearest to the data\. (.*) would pass the test above, too, but only because", words)
    assert "hertz" in passing[1] and "fem" not in passing[1]
    assert "by chance" not in words


def test_a_law_that_cannot_be_used_does_not_end_the_comparison(capsys):
    write("hits.csv", HEAD, "6,0.1,0.01", "2,0.1,0.01")
    asked = ["hits.csv", "--sphere", "bearing-steel-52100", "--plate", "aluminium-6061-t6", *BEAD[4:7], "0.6mm"]
    with pytest.raises(cl.ArgumentError, match="law"):
        cl.compare(cl.Pair(asked[2], asked[4]), DATA, "jackson_green")
    status, out, err = ran(capsys, "compare", *asked)
    assert (status, err) == (0, "") and "myc" in out and "jackson_green" not in out
