"""Command line: ``contactlaw cor | sweep | constant | fit | history | export | ...``."""

from __future__ import annotations

import argparse
import json
import math
import os
import secrets
import sys
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import asdict
from pathlib import Path
from typing import Literal

import numpy as np

from contactlaw import export, laws, table
from contactlaw._jit import enable_caching
from contactlaw.command import (
    curves,
    fitplot,
    fits,
    lines,
    measured,
    options,
    plots,
    records,
    sheet,
    sweep,
    walls,
    wording,
)
from contactlaw.command.quantities import LENGTH, written
from contactlaw.fitting import fit
from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import scalars
from contactlaw.physical.history import ForceHistory
from contactlaw.physical.materials import material, materials
from contactlaw.physical.pair import Pair
from contactlaw.physical.scaling import law_of
from contactlaw.physical.validity import count_flags, explain
from contactlaw.table import cache, file

_DONE, _REFUSED, _INTERRUPTED = 0, 1, 130  # argparse itself exits with 2 on wrong usage


def _model(arguments: argparse.Namespace) -> ImpactModel:
    return ImpactModel(_pair(arguments), law=arguments.law, outside=arguments.outside)


def _pair(arguments: argparse.Namespace, known: Pair | None = None) -> Pair:
    """Materials that are named, or else known."""
    bodies = {}
    for name in ("sphere", "plate"):
        asked = getattr(arguments, name)
        if asked is None:
            if known is None:
                raise wording.Refused(f"--{name}: has to be given, no record says it")
            bodies[name] = getattr(known, name)
        else:
            with wording.material_of(name):
                bodies[name] = material(asked)
    return Pair(**bodies)


def _check_quantities(arguments: argparse.Namespace) -> None:
    """Refuse each value beyond its limits by itself: in all combinations it has no number."""
    for name in ("speed", "radius", "thickness"):
        given = getattr(arguments, name, None)
        for value in () if given is None else np.atleast_1d(given).tolist():
            scalars(**{name: value})


@contextmanager
def _picture(arguments: argparse.Namespace) -> Iterator[None]:
    """Refuse what cannot be drawn into, before anything is computed."""
    with wording.file_of("plot", arguments.plot):
        plots.check_suffix(arguments.plot)
        yield
    print(arguments.plot)


def _cor(arguments: argparse.Namespace) -> None:
    _check_quantities(arguments)
    if arguments.plot is not None:
        with _picture(arguments):
            _plot_cor(arguments)
        return
    values = (arguments.speed, arguments.radius, arguments.thickness)
    found = sheet.impacts(_model(arguments), *values, solve=arguments.solve)
    if arguments.csv:
        sheet.write_csv(found, sys.stdout)
    elif arguments.json:
        print(json.dumps(_as_json(sheet.records(found)), indent=2))
    elif len(found) > 1:
        print(*sheet.text(found), sep="\n")
    else:
        _print_one(found)


def _as_json(rows: list[dict[str, object]]) -> object:
    """Rows; of one impact, which its caller knows, what comes of it."""
    if len(rows) > 1:
        return rows
    asked = ("speed", "radius", "thickness")
    return {name: value for name, value in rows[0].items() if name not in asked}


def _print_one(found: sheet.Sheet) -> None:
    units = sheet.units()
    for name, (value,) in found.columns.items():
        if name == "yield_speed" and value == math.inf:
            print(f"{name:21s} none within the table")
        elif name not in ("speed", "radius", "thickness"):
            print(f"{name:21s} {value:.6g} {units[name]}".rstrip())
    flags = int(found.flags[0])
    print(f"{'flags':21s} {', '.join(sheet.flag_names(flags)) or 'none: inside every limit'}")
    for words in explain(flags):
        print(f"{'':21s} {words}")


