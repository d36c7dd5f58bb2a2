"""``contactlaw fit`` (measure): strengths, sizes and more from measured rebounds, with their errors."""

import argparse
import json
from argparse import Namespace
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.cli.fit import printed
from contactlaw.cli.parts import chosen, measured, options, rebounds, wording
from contactlaw.cli.parts.figure import Figure
from contactlaw.cli.parts.options import reader_of
from contactlaw.cli.parts.table import for_json, in_words
from contactlaw.fitting import Fit, Measurements, fit
from contactlaw.fitting.measurements import KINDS
from contactlaw.fitting.unknowns import UNKNOWNS
from contactlaw.physical.arguments import unknown
from contactlaw.quantities import LENGTH
from contactlaw.record.file import read_record


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "strengths, sizes and more from measured rebounds, with their errors"
    command = options.command(commands, "fit", about, _run)
    add = command.add_argument
    add(
        "files",
        metavar="FILE",
        nargs="+",
        help="a table of rebounds or drops (CSV), an export of phyphox, or the record of a run (.h5, .npy), which "
        "may be in several files. Columns of a table, a row for each rebound: speed_m/s; at least one of COR, "
        "contact_time_us, peak_force_N, tangential_restitution, rotational_restitution, spin_rad/s; optionally "
        "radius_mm, thickness_mm and standard errors such as COR_error. The last three quantities need angle_deg "
        "from the normal, beside the speed of the bead, or sliding_speed_m/s, beside the normal speed. Or a row "
        "for each drop: drop_cm, with bounce_cm or with t1_ms, t2_ms, ..., the times between bounces. Lines of "
        "TOML behind # above the table may state materials, sizes and their errors",
    )
    what = "coefficient of friction of all rebounds at angles, unless it is an --unknown"
    options.add_quantity(command, "--friction", quantities.FRICTION, what, metavar="MU")
    what = f"quantity to find, or up to three, separated by commas: {', '.join(UNKNOWNS)}"
    add(
        "--unknown",
        required=True,
        action="extend",
        metavar="NAME",
        type=lambda text: tuple(map(_named, text.split(","))),
        help=what,
    )
    add(
        "--prior",
        action="append",
        default=[],
        metavar="NAME=ERROR",
        type=_prior,
        help="standard error of a stated value of one of these quantities, such as density=20kg/m3; may be "
        "repeated (default: stated values are exact)",
    )
    measured.add_options(command, {"json": "print the whole fit in SI units"})


def _named(text: str) -> str:
    name = text.strip().replace("-", "_")
    if name not in UNKNOWNS:
        raise argparse.ArgumentTypeError(unknown(name, UNKNOWNS))
    return name


def _prior(text: str) -> tuple[str, float]:
    """Read the name of a quantity and its standard error, in a unit of that quantity."""
    name, _, size = text.partition("=")
    if not size:
        raise argparse.ArgumentTypeError(f"got {text!r}, expected NAME=ERROR, such as density=20kg/m3")
    name = _named(name)
    kinds = {"Pa": quantities.STRESS, "kg/m3": quantities.DENSITY, "m": LENGTH, "": quantities.FRICTION}
    return name, reader_of(quantities.value, kinds[UNKNOWNS[name].unit])(size)


def _run(arguments: Namespace) -> None:
    chosen.take_drops(arguments)
    source = _source(arguments)
    pair, priors = source.pair, _errors(source) | dict(arguments.prior)
    bodies = {"sphere": pair.sphere.name, "plate": pair.plate.name, "law": arguments.law}
    with chosen.plot_file(arguments):
        found = fit(pair, source.rebounds, arguments.unknown, arguments.law, priors)
        if arguments.plot is not None:
            _figure(found, in_words(bodies)).save(arguments.plot)
        if arguments.form == "json":
            sizes = {"radius_m": arguments.radius, "thickness_m": for_json(arguments.thickness)}
            numbers = bodies | sizes | printed.record(found)
            print(json.dumps(numbers, indent=2, default=np.ndarray.tolist))
        else:
            print(in_words(bodies), *printed.text(found), "", sep="\n")
            print("Measured minus fitted values, in % of the fitted ones:", *printed.rows(found).text(), sep="\n")


def _figure(found: Fit, about: str) -> Figure:
    """Figure of the quantity with the most values."""
    kind = max(found.rows, key=lambda name: found.rows[name].size)
    rows, shift = found.rows[kind], KINDS[kind].shift

    def predicted(impact: dict[str, Any]) -> tuple[Any, Array, Array, Array]:
        speed, angle = impact["speed"], np.radians(impact.get("angle", 0.0))
        along = {"sliding_speed": speed * np.sin(angle)} if "angle" in impact else {}
        hit, errors = found.curve(speed * np.cos(angle), impact["radius"], impact["thickness"], **along)
        value = np.asarray(getattr(hit, kind)) + shift
        return hit, value, value - errors[kind], value + errors[kind]

    sizes = {name: size[rows] for name, size in printed.impacts_of(found).items()}
    error: Any = getattr(found.data, f"{kind}_error")
    values = np.asarray(getattr(found.data, kind))[rows] + shift, None if error is None else error[rows]
    title = f"Fit: {', '.join(printed.values_in_words(found))}".replace("+-", "±")
    return measured.figure_of(
        kind, sizes, *values, found.flags[rows], predicted, title, about, "Band: one standard error of the fit"
    )


def _source(arguments: Namespace) -> rebounds.Source:
    """Read what was measured, and the pair that goes with it."""
    return _recorded(arguments) if chosen.is_record(arguments.files) else chosen.of_file(arguments, arguments.files[0])


def _errors(source: rebounds.Source) -> dict[str, float]:
    """Turn the relative errors of a head into standard errors of the sizes [m]."""
    if "speed_error" in source.errors:
        wording.print_warning("speed_error: a fit takes speeds as exact; compare knows their error")
    errors = {}
    for name in ("radius", "thickness"):
        share, size = source.errors.get(f"{name}_error"), getattr(source.rebounds, name)
        if share and size is not None and np.isfinite(size).all():
            errors[name] = share * float(np.median(size))
    return errors


def _recorded(arguments: Namespace) -> rebounds.Source:
    """Impacts on walls of the record of a run; one of several pairs has to be named."""
    record, first = read_record(*arguments.files), arguments.files[0]
    for name in ("radius", "thickness", "time_error"):
        if getattr(arguments, name) is not None:
            raise ArgumentError(name, None, "a record does not need it: leave this one out")
    on_walls = record.which[record.impact & (record.rows["plate"] >= 0)]
    pairs = {n: record.bodies[n].pair for n in np.unique(on_walls).tolist() if n >= 0}
    some, names = chosen.of_record(arguments, pairs)
    if len(some) > 1:
        raise ValueError(f"{first}: has impacts of several pairs, {names}: choose one by --sphere and --plate")
    if len(pairs) > 1:
        record.rows["plate"][record.which != some[0]] = -1  # left in their places, since rows are named
    with wording.reading(first):
        data = Measurements.of(record, {*arguments.unknown} - {*dict(arguments.prior)})
    return rebounds.Source("", "", chosen.pair(arguments, pairs[some[0]] if some else None), data, {})
