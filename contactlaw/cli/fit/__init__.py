"""``contactlaw fit``: strengths, sizes and more from measured rebounds, with their errors."""

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
from contactlaw.cli.parts import chosen, options, rebounds, wording
from contactlaw.cli.parts.impacts import in_words
from contactlaw.cli.parts.options import reader_of
from contactlaw.fitting import Measurements, fit
from contactlaw.fitting.unknowns import UNKNOWNS
from contactlaw.physical.pair import Pair
from contactlaw.quantities import LENGTH
from contactlaw.record.file import HDF5, read_record


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "strengths, sizes and more from measured rebounds, with their errors"
    command = options.command(commands, "fit", about, _run)
    add = command.add_argument
    add(
        "data",
        metavar="FILE",
        nargs="?",
        help="record of a run (.h5), or CSV with a row per rebound. Columns: speed_m/s; at least one "
        "of COR, contact_time_us, peak_force_N, tangential_restitution, rotational_restitution, "
        "spin_rad/s; optionally radius_mm, thickness_mm and standard errors, as COR_error. The last "
        "three measurements need angle_deg from the normal too (the speed is then that of the "
        "bead), or sliding_speed_m/s (the speed is then the normal one). Or a row per drop: drop_cm, "
        "with bounce_cm or the times between its bounces, t1_ms, t2_ms, ..., or what phyphox exports of it. Its head "
        "may have materials, sizes and their errors, as lines of TOML behind # (default: --drop and --bounce)",
    )
    options.add_drop(command, quantities.values, "of a bead, or of all in FILE")
    what = "height of the bounce of each drop [m], or with a unit, without FILE"
    options.add_quantity(command, "--bounce", quantities.HEIGHT, what, quantities.values, metavar="Z")
    options.add_pair(command, " (default: that of FILE)")
    options.add_radius(command, "all beads", quantities.value)
    what = "thickness of all plates [m], or with a unit; inf: a half-space"
    options.add_quantity(command, "--thickness", LENGTH, what, metavar="H")
    what = "coefficient of friction of all rebounds at angles, unless it is an --unknown"
    options.add_quantity(command, "--friction", quantities.FRICTION, what, metavar="MU")
    add(
        "--unknown",
        required=True,
        metavar="NAME",
        type=_names,
        help=f"what to find, up to three: {', '.join(UNKNOWNS)}",
    )
    add(
        "--prior",
        action="append",
        default=[],
        metavar="NAME=ERROR",
        type=_prior,
        help="standard error of one of these quantities that is given, as density=20kg/m3; may be "
        "repeated (default: known quantities are exact)",
    )
    options.add_name_of_law(command)
    add = command.add_mutually_exclusive_group().add_argument
    add("--json", action="store_true", help="print the whole fit in SI units")
    add("--plot", metavar="FILE", help="draw data, fit, its band and residuals into FILE (PNG, SVG, PDF)")
    command.epilog = options.UNITS


def _names(text: str) -> tuple[str, ...]:
    return tuple(name.strip().replace("-", "_") for name in text.split(","))


def _prior(text: str) -> tuple[str, float]:
    """Read the name of a quantity and its standard error, in a unit of that quantity."""
    name, _, size = text.partition("=")
    name = name.strip().replace("-", "_")
    if name not in UNKNOWNS or not size:
        raise argparse.ArgumentTypeError(f"got {text!r}, expected NAME=ERROR with a NAME of {', '.join(UNKNOWNS)}")
    kinds = {"Pa": quantities.STRESS, "kg/m3": quantities.DENSITY, "m": LENGTH, "": quantities.FRICTION}
    error: float = reader_of(quantities.value, kinds[UNKNOWNS[name].unit])(size)
    return name, error


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    priors = dict(arguments.prior)
    if (arguments.data is None) == (arguments.bounce is None):
        raise ArgumentError("drop, bounce", None, "give these without FILE, or FILE")
    if arguments.data is None:
        pair = chosen.pair(arguments)
        names = "radius", "thickness", "friction", "drop", "bounce"
        noted = {name: size for name, size in vars(arguments).items() if name in names and size is not None}
        noted["line"] = np.arange(1, len(arguments.bounce) + 1)
        data = Measurements.of(noted, density=pair.sphere.density)
    elif Path(arguments.data).suffix.lower() in (*HDF5, ".npy"):
        data, known = _recorded(arguments, {*arguments.unknown} - {*priors})
        pair = chosen.pair(arguments, known)
    else:
        data, pair, head = chosen.of_file(arguments, arguments.data)
        priors = _errors(head, data) | priors
    asked: dict[str, Any] = {"sphere": pair.sphere.name, "plate": pair.plate.name, "law": arguments.law}
    for name in ("radius", "thickness"):
        if (size := getattr(arguments, name)) is not None:
            asked[f"{name}_m"] = size
    with nullcontext() if arguments.plot is None else chosen.plot_file(arguments):
        found = fit(pair, data, arguments.unknown, arguments.law, priors)
        if arguments.plot is not None:
            title = f"{pair.sphere.name} on {pair.plate.name}, law {arguments.law}"
            figure.save_fit(found, title, arguments.plot)
        if arguments.json:
            numbers = {name: None if size == math.inf else size for name, size in asked.items()}
            print(json.dumps(numbers | printed.record(found), indent=2))
        else:
            print(in_words(asked), *printed.text(found), "", sep="\n")
            print(*printed.rows(found), sep="\n")


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
    record = read_record(arguments.data)
    if arguments.drop is not None:
        raise ArgumentError("drop", None, "the record has its own speeds: leave this one out")
    on_walls = record.which[record.impact & (record.rows["plate"] >= 0)]
    pairs = {n: record.bodies[n].pair for n in np.unique(on_walls).tolist() if n >= 0}
    if len(pairs) > 1:
        given = {role: getattr(arguments, role) for role in ("sphere", "plate")}
        named = [
            n
            for n, pair in pairs.items()
            if all(name in (None, getattr(pair, role).name) for role, name in given.items())
        ]
        if len(named) != 1:
            names = ", ".join(f"{one.sphere.name} on {one.plate.name}" for one in pairs.values())
            reason = f"has impacts of several pairs, {names}: choose one by --sphere and --plate"
            raise ValueError(f"{arguments.data}: {reason}")
        rows, pairs = record.rows.copy(), {0: pairs[named[0]]}
        rows["plate"][record.which != named[0]] = -1  # left in their places, since rows are named
        record = replace(record, rows=rows)
    with wording.reading(arguments.data):
        data = Measurements.of(record, unknown)
    for size in ("radius", "thickness"):
        if (value := getattr(arguments, size)) is not None:
            if getattr(data, size) is not None:
                raise ArgumentError(size, None, "the record has its own: leave this one out")
            data = replace(data, **{size: value})
    return data, next(iter(pairs.values()), None)
