"""``contactlaw cor``: coefficient of restitution and more, of one impact or many."""

import argparse
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw._errors import ArgumentError
from contactlaw._readable import in_unit, scale_of
from contactlaw.answers.uncertainty import Uncertainty
from contactlaw.cli.cor import figures, files, tables
from contactlaw.cli.parts import bands, chosen, impacts, options, wording
from contactlaw.cli.parts.table import Table, flag_names, in_words, wrapped
from contactlaw.model import ImpactModel
from contactlaw.physical.validity import explain

_OF_BAND = "sphere_error", "plate_error", *tables.ERRORS, "causes"
_EXCLUDED = dict.fromkeys(tables.BANDLESS, _OF_BAND) | {"angle": (*_OF_BAND, "history")}
_NEEDED = {"angle": "friction", "friction": "angle", "samples": "history"}


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "coefficient of restitution and more, of one impact or many"
    command = options.command(commands, "cor", about, _run)
    command.usage = "%(prog)s --sphere NAME --plate NAME --radius R --thickness H\n  --speed V [options]"
    group = command.add_argument_group("impact")
    options.add_pair(group)
    options.add_sizes(group, quantities.values)
    options.add_speed(group, quantities.values, "approach speed: normal to the plate, or with --angle that of the bead")
    options.add_mass(group)
    what = "angle between path and normal of the plate [deg], below 90; with --friction (default: straight)"
    options.add_quantity(group, "--angle", quantities.ANGLE, what, quantities.values, metavar="A")
    what = "coefficient of friction between bead and plate; with --angle"
    options.add_quantity(group, "--friction", quantities.FRICTION, what, quantities.values, metavar="MU")
    options.add_law(group)
    group.add_argument("--solve", action="store_true", help="integrate the equation in place of using its table")
    options.add_wall(command.add_argument_group("walls"))
    group = command.add_argument_group("errors")
    options.add_errors(group, [name.removesuffix("_error") for name in tables.ERRORS])
    group.add_argument("--causes", action="store_true", help="say how much each error widens the 68 %% range")
    group.add_argument("--no-band", action="store_true", help="leave out the 68 %% range, which takes longest")
    group = command.add_argument_group("output")
    form = options.add_forms(group)
    form.add_argument(
        "--plot",
        metavar="FILE",
        help="draw the COR, with --angle the tangential restitution, into FILE (PNG, SVG, PDF). One list is the axis, "
        "a second one of at most 8 values makes the curves. Without a list the axis has the speeds up to --speed",
    )
    form.add_argument("--out", metavar="FILE", help="write all fields into FILE: .csv, or .h5 with the lists as axes")
    group.add_argument("--history", action="store_true", help="give the force over time of one impact, as CSV")
    group.add_argument("--samples", type=int, metavar="N", help="rows of --history (default: 256)")
    command.epilog = f"{options.UNITS} {options.LISTS}"


def _run(arguments: argparse.Namespace) -> None:
    _check(arguments)
    chosen.check_quantities(arguments)
    model = chosen.model(arguments)
    if arguments.plot is not None:
        with chosen.plot_file(arguments):
            figures.figure(arguments, model).save(arguments.plot)
    elif arguments.out is not None:
        with wording.writing("out", arguments.out):
            wording.check_suffix("out", arguments.out, files.SUFFIXES)
            table, _ = tables.table(arguments, model)
            axes = {"time": table.values["time"]} if arguments.history else tables.axes(arguments)
            files.save(table, axes, model.outside, arguments.out)
        print(f"{arguments.out}: {len(table)} rows", *wrapped(in_words(table.asked)), *table.remarks(), sep="\n")
    else:
        _print(arguments, model)


def _check(arguments: argparse.Namespace) -> None:
    """Refuse options that do not go together, and name the one to leave out or to add."""
    used = {name for name, value in vars(arguments).items() if value not in (None, False, 0.0, [])}
    for name, other in _NEEDED.items():
        if name in used and other not in used:
            raise ArgumentError(name, None, f"needs --{other}, too")
    for name, others in _EXCLUDED.items():
        for other in others:
            if {name, other} <= used:
                raise ArgumentError(other, None, f"does not go with --{name}: leave out one of them".replace("_", "-"))


def _print(arguments: argparse.Namespace, model: ImpactModel) -> None:
    table, known = tables.table(arguments, model)
    is_text = arguments.form == "text" and not arguments.history
    if is_text and len(table) == 1 and arguments.angle is None:
        print(*_fields(table, known), sep="\n")
    else:
        table.write(sys.stdout, arguments.form if is_text or arguments.form == "json" else "csv")
    if is_text and known:
        assumed = ImpactModel(bands.assumed(model.pair), law=arguments.law)
        first = known if assumed.pair == model.pair else tables.uncertainty(arguments, assumed, table)
        meaning = f"68 %: {bands.meaning(known.restitution, model.pair)}."
        print("", *wrapped(f"{meaning} {bands.measure_first(first.restitution, model.pair)}"), sep="\n")
        if arguments.causes:
            print("", *wrapped(bands.causes(known.restitution)), sep="\n")


def _fields(table: Table, known: Uncertainty | None) -> Iterator[str]:
    """Lines of one impact, field by field."""
    yield from wrapped(in_words(table.asked))
    for name, unit in impacts.UNITS.items():
        value, band = table.values[name].item(), getattr(known, name, None)
        shown = "none within the table" if name == "yield_speed" and value == np.inf else in_unit(value, unit).strip()
        if band and np.isfinite(band.low).all():
            scale = scale_of(value, unit)[1]
            low, high = (f"{np.ravel(end).item() / scale:.3g}" for end in (band.low, band.high))
            shown = f"{shown:20s}  68 %: {low} to {high}"
        yield f"{name:20s}  {shown}"
    flags = 0 if table.flags is None else int(table.flags.flat[0])
    lines = [", ".join(flag_names(flags)) or "none: inside every limit", *explain(flags)]
    for title, text in zip(["flags", *[""] * len(lines)], lines, strict=False):
        yield from wrapped(f"{title:20s}  {text}", " " * 22)
