"""``contactlaw fit`` (measure): strengths, sizes and more from measured rebounds, with their errors."""

import argparse
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw._errors import ArgumentError
from contactlaw.cli.fit import figure, printed
from contactlaw.cli.parts import chosen, measured, options, rebounds, wording
from contactlaw.cli.parts.options import reader_of
from contactlaw.cli.parts.table import in_words
from contactlaw.fitting import Measurements, fit
from contactlaw.fitting.unknowns import UNKNOWNS
from contactlaw.physical.arguments import unknown
from contactlaw.quantities import LENGTH
from contactlaw.record.file import HDF5, read_record


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
    what = f"quantity to find, or up to three: {', '.join(UNKNOWNS)}"
    add("--unknown", required=True, metavar="NAME", type=lambda text: tuple(map(_named, text.split(","))), help=what)
    add(
        "--prior",
        action="append",
        default=[],
        metavar="NAME=ERROR",
        type=_prior,
        help="standard error of a stated value of one of these quantities, such as density=20kg/m3; may be "
        "repeated (default: stated values are exact)",
    )
    measured.add_options(command).add_argument("--json", action="store_true", help="print the whole fit in SI units")


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
    error: float = reader_of(quantities.value, kinds[UNKNOWNS[name].unit])(size)
    return name, error


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    source = _source(arguments)
    pair, priors = source.pair, _errors(source) | dict(arguments.prior)
    bodies = {"sphere": pair.sphere.name, "plate": pair.plate.name, "law": arguments.law}
    with chosen.plot_file(arguments):
        found = fit(pair, source.rebounds, arguments.unknown, arguments.law, priors)
        if arguments.plot is not None:
            figure.figure(found, in_words(bodies)).save(arguments.plot)
        if arguments.json:
            thickness = None if arguments.thickness == math.inf else arguments.thickness
            numbers = bodies | {"radius_m": arguments.radius, "thickness_m": thickness} | printed.record(found)
            print(json.dumps(numbers, indent=2, default=np.ndarray.tolist))
        else:
            print(in_words(bodies), *printed.text(found), "", sep="\n")
            print("Measured minus fitted values, in % of the fitted ones:", *printed.rows(found).text(), sep="\n")


def _source(arguments: argparse.Namespace) -> rebounds.Source:
    """Read what was measured, and the pair that goes with it."""
    first, *others = arguments.files
    if Path(first).suffix.lower() in (*HDF5, ".npy"):
        return _recorded(arguments)
    if others:
        raise ValueError(f"{others[0]}: only the files of one record are put together: give one table, with all rows")
    return chosen.of_file(arguments, first)


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


def _recorded(arguments: argparse.Namespace) -> rebounds.Source:
    """Impacts on walls of the record of a run; one of several pairs has to be named."""
    record, first = read_record(*arguments.files), arguments.files[0]
    for name in ("radius", "thickness"):
        if getattr(arguments, name) is not None:
            raise ArgumentError(name, None, "the record has its own: leave this one out")
    on_walls = record.which[record.impact & (record.rows["plate"] >= 0)]
    pairs = {n: record.bodies[n].pair for n in np.unique(on_walls).tolist() if n >= 0}
    if len(pairs) > 1:
        names = ", ".join(f"{pair.sphere.name} on {pair.plate.name}" for pair in pairs.values())
        for role in ("sphere", "plate"):
            if name := getattr(arguments, role):
                pairs = {n: pair for n, pair in pairs.items() if getattr(pair, role).name == name}
        if len(pairs) != 1:
            raise ValueError(f"{first}: has impacts of several pairs, {names}: choose one by --sphere and --plate")
        record.rows["plate"][record.which != min(pairs)] = -1  # left in their places, since rows are named
    with wording.reading(first):
        data = Measurements.of(record, {*arguments.unknown} - {*dict(arguments.prior)})
    return rebounds.Source("", "", chosen.pair(arguments, next(iter(pairs.values()), None)), data, {})
