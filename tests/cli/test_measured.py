"""`fit` and `compare` of files with mistakes: which rows are used, and what is said of the others."""

import re
from pathlib import Path

import pytest
from command_line import run

import contactlaw as cl

PAIR = "--sphere gamma-alumina --plate glass"
BEAD = f"{PAIR} --radius 0.9mm --thickness 2mm"
HEAD = "speed_m/s,COR,COR_error"
GOOD = ["1,0.96,0.01", "2,0.95,0.01", "3,0.94,0.01", "4,0.94,0.01"]

pytestmark = pytest.mark.usefixtures("folder")


def write(name, *lines):
    Path(name).write_text("\n".join(lines), "utf-8")


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


@pytest.mark.parametrize(("row", "words"), WRONG_ROWS)
def test_a_wrong_row_is_named_and_does_not_end_the_table_of_more_good_ones(row, words, answer, capsys):
    write("good.csv", HEAD, *GOOD[:2], "", *GOOD[2:])
    write("hits.csv", HEAD, *GOOD[:2], row, *GOOD[2:])
    write("half.csv", HEAD, GOOD[0], "", row, GOOD[1], row)
    wanted, printed = (answer(f"compare {name}.csv {BEAD} --json") for name in ("good", "hits"))
    assert printed.values == wanted.values and wanted.err == ""
    assert printed.err.startswith(f"contactlaw: warning: hits.csv: left out: {words}") and printed.err.count("\n") == 1
    refused = run(f"compare half.csv {BEAD}", capsys)
    assert (refused.status, refused.out) == (1, "") and f"contactlaw: half.csv: {words}" in refused.err
    assert refused.err.endswith("(half of all rows or more are wrong)\n")


@pytest.mark.filterwarnings("ignore:the air changes")
def test_a_wrong_drop_is_named_by_its_line_though_its_bounces_are_rows_of_their_own(answer):
    rows = "30,440,400,5", "30,440,400,6", "30,400,420,7", "30,440,400,8", "30,440,400,0.0001", "30,440,400,9"
    write("drops.csv", "# ours", "drop_cm,t1_ms,t2_ms,thickness_mm", *rows)
    fitted = answer(f"fit drops.csv {PAIR} --radius 5mm --unknown plate_youngs_modulus --json")
    first, second = fitted.err.splitlines()
    assert "drops.csv: left out: line 5: t2: got 0.42; a bead that arrives at" in first
    assert "drops.csv: left out: line 7: thickness: got 1.0000000000000001e-07; R/H" in second
    assert len(fitted.values["flags"]) == 8


def test_a_law_that_passes_by_its_own_large_error_is_said_to(answer):
    """Data far from law fem, as its own error is small, are within that of Hertz's."""
    write("hits.csv", HEAD, *(f"{v},{0.955 - 0.003 * v},0.003" for v in (1, 2, 3, 4)))
    words = answer(f"compare hits.csv {BEAD}").text
    assert "the data differ from the model by more than the stated errors explain" in words
    passing = re.search(r"nearest to the data\. (.*) would pass the test above, too, but only because", words)
    assert "hertz" in passing[1] and "fem" not in passing[1]
    assert "by chance" not in words


def test_a_law_that_cannot_be_used_does_not_end_the_comparison(answer):
    write("hits.csv", HEAD, "6,0.1,0.01", "2,0.1,0.01")
    pair = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
    data = {"speed": 6.0, "radius": 0.9e-3, "thickness": 0.6e-3, "restitution": 0.1, "restitution_error": 0.01}
    with pytest.raises(cl.ArgumentError, match="law"):
        cl.compare(pair, data, "jackson_green")
    bodies = f"--sphere {pair.sphere.name} --plate {pair.plate.name}"
    printed = answer(f"compare hits.csv {bodies} --radius 0.9mm --thickness 0.6mm")
    assert printed.err == "" and "myc" in printed.out and "jackson_green" not in printed.out
