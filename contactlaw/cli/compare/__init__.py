"""``contactlaw compare``: measured CORs beside the model, to which they were not fitted."""

import argparse
import json
import sys
import textwrap
from collections.abc import Iterator
from contextlib import nullcontext, suppress
from typing import Any

import numpy as np

from contactlaw import laws, quantities
from contactlaw.cli.compare import figure
from contactlaw.cli.parts import chosen, impacts, options
from contactlaw.cli.parts.impacts import COLUMNS, Column, ImpactTable
from contactlaw.comparison import Comparison, compare
from contactlaw.physical.materials import NoYieldStrengthError
from contactlaw.physical.pair import Pair
from contactlaw.quantities import LENGTH, TIME

_UNLIKELY = 0.05  # probability of chi-squared below which chance does not explain the differences
_TOLD = 2.0  # standard errors by which a law is told from another
_WIDTH = 110  # of a line of text


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "measured CORs beside the model, to which they were not fitted"
    command = options.command(commands, "compare", about, _run)
    command.add_argument(
        "data",
        metavar="FILE",
        help="CSV with a row per rebound or drop, as of `contactlaw fit`, with a standard error of each COR, height or "
        "time; its head may have materials, sizes, their errors and source, as lines of TOML behind #",
    )
    of_file = " (default: that of the file)"
    options.add_pair(command, of_file)
    options.add_radius(command, "all beads", quantities.value, known=of_file)
    what = f"thickness of all plates [m], or with a unit; inf: a half-space{of_file}"
    options.add_quantity(command, "--thickness", LENGTH, what, metavar="H")
    what = f"standard error of the instants of bounces [s], or with a unit{of_file}"
    options.add_quantity(command, "--time-error", TIME, what, metavar="T")
    options.add_name_of_law(command)
    add = command.add_mutually_exclusive_group().add_argument
    add("--csv", action="store_true", help="print the rebounds as rows in SI units, every digit")
    add("--json", action="store_true", help="print chi-squared, all laws and the rebounds; inf is null")
    add("--plot", metavar="FILE", help="draw the model's band and the data into FILE (PNG, SVG, PDF)")
    command.epilog = options.UNITS


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    data, pair, known = chosen.of_file(arguments, arguments.data)
    with nullcontext() if arguments.plot is None else chosen.plot_file(arguments):
        found = compare(pair, data, arguments.law, **known.errors)
        if arguments.plot is not None:
            about = f"{known.title or 'rebounds'}: {pair.sphere.name} on {pair.plate.name}, law {arguments.law}"
            figure.save(found, pair, arguments.law, known.errors, about, arguments.plot)
            return
    table, columns = _rows(found, pair, arguments.law)
    if arguments.csv:
        impacts.write_csv(table, sys.stdout, columns)
    elif arguments.json:
        said = {"title": known.title, "reference": known.reference, **_numbers(found), "unknown": found.unknown}
        said |= {"laws": {name: _numbers(one) for name, one in _by_law(pair, found, known.errors).items()}}
        print(json.dumps(said | {"rebounds": impacts.records(table)}, indent=2))
    else:
        print(*filter(None, (known.title, known.reference)), *impacts.text(table, columns), "", sep="\n")
        print(*_judged(found), "", *_nearest(pair, found, _by_law(pair, found, known.errors)), sep="\n")


def _rows(found: Comparison, pair: Pair, law: str) -> tuple[ImpactTable, tuple[Column, ...]]:
    """Table of the rebounds: measured COR, its error, COR of the model, its range, and flags."""
    by_name, data = {column.name: column for column in COLUMNS}, found.data
    values = {name: getattr(data, name) for name in ("speed", "radius", "thickness")}
    values |= {"measured": data.restitution, "error": data.restitution_error, "restitution": found.restitution}
    low, high = (np.where(np.isfinite(end), end, np.nan) for end in (found.band.low, found.band.high))
    columns = tuple(by_name.get(name, Column(name, "", name)) for name in values)
    columns += Column("low", "", "68 %", to="high"), Column("high", "")
    asked = {"sphere": pair.sphere.name, "plate": pair.plate.name, "law": law}
    return ImpactTable(values | {"low": low, "high": high}, found.flags, asked), columns


def _judged(found: Comparison) -> list[str]:
    """Say what chi-squared means."""
    many = f"{len(found.data)} rebound{'s' * (len(found.data) > 1)}"
    verdict = "agrees within" if found.probability >= _UNLIKELY else "differs by more than"
    said = (
        f"chi-squared {found.chi_squared:.3g} of {many}, as large or larger by chance in "
        f"{100.0 * found.probability:.2f} % of cases: the model {verdict} the known errors."
    )
    if found.unknown:
        said += f" A specified minimum is not in it, and may be a cause of differences: {', '.join(found.unknown)}."
    return textwrap.wrap(said, _WIDTH)


def _numbers(one: Comparison) -> dict[str, float]:
    return {name: getattr(one, name) for name in ("rms", "if_exact", "chi_squared", "probability")}


def _by_law(pair: Pair, found: Comparison, errors: dict[str, float]) -> dict[str, Comparison]:
    """Comparisons with all laws that have an answer, the one nearest to the data first."""
    compared = dict[str, Comparison]()
    for name in laws.names():
        with suppress(NoYieldStrengthError):
            compared[name] = compare(pair, found.data, name, **errors)
    return dict(sorted(compared.items(), key=lambda one: one[1].if_exact))


def _nearest(pair: Pair, found: Comparison, by_law: dict[str, Comparison]) -> Iterator[str]:
    """Lines of the laws, with those that the errors of data and materials do not tell from the nearest one."""
    (first, best), *others = by_law.items()
    alike = [name for name, one in others if one.if_exact - best.if_exact < _TOLD**2]
    also = ", which the errors of data and materials do not tell from " * bool(alike) + ", ".join(alike)
    said = f"Nearest to the data is law {first}{also}. If exact: chi-squared without the law's own errors."
    yield from textwrap.wrap(said, _WIDTH)
    rows = [["law", "rms off", "if exact", "chi-squared", "by chance", ""], ["", "[-]", "[-]", "[-]", "[%]", ""]]
    for n, one in by_law.items():
        rows.append([n, *(f"{x:.3g}" for x in (one.rms, one.if_exact, one.chi_squared, 100.0 * one.probability)), ""])
    yield from impacts.aligned([*zip(*rows, strict=True)])
    if without := [name for name in laws.names() if name not in by_law]:
        yield f"without an answer, as {pair.sphere.name} has no yield strength: {', '.join(without)}"
