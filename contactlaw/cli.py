"""Command line: ``contactlaw cor | history | materials | table``."""

from __future__ import annotations

import argparse
import json
import math
import os
import secrets
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from contactlaw import laws, plots, table
from contactlaw.model import ImpactModel
from contactlaw.physical.materials import material, materials
from contactlaw.physical.pair import Pair
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.validity import Validity, explain
from contactlaw.table import cache, file

_UNITS = {
    "contact_time": "s",
    "peak_force": "N",
    "peak_compression": "m",
    "residual_compression": "m",
}
_DONE, _REFUSED, _INTERRUPTED = 0, 1, 130  # argparse itself exits with 2 on wrong usage


def _model(arguments: argparse.Namespace) -> ImpactModel:
    pair = Pair(arguments.sphere, arguments.plate)
    return ImpactModel(pair, law=arguments.law, outside=arguments.outside)


def _cor(arguments: argparse.Namespace) -> None:
    model = _model(arguments)
    impact = (arguments.speed, arguments.radius, arguments.thickness)
    rebound = model.solve(*impact) if arguments.solve else model.lookup(*impact)
    try:
        yield_speed = float(model.yield_speed(arguments.radius, arguments.thickness))
    except ValueError:  # so thin a plate that V_Y is beyond the table; the impact need not be
        yield_speed = math.inf
    if arguments.json:
        print(json.dumps(_as_json(rebound, yield_speed), indent=2))
        return
    for name, value in asdict(rebound).items():
        if name != "flags":
            print(f"{name:21s} {value:.6g} {_UNITS.get(name, '')}".rstrip())
    beyond = "none within the table" if yield_speed == math.inf else f"{yield_speed:.6g} m/s"
    print(f"{'yield_speed':21s} {beyond}")
    print(f"{'flags':21s} {', '.join(_flag_names(rebound)) or 'none: inside every limit'}")
    for words in explain(int(rebound.flags)):
        print(f"{'':21s} {words}")


def _flag_names(rebound: Rebound) -> list[str]:
    return [str(flag.name) for flag in Validity(int(rebound.flags))]


def _as_json(rebound: Rebound, yield_speed: float) -> dict[str, object]:
    """Field names carry no unit: all values are SI. No yield speed is null."""
    values: dict[str, object] = asdict(rebound)
    values["yield_speed"] = yield_speed if yield_speed < math.inf else None
    values["flags"] = _flag_names(rebound)
    return values


def _history(arguments: argparse.Namespace) -> None:
    contact = _model(arguments).force_history(
        arguments.speed,
        arguments.radius,
        arguments.thickness,
        samples=arguments.samples,
        method="solve" if arguments.solve else "table",
    )
    if arguments.plot is not None:
        title = (
            f"{arguments.sphere} on {arguments.plate}: radius {arguments.radius * 1e3:g} mm, "
            f"plate {arguments.thickness * 1e3:g} mm, {arguments.speed:g} m/s"
        )
        plots.save_history(contact, title, arguments.plot)
        print(arguments.plot)
        return
    print("time_s,force_N,compression_m,impulse_Ns,plate_displacement_m")
    np.savetxt(sys.stdout, np.column_stack(contact), fmt="%.9g", delimiter=",")


def _materials(arguments: argparse.Namespace) -> None:
    entries = [material(name) for name in ([arguments.name] if arguments.name else materials())]
    if arguments.json:
        print(json.dumps([asdict(entry) for entry in entries], indent=2))
        return
    print(
        f"{'name':24s} {'E [GPa]':>9s} {'nu [-]':>7s} {'rho [kg/m3]':>12s} {'sigma_Y [MPa]':>14s}"
    )
    for entry in entries:
        strength = "-" if entry.yield_strength is None else f"{entry.yield_strength / 1e6:.1f}"
        print(
            f"{entry.name:24s} {entry.youngs_modulus / 1e9:9.3f} {entry.poissons_ratio:7.3f} "
            f"{entry.density:12.0f} {strength:>14s}"
        )
    if arguments.name:
        print(entries[0].source)


def _table_build(arguments: argparse.Namespace) -> None:
    out = Path(arguments.out or f"{arguments.law}.h5")
    if not out.parent.is_dir():
        raise ValueError(f"--out: there is no folder {out.parent}")
    law = laws.law(arguments.law)
    built = table.build(law, progress=cache.progress_bar)
    built = table.with_shapes(built, points=10_000, progress=cache.progress_bar)
    file.write(built, out)
    _print_certificate(built.certificate, table.bounds(law))
    print(out)


def _stored(arguments: argparse.Namespace) -> table.Table:
    if arguments.file:
        return file.read(arguments.file)
    law = laws.law(arguments.law)
    return file.packaged(law) or cache.cached_shapes(cache.cached(law))


