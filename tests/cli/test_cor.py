"""``contactlaw cor`` for a few impacts, which are integrated in Python, against the table; and its bands."""

import dataclasses
import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest

import contactlaw as cl
from contactlaw import _jit
from contactlaw.__main__ import asked
from contactlaw.answers.few import switch_off_compiler

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


def test_both_routes_print_the_same_and_refuse_alike():
    """Words agree; the COR to 1e-6, other numbers to 1e-4 or to one unit of the last digit that is shown."""
    commands = [*(f"{command} --json" for command in ANSWERED), *ANSWERED[:4], *REFUSED]
    routes = (outcomes(commands, route) for route in ("python", "compiled"))
    for command, ours, its in zip(commands, *routes, strict=True):
        if command in REFUSED:
            assert ours == its and ours[0] == 1
            assert ours[2].startswith("contactlaw: ") and ours[2].count("\n") == 1
            continue
        assert (ours[0], ours[2]) == (its[0], its[2]) == (0, ""), command
        is_exact = "--json" in command
        our_cors, its_cors = (re.findall(r'"restitution": ([\d.e-]+)', out) for _, out, _ in (ours, its))
        assert [*map(float, our_cors)] == pytest.approx([*map(float, its_cors)], abs=1e-6), command
        for our_word, its_word in zip(*(re.split(r"[\s,]+", out) for _, out, _ in (ours, its)), strict=True):
            try:
                close = 1e-4 if is_exact else 1e-5 if len(its_word) > 5 else 1e-3
                assert float(our_word) == pytest.approx(float(its_word), rel=close, abs=1e-12), command
            except ValueError:
                assert our_word == its_word, command


@pytest.mark.parametrize(
    ("few", "words"),
    [
        (True, "cor --speed 1,2,5 --radius 1mm"),
        (True, "cor --speed 1,2,3,4 --radius 1mm,2mm,3mm"),
        (False, "cor --speed 1 --outside solve"),
        (False, "cor --speed 1,2,3,4 --radius 1mm,2mm,3mm --thickness 1mm,2mm"),
        (False, "cor --speed 1:5:3"),
        (False, "cor --speed 1 --plot cor.png"),
        (False, "cor --speed 1 --outside=clamp"),
        (True, "cor --history --speed 1"),
        (False, ""),
    ],
)
def test_few_impacts_are_told_from_many(few, words, monkeypatch):
    off = []
    monkeypatch.setattr(_jit, "switch_off", lambda: off.append(True))
    assert switch_off_compiler(*asked(words.split())) is few is bool(off)


# A user's process, and whether its children would have a compiler.
USER = """
import os, sys
from contactlaw.__main__ import main
status = main()
print(os.environ.get("NUMBA_DISABLE_JIT"))
sys.exit(status)
"""


def test_a_few_impacts_leave_neither_code_nor_a_table_and_children_their_compiler(tmp_path):
    environment = {**os.environ, "HOME": str(tmp_path), "XDG_CACHE_HOME": str(tmp_path)}
    for name in ("NUMBA_CACHE_DIR", "NUMBA_DISABLE_JIT", "CONTACTLAW_CACHE_DIR"):
        environment.pop(name, None)
    command = [sys.executable, "-c", USER, *ANSWERED[0].split()]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("gamma-alumina on glass") and done.stdout.endswith("\nNone\n")
    assert list(tmp_path.iterdir()) == []


SURE = f"{PAIR} --thickness 1mm --speed 12"
ERRORS = "--sphere-error yield_strength=20% --thickness-error 5%"


def test_the_band_is_that_of_the_model(answer):
    """The same numbers as in Python; the text of one impact and its causes are in docs/command_line.md."""
    pair = cl.Pair("gamma-alumina", "glass")
    bead = dataclasses.replace(pair.sphere, uncertainty={"yield_strength": 0.2})
    model = cl.ImpactModel(cl.Pair(bead, pair.plate))
    bands = model.uncertainty(12.0, 0.9e-3, 1e-3, thickness_error=0.05)
    (row,), record = answer(f"{SURE} {ERRORS} --csv").rows, answer(f"{SURE} {ERRORS} --json").values
    for name, unit in (("restitution", ""), ("contact_time", "_s"), ("peak_force", "_N")):
        for end in ("low", "high"):
            value = pytest.approx(getattr(getattr(bands, name), end), rel=1e-6)
            assert float(row[f"{name}_{end}{unit}"]) == record[f"{name}_{end}"] == value
    table = answer(f"{SURE},1 {ERRORS} --causes")
    assert f"  {bands.restitution.low:.3f}-{bands.restitution.high:.3f}  " in table.out
    several = model.uncertainty([12.0, 1.0], 0.9e-3, 1e-3, thickness_error=0.05).restitution
    size = np.sqrt(np.mean(np.square(several.causes["yield strength of the bead"])))
    assert f"by cause: yield strength of the bead {size:.2g}, " in table.text
    assert "low" not in answer(f"{SURE} --no-band --csv").out
    for speeds in ("", ",1"):
        assert "68 %" not in answer(f"{SURE}{speeds} --no-band").out


@pytest.mark.parametrize("speeds", ["2", "2,3"])
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
def test_the_band_says_on_what_it_rests(pair, words, speeds, answer):
    """A band of moduli alone would look as if the COR were known."""
    assert words in answer(f"cor --sphere {pair} --radius 1mm --speed {speeds} --thickness 5mm").text


@pytest.mark.parametrize(
    ("pair", "size", "words"),
    [
        ("soda-lime-glass --plate aluminium-6082-t6", 0.1, "Measure the plate's hardness first: 10 % of it"),
        ("soda-lime-glass --plate aluminium-6061-t6", 0.1, "Measure the plate's hardness first: 10 % of it"),
        ("bearing-steel-52100-ball --plate steel-dc01", 0.19, "Measure the plate's hardness better: its error"),
        ("glass --plate glass", 0.0, ""),
    ],
)
def test_it_asks_for_what_narrows_the_band_most(pair, size, words, answer):
    """A strength: off by its error it changes the COR by as much, and without it the band is narrower by 17 %."""
    line = f"cor --sphere {pair} --radius 1.5mm --speed 2.43 --thickness 5mm"
    text = answer(line).text
    assert words in text and ("Measure" in text) == bool(words)
    if words:
        sphere, plate = pair.split(" --plate ")
        body = cl.material(plate)
        strengths = (body.yield_strength * np.exp(z * size) for z in (-1, 1))
        ends = [dataclasses.replace(body, yield_strength=strength, uncertainty={}) for strength in strengths]
        low, high = (cl.ImpactModel(cl.Pair(sphere, end)).restitution(2.43, 1.5e-3, 5e-3) for end in ends)
        assert f"changes the COR by {0.5 * (high - low):.2g}." in text
        known, exact = (
            answer(f"{line} --plate-error yield_strength={error} --json").values for error in (f"{size:.0%}", "0%")
        )
        narrow, wide = (band["restitution_high"] - band["restitution_low"] for band in (exact, known))
        assert narrow < 0.83 * wide


def test_a_value_at_the_border_of_the_table_has_no_band(answer):
    """The band is of the integrated impact, whose COR may be another one."""
    line = f"{PAIR} --thickness 1mm --outside clamp --speed 2000"
    border, inside = answer(f"{line},12 --json").values
    assert inside["restitution_low"] < inside["restitution"] < inside["restitution_high"]
    assert border["restitution_low"] is border["restitution_high"] is None
    assert "68 %" not in answer(line).out
