"""What several tests ask of the command line."""

import argparse

import pytest

from contactlaw.cli import main


def refused(argv, *messages, capsys):
    """Sentence on stderr, behind warnings alone, with which a command is refused."""
    assert main(argv) == 1
    said = capsys.readouterr()
    *warnings, sentence = said.err.splitlines()
    assert said.out == "" and sentence.startswith("contactlaw: ")
    assert all(line.startswith("contactlaw: warning: ") for line in warnings)
    for message in messages:
        assert message in sentence
    for word in ("ImpactModel", "Material(", 'law="', "materials()"):  # for Python
        assert word not in sentence
    return sentence


def misused(argv, message, capsys):
    """Wrong usage is said beside the right one."""
    with pytest.raises(SystemExit) as stop:
        main(argv)
    assert stop.value.code == 2
    said = capsys.readouterr().err
    assert "usage:" in said and message in said


def parsers(parser, name="contactlaw"):
    yield name, parser
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command, inner in action.choices.items():
                yield from parsers(inner, f"{name} {command}")
