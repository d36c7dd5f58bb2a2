"""``contactlaw cor``: coefficient of restitution and more, of one impact or many."""

import argparse
import functools
import sys
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._readable import in_unit, scale_of
from contactlaw.answers.uncertainty import Uncertainty
from contactlaw.cli.cor import figures, files, history, oblique
from contactlaw.cli.parts import bands, chosen, impacts, options, wording
from contactlaw.cli.parts.table import Table, flag_names, in_words, wrapped
from contactlaw.model import ImpactModel
from contactlaw.physical.validity import explain

_SIZES = "speed", "radius", "thickness"
_ERRORS = "sphere_error", "plate_error", *(f"{name}_error" for name in _SIZES), "causes"
_SWINGS = "cylinder", "bowl", "foundation"


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "coefficient of restitution and more, of one impact or many"
    command = options.command(commands, "cor", about, _run)
    command.usage = "%(prog)s --sphere NAME --plate NAME --radius R --thickness H --speed V [options]"
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
    options.add_errors(group, _SIZES)
    group.add_argument("--causes", action="store_true", help="say which errors make the 68 %% range how wide")
    group.add_argument("--no-band", action="store_true", help="leave out the 68 %% range, which takes longest")
    group = command.add_argument_group("output")
    add = group.add_mutually_exclusive_group().add_argument
    add("--csv", action="store_true", help="print all fields as CSV, in SI units with every digit")
    add("--json", action="store_true", help="print all fields as JSON, in SI units; inf is null")
    add(
        "--plot",
        metavar="FILE",
        help="draw the COR, with --angle the tangential restitution, into FILE (PNG, SVG, PDF). One list is the axis, "
        "a second one of at most 8 values makes the curves. Without a list the axis has the speeds up to --speed",
    )
    add("--out", metavar="FILE", help="write all fields into FILE: .csv, or .h5 with the lists as axes")
    group.add_argument("--history", action="store_true", help="print the force over time of one impact as CSV")
    group.add_argument("--samples", type=int, metavar="N", help="rows of --history (default: 256)")
    command.epilog = f"{options.UNITS} {options.LISTS}"


def _run(arguments: argparse.Namespace) -> None:
    _check(arguments)
    chosen.check_quantities(arguments)
    if arguments.history:
        history.run(arguments)
    elif arguments.plot is not None:
        with chosen.plot_file(arguments):
            _plot(arguments)
    elif arguments.out is not None:
        with wording.writing("out", arguments.out):
            wording.check_suffix("out", arguments.out, files.SUFFIXES)
            model = chosen.model(arguments)
            table, _ = _table(arguments, model)
            files.save(table, model, _axes(arguments), arguments.out)
        print(f"{arguments.out}: {len(table)} impacts, {in_words(table.asked)}")
        print(*table.remarks(), sep="\n", end="")
    else:
        _print(arguments)


def _check(arguments: argparse.Namespace) -> None:
    """Refuse options that do not go together, with the one to leave out."""
    is_oblique = arguments.angle is not None or arguments.friction is not None
    for name, other in (("angle", "friction"), ("friction", "angle")):
        if is_oblique and getattr(arguments, name) is None:
            raise ArgumentError(other, None, f"needs --{name}, too, for impacts at an angle")
    refused = []
    if is_oblique:
        refused = [("--angle", (*_ERRORS, "history"))]
    if arguments.history:
        refused.append(("--history", (*_ERRORS, "json")))
    elif arguments.samples is not None:
        raise ArgumentError("samples", None, "leave it out, or add --history")
    if arguments.no_band:
        refused.append(("--no-band", _ERRORS[2:]))
    swings = next((name for name in _SWINGS if getattr(arguments, name) is not None), None)
    if swings:  # how errors change the answers of such walls is not known
        refused.append((f"--{swings}", _ERRORS))
    for option, names in refused:
        for name in names:
            if getattr(arguments, name):
                raise ArgumentError(name, None, f"does not go with {option}: leave one of the two out")


def _errors(arguments: argparse.Namespace) -> dict[str, float] | None:
    """Errors of speed and sizes; None if there is to be no band."""
    swings = any(getattr(arguments, name) is not None for name in _SWINGS)
    if arguments.no_band or swings or arguments.angle is not None:
        return None
    return {f"{name}_error": getattr(arguments, f"{name}_error") for name in _SIZES}


def _table(arguments: argparse.Namespace, model: ImpactModel) -> tuple[Table, Uncertainty | None]:
    """All impacts, with their bands if these are wanted."""
    if arguments.angle is not None:
        table = oblique.tabulate(arguments, model)
    else:
        lists = arguments.speed, arguments.radius, arguments.thickness
        table = impacts.tabulate(model, *lists, arguments.solve, arguments.mass, _wall(arguments, model))
    plate = chosen.plate_in_words(arguments, model.pair.given[1].name)
    table.asked["plate"] = plate
    known = _uncertainty(arguments, model, table.values)
    return bands.with_bands(table, known), known


