"""Command line: ``contactlaw cor | sweep | constant | fit | history | export | ...``.

Each file or folder but `parts` has a subcommand: its function `add` adds the parser and options to
argparse's subparsers, and a line of its docstring that begins with ``contactlaw NAME`` says what it
is for. Only the file of the subcommand that is called is imported, so that help comes at once. Code
that several subcommands share is in `parts`.
"""

import argparse
import ast
import importlib
import os
import re
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from contactlaw._version import VERSION
from contactlaw.parser import Parser

_ABOUT = re.compile(r"^``contactlaw ([\w-]+)``: (.*)\.$", re.MULTILINE)
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
    words = sys.argv[1:] if argv is None else argv
    arguments = parser(words).parse_args(words)
    from contactlaw.cli.parts import wording  # what takes long is loaded once help has been given

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
        wording.print_message(wording.sentence(error, vars(arguments)))
        try:
            sys.stdout.flush()
        except OSError:  # a full disk
            _drop_output()
        return _REFUSED
    return _DONE


def parser(words: Sequence[str] | None = None) -> argparse.ArgumentParser:
    """Make the parser; parsed arguments have the function of the subcommand as `run`.

    With the words of a command line, other subcommands than its own have a line of help only.
    """
    made = Parser(prog="contactlaw", description="Restitution of beads that hit thin plates.")
    made.add_argument("--version", action="version", version=f"%(prog)s {VERSION}", help="print the version and exit")
    made.add_argument(
        "--print-completion",
        action=_Completion,
        choices=("bash", "zsh", "tcsh"),
        help="print a script for the shell's completion and exit",
    )
    commands = made.add_subparsers(required=True, metavar="COMMAND", help="what to do")
    listed = _subcommands()
    asked = next((word for word in words or () if not word.startswith("-")), None)
    modules = {module for name, (module, _) in listed.items() if words is None or name == asked}
    for name, (_, about) in listed.items() if not modules else ():
        commands.add_parser(name, help=about)
    for module in sorted(modules):
        importlib.import_module(f"{__name__}.{module}").add(commands)
    return made


class _Completion(argparse.Action):
    """Prints a script by which a shell completes subcommands, options, materials and laws."""

    def __call__(self, caller: argparse.ArgumentParser, _: Any, shell: Any, __: Any = None) -> None:
        try:
            import shtab
        except ImportError:
            caller.exit(_REFUSED, "contactlaw: this needs shtab: pip install 'contactlaw[shell]'\n")
        from contactlaw import laws
        from contactlaw.physical.materials import materials

        names = {"sphere": materials(), "plate": materials(), "law": laws.names()}
        files = {"FILE": shtab.FILE, "FOLDER": shtab.DIR, "DIR": shtab.DIR}
        made = parser()
        found = list(made._actions)  # those of subcommands are put behind, and follow
        for action in found:
            if isinstance(action.choices, dict):
                found += [one for each in action.choices.values() for one in each._actions]
            elif action.dest in names:
                action.choices = names[action.dest]
            elif action.metavar in files:
                action.complete = files[action.metavar]  # type: ignore[attr-defined]
        print(shtab.complete(made, shell))
        caller.exit()


def _subcommands() -> dict[str, tuple[str, str]]:
    """Find module and purpose of each subcommand, from the docstring of its file."""
    found = dict[str, tuple[str, str]]()
    for path in sorted(Path(__file__).parent.glob("*")):
        file = path / "__init__.py" if path.is_dir() else path
        if file.suffix == ".py" and path.stem not in ("__init__", "parts") and file.exists():
            said = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or ""
            found |= {name: (path.stem, about) for name, about in _ABOUT.findall(said)}
    return found


def _drop_output() -> None:
    """Discard the rest of the buffer, which Python would otherwise write at its exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
