"""``contactlaw materials``: the catalogue, with the source of each number."""

import argparse
import json
from dataclasses import asdict
from typing import Any

from contactlaw.cli.parts import options
from contactlaw.physical.materials import Material, find, materials

# Heading, width and places of each column, and what one of its unit is in SI units.
_COLUMNS = {
    "E [GPa]": (9, 3, 1e9),
    "nu [-]": (7, 3, 1.0),
    "rho [kg/m3]": (12, 0, 1.0),
    "sigma_Y [MPa]": (14, 1, 1e6),
    "H [GPa]": (8, 3, 1e9),
    "B [MPa]": (8, 0, 1e6),
    "n [-]": (6, 2, 1.0),
    "C [-]": (6, 3, 1.0),
    "tan delta [-]": (13, 3, 1.0),
}


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "the catalogue, with the source of each number"
    command = options.command(commands, "materials", about, _run)
    options.add_materials(command)
    command.add_argument("name", nargs="?", metavar="NAME", help="one material, and its sources")
    command.add_argument("--json", action="store_true", help="print all fields, in SI units")


def _run(arguments: argparse.Namespace) -> None:
    own = arguments.materials
    listed = sorted({body.name for body in own.values()}) or materials()
    names = [arguments.name] if arguments.name else listed
    entries = [find(name, own) for name in names]
    if arguments.json:
        print(json.dumps([asdict(entry) for entry in entries], indent=2))
        return
    headings = (f"{heading:>{width}s}" for heading, (width, *_) in _COLUMNS.items())
    print(f"{'name':25s}", *headings)
    for entry in entries:
        print(f"{entry.name:25s}", *_cells(entry))
    if arguments.name:
        print(entries[0].source)


def _cells(entry: Material) -> list[str]:
    """Numbers of a material, each as wide as its column; a dash for those that it lacks."""
    hardening = entry.hardening if isinstance(entry.hardening, tuple) else (None, entry.hardening)
    numbers = (
        entry.youngs_modulus,
        entry.poissons_ratio,
        entry.density,
        entry.yield_strength,
        entry.hardness,
        *hardening,
        entry.rate and entry.rate[0],
        entry.loss_factor and entry.loss_factor[0],
    )
    return [
        f"{'-':>{width}s}" if number is None else f"{number / unit:{width}.{places}f}"
        for number, (width, places, unit) in zip(numbers, _COLUMNS.values(), strict=True)
    ]
