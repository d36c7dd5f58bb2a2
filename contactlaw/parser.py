"""The parser of ``contactlaw`` and of ``dem-demo``, and lines that fit a terminal; no slow imports."""

import argparse
import difflib
import itertools
import re
import sys
import textwrap
from typing import Any, NoReturn

WIDTH = 80  # of a line on a terminal


class Parser(argparse.ArgumentParser):
    """A parser that takes no abbreviations, and names the option nearest to an unknown one."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings, allow_abbrev=False)
        # argparse takes -1 for a number, but would take -1mm for an option
        self._negative_number_matcher = re.compile(r"-(\.?\d|inf)")

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Refuse unknown options first, which may be meant for one that is missing."""
        words = sys.argv[1:] if args is None else list(args)
        # The words from the name of a subcommand on are for its own parser.
        mine = (lambda word: word[:1] == "-") if self._subparsers else (lambda word: word != "--")
        for word in itertools.takewhile(mine, words):
            name = word.partition("=")[0]
            named = re.fullmatch(r"--?(?!inf(?:inity)?$)[^\W\d][\w-]*", name)
            if named and name not in self._option_string_actions:
                self.error(f"{name}: no such option{self._hint(name)}")
        return super().parse_known_args(words, namespace)

    def error(self, message: str) -> NoReturn:
        """Print the usage and a message, and exit with 2."""
        self.print_usage(sys.stderr)
        self.exit(2, f"{for_stderr(f'{self.prog}: error: {message}')}\n")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Name the choice nearest to an unknown one."""
        if action.choices is not None and value not in action.choices:
            near = difflib.get_close_matches(str(value), action.choices, n=1, cutoff=0.65)
            hint = f", did you mean {near[0]}?" if near else f"; choose from {', '.join(action.choices)}"
            raise argparse.ArgumentError(action, f"got {value!r}{hint}")

    def _hint(self, name: str) -> str:
        known = [option.lstrip("-") for option in self._option_string_actions]
        option = name.lower().lstrip("-").replace("_", "-")
        for near in difflib.get_close_matches(option, known, n=1):
            return f", did you mean --{near}?"
        if option.startswith("edge"):
            return ": edges are for Python, restitution(..., edge=..., edge_distance=...)"
        return f", known: --{', --'.join(known[2:])}"  # without -h, --help


def wrapped(text: str, indent: str = "", width: int = WIDTH) -> list[str]:
    """Break a text into lines for a terminal; lines after the first are indented."""
    return textwrap.wrap(text, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def for_stderr(message: str) -> str:
    """Break the lines of a message for a terminal; in a file or a pipe they stay whole, so that grep finds them."""
    if not sys.stderr.isatty():
        return message
    return "\n".join(part for line in message.splitlines() for part in wrapped(line, "  "))
