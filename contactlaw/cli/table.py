"""``contactlaw table``: lookup tables, to build, describe and check."""

import argparse
import secrets
from dataclasses import asdict
from pathlib import Path
from typing import Any

from contactlaw import laws, table
from contactlaw._errors import ArgumentError
from contactlaw._jit import enable_caching
from contactlaw.cli.parts import chosen, options, wording
from contactlaw.physical.law import law_of
from contactlaw.physical.strengths import with_strengths
from contactlaw.table import cache, file


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    actions = options.group(commands, "table", "lookup tables: build, info, check", "ACTION", "what to do")
    info = options.command(actions, "info", "extent, settings and certified errors of a table", _info)
    about = "measure the errors of a table at random points, and fail if one exceeds its bound"
    check = options.command(actions, "check", about, _check)
    build = options.command(actions, "build", "solve the equation at every node of a table", _build)
    for action in (info, check):
        action.add_argument("file", nargs="?", metavar="FILE", help="a table (default: the one in use for LAW)")
    for action in (info, check, build):
        # not laws.DEFAULT, whose table may depend on the pair; this table comes with the package
        action.add_argument("--law", default="myc", metavar="LAW", help="force law of the table (default: %(default)s)")
        options.add_pair(action, "; for laws with a table per pair")
    check.add_argument(
        "--points", type=int, default=20_000, metavar="N", help="number of points, at least 100 (default: %(default)s)"
    )
    check.add_argument("--seed", type=int, metavar="S", help="seed of the points (default: a fresh one)")
    build.add_argument("--out", metavar="FILE", help="file to write (default: LAW.h5)")


def _info(arguments: argparse.Namespace) -> None:
    found = _stored(arguments)
    print(f"law {found.law.family}: {found.law.source}")
    lam, chi = found.settings.largest_inelasticity, found.settings.largest_overload
    rungs = found.grid.rungs[:, 0]
    more = f", {rungs.size} strengths to {rungs[-1]:.4g}" if rungs.size > 1 else ""
    columns = sum(found.grid.axes[2:5])
    print(f"inelasticity 0 to {lam:g}, overload to {chi:g}, {found.settings.rows} by {columns:g} cells{more}")
    for name, value in asdict(found.settings).items():
        print(f"  {name:22s} {value:g}")
    _print_certificate(found.certificate, table.bounds(found.law))


def _check(arguments: argparse.Namespace) -> None:
    seed = secrets.randbits(32) if arguments.seed is None else arguments.seed
    stored, bar = _stored(arguments), cache.progress_bar
    certificate = table.certify(stored, arguments.points, seed, progress=bar)
    limits = table.bounds(stored.law)
    _print_certificate(certificate, limits)
    exceeded = certificate.exceeded(limits)
    if exceeded:
        raise ValueError(f"the table exceeds its bounds: {exceeded} (seed {seed})")


def _build(arguments: argparse.Namespace) -> None:
    enable_caching()
    out = Path(arguments.out or f"{arguments.law}.h5")
    with wording.writing("out", out):
        law = _law(arguments)
        built = table.build(law, progress=cache.progress_bar)
        built = table.with_shapes(built, points=10_000, progress=cache.progress_bar)
        file.write(built, out)
    _print_certificate(built.certificate, table.bounds(law))
    print(out)


def _stored(arguments: argparse.Namespace) -> table.Table:
    enable_caching()
    if arguments.file:
        return file.read(arguments.file)
    law = _law(arguments)
    return file.packaged(law) or cache.cached_shapes(cache.cached(law))


def _law(arguments: argparse.Namespace) -> laws.Law:
    """Law of a table, by its name and, for laws with parameters of a pair, by the materials."""
    if not laws.parameters(arguments.law):
        return laws.law(arguments.law)
    if arguments.sphere is None or arguments.plate is None:
        reason = "takes numbers from a pair: give --sphere and --plate too"
        raise ArgumentError("law", arguments.law, reason)
    pair = chosen.pair(arguments)
    return with_strengths(pair, law_of(pair, arguments.law))


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
