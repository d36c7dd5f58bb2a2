"""The command line: what it prints, and its exit status."""

import argparse
import csv
import io
import json
import os
import re
import signal
import subprocess
import sys
import warnings

import numpy as np
import pytest
from command_line import misused, parsers, refused

import contactlaw as cl
from contactlaw import cli, laws, table
from contactlaw.cli import main
from contactlaw.table import file

COR = ["cor", "--sphere", "gamma-alumina", "--plate", "glass", "--law", "myc"]
IMPACT = [*COR, "--radius", "0.9e-3", "--thickness", "1e-3", "--speed", "12"]


# Ends of bands.
ENDS = [f"{name}_{end}" for name in ("restitution", "contact_time", "peak_force") for end in ("low", "high")]
ASKED = {"sphere": "gamma-alumina", "plate": "glass", "law": "myc"}
SIZES = {"speed": 12.0, "radius": 0.9e-3, "thickness": 1e-3}


def test_cor_json_holds_every_field(model, capsys):
    assert main([*IMPACT, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    hit = model.lookup(12.0, 0.9e-3, 1e-3)
    assert set(printed) == {*cl.Rebound.__dataclass_fields__, *ENDS, *ASKED, *SIZES}
    assert printed.items() >= {**ASKED, **SIZES}.items()
    assert printed["restitution"] == hit.restitution
    assert printed["contact_time"] == hit.contact_time
    assert printed["flags"] == []


def test_a_mass_is_a_number_and_named_where_it_makes_a_plate_too_thin(capsys):
    assert main([*IMPACT, "--mass", "4mg", "--json", "--no-band"]) == 0
    assert json.loads(capsys.readouterr().out)["mass_kg"] == 4e-6
    thin = [*COR, "--radius", "0.9mm", "--thickness", "0.1mm", "--speed", "1", "--no-band"]
    refused([*thin, "--mass", "6mg"], ", mass 6 mg: outside the table, its inelasticity", capsys=capsys)


def test_cor_names_the_limits_exceeded(capsys):
    assert main([*COR, "--radius", "1e-3", "--thickness", "0.5e-3", "--speed", "70"]) == 0
    out = " ".join(capsys.readouterr().out.split())
    assert "THIN_PLATE, FAST_IMPACT" in out
    for words in cl.explain(cl.Validity.THIN_PLATE | cl.Validity.FAST_IMPACT):
        assert words in out


def test_the_law_of_hertz_names_the_yield_speed_too(model, capsys):
    for law in ("myc", "hertz"):
        assert main([*IMPACT, "--law", law]) == 0
        assert f"yield_speed           {model.yield_speed(0.9e-3, 1e-3):.6g} m/s\n" in capsys.readouterr().out


def test_cor_of_a_plate_too_thin_for_a_yield_speed(capsys):
    thin = [*COR, "--radius", "0.9e-3", "--thickness", "0.05e-3", "--speed", "5"]
    refused(thin, "outside the table", capsys=capsys)
    assert main([*thin, "--outside", "solve"]) == 0
    assert "yield_speed           not known\n" in capsys.readouterr().out
    assert main([*IMPACT, "--cylinder", "5cm"]) == 0
    assert "yield_speed           not known\n" in capsys.readouterr().out


MANY = [*COR, "--radius", "0.9mm", "--thickness", "0.5mm,1mm,inf", "--speed", "1,5"]


def test_units_are_those_of_the_si(capsys):
    assert main([*IMPACT, "--json"]) == 0
    plain = capsys.readouterr().out
    units = ["--radius", "900um", "--thickness", "0.1 cm", "--speed", "43.2km/h"]
    assert main([*IMPACT, *units, "--json"]) == 0
    assert capsys.readouterr().out == plain


def test_several_values_are_every_combination(model, capsys):
    assert main([*MANY, "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    asked = [(row["thickness"], row["speed"]) for row in rows]
    assert asked == [(0.5e-3, 1), (0.5e-3, 5), (1e-3, 1), (1e-3, 5), ("inf", 1), ("inf", 5)]
    for row in rows:
        hit = model.lookup(row["speed"], row["radius"], float(row["thickness"]))
        assert row["restitution"] == hit.restitution
    assert rows[0]["flags"] == []
    assert set(rows[0]) == {"speed", "radius", "thickness", *cl.Rebound.__dataclass_fields__, *ENDS, *ASKED}


def test_a_table_has_a_row_per_impact_and_units(capsys):
    assert main([*MANY, "--speed", "1,70"]) == 0
    question, names, units, *rows = capsys.readouterr().out.splitlines()
    assert question == "gamma-alumina on glass, law myc, radius 0.9 mm"
    assert names.split() == "speed thickness COR 68 % time force plastic wave other flags".split()
    assert units.split() == "[m/s] [mm] [-] [-] [us] [N] [%] [%] [%]".split()
    sizes = [row.split()[:2] for row in rows[:6]]
    assert sizes == [["1", "0.5"], ["70", "0.5"], ["1", "1"], ["70", "1"], ["1", "inf"], ["70", "inf"]]
    assert [row.endswith("  a") for row in rows[:6]] == [False, True] * 3
    assert rows[6] == ""
    (words,) = cl.explain(cl.Validity.FAST_IMPACT)
    legend = " ".join(" ".join(rows[7:]).split())
    assert legend.startswith(f"a: FAST_IMPACT, 3 of 6: {words} 68 %: two in three real impacts lie here")


def test_columns_that_do_not_fit_are_named(capsys):
    """Three lists and flags: all lines keep to 80 columns, and the table says what CSV has."""
    assert main([*MANY, "--speed", "1,70", "--radius", "0.6mm,0.9mm"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80 and lines[1].split()[-2:] == ["plastic", "flags"]
    assert "CSV has more columns than fit here: wave, other." in lines


def test_csv_has_units_in_its_header_and_every_digit(model, capsys):
    assert main([*MANY, "--csv", "--no-band"]) == 0
    out = capsys.readouterr().out
    header, *rows = csv.reader(io.StringIO(out))
    assert header[:5] == ["speed_m/s", "radius_m", "thickness_m", "restitution", "contact_time_s"]
    assert header[-4:] == [*ASKED, "flags"]
    assert rows[0][-4:] == [*ASKED.values(), ""]
    hit = model.lookup([1.0, 5.0] * 3, 0.9e-3, np.repeat([0.5e-3, 1e-3, np.inf], 2))
    assert [float(row[3]) for row in rows] == list(hit.restitution)
    assert [float(row[4]) for row in rows] == list(hit.contact_time)
    assert main([*IMPACT, "--csv"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 2


@pytest.mark.parametrize("command", ["cor", "constant"])
@pytest.mark.parametrize("name", ["=1+1", "@SUM(1)", "glass"])
def test_a_spreadsheet_computes_no_name(command, name, capsys):
    named = f"E=70GPa nu=0.2 rho=2500 yield=2GPa name={name}"
    argv = [command, *IMPACT[3:], "--sphere", named, "--csv"]
    assert main([*argv, *["--no-band"] * (command == "cor")]) == 0
    (row,) = csv.DictReader(io.StringIO(capsys.readouterr().out))
    assert row["sphere"] == ("glass" if name == "glass" else f"'{name}")
    assert 0.0 < float(row["restitution"]) < 1.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (["--thickness=-inf"], "--thickness: got '-inf'; must lie"),
        (["--sphere", "glass"], "--sphere: law 'myc' needs a yield strength, and material 'glass'"),
        (["--sphere", "glass"], "take --law fem"),
        (["--law", "kogut_etsion(9)"], "poissons_ratio must lie between 0 and 0.5, not '9'"),
        (["--speed", "1,1e4"], "--outside solve integrates the equation there, --outside clamp"),
        (["--solve", "--law", "hertz", "--speed", "1e4", "--radius", "1m", "--thickness", "1cm"], "did not solve"),
    ],
)
def test_refused_physics_is_status_1_and_one_sentence(change, message, capsys):
    """Shorter lines with other mistakes are in test_refusals.py."""
    assert "element 0" not in refused([*IMPACT, *change], message, capsys=capsys)


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["table", "check", "--points", "5"], "--points: got 5; at least 100"),
        (["table", "info", "--law", "hertz"], "--law: got 'hertz'; never yields"),
        (["table", "info", "missing.h5"], "table: there is no file missing.h5"),
        (["table", "build", "--out", "nowhere/t.h5"], "--out: there is no folder nowhere"),
        (["table", "build", "--out", "."], "--out: . is a folder"),
        (["materials", "glas"], "unknown material 'glas': did you mean 'glass'"),
    ],
)
def test_messages_name_options(argv, message, capsys):
    refused(argv, message, capsys=capsys)


def test_a_file_that_cannot_be_written(tmp_path, monkeypatch, capsys):
    (tmp_path / "cor.png").mkdir()
    assert main([*MANY, "--plot", str(tmp_path / "cor.png")]) == 1
    assert capsys.readouterr().err == f"contactlaw: --plot: {tmp_path}/cor.png is a folder\n"
    (tmp_path / "link.png").symlink_to(tmp_path / "gone" / "cor.png")
    assert main([*MANY, "--plot", str(tmp_path / "link.png")]) == 1
    assert capsys.readouterr().err == (
        f"contactlaw: --plot: cannot write {tmp_path}/gone/cor.png: there is no such folder\n"
    )


def test_a_warning_is_a_sentence_too(monkeypatch, capsys):
    """A warning, as of a cache that cannot be written, shows no path or line of a source file."""

    def full():
        warnings.warn("the cache is full", stacklevel=1)
        return ("glass",)

    monkeypatch.setattr("contactlaw.cli.materials.materials", full)
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        assert main(["materials"]) == 0
    assert capsys.readouterr().err == "contactlaw: warning: the cache is full\n"


def test_the_version(capsys):
    with pytest.raises(SystemExit) as stop:
        main(["--version"])
    assert stop.value.code == 0
    assert capsys.readouterr().out == f"contactlaw {cl.__version__}\n"


def test_help_comes_at_once():
    """It lists every subcommand, and loads nothing that takes long."""
    code = (
        "import sys; from contactlaw import cli; text = cli.parser([]).format_help()\n"
        "print(text); assert not {'numpy', 'numba', 'h5py'} & {*sys.modules}"
    )
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    groups = re.findall(r"^(\w+):\n((?:  .*\n)+)", shown.stdout.partition("exit\n")[2], re.MULTILINE)
    listed = {title: re.findall(r"^  ([a-z]+) ", lines, re.MULTILINE) for title, lines in groups}
    assert [*listed] == ["ask", "measure", "engines", "pages"]
    whole = re.findall(r"^    ([a-z-]+)\b", cli.parser().format_help(), re.MULTILINE)
    assert sum(listed.values(), []) == whole and len(whole) == 10
    assert max(map(len, shown.stdout.splitlines())) <= 80


def test_a_new_file_is_enough_for_a_new_subcommand(tmp_path, monkeypatch, capsys):
    words = "def add(commands):\n    commands.add_parser('greet').set_defaults(run=lambda _: print('hello'))\n"
    (tmp_path / "greet.py").write_text(f'"""``contactlaw greet`` (people): say hello."""\n{words}')
    monkeypatch.setattr(cli, "__path__", [*cli.__path__, str(tmp_path)])
    assert "\npeople:\n  greet       say hello\n" in cli.parser([]).format_help()
    assert main(["greet"]) == 0
    assert capsys.readouterr().out == "hello\n"


def test_the_options_of_cor_are_in_groups(capsys):
    with pytest.raises(SystemExit):
        main(["cor", "--help"])
    shown = capsys.readouterr().out
    assert re.findall(r"^(\w+):$", shown, re.MULTILINE) == ["options", "impact", "walls", "errors", "output"]


LISTS = ["--radius", "0.5mm,0.9mm", "--thickness", "0.3mm,1mm,inf", "--speed", "1,70"]
STEEL = ["cor", "--sphere", "stainless-steel-304", "--plate", "aluminium-6082-t6"]


@pytest.mark.parametrize(
    "argv",
    [
        IMPACT,
        [*IMPACT, "--causes", "--on", "steel-s235:3mm", "--mass", "5mg", "--speed", "60"],
        [*MANY, "--causes"],
        [*STEEL, *LISTS, "--outside", "solve"],
        [*STEEL, *LISTS, "--angle", "30,60", "--friction", "0.1,0.4"],
        [*IMPACT, "--angle", "30", "--friction", "0.1", "--cylinder", "50mm"],
        [*STEEL, *LISTS, "--outside", "solve", "--out", "a-file-of-a-grid-in-the-folder-of-the-user.csv"],
        [*IMPACT, "--sphere", "E=2.8GPa nu=0.35 rho=1410 yield=62MPa kind=polymer", "--law", "fem", "--no-band"],
        ["materials"],
        ["materials", "stainless-steel-304"],
        ["table", "info"],
        ["find", "thickness", "--cor", "0.5", *STEEL[1:], "--radius", "1mm,2mm", "--speed", "1,3"],
        [
            "constant",
            *STEEL[1:],
            "--radius",
            "1mm",
            "--thickness",
            "0.5mm,1mm",
            "--speed",
            "1,70",
            "--outside",
            "solve",
        ],
    ],
)
def test_no_line_is_wider_than_a_terminal(argv, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(argv) == 0
    assert max(map(len, capsys.readouterr().out.splitlines())) <= 80


@pytest.mark.parametrize(("name", "parser"), list(parsers(cli.parser())))
def test_every_option_is_explained(name, parser, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    for action in parser._actions:
        assert action.help, (name, action.dest)
        if action.nargs != 0 and action.default not in (None, False, [], argparse.SUPPRESS):
            assert "default" in action.help, (name, action.dest)
    assert max(map(len, parser.format_help().splitlines())) <= 80  # and no stray per cent sign
    assert parser.description


@pytest.mark.parametrize("argv", [[], COR, [*IMPACT, "--materials", "/dev/zero"], [*COR, "-Thick=1mm"]])
def test_wrong_usage_is_status_2(argv, capsys):
    """Shorter lines with other mistakes are in test_refusals.py."""
    words = {0: "COMMAND", 7: "--radius", 8: "did you mean --thickness?"}.get(len(argv), "/dev/zero: it is no regular")
    misused(argv, words, capsys)


def test_materials(capsys):
    assert main(["materials"]) == 0
    head, units, *lines = capsys.readouterr().out.split("\n\n")[0].splitlines()
    assert head.split() == ["name", "E", "nu", "rho", "yield", "H", "B", "n"]
    assert [line.split()[0] for line in lines] == list(cl.materials())
    assert main(["materials", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    glass = next(entry for entry in listed if entry["name"] == "glass")
    assert (glass["youngs_modulus"], glass["yield_strength"]) == (73e9, None)
    shown = {line.split()[0]: line.split()[3:] for line in lines}
    assert shown["glass"] == ["2.5", *4 * ["-"]]
    assert shown["stainless-steel-304-ball"] == ["8", "-", "3.119", "-", "-"]
    assert shown["copper-ofhc-annealed"] == ["8.94", "90", "-", "292", "0.31"]
    assert len({len(line) for line in (head, units, *lines)}) == 1
    assert main(["materials", "copper-ofhc-annealed"]) == 0
    head, _, numbers, *text = capsys.readouterr().out.splitlines()
    assert head.split()[-3:] == ["C", "tan", "delta"]
    assert numbers.split() == ["115", "0.343", *shown["copper-ofhc-annealed"], "0.025", "-"]
    assert "copper-ofhc-annealed: Oxygen-free copper" in " ".join(text)


def test_table_info_and_check(capsys, monkeypatch):
    monkeypatch.setattr("secrets.randbits", lambda bits: 5)
    assert main(["table", "info"]) == 0
    info = capsys.readouterr().out
    assert "law myc" in info
    assert "restitution" in info
    assert main(["table", "check", "--points", "1000"]) == 0
    assert "seed 5" in capsys.readouterr().out


def test_a_table_of_a_law_that_takes_numbers_from_a_pair(capsys):
    steel = ["--law", "fem", "--sphere", "stainless-steel-304", "--plate", "glass"]
    assert main(["table", "info", *steel]) == 0
    assert "law fem:" in capsys.readouterr().out
    assert main(["table", "info", *steel[:4]]) == 1
    assert capsys.readouterr().err == ("contactlaw: --plate: has to be given, no record or file says it\n")
    asked = ["table", "info", *steel[:2], "--sphere", "steal", "--plate", "glass"]
    refused(asked, "--sphere: unknown material 'steal'", capsys=capsys)


def test_table_check_fails_above_the_bounds(tmp_path, capsys):
    coarse = table.Settings(rows=9, columns=8)
    file.write(table.build(laws.law("myc"), coarse), tmp_path / "coarse.h5")
    assert main(["table", "check", str(tmp_path / "coarse.h5"), "--points", "500"]) == 1
    assert "exceeds its bounds" in capsys.readouterr().err


# Says when it is in the middle of a long check, and stays there.
SLOW = """
import sys, time
from contactlaw import table
from contactlaw.cli import main
def slow(*arguments, **options):
    print("inside", flush=True)
    time.sleep(60)
table.certify = slow
sys.exit(main(["table", "check"]))
"""


def test_ctrl_c_leaves_a_sentence_and_nothing_else(tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-c", SLOW], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "inside\n"
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=30)[1] == "contactlaw: interrupted\n"
    assert process.returncode == 130
    assert list(tmp_path.iterdir()) == []


def shell(command):
    """Exit status of a command in bash: its own, not that of the last command of a pipe."""
    return subprocess.run(["bash", "-c", f"{command}; exit ${{PIPESTATUS[0]}}"], capture_output=True, text=True)


@pytest.mark.parametrize("command", ["materials", "materials --json"])
def test_a_reader_that_goes_away(command):
    done = shell(f"{sys.executable} -u -m contactlaw {command} | head -1")
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("command", ["materials", "materials --json"])
def test_an_output_that_was_never_open(command):
    done = shell(f"{sys.executable} -m contactlaw {command} >&-")
    assert (done.returncode, done.stderr) == (1, "contactlaw: the standard output is closed\n")


def test_messages_never_go_where_results_do():
    done = shell(f"{sys.executable} -m contactlaw materials nothing 2>&-")
    assert (done.returncode, done.stdout) == (1, "")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no device that is always full")
def test_an_output_that_is_full():
    done = shell(f"{sys.executable} -m contactlaw materials > /dev/full")
    assert (done.returncode, done.stderr) == (1, "contactlaw: No space left on device\n")


def test_an_output_that_lacks_a_letter():
    bead = "'E=2GPa nu=0.3 rho=1000 kind=ceramic name=Öl'"
    asked = f"cor --sphere {bead} --plate glass --radius 1mm --thickness 1mm --speed 1 --no-band"
    done = shell(f"PYTHONIOENCODING=ascii {sys.executable} -m contactlaw {asked}")
    assert (done.returncode, done.stdout) == (1, "") and "set PYTHONIOENCODING=utf-8" in done.stderr


HISTORY = ["cor", "--history", *IMPACT[1:]]


def test_a_history_is_csv_with_the_question_and_the_flags_in_each_row(tmp_path, model, capsys):
    assert main([*HISTORY, "--samples", "5"]) == 0
    text = capsys.readouterr().out
    rows = list(csv.DictReader(io.StringIO(text)))
    names = "time_s force_N compression_m impulse_Ns plate_displacement_m".split()
    contact = model.force_history(12.0, 0.9e-3, 1e-3, samples=5, method="solve")
    printed = [[float(row[name]) for name in names] for row in rows]
    assert printed == pytest.approx(np.column_stack(contact), rel=1e-12)
    assert rows[0].items() >= {**ASKED, "speed_m/s": "12.0", "radius_m": "0.0009", "flags": ""}.items()
    assert main([*HISTORY, "--samples", "5", "--out", f"{tmp_path}/force.csv"]) == 0
    assert (tmp_path / "force.csv").read_text() == text
    assert capsys.readouterr().out.startswith(f"{tmp_path}/force.csv: 5 rows")
    assert main([*HISTORY, "--speed", "60", "--thickness", "0.3mm"]) == 0
    rows = list(csv.DictReader(io.StringIO(capsys.readouterr().out)))
    assert len(rows) == 256 and {row["flags"] for row in rows} == {"THIN_PLATE|FAST_IMPACT"}


PLOT = [*COR, "--radius", "0.9mm", "--thickness", "0.5mm,1mm,inf", "--speed", "0.1:70:2"]


def test_a_plot_without_matplotlib_says_what_to_install(monkeypatch, capsys, tmp_path):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    refused([*PLOT, "--plot", str(tmp_path / "cor.png")], "pip install 'contactlaw[demo]'", capsys=capsys)
