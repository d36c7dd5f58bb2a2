"""The parser of a command line, of ``contactlaw`` and of ``dem-demo``; no slow imports."""

import argparse
import difflib
import itertools
import re
import sys
from typing import Any


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

    def _hint(self, name: str) -> str:
        known = [option.lstrip("-") for option in self._option_string_actions]
        asked = name.lower().lstrip("-").replace("_", "-")
        for near in difflib.get_close_matches(asked, known, n=1):
            return f", did you mean --{near}?"
        if asked.startswith("edge"):
            return ": edges are for Python, restitution(..., edge=..., edge_distance=...)"
        return f", known: --{', --'.join(known[2:])}"  # without -h, --help