def _table_info(arguments: argparse.Namespace) -> None:
    found = _stored(arguments)
    print(f"law {found.law.name}: {found.law.source}")
    lam, chi = found.settings.largest_inelasticity, found.settings.largest_overload
    print(f"inelasticity 0 to {lam:g}, overload to {chi:g}, {found.fields['restitution'].shape}")
    for name, value in asdict(found.settings).items():
        print(f"  {name:22s} {value:g}")
    _print_certificate(found.certificate, table.bounds(found.law))


def _table_check(arguments: argparse.Namespace) -> None:
    seed = secrets.randbits(32) if arguments.seed is None else arguments.seed
    stored, bar = _stored(arguments), cache.progress_bar
    certificate = table.certify(stored, arguments.points, seed, progress=bar)
    limits = table.bounds(stored.law)
    _print_certificate(certificate, limits)
    exceeded = certificate.exceeded(limits)
    if exceeded:
        raise ValueError(f"the table exceeds its bounds: {exceeded} (seed {seed})")


def _print_certificate(certificate: table.Certificate | None, limits: dict[str, float]) -> None:
    if certificate is None:
        print("no certificate")
        return
    print(f"errors at {certificate.points} random points, seed {certificate.seed}:")
    print(f"  {'field':22s} {'median':>9s} {'99 %':>9s} {'largest':>9s} {'bound':>9s}")
    for name in certificate.largest:
        bound = limits[name]
        values = (certificate.median, certificate.percentile_99, certificate.largest)
        figures = " ".join(f"{value[name]:9.1e}" for value in values)
        print(f"  {name:22s} {figures} {bound:9.0e}")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="contactlaw",
        description="Restitution of a bead that hits a thin plate. All quantities in SI units.",
    )
    commands = parser.add_subparsers(required=True, metavar="command")

    cor = commands.add_parser("cor", help="one impact: coefficient of restitution and more")
    cor.set_defaults(run=_cor)
    history = commands.add_parser("history", help="one impact: force over time, as CSV or a plot")
    history.set_defaults(run=_history)
    for impact in (cor, history):
        add = impact.add_argument
        add("--sphere", required=True, help="material of the bead, from the catalogue")
        add("--plate", required=True, help="material of the plate")
        add("--radius", required=True, type=float, help="radius of the bead [m]")
        add("--thickness", required=True, type=float, help="of the plate [m]; inf: bulk")
        add("--speed", required=True, type=float, help="normal approach speed [m/s]")
        add("--law", default=laws.DEFAULT, help=f"one of {', '.join(laws.names())}")
        add("--outside", default="raise", choices=["raise", "solve", "clamp"])
        add("--solve", action="store_true", help="integrate instead of looking up")
    cor.add_argument("--json", action="store_true", help="machine-readable output")
    history.add_argument("--samples", type=int, default=256, help="number of times")
    history.add_argument("--plot", metavar="FILE", help="draw into FILE (PNG, SVG, PDF)")

    listing = commands.add_parser("materials", help="the catalogue, with the source of each number")
    listing.set_defaults(run=_materials)
    listing.add_argument("name", nargs="?", help="one material, with its sources")
    listing.add_argument("--json", action="store_true", help="machine-readable output")

    tables = commands.add_parser("table", help="lookup tables: build, info, check").add_subparsers(
        required=True, metavar="action"
    )
    for name, run, purpose in (
        ("info", _table_info, "extent, settings and certificate of a table"),
        ("check", _table_check, "certify a table at fresh random points; fail above the bounds"),
    ):
        action = tables.add_parser(name, help=purpose)
        action.set_defaults(run=run)
        action.add_argument("file", nargs="?", help="a table (default: the one in use for LAW)")
        action.add_argument("--law", default="myc")
    action.add_argument("--points", type=int, default=10_000)
    action.add_argument("--seed", type=int, help="of the points (default: a fresh one)")
    build = tables.add_parser("build", help="solve the equation at every node of a table")
    build.set_defaults(run=_table_build)
    build.add_argument("--law", default="myc")
    build.add_argument("--out", help="file to write (default: LAW.h5)")
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line.

    Returns
    -------
    int
        0 done, 1 refused with a message on stderr, 130 interrupted; wrong usage exits with 2.

    Examples
    --------
    >>> main(["cor", "--sphere", "glass", "--plate", "glass", "--radius", "1e-3",
    ...       "--thickness", "1e-3", "--speed", "1", "--law", "hertz", "--json"])
    ... # doctest: +ELLIPSIS
    {
      "restitution": 0.7...
    """
    arguments = _parser().parse_args(argv)
    try:
        arguments.run(arguments)
        sys.stdout.flush()  # here, where a reader that has gone can be dealt with
    except KeyboardInterrupt:
        print("contactlaw: interrupted", file=sys.stderr)
        return _INTERRUPTED
    except BrokenPipeError:  # the reader has seen enough, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return _DONE
    except (ValueError, RuntimeError, OSError, ImportError) as error:
        print(f"contactlaw: {error}", file=sys.stderr)
        return _REFUSED
    return _DONE
