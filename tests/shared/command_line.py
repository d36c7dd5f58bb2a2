"""What several tests ask of the command line."""

import argparse
import csv
import json
import shlex
from typing import NamedTuple

from contactlaw.cli import main


class Run(NamedTuple):
    """Exit status of a command line, and what it printed."""

    status: int
    out: str
    err: str

    @property
    def values(self):
        """Values of a command with ``--json``; NaN and infinity are no JSON."""
        return json.loads(self.out, parse_constant=lambda name: 1 / 0)

    @property
    def rows(self):
        """Rows of a command with ``--csv``."""
        return [*csv.DictReader(self.out.splitlines())]

    @property
    def text(self):
        """What a person reads, without line breaks."""
        return " ".join(self.out.split())


def run(line, capsys):
    """Run a command line in this process; neither a usage nor a refusal shows a traceback."""
    try:
        status = main(shlex.split(line))
    except SystemExit as stop:
        status = stop.code
    made = Run(status, *capsys.readouterr())
    assert "Traceback" not in made.err
    return made


def parsers(parser, name="contactlaw"):
    yield name, parser
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command, inner in action.choices.items():
                yield from parsers(inner, f"{name} {command}")
