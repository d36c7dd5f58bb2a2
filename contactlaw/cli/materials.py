"""``contactlaw materials``: the catalogue, with the source of each number."""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict
from typing import Any

from contactlaw.cli.parts import options
from contactlaw.physical.materials import material, materials


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "the catalogue, with the source of each number"
    command = options.command(commands, "materials", about, _run)
    command.add_argument("name", nargs="?", metavar="NAME", help="one material, and its sources")
    command.add_argument("--json", action="store_true", help="print all fields, in SI units")


def _run(arguments: argparse.Namespace) -> None:
    entries = [material(name) for name in ([arguments.name] if arguments.name else materials())]
    if arguments.json:
        print(json.dumps([asdict(entry) for entry in entries], indent=2))
        return
    print(
        f"{'name':24s} {'E [GPa]':>9s} {'nu [-]':>7s} {'rho [kg/m3]':>12s} {'sigma_Y [MPa]':>14s}"
    )
    for entry in entries:
        strength = "-" if entry.yield_strength is None else f"{entry.yield_strength / 1e6:.1f}"
        print(
            f"{entry.name:24s} {entry.youngs_modulus / 1e9:9.3f} {entry.poissons_ratio:7.3f} "
            f"{entry.density:12.0f} {strength:>14s}"
        )
    if arguments.name:
        print(entries[0].source)
