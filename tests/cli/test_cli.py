"""The command line: what it prints, and its exit status."""

import argparse
import re
import signal
import subprocess
import sys

import numpy as np
import pytest
from command_line import parsers, run
from places import ROOT

import contactlaw as cl
from contactlaw import __main__, cli, table
from contactlaw.cli import main

PAIR = "cor --sphere gamma-alumina --plate glass --law myc"
IMPACT = f"{PAIR} --radius 0.9e-3 --thickness 1e-3 --speed 12"
MANY = f"{PAIR} --radius 0.9mm --thickness 0.5mm,1mm,inf --speed 1,5"

# Ends of bands.
ENDS = [f"{name}_{end}" for name in ("restitution", "contact_time", "peak_force") for end in ("low", "high")]
ASKED = {"sphere": "gamma-alumina", "plate": "glass", "law": "myc"}
SIZES = {"speed": 12.0, "radius": 0.9e-3, "thickness": 1e-3}


def test_json_holds_every_field_and_units_are_those_of_the_si(model, answer):
    printed = answer(f"{IMPACT} --json")
    hit = model.lookup(12.0, 0.9e-3, 1e-3)
    assert set(printed.values) == {*cl.Rebound.__dataclass_fields__, *ENDS, *ASKED, *SIZES}
    exact = {"restitution": hit.restitution, "contact_time": hit.contact_time, "flags": []}
    assert printed.values.items() >= {**ASKED, **SIZES, **exact}.items()
    assert answer(f"{IMPACT} --radius 900um --thickness '0.1 cm' --speed 43.2km/h --json") == printed
    assert answer(f"{IMPACT} --mass 4mg --json --no-band").values["mass_kg"] == 4e-6


def test_text_names_the_limits_exceeded_and_the_yield_speed(model, answer):
    text = answer(f"{IMPACT} --thickness 0.45mm --speed 70").text
    assert "THIN_PLATE, FAST_IMPACT" in text
    for words in cl.explain(cl.Validity.THIN_PLATE | cl.Validity.FAST_IMPACT):
        assert words in text
    for law in ("myc", "hertz"):
        yields = f"yield_speed           {model.yield_speed(0.9e-3, 1e-3):.6g} m/s\n"
        assert yields in answer(f"{IMPACT} --law {law}").out
    for wall in ("--thickness 0.05e-3 --outside solve", "--cylinder 5cm"):
        assert "yield_speed           not known\n" in answer(f"{IMPACT} {wall}").out


def test_several_values_are_every_combination(model, answer):
    """As JSON, and as CSV with units in its header and every digit."""
    hit = model.lookup([1.0, 5.0] * 3, 0.9e-3, np.repeat([0.5e-3, 1e-3, np.inf], 2))
    objects, rows = answer(f"{MANY} --json").values, answer(f"{MANY} --csv --no-band").rows
    assert [(row["thickness"], row["speed"]) for row in objects] == [
        (size, speed) for size in (0.5e-3, 1e-3, "inf") for speed in (1, 5)
    ]
    assert [row["restitution"] for row in objects] == hit.restitution.tolist() and objects[0]["flags"] == []
    assert [*rows[0]][:5] == ["speed_m/s", "radius_m", "thickness_m", "restitution", "contact_time_s"]
    assert [*rows[0].items()][-4:] == [*ASKED.items(), ("flags", "")]
    assert [float(row["contact_time_s"]) for row in rows] == hit.contact_time.tolist()
    assert len(answer(f"{IMPACT} --csv").rows) == 1


def test_flags_of_a_table_are_letters_that_are_explained_below_it(answer):
    """The other columns are those of the pages of docs, which tests/test_readme.py compares."""
    _, names, _, *rows = answer(f"{MANY} --speed 1,70").out.splitlines()
    assert names.split()[-1] == "flags"
    assert [row.endswith("  a") for row in rows[:6]] == [False, True] * 3
    (words,) = cl.explain(cl.Validity.FAST_IMPACT)
    legend = " ".join(" ".join(rows[6:]).split())
    assert legend.startswith(f"a: FAST_IMPACT, 3 of 6: {words} 68 %: two in three real impacts lie here")


def test_columns_that_do_not_fit_are_named(answer):
    """Three lists and flags: all lines keep to 80 columns, and the table says what CSV has."""
    lines = answer(f"{MANY} --speed 1,70 --radius 0.6mm,0.9mm").out.splitlines()
    assert max(map(len, lines)) <= 80 and lines[1].split()[-2:] == ["plastic", "flags"]
    assert "CSV has more columns than fit here: wave, other." in lines


