"""Bands of ``contactlaw cor``: how far a real impact may be from its COR, and why."""

import dataclasses
import math
import textwrap
from collections.abc import Iterator

import numpy as np

from contactlaw._arrays import Array
from contactlaw.answers.uncertainty import Band, Uncertainty
from contactlaw.cli.parts.impacts import COLUMNS, Column, ImpactTable
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair

_MOST, _LEAST = 3, 0.01  # causes that are named, and the least of one over the largest
_OF_LAW = "two of three impacts by finite elements (no errors of the materials are known)"
_OF_ALL = "two of three impacts, as far as errors are known"
_ASSUMED = 0.1  # relative error of a strength whose own is not known
_TELLS = 0.75  # share of a cause in all others from which without it the band is narrower by a fifth
WIDTH = 110  # of a line of text


def with_bands(table: ImpactTable, bands: Uncertainty | None) -> tuple[ImpactTable, tuple[Column, ...]]:
    """Table and columns with the ends of each band after its value; without bands, as they are."""
    columns, values = [], {}
    for column in COLUMNS:
        columns.append(column)
        values[column.name] = table.columns[column.name]
        band: Band | None = getattr(bands, column.name, None)
        if band:
            low, high = f"{column.name}_low", f"{column.name}_high"
            shown = "68 %" if column.name == "restitution" else ""
            columns += [Column(low, column.unit, shown, to=high), Column(high, column.unit)]
            for name, end in ((low, band.low), (high, band.high)):
                values[name] = np.where(np.isfinite(end), end, np.nan)
    return dataclasses.replace(table, columns=values), tuple(columns)


def unknown(band: Band) -> str:
    """Say which errors that matter are not known; empty if all are."""
    known = np.isfinite(band.causes["model"]).all()
    return "" if known else "no range: how far the law is from finite elements is not known"


def in_brackets(band: Band) -> str:
    """Band of one impact, with its causes, as text after its value."""
    low, high = (np.ravel(end).item() for end in (band.low, band.high))
    return "(no range)" if np.isinf(low) else f"({low:.3g} to {high:.3g}; {_causes(band)})"


def assumed(pair: Pair) -> tuple[dict[str, str], Pair]:
    """Say which strengths have no known error, and why; and the pair with one of 10 % in its place."""
    why, bodies = dict[str, str](), list[Material]()
    for role, body in zip(("bead", "plate"), pair.given, strict=True):
        name = "hardness" if body.yield_strength is None else "yield_strength"
        if body.strength is not None and name not in body.uncertainty:
            remark = "a specified minimum" if body.specified_minimum else "its error is not known"
            why |= {f"{name.replace('_', ' ')} of {of}": remark for of in (f"the {role}", "both bodies")}
            body = dataclasses.replace(body, uncertainty={**body.uncertainty, name: _ASSUMED})
        bodies.append(body)
    return why, Pair(*bodies)


def measure_first(band: Band, assumed: dict[str, str]) -> str:
    """Name the input whose measurement narrows the band most, and by how much: rms of several impacts.

    Causes that are `assumed` have an error of 10 %, since theirs is not known.
    """
    sizes = {cause: float(np.sqrt(np.mean(np.square(size)))) for cause, size in band.causes.items()}
    rest = sizes.pop("model")
    cause, size = max(sizes.items(), key=lambda one: one[1], default=("", 0.0))
    rest = math.hypot(rest, *(one for name, one in sizes.items() if name != cause))
    if not size > _TELLS * rest:
        return ""
    what = "the " + cause.replace("yield strength", "yield strength or hardness")
    why = (
        f": {assumed[cause]}, and each 10 % of it is {size:.2g} of COR"
        if cause in assumed
        else f", {size:.2g} of half the width"
    )
    guessed = [f"the {name}" for name in sizes.keys() & assumed if name != cause]
    return f"{what}{why}; all else is {rest:.2g}{', with 10 % for ' * bool(guessed)}{' and '.join(guessed)}"


def explained(band: Band, pair: Pair, first: str) -> Iterator[str]:
    """Lines below a table with the meaning of the band of the COR, and its causes."""
    yield ""
    said = [f"68 %: the COR is in this range in {meaning(band)}{left_out(band, pair)}."]
    if meaning(band) is _OF_ALL and np.isfinite(band.low).any():
        said.append(f"Half its width by cause: {_causes(band)}.")
    yield from textwrap.wrap(" ".join([*said, *[f"Measure this first: {first}."] * bool(first)]), WIDTH)


def left_out(band: Band, pair: Pair) -> str:
    """Name what is not in the band and often matters most, unknown errors and viscosity, and ranges."""
    roles = {"the bead": pair.sphere, "the plate": pair.plate}
    known = {"yield_strength", "hardness"}
    bodies = {role: body for role, body in roles.items() if body.strength is not None and not body.specified_minimum}
    names = [role for role, body in bodies.items() if not body.uncertainty.keys() & known]
    parts = list(filter(None, [unknown(band)]))
    minima = [
        f"the strength of {role} is a specified minimum" for role, body in roles.items() if body.specified_minimum
    ]
    parts += [f"{' and '.join(minima)}: the real COR may be higher"] if minima else []
    if names and meaning(band) is _OF_ALL:
        subject = "strength" if len(names) == 1 else "strengths"
        parts.append(f"errors of the {subject} of {' and '.join(names)} are not")
    if any(body.is_polymer and not body.loss_factor for body in roles.values()):
        parts.append("what a polymer loses by viscosity is not in it")
    return f" ({'; '.join(parts)})" if parts else ""


def meaning(band: Band) -> str:
    """Say which impacts are in a band."""
    return _OF_LAW if [*band.causes] == ["model"] and not unknown(band) else _OF_ALL


def in_caption(band: Band) -> str:
    """Say which impacts are in a band, and which of several causes makes it widest."""
    cause = max(band.causes, key=lambda name: np.max(band.causes[name]), default="")
    if why := unknown(band):
        return f"{meaning(band)}; {why}"
    return meaning(band) + (f", mostly by the {cause}" if len(band.causes) > 1 else "")


def _causes(band: Band) -> str:
    """Causes with the half widths that they alone make, the largest ones first."""
    sizes = {name: np.asarray(size) for name, size in band.causes.items()}
    most = max((size.max() for size in sizes.values()), default=0.0)
    largest = sorted(sizes, key=lambda name: -sizes[name].max())[:_MOST]
    counted = (name for name in largest if sizes[name].max() >= _LEAST * most)
    return ", ".join(f"{name} {_range(sizes[name])}" for name in counted)


def _range(sizes: Array) -> str:
    known = np.where(sizes > _LEAST**2 * sizes.max(), sizes, 0.0)  # not what integration errs by
    least, most = (f"{size:.2g}" for size in (known.min(), known.max()))
    return most if least == most else f"{least} to {most}"
