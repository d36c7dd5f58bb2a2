"""Bands of the COR in words: how far a real impact may be from the answer, and why."""

import dataclasses
import math

import numpy as np

from contactlaw.answers.uncertainty import Band, Uncertainty
from contactlaw.cli.parts.table import Column, Table
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.physical.validity import Validity

_MOST = 3  # causes that are named
_ASSUMED = 0.1  # relative error of a strength whose own is not stated
_TELLS = 0.75  # share of a cause in all others from which without it the band is narrower by a fifth
_STRENGTHS = "yield_strength", "hardness"
_HERE = "two in three real impacts lie here"


def with_bands(table: Table, bands: Uncertainty | None) -> Table:
    """Add the ends of each band after its value; without bands, leave the table as it is.

    The bands are of integrated impacts: a value at the border of a table, which is that of another
    impact, has none.
    """
    columns, values = [], dict(table.values)
    inside = table.values["flags"] & Validity.CLAMPED == 0
    for column in table.columns:
        columns.append(column)
        if band := getattr(bands, column.name, None):
            low, high = f"{column.name}_low", f"{column.name}_high"
            shown = "68 %" if column.name == "restitution" else ""
            columns += [Column(low, column.unit, shown, to=high, digits=".3f"), Column(high, column.unit)]
            values |= {
                end: np.where(np.isfinite(size) & inside, size, np.nan)
                for end, size in ((low, band.low), (high, band.high))
            }
    return dataclasses.replace(table, columns=columns, values=values)


def meaning(band: Band, pair: Pair) -> str:
    """Say what is in a band, and what may move real impacts out of it; ends without a full stop."""
    subject = _HERE
    bodies = {"bead": pair.given[0], "plate": pair.given[1]}
    unstated = [role for role, body in bodies.items() if body.strength is not None and not _has_error(body)]
    if not np.isfinite(band.low).any():
        subject = "no range, because the error of this law is not known"
    elif len(unstated) == 1:
        subject += f", if the {unstated[0]}'s strength is right; its error is not stated"
    elif unstated or [*band.causes] == ["model"]:
        subject += f", if the {'strengths' if unstated else 'materials'} are right; their errors are not stated"
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
    sizes = _half_widths(band)
    law = sizes.pop("model")
    (cause, size), *others = sizes.items() or [("", 0.0)]
    if size <= _TELLS * math.hypot(law, *(width for _, width in others)):
        return ""
    name, _, owner = cause.partition(" of ")
    if name.replace(" ", "_") in _STRENGTHS:
        cause = f"{owner.replace('both bodies', 'the material')}'s hardness"
        if not _has_error(pair.given[owner == "the plate"]):
            return f"Measure {cause} first: 10 % of it changes the COR by {size:.2g}."
    return f"Measure the {cause.removeprefix('the ')} better: its error changes the COR by {size:.2g}."


def causes(band: Band) -> str:
    """Name the largest causes of a band of the COR, with the half widths that they alone make."""
    largest = [*_half_widths(band).items()][:_MOST]
    parts = (f"{'law' if name == 'model' else name} {size:.2g}" for name, size in largest)
    return f"Half the width of the COR's range by cause: {', '.join(parts)}."


def _half_widths(band: Band) -> dict[str, float]:
    """Half the width that each cause alone makes, rms of several impacts; the largest one is first."""
    sizes = {cause: float(np.sqrt(np.mean(np.square(size)))) for cause, size in band.causes.items()}
    return dict(sorted(sizes.items(), key=lambda cause: -cause[1]))