def _plot_cor(arguments: argparse.Namespace) -> None:
    model = _model(arguments)
    drawn = curves.restitution_curves(
        model, arguments.speed, arguments.radius, arguments.thickness, solve=arguments.solve
    )
    title = f"{arguments.sphere} on {arguments.plate}, law {arguments.law}"
    plots.save_restitution(drawn, title, arguments.plot)


def _sweep(arguments: argparse.Namespace) -> None:
    _check_quantities(arguments)
    with wording.file_of("out", arguments.out):
        sweep.check_suffix(arguments.out)
        axes = (arguments.speed, arguments.radius, arguments.thickness)
        model = _model(arguments)
        found = sheet.impacts(model, *axes, solve=arguments.solve)
        sweep.save(found, model, axes, arguments.out)
    flags = sheet.explained(count_flags(found.flags), len(found))
    print(f"{arguments.out}: {len(found)} impacts", *flags, sep="\n")


def _constant(arguments: argparse.Namespace) -> None:
    happened = _happened(arguments)
    pair = _pair(arguments, happened.pair)
    law = arguments.law or happened.law or laws.DEFAULT
    model = ImpactModel(pair, law=law, outside=arguments.outside)
    found = walls.walls(model, happened, arguments.keep)
    formats = {"lammps": lines.lammps, "liggghts": lines.liggghts, "yade": lines.yade}
    write = next((write for name, write in formats.items() if getattr(arguments, name)), None)
    if write is not None:
        print(*list(write(model, found, arguments.keep)), sep="\n")
    elif arguments.csv:
        walls.write_csv(found, arguments.keep, sys.stdout)
    else:
        print(*walls.text(found, arguments.keep), sep="\n")


def _happened(arguments: argparse.Namespace) -> records.Impacts:
    """Impacts of the record, or every combination of the speeds with what else options say."""
    _check_quantities(arguments)
    sizes = (arguments.radius, arguments.thickness)
    if arguments.record is None:
        return records.combined(arguments.speed, *sizes)
    return records.completed(records.read(arguments.record), *sizes)


def _speed_table(arguments: argparse.Namespace) -> None:
    _check_quantities(arguments)
    ends = (arguments.slowest, arguments.fastest)
    with wording.impacts(ends, arguments.radius, arguments.thickness):
        found = _model(arguments).speed_table(
            arguments.radius, arguments.thickness, arguments.error, *ends
        )
    if arguments.csv:
        print("speed_m/s,restitution")
        np.savetxt(sys.stdout, np.column_stack(found[:2]), fmt="%.17g", delimiter=",")
    else:
        print(*sheet.speed_table(found), sep="\n")


def _fit(arguments: argparse.Namespace) -> None:
    _check_quantities(arguments)
    pair = _pair(arguments)
    read = measured.read(arguments.data)
    if read.unused:
        _say_warning(f"{arguments.data}: columns that are not used: {', '.join(read.unused)}")
    data = measured.completed(
        read, arguments.data, radius=arguments.radius, thickness=arguments.thickness
    )
    priors = dict(arguments.prior)
    with nullcontext() if arguments.plot is None else _picture(arguments):
        found = fit(pair, data, arguments.unknown, arguments.law, priors)
        if arguments.plot is not None:
            title = f"{arguments.sphere} on {arguments.plate}, law {arguments.law}"
            fitplot.save_fit(found, title, arguments.plot)
        if arguments.json:
            print(json.dumps(fits.record(found), indent=2))
        else:
            print(*fits.text(found), "", *fits.rows(found), sep="\n")


def _history(arguments: argparse.Namespace) -> None:
    _check_quantities(arguments)
    if arguments.plot is not None:
        with _picture(arguments):
            _plot_history(arguments)
        return
    contact = np.column_stack(_contact(arguments))
    print("time_s,force_N,compression_m,impulse_Ns,plate_displacement_m")
    np.savetxt(sys.stdout, contact, fmt="%.9g", delimiter=",")


