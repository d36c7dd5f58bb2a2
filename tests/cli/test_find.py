"""``contactlaw find``: odd command lines, and what people read; its numbers are in tests/answers."""

import pytest
from command_line import misused, refused

from contactlaw.cli import main

PAIR = "--sphere stainless-steel-304-ball --plate glass --radius 1mm".split()
THICKNESS = ["find", "thickness", *PAIR]
SPEED = ["find", "speed", *PAIR]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([*THICKNESS, "--cor", "1.5", "--speed", "2"], "--cor: got '1.5'; must lie between"),
        ([*THICKNESS, "--cor", "0.5", "--speed", "-2"], "--speed: got '-2'; must lie between"),
        ([*THICKNESS, "--cor", "0.99", "--speed", "2"], "COR 0.99: no thickness: "),
        ([*SPEED, "--cor", "0.01", "--thickness", "inf"], "COR 0.01: no speed: "),
        ([*THICKNESS, "--cor", "0.5", "--drop", "3cm", "--radius", "1mm,2mm"], "takes one radius"),
        ([*THICKNESS, "--cor", "0.5", "--speed", "2e4"], "--speed: got '2e4'; no thickness brings the impact"),
        ([*SPEED, "--cor", "0.5", "--thickness", "10um"], "--thickness: got '10um'; no speed brings the impact"),
        ([*THICKNESS, "--cor", "0.5", "--speed", "2", "--on", "steel-s235"], "expected a material and a thickness"),
        ([*THICKNESS, "--cor", "0.5", "--speed", "2", "--plate", "glas"], "unknown material 'glas'"),
    ],
)
def test_refused_questions_are_status_1_and_one_sentence(words, message, capsys):
    refused(words, message, capsys=capsys)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["find"], "UNKNOWN"),
        (["find", "radius", *PAIR], "radius"),
        (["find", "thicknes", *PAIR], "thickness"),
        ([*THICKNESS, "--speed", "2"], "--cor"),
        ([*THICKNESS, "--cor", "0.5"], "--speed"),
        ([*THICKNESS, "--cor", "0.5", "--speed", "2", "--thickness", "1mm"], "--thickness: no such option"),
        ([*SPEED, "--cor", "0,5", "--thickness", "1mm"], "is it a decimal comma? Write 0.5"),
        ([*SPEED, "--cor", "half", "--thickness", "1mm"], "half"),
        ([*SPEED, "--cor", "0.5", "--thickness", "1mm", "--csv", "--json"], "not allowed with argument --csv"),
    ],
)
def test_wrong_usage_is_status_2(words, message, capsys):
    misused(words, message, capsys)


@pytest.mark.parametrize(
    "words",
    [
        [*THICKNESS, "--cor", "0.5", "--speed", "2"],
        [*THICKNESS, "--cor", "0.3,0.5,0.99", "--speed", "1,2", "--radius", "1mm,2mm"],
        [*SPEED, "--cor", "0.5,0.9", "--thickness", "1mm,2mm,inf"],
    ],
    ids=" ".join,
)
def test_what_people_read_fits_a_terminal(words, capsys):
    assert main(words) == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    name = "thickness" if "thickness" in words else "speed"
    heads = next(words for words in map(str.split, lines) if name in words)
    assert len({*heads}) == len(heads)
