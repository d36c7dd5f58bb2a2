"""``contactlaw thickness`` and ``contactlaw speed``: what gives a coefficient of restitution."""

import argparse
import functools
import itertools
import json
import sys
import textwrap
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw._errors import ArgumentError
from contactlaw.answers.inverse import Solutions
from contactlaw.cli.parts import bands, chosen, impacts, options, wording
from contactlaw.cli.parts.impacts import COLUMNS, Column, ImpactTable
from contactlaw.fitting.drops import rebounds_of
from contactlaw.quantities import HEIGHT, SHARE

_KNOWN = {"thickness": ("speed", "radius"), "speed": ("radius", "thickness")}


def add(commands: Any) -> None:
    """Add both subcommands and their options."""
    for unknown, found in (("thickness", "thicknesses of the plate"), ("speed", "impact speeds")):
        about = f"all {found} that give a coefficient of restitution"
        command = options.command(commands, unknown, about, functools.partial(_run, unknown))
        options.add_pair(command)
        options.add_sizes(command, quantities.values, unknown=unknown)
        if unknown == "thickness":
            options.add_speed(command, quantities.values)
            options.add_layers(command)
        what = "coefficients of restitution, between 0 and 1"
        group = command.add_mutually_exclusive_group(required=True)
        options.add_quantity(group, "--cor", SHARE, what, quantities.values, metavar="E")
        if unknown == "thickness":
            what = "heights of bounces [m], or with a unit, in place of --cor; with one --speed or --drop"
            options.add_quantity(group, "--bounce", HEIGHT, what, quantities.values, metavar="Z")
        options.add_name_of_law(command)
        command.set_defaults(outside="raise")  # what is outside the table is not searched
        options.add_errors(command, _KNOWN[unknown])
        add = command.add_mutually_exclusive_group().add_argument
        add("--csv", action="store_true", help="print rows in SI units, every digit")
        add("--json", action="store_true", help="print rows in SI units; inf is null")
        command.epilog = f"{options.UNITS} {options.LISTS}"


def _run(unknown: str, arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    if getattr(arguments, "bounce", None) is not None:
        if len(arguments.speed) > 1:
            raise ArgumentError("bounce", None, "takes one speed or drop")
        measured = {"speed": arguments.speed, "bounce": arguments.bounce, "radius": chosen.bead_radius(arguments)}
        arguments.cor = rebounds_of(measured, chosen.density(arguments))["restitution"].tolist()
    model, known = chosen.model(arguments), _KNOWN[unknown]
    values = arguments.cor, *(getattr(arguments, name) for name in known)
    asked = np.array([*itertools.product(*values)]).T
    errors = {f"{name}_error": getattr(arguments, f"{name}_error") for name in known}
    plate, more = model.pair.given[1], {}
    if unknown == "thickness" and arguments.on:
        below = [chosen.layer(text, arguments.materials) for text in arguments.on]
        more = {"layers": [(plate, None), *below]}
    found: Any = getattr(model, unknown)(*asked, **errors, **more)
    named = {"plate": chosen.plate_in_words(arguments, plate.name)}
    questions = [dict(zip(known, one, strict=True)) for one in asked[1:].T.tolist()]
    remarks = [
        f"{impacts.in_words(impacts.asked(model, **sizes) | named)}, COR {one.restitution:g}: {one.remark}"
        for sizes, one in zip(questions, found, strict=True)
        if one.remark
    ]
    if len(remarks) == len(found):
        raise ValueError("\n".join(remarks))
    for remark in remarks:
        wording.print_warning(remark)
    counts = [one.value.size for one in found]
    rows = dict(zip(("restitution", *known), np.repeat(asked, counts, axis=1), strict=True))
    for name, field in ((unknown, "value"), (f"{unknown}_low", "low"), (f"{unknown}_high", "high")):
        rows[name] = np.concatenate([getattr(one, field) for one in found])
    low, high = (rows[f"{unknown}_{end}"] for end in ("low", "high"))
    low[np.isinf(low)] = np.nan
    high[np.isinf(high) & (np.isnan(low) | (unknown == "speed"))] = np.nan  # a half-space is an end
    flags = np.concatenate([one.flags for one in found])
    table, columns = ImpactTable(rows, flags, impacts.asked(model) | named), _columns(unknown)
    if arguments.csv:
        impacts.write_csv(table, sys.stdout, columns)
    elif arguments.json:
        answers = iter(impacts.records(table))
        rows_of = [
            [*itertools.islice(answers, one.value.size)] or [_unanswered(question, one, table)]
            for question, one in zip(questions, found, strict=True)
        ]
        print(json.dumps([*itertools.chain(*rows_of)], indent=2))
    else:
        band = max((one.band for one in found if one.band), key=bands.unknown)
        said = (
            f"68 %: at a {unknown} in this range the COR asked for is likely: it is in the range of the COR of "
            f"{bands.meaning(band)}{bands.left_out(band, model.pair)}."
        )
        print(*impacts.text(table, columns), "", *textwrap.wrap(said, bands.WIDTH), sep="\n")


def _unanswered(question: dict[str, float], one: Solutions, table: ImpactTable) -> dict[str, Any]:
    """Row of a question without an answer, which has a remark in its place; JSON has no inf."""
    sizes = {name: None if size == np.inf else size for name, size in question.items()}
    return {"restitution": one.restitution} | sizes | {"remark": one.remark} | table.asked


def _columns(unknown: str) -> tuple[Column, ...]:
    by_name = {column.name: column for column in COLUMNS}
    value, low, high = by_name[unknown], f"{unknown}_low", f"{unknown}_high"
    band = value._replace(name=low, title="68 %", to=high), Column(high, value.unit)
    return *(by_name[name] for name in ("restitution", *_KNOWN[unknown])), value, *band
