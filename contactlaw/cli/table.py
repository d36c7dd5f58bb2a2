"""``contactlaw table`` (engines): describe, check or build a lookup table."""

import secrets
from argparse import Namespace
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from contactlaw import laws, table
from contactlaw._jit import enable_caching
from contactlaw.cli.parts import chosen, options, wording
from contactlaw.cli.parts.table import Column, Table
from contactlaw.parser import wrapped
from contactlaw.physical.law import law_of
from contactlaw.physical.strengths import with_strengths
from contactlaw.table import cache, file


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    actions = options.group(commands, "table", "describe, check or build a lookup table", "ACTION", "what to do")
    info = options.command(actions, "info", "print the range of a table, its settings and its certified errors", _info)
    about = "measure the errors of a table at random points, and fail if one exceeds its bound"
    check = options.command(actions, "check", about, _check)
    build = options.command(
        actions, "build", "solve the equation at every node of a table, and write the table", _build
    )
    for action in (info, check):
        action.add_argument("file", nargs="?", metavar="FILE", help="table to read (default: the one in use for LAW)")
    for action in (info, check, build):
        # not laws.DEFAULT, whose table may depend on the pair; this table comes with the package
        action.add_argument("--law", default="myc", metavar="LAW", help="force law of the table (default: %(default)s)")
        options.add_pair(action, "; only for laws with a table for each pair")
    what = "number of random points, at least 100 (default: %(default)s)"
    check.add_argument("--points", type=int, default=20_000, metavar="N", help=what)
    build.add_argument("--out", metavar="FILE", help="file to write (default: LAW.h5)")


def _info(arguments: Namespace) -> None:
    stored = _stored(arguments)
    settings = ", ".join(f"{name} {value:g}" for name, value in asdict(stored.settings).items())
    axes, rungs = stored.grid.axes, stored.grid.rungs[:, 0]
    cells = f"{axes.rows:g} by {sum(axes[2:5]):g} cells, strengths up to {rungs[-1]:.4g} times: {rungs.size}"
    for text in (f"law {stored.law.family}: {stored.law.source}", f"settings: {settings}; {cells}"):
        print(*wrapped(text), sep="\n")
    _print_certificate(stored)


def _check(arguments: Namespace) -> None:
    stored = _stored(arguments)
    certified = replace(stored, certificate=table.certify(stored, arguments.points, secrets.randbits(32)))
    _print_certificate(certified)
    if exceeded := certified.exceeded():
        raise ValueError(f"the table exceeds its bounds: {exceeded}")


def _build(arguments: Namespace) -> None:
    enable_caching()
    out = Path(arguments.out or f"{arguments.law}.h5")
    with wording.writing("out", out):
        built = table.build(_law(arguments))
        built = table.with_shapes(built, points=10_000)
        file.write(built, out)
    _print_certificate(built)
    print(out)


def _stored(arguments: Namespace) -> table.Table:
    enable_caching()
    if arguments.file:
        return file.read(arguments.file)
    law = _law(arguments)
    return file.packaged(law) or cache.cached(law)


def _law(arguments: Namespace) -> laws.Law:
    """Law of a table, by its name and, for laws with parameters of a pair, by the materials."""
    if not laws.parameters(arguments.law):
        return laws.law(arguments.law)
    pair = chosen.pair(arguments)
    return with_strengths(pair, law_of(pair, arguments.law))


def _print_certificate(stored: table.Table) -> None:
    certificate = stored.certificate
    if certificate is None:
        print("no certificate")
        return
    errors = {"largest": certificate.largest, "bound": table.bounds(stored.law)}
    columns = [Column("field", title="field", shown=""), *(Column(name, title=name, digits=".1e") for name in errors)]
    values = {name: [sizes[field] for field in certificate.largest] for name, sizes in errors.items()}
    print("", f"errors at {certificate.points} random points, seed {certificate.seed}", sep="\n")
    print(*Table(columns, values | {"field": [*certificate.largest]}).text(), sep="\n")
