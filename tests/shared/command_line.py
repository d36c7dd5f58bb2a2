"""What several tests ask of the command line."""

import argparse


def parsers(parser, name="contactlaw"):
    yield name, parser
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command, inner in action.choices.items():
                yield from parsers(inner, f"{name} {command}")
