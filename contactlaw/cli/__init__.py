"""Command line: ``contactlaw cor | sweep | constant | fit | history | export | ...``.

Each file or folder but `parts` is a subcommand: its function `add` adds the parser and options to
argparse's subparsers. Code that several subcommands share is in `parts`. Another command line, as
that of dem-demo, takes `quantities` and `sentence` from here.
"""

from __future__ import annotations

import argparse
import importlib
import os
import pkgutil
import sys
import warnings
from collections.abc import Sequence

from contactlaw._version import VERSION
from contactlaw.cli.parts import quantities, wording
from contactlaw.cli.parts.wording import sentence
from contactlaw.parser import Parser

__all__ = ["main", "parser", "quantities", "sentence"]

_DONE, _REFUSED, _INTERRUPTED = 0, 1, 130  # argparse itself exits with 2 on wrong usage


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line.

    Returns
    -------
    int
        0 done, 1 refused with a message on stderr, 130 interrupted; wrong usage exits with 2.

    Examples
    --------
    >>> main(["cor", "--sphere", "glass", "--plate", "glass", "--radius", "1e-3",
    ...       "--thickness", "1e-3", "--speed", "1", "--law", "hertz", "--json"])
    ... # doctest: +ELLIPSIS
    {
      "speed": 1.0,
    ...
      "restitution": 0.7...
    """
    arguments = parser().parse_args(argv)
    if sys.stdout is None:  # the shell has closed it by >&-
        wording.print_message("the standard output is closed")
        return _REFUSED
    try:
        with warnings.catch_warnings():
            warnings.showwarning = wording.print_warning  # type: ignore[assignment]
            arguments.run(arguments)
        sys.stdout.flush()  # here, so that a closed pipe is caught below
    except KeyboardInterrupt:
        wording.print_message("interrupted")
        return _INTERRUPTED
    except BrokenPipeError:  # the reader has closed the pipe, as `head` does
        _drop_output()
        return _DONE
    except (ValueError, RuntimeError, OSError, ImportError) as error:
        wording.print_message(sentence(error, vars(arguments)))
        try:
            sys.stdout.flush()
        except OSError:  # a full disk
            _drop_output()
        return _REFUSED
    return _DONE


def parser() -> argparse.ArgumentParser:
    """Make the parser; parsed arguments have the function of the subcommand as `run`."""
    made = Parser(prog="contactlaw", description="Restitution of beads that hit thin plates.")
    made.add_argument("--version", action="version", version=f"%(prog)s {VERSION}",
                      help="print the version and exit")  # fmt: skip
    commands = made.add_subparsers(required=True, metavar="COMMAND", help="what to do")
    for found in pkgutil.iter_modules(__path__):
        if found.name != "parts":
            importlib.import_module(f"{__name__}.{found.name}").add(commands)
    return made


def _drop_output() -> None:
    """Discard the rest of the buffer, which Python would otherwise write at its exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
