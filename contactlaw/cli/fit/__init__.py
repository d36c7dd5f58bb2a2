"""``contactlaw fit`` (measure): strengths, sizes and more from measured rebounds, with their errors."""

import argparse
import json
import math
from collections.abc import Collection
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw._errors import ArgumentError
from contactlaw.cli.fit import figure, printed
from contactlaw.cli.parts import chosen, measured, options, own, rebounds, wording
from contactlaw.cli.parts.options import reader_of
from contactlaw.cli.parts.table import in_words
from contactlaw.fitting import Measurements, fit
from contactlaw.fitting.unknowns import UNKNOWNS
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.quantities import LENGTH
from contactlaw.record.file import HDF5, read_record

_RECORDS = (*HDF5, ".npy")


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "strengths, sizes and more from measured rebounds, with their errors"
    command = options.command(commands, "fit", about, _run)
    add = command.add_argument
    add(
        "files",
        metavar="FILE",
        nargs="*",
        help="a table of rebounds or drops (CSV), an export of phyphox, or the record of a run (.h5, .npy), which "
        "may be in several files. Columns of a table, a row for each rebound: speed_m/s; at least one of COR, "
        "contact_time_us, peak_force_N, tangential_restitution, rotational_restitution, spin_rad/s; optionally "
        "radius_mm, thickness_mm and standard errors such as COR_error. The last three quantities need angle_deg "
        "from the normal, beside the speed of the bead, or sliding_speed_m/s, beside the normal speed. Or a row "
        "for each drop: drop_cm, with bounce_cm or with t1_ms, t2_ms, ..., the times between bounces. Lines of "
        "TOML behind # above the table may state materials, sizes and their errors (default: --drop and --bounce)",
    )
    options.add_drop(command, quantities.values, "of a bead, or of all in FILE")
    what = "height of the bounce of each drop [m], without FILE"
    options.add_quantity(command, "--bounce", quantities.HEIGHT, what, quantities.values, metavar="Z")
    what = "coefficient of friction of all rebounds at angles, unless it is an --unknown"
    options.add_quantity(command, "--friction", quantities.FRICTION, what, metavar="MU")
    what = f"quantity to find, or up to three: {', '.join(UNKNOWNS)}"
    add("--unknown", required=True, metavar="NAME", type=_unknowns, help=what)
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


def _unknowns(text: str) -> tuple[str, ...]:
    return tuple(map(_named, text.split(",")))


def _named(text: str) -> str:
    name = text.strip().replace("-", "_")
    if name not in UNKNOWNS:
        raise argparse.ArgumentTypeError(own.unknown(name, UNKNOWNS))
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
    data, pair, priors = _data(arguments)
    bodies = {"sphere": pair.sphere.name, "plate": pair.plate.name, "law": arguments.law}
    with nullcontext() if arguments.plot is None else chosen.plot_file(arguments):
        found = fit(pair, data, arguments.unknown, arguments.law, priors)
        if arguments.plot is not None:
            figure.figure(found, in_words(bodies)).save(arguments.plot)
        if arguments.json:
            sizes = {f"{name}_m": getattr(arguments, name) for name in ("radius", "thickness")}
            stated = {name: None if size == math.inf else size for name, size in sizes.items() if size is not None}
            print(json.dumps(bodies | stated | printed.record(found), indent=2, default=np.ndarray.tolist))
        else:
            print(in_words(bodies), *printed.text(found), "", sep="\n")
            print("Measured minus fitted values, in % of the fitted ones:", *printed.rows(found).text(), sep="\n")


def _data(arguments: argparse.Namespace) -> tuple[Measurements, Pair, dict[str, float]]:
    """Read what was measured, and the pair and the priors that go with it."""
    files, priors = arguments.files, dict(arguments.prior)
    if bool(files) == (arguments.bounce is not None):
        raise ArgumentError("drop, bounce", None, "give these without FILE, or FILE")
    if not files:
        pair = chosen.pair(arguments)
        names = "radius", "thickness", "friction", "drop", "bounce"
        sizes = {name: getattr(arguments, name) for name in names if getattr(arguments, name) is not None}
        line = np.arange(1, len(arguments.bounce) + 1)
        return Measurements.of(sizes | {"line": line}, density=pair.sphere.density), pair, priors
    if Path(files[0]).suffix.lower() in _RECORDS:
        data, known = _recorded(arguments, {*arguments.unknown} - {*priors})
        return data, chosen.pair(arguments, known), priors
    if len(files) > 1:
        what = f"only the files of one record ({', '.join(_RECORDS)}) are put together"
        raise ValueError(f"{files[1]}: {what}: give one table, with all rows")
    data, pair, head = chosen.of_file(arguments, files[0])
    return data, pair, _errors(head, data) | priors


def _errors(head: rebounds.Conditions, data: Measurements) -> dict[str, float]:
    """Turn the relative errors of a head into standard errors of the sizes [m]."""
    errors = {}
    for name, share in head.errors.items():
        size = getattr(data, name.removesuffix("_error"))
        if name == "speed_error":
            wording.print_warning("speed_error: a fit takes speeds as exact; compare knows their error")
        elif share and size is not None and np.isfinite(size).all():
            errors[name.removesuffix("_error")] = share * float(np.median(size))
    return errors


def _recorded(arguments: argparse.Namespace, unknown: Collection[str]) -> tuple[Measurements, Pair | None]:
    """Impacts on walls of the record of a run, and their pair; one of several has to be named."""
    record, first = read_record(*arguments.files), arguments.files[0]
    if arguments.drop is not None:
        raise ArgumentError("drop", None, "the record has its own speeds: leave this one out")
    on_walls = record.which[record.impact & (record.rows["plate"] >= 0)]
    pairs = {n: record.bodies[n].pair for n in np.unique(on_walls).tolist() if n >= 0}
    if len(pairs) > 1:
        wanted = arguments.sphere, arguments.plate
        named = [n for n, pair in pairs.items() if all(map(_is_of, wanted, (pair.sphere, pair.plate)))]
        if len(named) != 1:
            names = ", ".join(f"{pair.sphere.name} on {pair.plate.name}" for pair in pairs.values())
            raise ValueError(f"{first}: has impacts of several pairs, {names}: choose one by --sphere and --plate")
        pairs = {0: pairs[named[0]]}
        record.rows["plate"][record.which != named[0]] = -1  # left in their places, since rows are named
    with wording.reading(first):
        data = Measurements.of(record, unknown)
    for size in ("radius", "thickness"):
        if (value := getattr(arguments, size)) is not None:
            if getattr(data, size) is not None:
                raise ArgumentError(size, None, "the record has its own: leave this one out")
            data = replace(data, **{size: value})
    return data, next(iter(pairs.values()), None)


def _is_of(name: str | None, body: Material) -> bool:
    return name in (None, body.name)
