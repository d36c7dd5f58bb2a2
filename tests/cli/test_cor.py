"""``contactlaw cor`` for a few impacts, which are integrated in Python, against the table."""

import csv
import dataclasses
import json
import os
import re
import shlex
import subprocess
import sys

import numpy as np
import pytest

import contactlaw as cl
from contactlaw import _jit
from contactlaw.__main__ import asked
from contactlaw.answers.few import switch_off_compiler
from contactlaw.cli import main

PAIR = "cor --sphere gamma-alumina --plate glass --radius 0.9mm"
STEEL = "cor --sphere stainless-steel-304 --plate aluminium-6061-t6 --radius 1mm"
# Impacts at the limits of the table, of the speed and of the arguments.
ANSWERED = [
    f"{PAIR} --thickness 1mm --speed 12",
    f"{PAIR} --thickness inf --speed 12",
    f"{PAIR} --thickness 0.2mm,1mm --speed 1,40",
    f"{PAIR} --thickness 0.05mm --speed 12 --outside solve",
    f"{PAIR} --thickness 1mm --speed 2000 --outside solve",
    f"{PAIR} --thickness 0.12mm --speed 12",
    f"{STEEL} --thickness 1mm,10mm --speed 0.01,1",
    "cor --sphere glass --plate glass --radius 1mm --thickness 2mm --speed 3",
    *(f"{PAIR} --thickness 1mm --speed 12 --law {law}" for law in ("myc", "hertz", "jackson_green", "thornton")),
]
REFUSED = [
    f"{PAIR} --thickness 0.05mm --speed 12",
    f"{PAIR} --thickness 0.05mm --speed 12 --law jackson_green",
    f"{PAIR} --thickness 1mm --speed 1,3000",
    f"{PAIR} --thickness 0.05mm,1mm --speed 3000",
    f"{PAIR} --thickness 1mm,0.05mm --speed 3000",
    f"{PAIR} --thickness 9um --speed 1e5",
    f"{PAIR} --thickness 1nm --speed 12",
    f"{PAIR} --thickness 1mm --speed -1",
    f"{PAIR} --thickness 1mm --speed 12 --law nobody",
    "cor --sphere chalk --plate glass --radius 1mm --thickness 1mm --speed 1",
]
BOTH = """
import contextlib, io, json, sys
from contactlaw import _jit
if sys.argv[1] == "python":
    _jit.switch_off()
from contactlaw.cli import main
found = []
for command in json.load(sys.stdin):
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main(command.split())
    found.append((code, out.getvalue(), err.getvalue()))
json.dump(found, sys.stdout)
"""