@pytest.mark.parametrize("command", [f"{IMPACT} --no-band", IMPACT.replace("cor", "constant", 1)])
def test_a_spreadsheet_computes_no_name(command, answer):
    for name, shown in {"=1+1": "'=1+1", "@SUM(1)": "'@SUM(1)", "glass": "glass"}.items():
        (row,) = answer(f"{command} --sphere 'E=70GPa nu=0.2 rho=2500 yield=2GPa name={name}' --csv").rows
        assert row["sphere"] == shown


def test_help_comes_at_once():
    """It lists every subcommand, and loads nothing that takes long."""
    code = (
        "import sys; from contactlaw import cli; text = cli.parser([]).format_help()\n"
        "print(text); assert not {'numpy', 'numba', 'h5py'} & {*sys.modules}"
    )
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    groups = re.findall(r"^(\w+):\n((?:  .*\n)+)", shown.stdout.partition("exit\n")[2], re.MULTILINE)
    assert [title for title, _ in groups] == ["ask", "measure", "engines", "pages"]
    listed = re.findall(r"^  ([a-z]+) ", "".join(lines for _, lines in groups), re.MULTILINE)
    assert listed == re.findall(r"^    ([a-z-]+)\b", cli.parser().format_help(), re.MULTILINE)
    assert max(map(len, shown.stdout.splitlines())) <= 80


def test_a_new_file_is_enough_for_a_new_subcommand(tmp_path, monkeypatch, answer):
    words = "def add(commands):\n    commands.add_parser('greet').set_defaults(run=lambda _: print('hello'))\n"
    (tmp_path / "greet.py").write_text(f'"""``contactlaw greet`` (people): say hello."""\n{words}')
    monkeypatch.setattr(cli, "__path__", [*cli.__path__, str(tmp_path)])
    assert "\npeople:\n  greet       say hello\n" in cli.parser([]).format_help()
    assert answer("greet").out == "hello\n"


