"""``contactlaw cor`` (ask): coefficient of restitution and more, of one impact or many."""

import itertools
import sys
from argparse import Namespace
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._readable import in_unit
from contactlaw.cli.cor import figures, files, tables
from contactlaw.cli.parts import bands, chosen, impacts, options, wording
from contactlaw.cli.parts.table import Table, flag_names, in_words
from contactlaw.model import ImpactModel
from contactlaw.parser import wrapped
from contactlaw.physical.validity import Validity, explain

_OF_BAND = "sphere_error", "plate_error", *tables.ERRORS, "causes"
_BANDLESS = "no_band", "angle", "history", "cylinder", "bowl", "foundation"  # options without a band
_EXCLUDED = [*itertools.product(_BANDLESS, _OF_BAND), ("angle", "history")]
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
    what = "mass of the bead if it is hollow, coated or a clump [kg] (default: that of a solid sphere)"
    options.add_quantity(group, "--mass", quantities.MASS, what, metavar="M")
    what = "angle between path and normal of the plate [deg], below 90; with --friction (default: straight)"
    options.add_quantity(group, "--angle", quantities.ANGLE, what, quantities.values, metavar="A")
    what = "coefficient of friction between bead and plate; with --angle"
    options.add_quantity(group, "--friction", quantities.FRICTION, what, quantities.values, metavar="MU")
    options.add_law(group)
    group.add_argument("--solve", action="store_true", help="integrate the equation in place of using its table")
    options.add_wall(command.add_argument_group("walls"))
    group = command.add_argument_group("errors")
    options.add_errors(group, [name.removesuffix("_error") for name in tables.ERRORS])
    group.add_argument(
        "--causes", action="store_true", help="say how much each error widens the 68 %% range (rms of several impacts)"
    )
    group.add_argument("--no-band", action="store_true", help="leave out the 68 %% range, which takes longest")
    group = command.add_argument_group("output")
    form = options.add_forms(group)
    form.add_argument(
        "--plot",
        metavar="FILE",
        help="draw the COR, with --angle the tangential restitution, into FILE (PNG, SVG, PDF). One list is the axis, "
        "a second one of at most 8 values makes the curves. Without a list the axis has the speeds up to --speed",
    )
    form.add_argument(
        "--out",
        metavar="FILE",
        help="write all fields into FILE: .csv, or without --angle and --history .h5, in which the lists are axes",
    )
    group.add_argument("--history", action="store_true", help="give the force over time of one impact, as CSV")
    group.add_argument("--samples", type=int, metavar="N", help="rows of --history (default: 256)")
    command.epilog = f"{options.UNITS} {options.LISTS}"


def _run(arguments: Namespace) -> None:
    _check(arguments)
    chosen.take_drops(arguments)
    model = chosen.model(arguments)
    if arguments.plot is not None:
        with chosen.plot_file(arguments):
            figures.figure(arguments, model).save(arguments.plot)
    elif arguments.out is not None:
        with wording.writing("out", arguments.out):
            is_grid = arguments.angle is None and not arguments.history
            wording.check_suffix("out", arguments.out, (".csv", ".h5", ".hdf5") if is_grid else (".csv",))
            table, _ = tables.table(arguments, model)
            files.save(table, tables.axes(arguments), model.outside, arguments.out)
        print(f"{arguments.out}: {len(table)} rows", *wrapped(in_words(table.asked)), *table.remarks(), sep="\n")
    else:
        _print(arguments, model)


def _check(arguments: Namespace) -> None:
    """Refuse options that do not go together, and leave out the band where some do not have one."""
    used = {name for name, value in vars(arguments).items() if value not in (None, False, 0.0, [])}
    for name, other in _NEEDED.items():
        if name in used and other not in used:
            raise ArgumentError(name, None, f"needs --{other}, too")
    for name, other in _EXCLUDED:
        if {name, other} <= used:
            raise ArgumentError(other, None, f"does not go with --{name}: leave out one of them".replace("_", "-"))
    arguments.no_band = not used.isdisjoint(_BANDLESS)


def _print(arguments: Namespace, model: ImpactModel) -> None:
    table, known = tables.table(arguments, model)
    form = "csv" if arguments.history and arguments.form == "text" else arguments.form
    if form == "text" and len(table) == 1 and arguments.angle is None:
        print(*_fields(table, _yield_speed(arguments, model, table.values)), sep="\n")
    else:
        table.write(sys.stdout, form)
    if form == "text" and known and not np.all(table.values["flags"] & Validity.CLAMPED):
        assumed = ImpactModel(bands.assumed(model.pair), law=arguments.law)
        first = known if assumed.pair == model.pair else tables.uncertainty(arguments, assumed, table.values)
        meaning = f"68 %: {bands.meaning(known.restitution, model.pair)}."
        print("", *wrapped(f"{meaning} {bands.measure_first(first.restitution, model.pair)}"), sep="\n")
        if arguments.causes:
            print("", *wrapped(bands.causes(known.restitution)), sep="\n")


def _fields(table: Table, yield_speed: str) -> Iterator[str]:
    """Lines of one impact, field by field."""
    yield from wrapped(in_words(table.asked))
    for column in impacts.COLUMNS:
        shown = in_unit(table.values[column.name].item(), column.unit).strip()
        names = f"{column.name}_low", f"{column.name}_high"
        ends = [table.values[name].item() for name in names if name in table.values]
        if np.isfinite(ends).any():
            low, high = (in_unit(end, column.unit, 3).strip() for end in ends)
            shown = f"{shown:20s}  68 %: {low} to {high}"
        yield f"{column.name:20s}  {shown}"
    yield f"{'yield_speed':20s}  {yield_speed}"
    flags = table.values["flags"].item()
    yield f"{'flags':20s}  {', '.join(flag_names(flags)) or 'none: inside every limit'}"
    for words in explain(flags):
        yield from wrapped(f"{'':20s}  {words}", " " * 22)


def _yield_speed(arguments: Namespace, model: ImpactModel, sizes: Mapping[str, Array]) -> str:
    """Write the speed of the first yield, which has no answer for some walls and outside the table."""
    try:
        speed = tables.answer(lambda speed, **rest: model.yield_speed(**rest), arguments, model, sizes)
    except ValueError:
        return "not known"
    return in_unit(speed.item(), "m/s")
