"""Bands of the COR in words: how far a real impact may be from the answer, and why."""

import dataclasses
import math

import numpy as np

from contactlaw._arrays import Array
from contactlaw.answers.uncertainty import Band, Uncertainty
from contactlaw.cli.parts.table import Column, Table
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair

_MOST, _LEAST = 3, 0.01  # causes that are named, and the least of one over the largest
_ASSUMED = 0.1  # relative error of a strength whose own is not stated
_TELLS = 0.75  # share of a cause in all others from which without it the band is narrower by a fifth
_STRENGTHS = "yield_strength", "hardness"
_HERE = "two in three real impacts lie here"


def with_bands(table: Table, bands: Uncertainty | None) -> Table:
    """Add the ends of each band after its value; without bands, leave the table as it is."""
    columns, values = [], dict(table.values)
    for column in table.columns:
        columns.append(column)
        band: Band | None = getattr(bands, column.name, None)
        if band:
            low, high = f"{column.name}_low", f"{column.name}_high"
            shown = "68 %" if column.name == "restitution" else ""
            columns += [Column(low, column.unit, shown, to=high, digits=".3f"), Column(high, column.unit)]
            for name, end in ((low, band.low), (high, band.high)):
                values[name] = np.where(np.isfinite(end), end, np.nan)
    return dataclasses.replace(table, columns=columns, values=values)


def meaning(band: Band, pair: Pair, subject: str = _HERE) -> str:
    """Say what is in a band, and what may move real impacts out of it; ends without a full stop.

    The subject is a clause of the things that are in the band.
    """
    bodies = {"bead": pair.given[0], "plate": pair.given[1]}
    strong = {role: body for role, body in bodies.items() if body.strength is not None}
    unstated = [role for role, body in strong.items() if not _has_error(body)]
    if not np.isfinite(band.low).any():
        subject = "no range, because the error of this law is not known"
    elif len(unstated) == 2:
        subject += ", if the strengths are right; their errors are not stated"
    elif unstated:
        subject += f", if the {unstated[0]}'s strength is right; its error is not stated"
    elif [*band.causes] == ["model"]:
        subject += ", if the materials are right; their errors are not stated"
    sentences = [subject]
    for role in unstated:
        if bodies[role].specified_minimum:
            sentences.append(f"The {role}'s strength is a specified minimum: the real COR may be higher")
    for role, body in bodies.items():
        if body.is_polymer and not body.loss_factor:
            sentences.append(f"The {role} is a polymer without a loss factor: the real COR may be lower")
    return ". ".join(sentences)


def _has_error(body: Material) -> bool:
    return not body.uncertainty.keys().isdisjoint(_STRENGTHS)


def assumed(pair: Pair) -> Pair:
    """Give each strength without a stated error one of 10 %."""
    bodies = []
    for body in pair.given:
        if body.strength is not None and not _has_error(body):
            name = _STRENGTHS[body.yield_strength is None]
            body = dataclasses.replace(body, uncertainty={**body.uncertainty, name: _ASSUMED})
        bodies.append(body)
    return Pair(*bodies)


def measure_first(band: Band, pair: Pair) -> str:
    """Name the input whose measurement narrows the band most, and by how much: rms of several impacts.

    The band is that of the pair with `assumed` errors. Without such an input the answer is empty.
    """
    sizes = {cause: float(np.sqrt(np.mean(np.square(size)))) for cause, size in band.causes.items()}
    rest = sizes.pop("model", 0.0)
    cause, size = max(sizes.items(), key=lambda pair: pair[1], default=("", 0.0))
    rest = math.hypot(rest, *(other for name, other in sizes.items() if name != cause))
    if not size > _TELLS * rest:
        return ""
    name, _, owner = cause.partition(" of ")
    body = pair.given[owner == "the plate"]
    is_strength = name.replace(" ", "_") in _STRENGTHS
    owner = {"": "the ", "both bodies": "the material's "}.get(owner, f"{owner}'s ")
    subject = f"Measure {owner}{'hardness' if is_strength else name}"
    if is_strength and not _has_error(body):
        return f"{subject} first: 10 % of it changes the COR by {size:.2g}."
    return f"{subject} better: its error changes the COR by {size:.2g}."


def causes(band: Band) -> str:
    """Name the largest causes of a band of the COR, with the half widths that they alone make."""
    sizes = {name: np.asarray(size) for name, size in band.causes.items() if np.isfinite(size).all()}
    most = max((size.max() for size in sizes.values()), default=0.0)
    largest = sorted(sizes, key=lambda name: -sizes[name].max())[:_MOST]
    named = (name for name in largest if sizes[name].max() >= _LEAST * most)
    parts = (f"{'law' if name == 'model' else name} {_range(sizes[name])}" for name in named)
    return f"Half the width of the COR's range by cause: {', '.join(parts)}."


def _range(sizes: Array) -> str:
    sizes = np.where(sizes > _LEAST**2 * sizes.max(), sizes, 0.0)  # smaller ones are errors of integration
    least, most = (f"{size:.2g}" for size in (sizes.min(), sizes.max()))
    return most if least == most else f"{least} to {most}"