@pytest.mark.parametrize(("name", "parser"), list(parsers(cli.parser())))
def test_every_option_is_explained(name, parser, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    for action in parser._actions:
        assert action.help, (name, action.dest)
        if action.nargs != 0 and action.default not in (None, False, [], argparse.SUPPRESS):
            assert "default" in action.help, (name, action.dest)
    assert max(map(len, parser.format_help().splitlines())) <= 80  # and no stray per cent sign
    assert parser.description


STEEL = "--sphere stainless-steel-304 --plate aluminium-6082-t6"
LISTS = f"{STEEL} --radius 0.5mm,0.9mm --thickness 0.3mm,1mm,inf --speed 1,70"
LONG = "'name=my own aluminium from the shop at the corner E=70GPa nu=0.33 rho=2700 yield=250MPa kind=metal'"
HEAD = f"""# title = "{8 * "A title that goes on and on. "}"
# sphere = "pom"
speed_m/s,angle_deg,radius_mm,thickness_mm,COR,COR_error,contact_time_us,peak_force_N,beta
1,30,2.123,3,0.81,0.03,30,20,0.3
2,40,2.123,4,0.81,0.03,26,46,0.3
3,50,2.123,inf,0.81,0.03,24,75,0.3
"""


@pytest.mark.parametrize(
    "line",
    [
        f"{IMPACT} --causes --on steel-s235:3mm --mass 5mg --speed 60",
        f"{MANY} --causes",
        f"cor {LISTS} --outside solve",
        f"cor {LISTS} --angle 30,60 --friction 0.1,0.4",
        f"{IMPACT} --angle 30 --friction 0.1 --cylinder 50mm",
        f"cor {LISTS} --outside solve --out a-file-of-a-grid-in-the-folder-of-the-user.csv",
        f"{IMPACT} --sphere 'E=2.8GPa nu=0.35 rho=1410 yield=62MPa kind=polymer' --law fem --no-band",
        "materials",
        "materials stainless-steel-304",
        "table info",
        f"find thickness {STEEL} --cor 0.3,0.5,0.99 --radius 1mm,2mm --speed 1,3",
        f"find speed {STEEL} --cor 0.5,0.9 --radius 1mm --thickness 1mm,2mm,inf",
        f"constant {STEEL} --radius 1mm --thickness 0.5mm,1mm --speed 1,70 --outside solve",
        "fit wide.csv --unknown youngs_modulus --friction 0.2 --plate glass",
        f"compare wide.csv --plate {LONG}",
        f"compare wide.csv --plate {LONG} --law hertz",
    ],
)
def test_no_line_is_wider_than_a_terminal(line, folder, answer):
    (folder / "wide.csv").write_text(HEAD)
    lines = answer(line).out.splitlines()
    assert lines and max(map(len, lines)) <= 80
    if "find" in line:
        heads = next(words for words in map(str.split, lines) if line.split()[1] in words)
        assert len({*heads}) == len(heads)


def test_materials(answer):
    head, units, *lines = answer("materials").out.split("\n\n")[0].splitlines()
    assert head.split() == ["name", "E", "nu", "rho", "yield", "H", "B", "n"]
    assert len({len(line) for line in (head, units, *lines)}) == 1
    shown = {line.split()[0]: line.split()[1:] for line in lines}
    assert list(shown) == list(cl.materials())
    assert shown["glass"] == ["73", "0.21", "2.5", *4 * ["-"]]
    assert shown["stainless-steel-304-ball"][2:] == ["8", "-", "3.119", "-", "-"]
    glass = next(entry for entry in answer("materials --json").values if entry["name"] == "glass")
    assert (glass["youngs_modulus"], glass["yield_strength"]) == (73e9, None)
    _, _, numbers, *text = answer("materials copper-ofhc-annealed").out.splitlines()
    assert numbers.split() == [*shown["copper-ofhc-annealed"], "0.025", "-"]
    assert shown["copper-ofhc-annealed"][3:] == ["90", "-", "292", "0.31"]
    assert "copper-ofhc-annealed: Oxygen-free copper" in " ".join(text)


def test_tables_are_described_and_checked(answer, capsys, monkeypatch):
    monkeypatch.setattr("secrets.randbits", lambda bits: 5)
    assert re.search("law myc:.*restitution", answer("table info").text)
    assert answer(f"table info {ROOT}/contactlaw/data/myc.h5") == answer("table info")
    pair = "--sphere stainless-steel-304 --plate glass"  # whose numbers the law takes
    assert "law fem:" in answer(f"table info --law fem {pair}").out
    assert "seed 5" in answer("table check --points 1000").out
    monkeypatch.setattr("contactlaw.table.table.bounds", lambda law: dict.fromkeys(table.BOUNDS, 0.0))
    checked = run("table check --points 500", capsys)
    assert checked.status == 1 and "exceeds its bounds" in checked.err


@pytest.mark.parametrize("place", [(cli, "parser"), (table, "certify")])
def test_ctrl_c_leaves_a_sentence_and_nothing_else(place, folder, capsys, monkeypatch):
    """While a subcommand is imported, and in the middle of a long check."""
    monkeypatch.setattr(*place, lambda *_, **__: signal.raise_signal(signal.SIGINT))
    monkeypatch.setattr(sys, "argv", ["contactlaw", "table", "check"])
    assert __main__.main() == 130
    assert capsys.readouterr() == ("", "contactlaw: interrupted\n")
    assert list(folder.iterdir()) == []


NAMED = "'E=2GPa nu=0.3 rho=1000 kind=ceramic name=Öl' --plate glass --radius 1mm --thickness 1mm --speed 1 --no-band"


@pytest.mark.parametrize(
    ("words", "status", "message"),
    [
        ("materials | head -1", 0, ""),
        ("materials --json | head -1", 0, ""),
        ("materials >&-", 1, "contactlaw: the standard output is closed\n"),
        ("materials nothing 2>&-", 1, ""),
        ("materials > /dev/full", 1, "contactlaw: No space left on device\n"),
        (f"cor --sphere {NAMED}", 1, "set PYTHONIOENCODING=utf-8\n"),
    ],
)
def test_an_output_that_takes_not_all_ends_in_words(words, status, message):
    command = f"PYTHONIOENCODING=ascii {sys.executable} -u -m contactlaw {words}"
    code = f"{command}; exit ${{PIPESTATUS[0]}}"  # its own, not that of the last command of a pipe
    done = subprocess.run(["bash", "-c", code], capture_output=True, text=True)
    assert done.returncode == status and (done.stdout == "") == (status > 0)
    assert done.stderr.endswith(message) if message else done.stderr == ""


def test_a_history_is_csv_with_the_question_and_the_flags_in_each_row(model, answer):
    history = f"{IMPACT} --history --samples 5"
    printed = answer(history)
    names = "time_s force_N compression_m impulse_Ns plate_displacement_m".split()
    contact = model.force_history(12.0, 0.9e-3, 1e-3, samples=5, method="solve")
    values = [[float(row[name]) for name in names] for row in printed.rows]
    assert values == pytest.approx(np.column_stack(contact), rel=1e-12)
    assert printed.rows[0].items() >= {**ASKED, "speed_m/s": "12.0", "radius_m": "0.0009", "flags": ""}.items()
    rows = answer(f"{IMPACT} --history --speed 60 --thickness 0.3mm").rows
    assert len(rows) == 256 and {row["flags"] for row in rows} == {"THIN_PLATE|FAST_IMPACT"}


def test_a_plot_without_matplotlib_says_what_to_install(monkeypatch, capsys, folder):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert main([*IMPACT.split(), "--plot", "cor.png"]) == 1
    assert "pip install 'contactlaw[demo]'" in capsys.readouterr().err