def outcomes(commands, route):
    done = subprocess.run(
        [sys.executable, "-c", BOTH, route], input=json.dumps(commands), capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def both():
    """Status, output and errors of each command, integrated in Python and by compiled kernels."""
    commands = [*(f"{command} --json" for command in ANSWERED), *REFUSED, *ANSWERED[:4]]
    routes = (outcomes(commands, route) for route in ("python", "compiled"))
    return dict(zip(commands, zip(*routes, strict=True), strict=True))


@pytest.mark.parametrize("command", ANSWERED)
def test_both_routes_agree(command, both):
    (code, ours, said), (other_code, table, others) = both[f"{command} --json"]
    assert (code, said) == (other_code, others) == (0, "")
    ours, table = json.loads(ours), json.loads(table)
    if isinstance(ours, dict):
        ours, table = [ours], [table]
    for one, other in zip(ours, table, strict=True):
        assert one.keys() == other.keys() and one["flags"] == other["flags"]
        assert one["restitution"] == pytest.approx(other["restitution"], abs=1e-6)
        for name in one.keys() - {"flags", "sphere", "plate", "law"}:
            assert float(one[name]) == pytest.approx(float(other[name]), rel=1e-4, abs=1e-12), name


@pytest.mark.parametrize("command", ANSWERED[:4])
def test_both_print_the_same(command, both):
    """All digits of the COR, words and units agree, other numbers to one unit of the last digit."""
    (code, ours, said), (other_code, table, others) = both[command]
    assert (code, said) == (other_code, others) == (0, "")
    ours, table = ours.split(), table.split()
    assert len(ours) == len(table)
    assert ours[:2] == table[:2]
    for one, other in zip(ours, table, strict=True):
        try:
            assert float(one) == pytest.approx(float(other), rel=1e-5 if len(other) > 5 else 1e-3)
        except ValueError:
            assert one == other


@pytest.mark.parametrize("command", REFUSED)
def test_both_refuse_alike(command, both):
    ours, table = both[command]
    assert ours == table
    assert ours[0] == 1 and ours[2].startswith("contactlaw: ") and ours[2].count("\n") == 1


@pytest.mark.parametrize(
    ("few", "words"),
    [
        (True, "cor --speed 1,2,5 --radius 1mm"),
        (True, "cor --speed 1,2,3,4 --radius 1mm,2mm,3mm"),
        (False, "cor --speed 1 --outside solve"),
        (False, "cor --speed 1,2,3,4 --radius 1mm,2mm,3mm --thickness 1mm,2mm"),
        (False, "cor --speed 1:5:3"),
        (False, "cor --speed 1 --plot cor.png"),
        (False, "cor --speed 1 --plot=cor.png"),
        (False, "cor --speed 1 --outside clamp"),
        (False, "cor --speed 1 --outside=clamp"),
        (True, "cor --history --speed 1"),
        (False, ""),
    ],
)
def test_few_impacts_are_told_from_many(few, words, monkeypatch):
    off = []
    monkeypatch.setattr(_jit, "switch_off", lambda: off.append(True))
    assert switch_off_compiler(*asked(words.split())) is few is bool(off)


def run(command, folder, *before):
    """Run the command line as users do, with an empty home folder."""
    environment = {**os.environ, "HOME": str(folder), "XDG_CACHE_HOME": str(folder)}
    for name in ("NUMBA_CACHE_DIR", "NUMBA_DISABLE_JIT", "CONTACTLAW_CACHE_DIR"):
        environment.pop(name, None)
    code = "import sys; from contactlaw.__main__ import main; sys.exit(main())"
    return subprocess.run(
        [sys.executable, "-c", "\n".join((*before, code)), *command.split()],
        env=environment,
        capture_output=True,
        text=True,
    )


def test_a_few_impacts_leave_neither_code_nor_a_table(tmp_path, both):
    done = run(ANSWERED[0], tmp_path)
    assert [done.returncode, done.stdout, done.stderr] == both[ANSWERED[0]][0]
    assert list(tmp_path.iterdir()) == []


def test_children_keep_their_compiler(tmp_path):
    """Child processes do not inherit the environment variable that disables the compiler."""
    child = "import os, atexit; atexit.register(lambda: print(os.environ.get('NUMBA_DISABLE_JIT')))"
    assert run(ANSWERED[0], tmp_path, child).stdout.endswith("\nNone\n")


SURE = f"{PAIR} --thickness 1mm --speed 12"
GIVEN = "--sphere-error yield_strength=20% --thickness-error 5%"


def printed(command, capsys):
    assert main(shlex.split(command)) == 0, capsys.readouterr().err
    return capsys.readouterr().out


def test_the_band_is_that_of_the_model(capsys):
    """As text, with its causes, as CSV and as JSON; the same numbers as in Python."""
    pair = cl.Pair("gamma-alumina", "glass")
    bead = dataclasses.replace(pair.sphere, uncertainty={"yield_strength": 0.2})
    model = cl.ImpactModel(cl.Pair(bead, pair.plate))
    bands = model.uncertainty(12.0, 0.9e-3, 1e-3, thickness_error=0.05)
    cor = bands.restitution
    text = printed(f"{SURE} {GIVEN}", capsys)
    assert f"68 %: {cor.low:.3g} to {cor.high:.3g}\n" in text and "cause" not in text
    names = {"model": "law"}
    sizes = [f"{names.get(name, name)} {size:.2g}" for name, size in cor.causes.items()]
    assert sizes[0].startswith("yield strength of the bead 0.028")
    text = printed(f"{SURE} {GIVEN} --causes", capsys)
    assert f"Half the width of the COR's range by cause: {', '.join(sizes)}." in " ".join(text.split())
    (row,) = csv.DictReader(printed(f"{SURE} {GIVEN} --csv", capsys).splitlines())
    record = json.loads(printed(f"{SURE} {GIVEN} --json", capsys))
    for name, unit in (("restitution", ""), ("contact_time", "_s"), ("peak_force", "_N")):
        band = getattr(bands, name)
        for end in ("low", "high"):
            value = pytest.approx(getattr(band, end), rel=1e-6)
            assert float(row[f"{name}_{end}{unit}"]) == record[f"{name}_{end}"] == value
    table = printed(f"{SURE},1 {GIVEN}", capsys)
    assert f"  {cor.low:.3f}-{cor.high:.3f}  " in table and "cause" not in table
    table = " ".join(printed(f"{SURE},1 {GIVEN} --causes", capsys).split())
    several = model.uncertainty([12.0, 1.0], 0.9e-3, 1e-3, thickness_error=0.05).restitution
    size = np.sqrt(np.mean(np.square(several.causes["yield strength of the bead"])))
    assert f"by cause: yield strength of the bead {size:.2g}, " in table


LOW = "--radius 1mm --speed 2 --thickness 5mm"


@pytest.mark.parametrize(
    ("pair", "words"),
    [
        ("soda-lime-glass --plate glass", "68 %: two in three real impacts lie here."),
        ("glass --plate glass", "lie here, if the materials are right; their errors are not stated."),
        ("gamma-alumina --plate glass", "lie here, if the bead's strength is right; its error is not stated."),
        ("bearing-steel-52100 --plate aluminium-6061-t6", "lie here, if the strengths are right; their errors are not"),
        ("soda-lime-glass --plate aluminium-6082-t6", "if the plate's strength is right; its error is not stated. The"),
        ("soda-lime-glass --plate aluminium-6082-t6", "The plate's strength is a specified minimum: the real COR may"),
        ("bearing-steel-52100-ball --plate steel-dc01", "68 %: two in three real impacts lie here. Measure the plate"),
        ("pom --plate glass", "The bead is a polymer without a loss factor: the real COR may be lower."),
    ],
)
def test_the_band_says_on_what_it_rests(pair, words, capsys):
    """A band of moduli alone would look as if the COR were known."""
    for speeds in ("", ",3"):
        text = printed(f"cor --sphere {pair} {LOW.replace('2 ', f'2{speeds} ')}", capsys)
        assert words in " ".join(text.split())
        assert max(map(len, text.splitlines())) <= 80


@pytest.mark.parametrize(
    ("pair", "size", "words"),
    [
        ("soda-lime-glass --plate aluminium-6082-t6", 0.1, "Measure the plate's hardness first: 10 % of it"),
        ("soda-lime-glass --plate aluminium-6061-t6", 0.1, "Measure the plate's hardness first: 10 % of it"),
        ("bearing-steel-52100-ball --plate steel-dc01", 0.19, "Measure the plate's hardness better: its error"),
        ("glass --plate glass", 0.0, ""),
    ],
)
def test_it_asks_for_what_narrows_the_band_most(pair, size, words, capsys):
    """That is the strength, by as much as a strength that is off by its error changes the COR."""
    text = " ".join(printed(f"cor --sphere {pair} --radius 1.5mm --speed 2.43 --thickness 5mm", capsys).split())
    assert words in text and ("Measure" in text) == bool(words)
    if words:
        sphere, plate = pair.split(" --plate ")
        body = cl.material(plate)
        ends = [
            dataclasses.replace(body, yield_strength=body.yield_strength * np.exp(z * size), uncertainty={})
            for z in (-1, 1)
        ]
        low, high = (cl.ImpactModel(cl.Pair(sphere, end)).restitution(2.43, 1.5e-3, 5e-3) for end in ends)
        assert f"changes the COR by {0.5 * (high - low):.2g}." in text


@pytest.mark.parametrize("sphere", ["hdpe", "alumina"])
def test_without_the_error_of_what_to_measure_first_the_band_is_narrower_by_a_fifth(sphere, capsys):
    line = f"cor --sphere {sphere} --plate steel-dc01 --speed 2 --radius 1mm --thickness 2cm"
    text = " ".join(printed(line, capsys).split())
    ((hard, name, body),) = re.findall(
        r"Measure the (?:(\w+)'s hardness|([\w' ]+) of the (\w+)) (?:first|better)", text
    )
    option = {"bead": "--sphere-error", "plate": "--plate-error"}[hard or body]
    if sphere == "hdpe":
        line += " --sphere-error yield_strength=10%"  # as assumed where none is stated
    number = "yield_strength" if hard else name.lower().replace("'", "").replace(" ", "_")
    halves = []
    for error in ("", f" {option} {number}=0%"):
        found = json.loads(printed(f"{line}{error} --json", capsys))
        halves.append(found["restitution_high"] - found["restitution_low"])
    assert halves[1] < 0.83 * halves[0]


def test_it_asks_for_what_narrows_the_bands_of_several_impacts_most(capsys):
    line = "cor --sphere soda-lime-glass --plate steel-s235 --radius 1.5mm --speed 2.43{} --thickness 5mm"
    one, two = (" ".join(printed(line.format(more), capsys).split()) for more in ("", ",2.43"))
    (sentence,) = re.findall("Measure .*", one)
    assert sentence in two


def test_without_a_band_nothing_is_said_of_one(capsys):
    assert "low" not in printed(f"{SURE} --no-band --csv", capsys).splitlines()[0]
    for speeds in ("", ",1"):
        assert "68 %" not in printed(f"{SURE}{speeds} --no-band", capsys)


def test_a_value_at_the_border_of_the_table_has_no_band(capsys):
    """The band is of the integrated impact, whose COR may be another one."""
    line = f"{PAIR} --thickness 1mm --outside clamp --speed 2000"
    border, inside = json.loads(printed(f"{line},12 --json", capsys))
    assert inside["restitution_low"] < inside["restitution"] < inside["restitution_high"]
    assert border["restitution_low"] is border["restitution_high"] is None
    assert "68 %" not in printed(line, capsys)


def test_an_interrupt_ends_it_in_words(tmp_path):
    raising = (
        "from contactlaw import _jit",
        "off = _jit.switch_off",
        "def switch_off():",
        "    off()",
        "    from contactlaw.answers.solver import Solver",
        "    def rebounds(*_): raise KeyboardInterrupt",
        "    Solver.rebounds = rebounds",
        "_jit.switch_off = switch_off",
    )
    done = run(ANSWERED[0], tmp_path, *raising)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "contactlaw: interrupted\n")
