"""``contactlaw materials`` (ask): the catalogue of materials, with the source of each number."""

import json
import math
import sys
from argparse import Namespace
from dataclasses import asdict
from typing import Any

from contactlaw.cli.parts import options
from contactlaw.cli.parts.table import Column, Table
from contactlaw.parser import wrapped
from contactlaw.physical.materials import Material, find, materials

# Title and unit of each column, and the number of these units in one SI unit.
_TITLES = (
    ("name", "", 1.0),
    ("E", "GPa", 1e-9),
    ("nu", "-", 1.0),
    ("rho", "g/cm3", 1e-3),
    ("yield", "MPa", 1e-6),
    ("H", "GPa", 1e-9),
    ("B", "MPa", 1e-6),
    ("n", "-", 1.0),
    ("C", "-", 1.0),
    ("tan delta", "-", 1.0),
)
_COLUMNS = [Column(title, "", title, unit, scale) for title, unit, scale in _TITLES]
_LISTED = 8  # columns of the catalogue; one material has all others
_MEANING = (
    "E Young's modulus, nu Poisson's ratio, rho density, yield: yield strength, H hardness; hardening: flow stress "
    "= yield + B strain^n; C growth of the flow stress per e-fold of the strain rate; tan delta loss factor."
)


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    command = options.command(commands, "materials", "the catalogue of materials, with the source of each number", _run)
    options.add_materials(command)
    command.add_argument("name", nargs="?", metavar="NAME", help="print this material alone, with its sources")
    command.add_argument("--json", action="store_true", help="print all properties as JSON, in SI units")


def _run(arguments: Namespace) -> None:
    own, name = arguments.materials, arguments.name
    listed = sorted({body.name for body in own.values()}) or materials()
    bodies = [find(one, own) for one in ([name] if name else listed)]
    if arguments.json:
        print(json.dumps([asdict(body) for body in bodies], indent=2))
        return
    values = dict(zip((title for title, *_ in _TITLES), zip(*map(_numbers, bodies), strict=True), strict=True))
    Table(_COLUMNS[1:] if name else _COLUMNS[:_LISTED], values).write(sys.stdout)
    print("", *wrapped(_MEANING), sep="\n")
    if name:
        print("", *wrapped(f"{bodies[0].name}: {bodies[0].source}"), sep="\n")


def _numbers(body: Material) -> list[Any]:
    """Values of the columns; NaN for those that a material lacks."""
    hardening = body.hardening if isinstance(body.hardening, tuple) else (None, body.hardening)
    of_time = (pair and pair[0] for pair in (body.rate, body.loss_factor))
    strengths = body.yield_strength, body.hardness, *hardening, *of_time
    elastic = body.name, body.youngs_modulus, body.poissons_ratio, body.density
    return [*elastic, *(math.nan if number is None else number for number in strengths)]