def _contact(arguments: argparse.Namespace) -> ForceHistory:
    """Force over time; what the flags say goes beside the output, which is CSV alone."""
    impact = (arguments.speed, arguments.radius, arguments.thickness)
    method: Literal["solve", "table"] = "solve" if arguments.solve else "table"
    model = _model(arguments)
    with wording.impacts(*impact):
        found = model.force_history(*impact, arguments.samples, method)
        rebound = model.solve(*impact) if arguments.solve else model.lookup(*impact)
    flags = int(rebound.flags)
    for name, words in zip(sheet.flag_names(flags), explain(flags), strict=True):
        _say_warning(f"{name}: {words}")
    return found


def _plot_history(arguments: argparse.Namespace) -> None:
    contact = _contact(arguments)
    radius, thickness = (written(size, LENGTH) for size in (arguments.radius, arguments.thickness))
    title = (
        f"{arguments.sphere} on {arguments.plate}: radius {radius}, plate {thickness}, "
        f"{arguments.speed:g} m/s"
    )
    plots.save_history(contact, title, arguments.plot)


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


def _law(arguments: argparse.Namespace) -> laws.Law:
    """Law of a table: by its name, or by that and a pair of materials."""
    if not laws.parameters(arguments.law):
        return laws.law(arguments.law)
    if arguments.sphere is None or arguments.plate is None:
        raise wording.Refused(
            f"--law: {arguments.law!r} takes numbers from a pair: give --sphere and --plate too"
        )
    return law_of(_pair(arguments), arguments.law)


def _table_build(arguments: argparse.Namespace) -> None:
    enable_caching()
    out = Path(arguments.out or f"{arguments.law}.h5")
    with wording.file_of("out", out):
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


def _table_info(arguments: argparse.Namespace) -> None:
    found = _stored(arguments)
    print(f"law {found.law.family}: {found.law.source}")
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


def _export_header(arguments: argparse.Namespace) -> None:
    with wording.file_of("out", arguments.out):
        model = ImpactModel(_pair(arguments), law=arguments.law)
        export.header(arguments.out, model, arguments.table)
    print(arguments.out)


def _export_liggghts(arguments: argparse.Namespace) -> None:
    with wording.folder_of("out", arguments.out):
        model = ImpactModel(_pair(arguments), law=arguments.law)
        export.liggghts(arguments.out, model)
    print(arguments.out)


_RUN = {
    "cor": _cor,
    "sweep": _sweep,
    "constant": _constant,
    "speed-table": _speed_table,
    "fit": _fit,
    "history": _history,
    "materials": _materials,
    "table info": _table_info,
    "table check": _table_check,
    "table build": _table_build,
    "export header": _export_header,
    "export liggghts": _export_liggghts,
}


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
    arguments = options.parser().parse_args(options.joined(sys.argv[1:] if argv is None else argv))
    if sys.stdout is None:  # so Python has it where the shell says >&-
        _say("the standard output is closed")
        return _REFUSED
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _say_warning  # type: ignore[assignment]
            _RUN[arguments.command](arguments)
        sys.stdout.flush()  # here, where a reader that has gone can be dealt with
    except KeyboardInterrupt:
        _say("interrupted")
        return _INTERRUPTED
    except BrokenPipeError:  # the reader has seen enough, as `head` does
        _drop_output()
        return _DONE
    except (ValueError, RuntimeError, OSError, ImportError) as error:
        _say(wording.sentence(error, vars(arguments)))
        try:
            sys.stdout.flush()
        except OSError:  # a full disk
            _drop_output()
        return _REFUSED
    return _DONE


def _drop_output() -> None:
    """Let what is left in the buffer go nowhere, where Python would write it at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _say(message: str) -> None:
    if sys.stderr is not None:  # None is where the shell says 2>&-, and to print the output
        print(f"contactlaw: {message}", file=sys.stderr)


def _say_warning(message: Warning | str, *_: object) -> None:
    _say(f"warning: {message}")
