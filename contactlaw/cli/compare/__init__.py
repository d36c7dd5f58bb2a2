"""``contactlaw compare``: measured CORs beside the model, to which they were not fitted."""

import argparse
import textwrap
from collections.abc import Iterator
from contextlib import nullcontext
from typing import Any

import numpy as np

from contactlaw import laws, quantities
from contactlaw.cli.compare import figure
from contactlaw.cli.parts import chosen, impacts, options, rebounds, wording
from contactlaw.cli.parts.impacts import COLUMNS, Column, ImpactTable
from contactlaw.comparison import Comparison, compare
from contactlaw.physical.materials import NoYieldStrengthError
from contactlaw.physical.pair import Pair
from contactlaw.quantities import LENGTH

_UNLIKELY = 0.05  # probability of chi-squared below which chance does not explain the differences
_WIDTH = 110  # of a line of text


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "measured CORs beside the model, to which they were not fitted"
    command = options.command(commands, "compare", about, _run)
    add = command.add_argument
    add(
        "data",
        metavar="FILE",
        help="CSV with a row per rebound, as of `contactlaw fit`, with columns of COR and COR_error; its "
        "head may have materials, source and errors of the sizes, as lines of TOML behind #",
    )
    of_file = " (default: that of the file)"
    options.add_pair(command, of_file)
    options.add_radius(command, "all beads", quantities.value, known=of_file)
    what = f"thickness of all plates [m], or with a unit; inf: a half-space{of_file}"
    options.add_quantity(command, "--thickness", LENGTH, what, metavar="H")
    options.add_name_of_law(command)
    add("--plot", metavar="FILE", help="draw the model's band and the data into FILE (PNG, SVG, PDF)")
    command.epilog = options.UNITS


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    read = rebounds.checked(arguments.data)
    with wording.reading(arguments.data):
        known = rebounds.conditions(read, arguments.materials)
    pair = Pair(**{role: chosen.body(arguments, role, known.bodies.get(role)) for role in ("sphere", "plate")})
    sizes = {"radius": arguments.radius, "thickness": arguments.thickness}
    data = rebounds.completed(read, arguments.data, pair.sphere.density, **sizes)
    with nullcontext() if arguments.plot is None else chosen.plot_file(arguments):
        found = compare(pair, data, arguments.law, **known.errors)
        if arguments.plot is not None:
            bodies = f"{pair.sphere.name} on {pair.plate.name}, law {arguments.law}"
            about = f"{known.title}: {bodies}" if known.title else bodies
            figure.save(found, pair, arguments.law, known.errors, about, arguments.plot)
        else:
            print(*filter(None, (known.title, known.reference)), *_rows(found, pair, arguments.law), "", sep="\n")
            print(*_judged(found), "", *_by_law(pair, found, known.errors), sep="\n")


def _rows(found: Comparison, pair: Pair, law: str) -> Iterator[str]:
    """Lines of the rebounds: measured COR, its error, COR of the model, its range, and flags."""
    by_name, data = {column.name: column for column in COLUMNS}, found.data
    values = {name: getattr(data, name) for name in ("speed", "radius", "thickness")}
    values |= {"measured": data.restitution, "error": data.restitution_error, "restitution": found.restitution}
    ends = np.array([found.band.low, found.band.high])
    low, high = np.where(np.isfinite(ends), ends, np.nan)
    columns = *(by_name.get(name, Column(name, "", name)) for name in values), Column("low", "", "68 %", to="high")
    asked = {"sphere": pair.sphere.name, "plate": pair.plate.name, "law": law}
    return impacts.text(ImpactTable(values | {"low": low, "high": high}, found.flags, asked), columns)


def _judged(found: Comparison) -> list[str]:
    """Say what chi-squared means."""
    many = f"{len(found.data)} rebound{'s' * (len(found.data) > 1)}"
    verdict = "agrees within" if found.probability >= _UNLIKELY else "differs by more than"
    said = (
        f"chi-squared {found.chi_squared:.3g} of {many}, as large or larger by chance in "
        f"{100.0 * found.probability:.2g} % of cases: the model {verdict} the known errors."
    )
    if found.unknown:
        said += f" Not in it, as nobody knows the error: {', '.join(found.unknown)}."
    return textwrap.wrap(said, _WIDTH)


def _by_law(pair: Pair, found: Comparison, errors: dict[str, float]) -> Iterator[str]:
    """Lines of all laws, the one nearest to the data first."""
    compared, without = list[tuple[str, Comparison]](), list[str]()
    for name in laws.names():
        try:
            compared.append((name, compare(pair, found.data, name, **errors)))
        except NoYieldStrengthError:
            without.append(name)
    compared.sort(key=lambda one: one[1].rms)
    rows = [("law", "rms off", "chi-squared", "by chance", ""), ("", "[-]", "[-]", "[%]", "")]
    for name, one in compared:
        rows.append((name, f"{one.rms:.4f}", f"{one.chi_squared:.3g}", f"{100.0 * one.probability:.0f}", ""))
    yield f"Nearest to the data is law {compared[0][0]}. A law with large errors of its own has a small chi-squared."
    yield from impacts.aligned([*zip(*rows, strict=True)])
    if without:
        yield f"without an answer, as {pair.sphere.name} has no yield strength: {', '.join(without)}"
