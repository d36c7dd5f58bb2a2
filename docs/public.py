"""Make the page of what is public from the code: `python docs/public.py`.

Names come from the modules, options from the parsers, formats and columns from the files that read them.
"""

import argparse
import importlib
from pathlib import Path

from contactlaw import cli
from contactlaw.engines.record import COLUMNS
from contactlaw.export import scene_file
from contactlaw.record import file as record
from contactlaw.table import file as table

PAGE = Path(__file__).with_name("public.md")
# The modules from which users import.
MODULES = [
    "contactlaw",
    "contactlaw.softsphere",
    "contactlaw.stepping",
    "contactlaw.walls",
    "contactlaw.laws",
    "contactlaw.engines.lammps",
    "contactlaw.engines.pymunk",
    "contactlaw.engines.record",
    "contactlaw.export",
    "contactlaw.table",
    "contactlaw.dashpot",
]
HEAD = """# What is public

Programs and scripts of yours may rely on what this page lists. It holds for all versions 1.x. `python
docs/public.py` makes the page from the code.

## What may change within 1.x

Versions are numbered by [Semantic Versioning](https://semver.org/): 1.1 and 1.2 add something, 1.1.1 mends faults.

| what | within 1.x |
| --- | --- |
| names, arguments and their order, options | stay, and keep their meaning; new ones may come |
| a name that something better replaces | works until 2.0; a `DeprecationWarning`, or a line on the \
standard error, says what to write in its place |
| commands and options of 0.3 | are answered with what to type now, until 1.1 |
| files that 1.x has written, [below](#files) | are read by every later 1.x; new columns and keys may come |
| numbers | may change by no more than [their stated error](how_sure.md); the changelog says by how \
much. Do not compare answers of two versions bit by bit |
| materials of the catalogue | a number may change if a better source is found; the changelog names it |
| flags | stay; a new one may come, and a limit may move with new evidence |
| printed tables, messages, pages, figures | may change. Programs read `--csv` and `--json`, the attributes \
of an error, and files |
| Python, numpy, numba, LAMMPS and other programs | a version may be dropped when its makers no longer support it |

Nothing is promised for names that begin with an underscore, modules that are not listed, the cache, restart files of
LAMMPS (continue them with the version that wrote them), `dem-demo`, `validation` and `tests`.

**Systems.** contactlaw is supported and tested on Linux (x86-64) with CPython 3.11, 3.12 and 3.13. It may run on
macOS and Windows, where nobody has tested it.

## Names in Python

The methods, attributes and arguments of these classes and functions are public, too, unless their names begin with an
underscore. The reference of the site (`make docs`) has them.

| import from | names |
| --- | --- |
"""
COMMANDS = """
Other languages: the functions and members that [the page of the C header](c.md) lists, and the words of the input
scripts of [LAMMPS](lammps.md) and [LIGGGHTS](liggghts.md). Environment variables: `CONTACTLAW_CACHE_DIR` and
`CONTACTLAW_NO_CACHE`.

## Commands

Results go to the standard output, messages to the standard error. The exit status is 0, or 1 if something was refused,
or 2 if an option is wrong.

| command | arguments and options |
| --- | --- |
"""
FILES = f"""
## Files

The tests keep a table, a record and a scene that 1.0 wrote, and read them in every version.

| file | written by | format |
| --- | --- | --- |
| a table, `.h5` | `contactlaw table build` | `{table.FORMAT}`, schema {table.SCHEMA} |
| a record, `.h5` | `save` of [LAMMPS](lammps_record.md) and [pymunk](pymunk.md#the-record), `cl.Record.save` | \
`{record.FORMAT}`, schema {record.SCHEMA} |
| rows of a record, `.npy` | `numpy.save`, the fix of LAMMPS | [these columns](#columns-of-a-record), or some of them |
| a scene | `contactlaw export lammps`, `cl.export.scene` | `{scene_file.FORMAT}`, for machines with the same order \
of bytes |
| a scene to write by hand, `.toml` | you | [its words](lammps_walls.md#in-a-scene) |
| materials, `.toml` | you | [its words](materials.md#a-file-of-your-own) |
| measurements, `.csv` | you, or phyphox | [its columns](fit.md#data) and [its head](measure.md#drop-and-note) |
| a grid of answers, `.csv` or `.h5` | `contactlaw cor --out` | [its axes and fields](command_line.md#files-of-a-grid) |

### Columns of a record

"""


def public(name: str) -> list[str]:
    """List the names that users take from a module, but for modules, which have entries of their own."""
    words = importlib.import_module(name).__all__
    return [word for word in words if f"{name}.{word}" not in MODULES and not word.startswith("__")]


def commands(parser: argparse.ArgumentParser) -> str:
    """Write a row for each command, with its arguments and options."""
    words = []
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            return "".join(map(commands, action.choices.values()))
        if action.dest != "help":
            words += action.option_strings or [action.dest.upper()]
    return f"| `{parser.prog}` | {listed(words)} |\n"


def listed(words: list[str]) -> str:
    """List words as code."""
    return ", ".join(f"`{word}`" for word in words)


def written() -> str:
    """Return the page."""
    rows = "".join(f"| `{name}` | {listed(sorted(public(name)))} |\n" for name in MODULES)
    return HEAD + rows + COMMANDS + commands(cli.parser()) + FILES + listed([column.name for column in COLUMNS]) + ".\n"


if __name__ == "__main__":
    PAGE.write_text(written(), "utf-8")