def _axes(arguments: argparse.Namespace) -> dict[str, Sequence[float]]:
    """Lay out the lists of the grid; the last one changes fastest."""
    if arguments.angle is not None:
        return oblique.axes(arguments)
    return {name: getattr(arguments, name) for name in ("radius", "thickness", "speed")}


def _wall(arguments: argparse.Namespace, model: ImpactModel) -> Callable[[Array], Any]:
    return functools.partial(chosen.wall, arguments, model.pair.given[1])


def _uncertainty(arguments: argparse.Namespace, model: ImpactModel, sizes: Any) -> Uncertainty | None:
    errors = _errors(arguments)
    if errors is None:
        return None
    speed, radius, thickness = (sizes[name] for name in _SIZES)
    with wording.naming_impact(speed, radius, thickness, mass=arguments.mass):
        wall = _wall(arguments, model)(thickness)
        return model.uncertainty(speed, radius, wall, **errors, mass=arguments.mass)


def _print(arguments: argparse.Namespace) -> None:
    model = chosen.model(arguments)
    table, known = _table(arguments, model)
    form = "csv" if arguments.csv else "json" if arguments.json else "text"
    is_single = len(table) == 1 and arguments.angle is None
    if form == "text" and is_single:
        print(*_fields(table, known), sep="\n")
    else:
        table.write(sys.stdout, form)
    if form == "text" and known:
        guess = ImpactModel(bands.assumed(model.pair), law=arguments.law)
        stated = known if guess.pair.given == model.pair.given else _uncertainty(arguments, guess, table.values)
        sentences = [f"68 %: {bands.meaning(known.restitution, model.pair)}."]
        sentences += [bands.measure_first(stated.restitution, model.pair)] if stated else []
        print("", *wrapped(" ".join(sentences)), sep="\n")
        if arguments.causes:
            units = {name: unit for name, unit in impacts.UNITS.items() if hasattr(known, name)}
            print("", *wrapped(bands.causes(known, units if is_single else {"restitution": ""})), sep="\n")


def _fields(table: Table, known: Uncertainty | None) -> Iterator[str]:
    """Lines of one impact, field by field."""
    yield from wrapped(in_words(table.asked))
    for name, unit in impacts.UNITS.items():
        value, band = table.values[name].item(), getattr(known, name, None)
        shown = "none within the table" if name == "yield_speed" and value == np.inf else in_unit(value, unit).strip()
        if band and np.isfinite([band.low, band.high]).any():
            scale = scale_of(value, unit)[1]
            low, high = (f"{np.ravel(end).item() / scale:.3g}" for end in (band.low, band.high))
            shown = f"{shown:20s}  68 %: {low} to {high}"
        yield f"{name:20s}  {shown}"
    flags = int(np.ravel(table.flags)[0])
    yield from wrapped(f"{'flags':20s}  {', '.join(flag_names(flags)) or 'none: inside every limit'}", " " * 22)
    for words in explain(flags):
        yield from wrapped(f"{'':22s}{words}", " " * 22)


def _plot(arguments: argparse.Namespace) -> None:
    model = chosen.model(arguments)
    plate = chosen.plate_in_words(arguments, model.pair.plate.name)
    about = f"{model.pair.sphere.name} on {plate}, law {arguments.law}"
    lists = dict(reversed(_axes(arguments).items()))
    if arguments.angle is not None:
        draw = functools.partial(oblique.curve, arguments, model)
        figures.save(arguments.plot, lists, draw, about, y="tangential_restitution")
        return
    remarks = list[str]()

    def curve(sizes: dict[str, Array]) -> dict[str, Any]:
        speed, radius, thickness = (sizes[name] for name in _SIZES)
        with wording.naming_impact(speed, radius, thickness, mass=arguments.mass):
            wall = _wall(arguments, model)(thickness)
            hit = (model.solve if arguments.solve else model.lookup)(speed, radius, wall, mass=arguments.mass)
        fields = {"y": hit.restitution, "flags": hit.flags, "overload": hit.overload}
        known = _uncertainty(arguments, model, sizes)
        if known is not None:
            band = known.restitution
            remarks[:] = [f"Shaded: {bands.meaning(band, model.pair)}"]
            ends = {"low": band.low, "high": band.high}
            fields |= {name: np.where(np.isfinite(end), end, hit.restitution) for name, end in ends.items()}
        return fields

    figures.save(arguments.plot, lists, curve, about, remarks)
