"""Command line: ``contactlaw cor | find | constant | fit | export | ...``.

A file or folder has the subcommand of its name: its function `add` adds the parser and options to
argparse's subparsers. Its docstring begins with a line such as ``contactlaw cor`` (ask): the name,
the group in the help, and what it is for. Only the file of the subcommand that is called is
imported, so that help comes at once. Code that several subcommands share is in `parts`.
"""

import argparse
import importlib
import os
import re
import sys
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path

from contactlaw._version import VERSION
from contactlaw.cli import old_names
from contactlaw.parser import Parser, for_stderr, wrapped

_ABOUT = re.compile(r'"""``contactlaw (\w+)`` \((\w+)\): (.*)\.')
_ORDER = {"ask": 0, "measure": 1, "engines": 2}  # of groups in the help; the others follow
_DONE, _REFUSED, _MISUSED = 0, 1, 2


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line.

    Returns
    -------
    int
        0 done, 1 refused with a message on stderr; wrong usage exits with 2.

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
    words = sys.argv[1:] if argv is None else argv
    arguments = parser(words).parse_args(words)
    from contactlaw.cli.parts import wording  # slow imports wait until help has been given

    if sys.stdout is None:  # the shell has closed it by >&-
        wording.print_message("the standard output is closed")
        return _REFUSED
    try:
        with warnings.catch_warnings():
            warnings.showwarning = wording.print_warning  # type: ignore[assignment]
            arguments.run(arguments)
        sys.stdout.flush()  # here, so that a closed pipe is caught below
    except BrokenPipeError:  # the reader has closed the pipe, as `head` does
        _drop_output()
        return _DONE
    except (ValueError, RuntimeError, OSError, ImportError) as error:
        wording.print_message(wording.sentence(error, vars(arguments)))
        try:
            sys.stdout.flush()
        except OSError:  # a full disk
            _drop_output()
        return _REFUSED
    return _DONE


def parser(words: Sequence[str] | None = None) -> argparse.ArgumentParser:
    """Make the parser; parsed arguments have the function of the subcommand as `run`.

    With the words of a command line only the called subcommand has its options. Without any call
    the help lists all subcommands in their groups.
    """
    made = Parser(prog="contactlaw", description="Restitution of beads that hit thin plates.")
    made.add_argument("--version", action="version", version=f"%(prog)s {VERSION}", help="print the version and exit")
    commands = made.add_subparsers(required=True, metavar="COMMAND", help="one of those below")
    called = next((word for word in words or () if not word.startswith("-")), None)
    if words and (answer := old_names.answer([*words])):
        made.exit(_MISUSED, f"{for_stderr(f'contactlaw: {answer}')}\n")
    subcommands = sorted(_subcommands(), key=lambda row: (_ORDER.get(row[0], len(_ORDER)), row))
    names = [name for _, name, _ in subcommands]
    if words is None or called in names:
        for name in names if words is None else [called]:
            importlib.import_module(f"{__name__}.{name}").add(commands)
        return made
    lines = []
    for group, name, about in subcommands:
        commands.add_parser(name)
        title = f"\n{group}:"
        lines += [title] * (title not in lines)
        lines += wrapped(f"  {name:12}{about}", " " * 14)
    made.formatter_class = argparse.RawDescriptionHelpFormatter
    made.epilog = "\n".join([*lines, "\n`contactlaw COMMAND --help` lists the options of a command."])
    return made


def _subcommands() -> Iterator[tuple[str, str, str]]:
    """Read the group, the name and the purpose of each subcommand out of its file."""
    for folder in map(Path, __path__):
        for path in (*folder.glob("*.py"), *folder.glob("*/__init__.py")):
            if about := _ABOUT.match(path.read_text(encoding="utf-8")):
                yield about[2], about[1], about[3]


def _drop_output() -> None:
    """Discard the rest of the buffer, which Python would otherwise write at its exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
