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
    *(f"{PAIR} --thickness 1mm --speed 12 --law {law}" for law in ("myc", "hertz", "jackson_green", "stronge")),
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
            if other[name] is None:  # inf has no place in JSON
                assert one[name] is None, name
            else:
                assert one[name] == pytest.approx(other[name], rel=1e-4, abs=1e-12), name


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
        (False, "sweep --speed 1"),
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
    sizes = [f"{name} {size:.2g}" for name, size in cor.causes.items()]
    text = printed(f"{SURE} {GIVEN}", capsys)
    assert f" ({cor.low:.3g} to {cor.high:.3g}; {', '.join(sizes)})" in text
    assert sizes[0].startswith("yield strength of the bead 0.028")
    assert "two of three impacts, as far as errors are known" in text
    (row,) = csv.DictReader(printed(f"{SURE} {GIVEN} --csv", capsys).splitlines())
    record = json.loads(printed(f"{SURE} {GIVEN} --json", capsys))
    for name, unit in (("restitution", ""), ("contact_time", "_s"), ("peak_force", "_N")):
        band = getattr(bands, name)
        for end in ("low", "high"):
            value = pytest.approx(getattr(band, end), rel=1e-6)
            assert float(row[f"{name}_{end}{unit}"]) == record[f"{name}_{end}"] == value
    table = printed(f"{SURE},1 {GIVEN}", capsys)
    assert f"  {cor.low:.3g}-{cor.high:.3g}  " in table and "yield strength of the bead 0 to" in table


def test_strengths_without_an_error_are_named(capsys):
    """A band of moduli alone would look as if the COR were known."""
    table = " ".join(
        printed(
            "cor --sphere aluminium-6061-t6 --plate glass --radius 1e-3 --thickness 1e-2 --speed 1,2", capsys
        ).split()
    )
    assert "as far as errors are known (errors of the strength of the bead are not)." in table


def test_a_specified_minimum_says_that_the_cor_may_be_higher(capsys):
    asked = "cor --sphere soda-lime-glass --plate {} --radius 1.5mm --speed 2.43 --thickness 5mm"
    said = "the strength of the plate is a specified minimum: the real COR may be higher"
    for plate, is_minimum in (("aluminium-6082-t6", True), ("aluminium-6061-t6", False), ("steel-dc01", False)):
        assert (said in printed(asked.format(plate), capsys)) == is_minimum


@pytest.mark.parametrize(
    ("asked", "size", "said"),
    [
        ("soda-lime-glass --plate aluminium-6082-t6", 0.1, "hardness of the plate: a specified minimum, and"),
        ("soda-lime-glass --plate aluminium-6061-t6", 0.1, "plate: its error is not known, and each"),
        ("bearing-steel-52100-ball --plate steel-dc01", 0.19, "plate, 0.041 of half the width; all"),
        ("glass --plate glass", 0.0, ""),
    ],
)
def test_it_asks_for_what_narrows_the_band_most(asked, size, said, capsys):
    """That is the strength, by as much as a strength that is off by its error changes the COR."""
    text = printed(f"cor --sphere {asked} --radius 1.5mm --speed 2.43 --thickness 5mm", capsys)
    (first,) = re.findall("measure this first .*", text) or [""]
    assert said in first and bool(first) == bool(said)
    if size:
        sphere, plate = asked.split(" --plate ")
        body = cl.material(plate)
        ends = [
            dataclasses.replace(body, yield_strength=body.yield_strength * np.exp(z * size), uncertainty={})
            for z in (-1, 1)
        ]
        low, high = (cl.ImpactModel(cl.Pair(sphere, end)).restitution(2.43, 1.5e-3, 5e-3) for end in ends)
        assert f"{0.5 * (high - low):.2g} of" in first


@pytest.mark.parametrize("sphere", ["hdpe", "alumina"])
def test_without_the_error_of_what_to_measure_first_the_band_is_as_narrow_as_said(sphere, capsys):
    asked = [
        "cor",
        "--sphere",
        sphere,
        "--plate",
        "steel-dc01",
        "--speed",
        "2",
        "--radius",
        "1mm",
        "--thickness",
        "2cm",
    ]
    said = printed(shlex.join(asked), capsys)
    name, body, rest = re.findall(r"measure this first +the (.*) of the (\w+), .*all else is (.*)", said)[0]
    if guessed := re.findall(", with 10 % for the yield strength of the bead", rest):
        asked += ["--sphere-error", "yield_strength=10%"]
        rest, said = rest.removesuffix(guessed[0]), printed(shlex.join(asked), capsys)
    assert bool(guessed) == (sphere == "hdpe")
    number = name.partition(" or ")[0].lower().replace("'", "").replace(" ", "_")
    option = "--sphere-error" if body == "bead" else "--plate-error"
    assert main([*asked, option, f"{number}=0%", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    half = 0.5 * (found["restitution_high"] - found["restitution_low"])
    assert float(rest) == pytest.approx(half, rel=0.1)
    ends = [float(end) for end in re.findall(r"restitution .*\((.*) to (.*?);", said)[0]]
    assert half < 0.83 * 0.5 * (ends[1] - ends[0])


def test_it_asks_for_what_narrows_the_bands_of_several_impacts_most(capsys):
    asked = "cor --sphere soda-lime-glass --plate steel-s235 --radius 1.5mm --speed 2.43{} --thickness 5mm"
    (one,) = re.findall("measure this first +(.*)", printed(asked.format(""), capsys))
    both = " ".join(printed(asked.format(",2.43"), capsys).split())
    assert f"Measure this first: {one}" in both


def test_without_errors_of_materials_it_says_so(capsys):
    words = "two of three impacts by finite elements (no errors of the materials are known)"
    for command in (SURE, f"{SURE},1"):
        assert words in " ".join(printed(command, capsys).split())
    assert "low" not in printed(f"{SURE} --no-band --csv", capsys).splitlines()[0]
    assert words not in printed(f"{SURE},1 --no-band", capsys)


@pytest.mark.parametrize(
    ("error", "said"),
    [
        ("--speed-error -1%", "--speed-error: got -0.01; must lie between 0 and 1"),
        ("--plate-error yeld=1%", "--plate-error: uncertainty: got 'yeld'; unknown"),
        ("--plate-error density", "as yield_strength=15%"),
    ],
)
def test_errors_that_are_none_are_refused(error, said, capsys):
    try:
        assert main(f"{SURE} {error}".split()) == 1
    except SystemExit as stopped:
        assert stopped.code == 2
    assert said in capsys.readouterr().err


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
