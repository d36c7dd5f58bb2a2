"""Coefficients of restitution, and what gives one.

``contactlaw cor``: coefficient of restitution and more, of one impact or many.
"""

import argparse
import functools
import json
import math
import sys
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw._arrays import Array
from contactlaw.answers.uncertainty import Uncertainty
from contactlaw.cli.parts import bands, chosen, impacts, layout, options, wording
from contactlaw.cli.parts import old_figure as figure
from contactlaw.model import ImpactModel
from contactlaw.physical.pair import Pair
from contactlaw.physical.validity import explain


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "coefficient of restitution and more, of one impact or many"
    command = options.command(commands, "cor", about, _run)
    options.add_impact(command, quantities.values)
    options.add_mass(command)
    options.add_wall(command)
    options.add_errors(command, _SIZES)
    command.add_argument("--no-band", action="store_true", help="leave out the 68 %% range, which takes longest")
    add = command.add_mutually_exclusive_group().add_argument
    add("--csv", action="store_true", help="print rows of all fields in SI units, every digit")
    add("--json", action="store_true", help="print all fields in SI units, a list for several impacts; inf is null")
    add(
        "--plot",
        metavar="FILE",
        help="draw the COR into FILE (PNG, SVG, PDF). A list of speeds, thicknesses or radii is the "
        "axis, or without a list all speeds up to the given one. A second list makes curves; two "
        "lists of more than 8 values make a map",
    )
    command.epilog = f"{options.UNITS} {options.LISTS}"


_SIZES = "speed", "radius", "thickness"


def _errors(arguments: argparse.Namespace) -> dict[str, float] | None:
    """Errors of speed and sizes; None if there is to be no band."""
    remembers = (arguments.cylinder, arguments.bowl, arguments.foundation) != (None, None, None)
    if arguments.no_band or remembers:  # errors of plates that swing are not known
        return None
    return {f"{name}_error": getattr(arguments, f"{name}_error") for name in _SIZES}


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    if arguments.plot is not None:
        with chosen.plot_file(arguments):
            _plot_cor(arguments)
        return
    values = arguments.speed, arguments.radius, arguments.thickness
    model, errors = chosen.model(arguments), _errors(arguments)
    mass, plate = arguments.mass, model.pair.given[1]
    wall = functools.partial(chosen.wall, arguments, plate)
    found = impacts.tabulate(model, *values, solve=arguments.solve, mass=mass, wall=wall)
    found.asked["plate"] = chosen.plate_in_words(arguments, plate.name)
    known = None
    if errors is not None:
        speed, radius, thickness = sizes = [found.columns[name] for name in _SIZES]
        with wording.naming_impact(*sizes, mass=mass):
            known = model.uncertainty(speed, radius, wall(thickness), **errors, mass=mass)
    found, columns = bands.with_bands(found, known)
    if arguments.csv:
        impacts.write_csv(found, sys.stdout, columns)
    elif arguments.json:
        rows = impacts.records(found)
        print(json.dumps(rows if len(rows) > 1 else rows[0], indent=2))
    else:
        first = ""
        if known is not None and errors is not None:
            (why, stated), ask = bands.assumed(model.pair), known
            if why:
                plate_given = chosen.wall(arguments, stated.given[1], thickness)
                guess = ImpactModel(stated, law=arguments.law)
                ask = guess.uncertainty(speed, radius, plate_given, **errors, mass=mass)
            first = bands.measure_first(ask.restitution, why)
        if len(found) == 1:
            _print_one(found, known, model.pair, first)
            return
        print(*impacts.text(found, columns), sep="\n")
        if known:
            print(*bands.explained(known.restitution, model.pair, first), sep="\n")


def _print_one(found: impacts.ImpactTable, known: Uncertainty | None, pair: Pair, first: str) -> None:
    print(f"{'asked':21s} {impacts.in_words(found.asked)}")
    for name, unit in impacts.units().items():
        value, band = found.columns[name][0], getattr(known, name, None)
        if name == "yield_speed" and value == math.inf:
            print(f"{name:21s} none within the table")
        else:
            shown = f"{name:21s} {value:.6g}", unit, band and bands.in_brackets(band)
            print(" ".join(filter(None, shown)))
    if known:
        band = known.restitution
        said = f"{bands.meaning(band)}{bands.left_out(band, pair)}; half the width by cause"
        print(f"{'in brackets':21s} {said}")
    if first:
        print(f"{'measure this first':21s} {first}")
    flags = int(found.flags[0])
    print(f"{'flags':21s} {', '.join(impacts.flag_names(flags)) or 'none: inside every limit'}")
    for words in explain(flags):
        print(f"{'':21s} {words}")


def _plot_cor(arguments: argparse.Namespace) -> None:
    model, errors, mass = chosen.model(arguments), _errors(arguments), arguments.mass
    wall = functools.partial(chosen.wall, arguments, model.pair.given[1])
    given = {name: getattr(arguments, name) for name in ("speed", "thickness", "radius")}
    if not any(map(layout.can_be_axis, given.values())):
        given["speed"] = (0.1 * arguments.speed[0], arguments.speed[0])

    def ask(grid: dict[str, Array]) -> layout.Answers:
        impact = grid["speed"], grid["radius"], wall(grid["thickness"])
        with wording.naming_impact(grid["speed"], grid["radius"], grid["thickness"], mass=mass):
            hit = (model.solve if arguments.solve else model.lookup)(*impact, mass=mass)
            known = None
            if errors is not None:
                known = model.uncertainty(*impact, **errors, mass=mass).restitution
        cor, flags, overload = map(np.asarray, (hit.restitution, hit.flags, hit.overload))
        if known is None or np.isinf(known.low).all():
            return layout.Answers(cor, flags, overload, cor, cor)
        low, high = (np.where(np.isfinite(end), end, cor) for end in (known.low, known.high))
        return layout.Answers(cor, flags, overload, low, high, bands.in_caption(known))

    plate = chosen.plate_in_words(arguments, model.pair.plate.name)
    about = f"{model.pair.sphere.name} on {plate}, law {arguments.law}"
    subject = figure.Subject("COR", "coefficient of restitution [-]", about)
    figure.save(arguments.plot, subject, given, ask)
