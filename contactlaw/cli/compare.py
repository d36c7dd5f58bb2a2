"""``contactlaw compare`` (measure): measured CORs beside the model, to which they were not fitted."""

import json
import sys
from argparse import Namespace
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Any

import numpy as np

from contactlaw import laws
from contactlaw._arrays import Array
from contactlaw._readable import percent
from contactlaw.cli.parts import bands, chosen, impacts, measured, options
from contactlaw.cli.parts.figure import Figure
from contactlaw.cli.parts.table import Column, Table, in_words
from contactlaw.comparison import Comparison, compare
from contactlaw.model import ImpactModel
from contactlaw.parser import wrapped
from contactlaw.physical.pair import Pair

_UNLIKELY = 0.05  # probability of chi-squared below which chance does not explain the differences
_FORMS = {
    "csv": "print the rebounds as rows in SI units, every digit",
    "json": "print chi-squared, all laws and the rebounds",
}
_DISTINCT = 2.0  # standard errors by which a law is farther from the data than another one


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "measured CORs beside the model, to which they were not fitted"
    command = options.command(commands, "compare", about, _run)
    command.add_argument(
        "data",
        metavar="FILE",
        help="a table of rebounds or drops (CSV), or an export of phyphox, as for `contactlaw fit`, with a standard "
        "error of each COR, height or time. Lines of TOML behind # above the table may state materials, sizes, "
        "their errors and the source",
    )
    measured.add_options(command, _FORMS)


def _run(arguments: Namespace) -> None:
    chosen.take_drops(arguments)
    source = chosen.of_file(arguments, arguments.data)
    pair = source.pair
    model = ImpactModel(pair, arguments.law)
    bodies = chosen.asked(arguments, model)
    with chosen.plot_file(arguments):
        found = compare(pair, source.rebounds, arguments.law, **source.errors)
        if arguments.plot is not None:
            about = ": ".join(filter(None, (source.title, in_words(bodies))))
            _figure(found, model, source.errors, about).save(arguments.plot)
            return
    table = _rows(found, bodies)
    if arguments.form == "csv":
        table.write(sys.stdout, "csv")
        return
    by_law = dict[str, Comparison]()
    for name in laws.names():
        with suppress(ValueError, RuntimeError):  # it cannot be used for this pair
            by_law[name] = compare(pair, found.data, name, **source.errors)
    by_law = dict(sorted(by_law.items(), key=lambda item: item[1].if_exact))
    if arguments.form == "json":
        numbers = {"title": source.title, "reference": source.reference, **_numbers(found), "unknown": found.unknown}
        numbers["laws"] = {name: _numbers(comparison) for name, comparison in by_law.items()}
        print(json.dumps(numbers | {"rebounds": table.records()}, indent=2))
    else:
        print(*wrapped(source.title), *wrapped(source.reference), *table.text(), "", sep="\n")
        print(*_judged(found, pair), "", *_nearest(by_law), sep="\n")


def _rows(found: Comparison, bodies: dict[str, str]) -> Table:
    """Table of the rebounds: measured COR, its error, COR of the model, its range, and flags."""
    data, ends = found.data, {"low": found.band.low, "high": found.band.high}
    values = {column.name: getattr(data, column.name) for column in impacts.COLUMNS[:3]}
    values |= {"measured": data.restitution, "error": data.restitution_error, "restitution": found.restitution}
    values |= {name: np.where(np.isfinite(end), end, np.nan) for name, end in ends.items()}
    columns = [*impacts.COLUMNS[:3], Column("measured", title="measured"), Column("error", title="error")]
    columns += [Column("restitution", title="predicted"), Column("low", title="68 %", to="high"), Column("high")]
    return Table(columns, values, bodies, found.flags)


def _judged(found: Comparison, pair: Pair) -> Iterator[str]:
    """Lines about the range and about chi-squared."""
    yield from wrapped(f"68 %: {bands.meaning(found.band, pair)}.")
    agree = found.probability >= _UNLIKELY
    yield from wrapped(
        f"The number of rebounds is {len(found.data)}, and chi-squared is {found.chi_squared:.3g}. If the model and "
        f"all stated errors are right, the probability of a value as large is {percent(found.probability)}: the data "
        f"{'agree with the model' if agree else 'differ from the model by more than the stated errors explain'}."
    )


def _figure(found: Comparison, model: ImpactModel, errors: Mapping[str, float], about: str) -> Figure:
    """Figure of a comparison with a model; the errors are those of speed and sizes."""
    data = found.data
    sizes = {name: np.asarray(getattr(data, name)) for name in ("speed", "thickness", "radius")}
    values = np.asarray(data.restitution), np.asarray(data.restitution_error), found.flags
    title = f"By their errors, the data {'agree with' if found.probability >= _UNLIKELY else 'differ from'} the model"
    band = f"Nothing is fitted. Band: {bands.meaning(found.band, model.pair)}"
    return measured.figure_of(
        "restitution", sizes, *values, lambda impact: curve(model, impact, errors), title, about, band
    )


def curve(
    model: ImpactModel, impact: Mapping[str, Any], errors: Mapping[str, float]
) -> tuple[Any, Array, Array, Array]:
    """Predict some impacts: what the model says, their COR, and the ends of its band."""
    hit = model.solve(**impact)
    cor, band = np.asarray(hit.restitution), model.uncertainty(**impact, **errors).restitution
    low, high = (np.where(np.isfinite(end), end, cor) for end in (band.low, band.high))
    return hit, cor, low, high


def _numbers(comparison: Comparison) -> dict[str, float]:
    return {name: getattr(comparison, name) for name in ("rms", "if_exact", "chi_squared", "probability")}


def _nearest(by_law: Mapping[str, Comparison]) -> Iterator[str]:
    """Lines of the laws, the nearest first, and what the errors of data and materials say of the others."""
    (first, best), *others = by_law.items()
    words = f"Law {first} is nearest to the data."
    similar = [name for name, one in others if one.if_exact - best.if_exact < _DISTINCT**2]
    if similar:
        words += f" The errors of data and materials do not distinguish it from {', '.join(similar)}."
    large = [name for name, one in others if name not in similar and one.probability >= _UNLIKELY]
    if large:
        why = "only because the stated error of the law itself is large"
        words += f" {', '.join(large)} would pass the test above, too, but {why}."
    yield from wrapped(words)
    values = {
        "law": [*by_law],
        "difference": [one.rms for one in by_law.values()],
        "law's error": [np.sqrt(np.mean(np.square(one.band.causes["model"]))) for one in by_law.values()],
        "chi-squared": [one.if_exact for one in by_law.values()],
    }
    columns = [Column(name, title=name, shown="-" * (name != "law"), digits=".3g") for name in values]
    yield from Table(columns, values).text()
    yield from wrapped(
        "Difference: rms of measured minus predicted COR. Law's error: the stated error of the law's COR for these "
        "impacts. Chi-squared: with the errors of data and materials alone. Laws that are not "
        "listed cannot be used for these materials."
    )
