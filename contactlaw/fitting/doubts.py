"""Signs that a fit is of nonsense: units mistaken, bodies exchanged, a law that does not hold."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._readable import percent, rounded, scale_of
from contactlaw.answers.backend import UnsolvedError
from contactlaw.fitting import errors, search
from contactlaw.fitting.identify import UnidentifiedError
from contactlaw.fitting.measurements import KINDS
from contactlaw.fitting.notes import listed
from contactlaw.fitting.predictions import Predictor
from contactlaw.fitting.unknowns import Parameter, centre
from contactlaw.physical.pair import Pair

Array = NDArray[np.float64]

_SIGNIFICANCE = 1e-3  # a trend is noted if scatter alone gives it in fewer than 1 of 1000 fits
_SUSPECT = 0.05  # chance of a trend below which other readings of the data are tried
_MISFIT = 1.5  # rms residual over its given standard error from which on they are tried, too
# Residuals are cut to 3 standard errors or medians, so that one mistake makes no trend.
_OUTLIER = 3.0
_EVIDENCE = 10.0  # difference of -2 ln(likelihood): one reading is 150 times as likely as another
# Factors by which a value may differ from the one given: a strength depends on the temper. A loss
# factor depends on the frequency and is often a guess.
_FACTORS = {"yield_strength": 3.0, "youngs_modulus": 2.0, "density": 2.0}
_SPEEDS = {"speeds in mm/s": 1e-3, "speeds in cm/s": 1e-2, "speeds 100 times larger": 1e2}
_SPEEDS["speeds 1000 times larger"] = 1e3


class _Reading(NamedTuple):
    """Best fit if the data or the bodies mean something else."""

    words: str
    predictor: Predictor
    at: Array
    allowed: errors.ModelCovariance | None
    gained: float  # by how much -2 ln(likelihood) is lower than that of the data as given


def doubts(
    predictor: Predictor,
    at: Array,
    error: Array,
    covariance: Array,
    model: errors.ModelCovariance | None,
) -> Iterator[str]:
    """Say what makes a fit doubtful, and which mistake would explain it.

    Arguments are those of `errors.covariances`, and the covariance of the parameters' logarithms.
    """
    values = predictor.values
    off = (values.value - predictor.predicted(at)) / error
    chances, trends = [1.0], []
    for n, name in enumerate(KINDS):
        of_kind = np.flatnonzero(values.kind == n)
        order = of_kind[np.argsort(np.asarray(predictor.data.speed)[values.row[of_kind]])]
        thirds = np.array_split(order, 3)
        chances.append(_chance(thirds, off, bool(np.isnan(values.error[of_kind]).any())))
        if chances[-1] < _SIGNIFICANCE:
            share = off * error / values.value
            means = [float(share[third].mean()) for third in thirds]
            slow, middle, fast = map(percent, means)
            known = 0.0 if model is None else model.size[of_kind] / values.value[of_kind]
            allowed = max(map(abs, means)) < 2.0 * math.sqrt(np.mean(np.square(known)))
            why = f"errors of law {predictor.law.family!r} allow that, those of the data do not"
            why = why if allowed else "units, materials or the law may be wrong"
            trends.append(
                f"residuals of {name} trend with speed: {slow}, {middle} and {fast} in the slow, "
                f"the middle and the fast third, by chance in fewer than 1 of 1000 fits: {why}"
            )
    yield from _above_one(predictor)
    low, high = search.limits(predictor)
    if ((at < 1.001 * low) | (at > 0.999 * high)).any() and (outside := _outside(predictor, at)):
        yield outside
    far = [n for n in range(at.size) if _is_far(predictor, at, n, covariance)]
    given = np.isfinite(values.error)
    misfit = given.any() and float(np.mean(off[given] ** 2)) > _MISFIT**2
    doubtful = far or misfit or min(chances) < _SUSPECT
    others = _readings(predictor, at, error) if doubtful else []
    for n in far:
        one = predictor.parameters[n]
        likely = [
            other.words
            for other in others
            if other.gained > -_EVIDENCE and not _is_far(other.predictor, other.at, n)
        ]
        ratio = at[n] / one.centre
        unit, size = scale_of(one.centre, one.unknown.unit)
        body = getattr(predictor.pair, one.unknown.body).name
        yield (
            f"{one.name} is {rounded(max(ratio, 1.0 / ratio))} times "
            f"{'above' if ratio > 1.0 else 'below'} that of {body}, {one.centre / size:.4g} "
            f"{unit}: {' or '.join(likely) or 'units or materials mistaken'}?"
        )
    yield from trends
    yield from _better(predictor, at, others)


def explained(refused: UnidentifiedError, predictor: Predictor, at: Array) -> UnidentifiedError:
    """Add to a refusal which values are attainable, or which mistake would explain it."""
    outside = _outside(predictor, at)
    others = _readings(predictor, at, search.guessed(predictor.values))
    better = (f"{words[0].upper()}{words[1:]}" for words in _better(predictor, at, others))
    sentences = [outside or refused.reason, *_above_one(predictor), *better]
    message = " ".join(one if one.endswith("?") else f"{one}." for one in sentences).rstrip(".")
    return UnidentifiedError(message, refused.unknown, refused.known)


def _above_one(predictor: Predictor) -> Iterator[str]:
    for name in ("restitution", "tangential_restitution"):
        rows = np.flatnonzero(np.array(getattr(predictor.data, name), dtype=np.float64) > 1.0)
        if rows.size:
            which = f"rebounds {listed(rows)}"
            which = predictor.data.rebound(rows[0]) if rows.size == 1 else which
            yield f"{name} of {which} is above 1: no impact gains energy, a mistake?"


def _chance(thirds: list[NDArray[np.intp]], off: Array, found: bool) -> float:
    """Chance that errors of the data alone move the means of the thirds as far apart.

    Errors that were found have the scatter within the thirds. Parameters take up a part of any
    trend, so that the chance is rather too large.
    """
    from scipy.special import fdtrc

    if min(third.size for third in thirds) < 2:
        return 1.0
    most = _OUTLIER * max(1.0, float(np.median(np.abs(off[np.concatenate(thirds)]))))
    parts = [np.clip(off[third], -most, most) for third in thirds]
    middle = np.concatenate(parts).mean()
    square = sum(float(part.size * (part.mean() - middle) ** 2) for part in parts)
    if not found:
        return math.exp(-0.5 * square)
    freedom = sum(part.size for part in parts) - 3
    within = sum(float(part.var() * part.size) for part in parts)
    return float(fdtrc(2.0, freedom, 0.5 * square * freedom / max(within, 1e-9)))


def _is_far(predictor: Predictor, at: Array, n: int, covariance: Array | None = None) -> bool:
    """Whether a value, with two standard errors, is far from the one given."""
    one = predictor.parameters[n]
    if one.unknown.field not in _FACTORS or not one.is_unknown or math.isnan(one.centre):
        return False
    spread = 0.0 if covariance is None else 2.0 * math.sqrt(covariance[n, n])
    return abs(math.log(at[n] / one.centre)) - spread > math.log(_FACTORS[one.unknown.field])


def _outside(predictor: Predictor, at: Array) -> str:
    """Say so if no value of the unknowns gives any of the data, and what is attainable."""
    values = predictor.values
    grid = np.vstack([search.attainable(predictor), predictor.at_trials(at[None])])
    low = np.where(grid == 0.0, np.inf, grid).min(axis=0)  # 0: the model has no answer there
    high = grid.max(axis=0)
    changes = (high > 1.001 * low).any()  # else the law does not depend on the unknowns
    near = np.clip(values.value, low, high)
    margin = 2.0 * np.nan_to_num(values.error) + 1e-6 * near
    if not (changes and (np.abs(values.value - near) > margin).all()):
        return ""
    n = int(np.argmax(np.abs(values.value / near - 1.0)))
    name, kind = list(KINDS.items())[values.kind[n]]
    row, unit = values.row[n], kind.unit.strip("-")
    speed = float(np.asarray(predictor.data.speed)[row])
    value, least, most = (float(one[n]) - kind.shift for one in (values.value, low, high))
    least = least if abs(least) > 1e-3 * most else 0.0
    unknown = " and ".join(one.name for one in predictor.parameters if one.is_unknown)
    ends = f"from {least:.3g} to {most:.3g} {unit}".rstrip()
    ends += ", that of a half-space" if unknown == "thickness" and high[n] == grid[-2, n] else ""
    which = f"{name} {f'{value:.4g} {unit}'.rstrip()} of {predictor.data.rebound(row)}"
    return f"no {unknown} gives the {which}, at {rounded(speed, 3)} m/s: attainable is {ends}"


def _readings(predictor: Predictor, at: Array, error: Array) -> list[_Reading]:
    """Fit with other units, the bodies exchanged, or the strength of the other body unknown."""
    pair, data, parameters = predictor.pair, predictor.data, predictor.parameters
    freedom = predictor.values.value.size - sum(one.prior is None for one in parameters)
    if freedom < 1:
        return []
    meant: list[tuple[str, Pair, dict[str, Any], list[Parameter]]] = []
    for words, factor in _SPEEDS.items():
        slide = None if data.sliding_speed is None else np.multiply(data.sliding_speed, factor)
        speeds = {"speed": np.multiply(data.speed, factor), "sliding_speed": slide}
        meant.append((words, pair, speeds, parameters))
    if data.radius is not None:
        half = np.multiply(data.radius, 0.5)
        meant.append(("diameters in place of radii", pair, {"radius": half}, parameters))
    # A body has a loss factor here if its own is unknown: exchanged, the other would need one.
    if pair.sphere != pair.plate and all(p.unknown.field != "loss_factor" for p in parameters):
        meant.append(("sphere and plate exchanged", Pair(pair.plate, pair.sphere), {}, parameters))
    asked = {p.name for p in parameters if p.is_strength and p.prior is None}
    for other, body in (("yield_strength", pair.sphere), ("plate_yield_strength", pair.plate)):
        if asked and body.strength is not None and all(p.name != other for p in parameters):
            swapped = [replace(p, name=other) if p.name in asked else p for p in parameters]
            meant.append((f"{other} as the unknown", pair, {}, swapped))
    least = _square(predictor, at, error)
    found = []
    for words, bodies, changes, varied in meant:
        try:
            read = replace(data, **changes)
            moved = [replace(p, centre=centre(bodies, read, p.unknown)) for p in varied]
            trial = Predictor(bodies, predictor.law, read, moved, predictor.values)
            values = search.basins(trial)[0].at
            allowed = errors.model_covariance(trial, values, trial.impacts(values))
            gained = freedom * math.log(least / _square(trial, values, error))
        except (UnsolvedError, ValueError):  # no such bodies, no law for them, or too fast
            continue
        found.append(_Reading(words, trial, values, allowed, gained))
    return sorted(found, key=lambda one: _strangeness(one) - one.gained)


def _strangeness(read: _Reading) -> float:
    """Squared distance of a reading's values from those given; a factor is two standard errors."""
    ratios = (
        (at / one.centre, _FACTORS[one.unknown.field])
        for one, at in zip(read.predictor.parameters, read.at.tolist(), strict=True)
        if one.unknown.field in _FACTORS and one.is_unknown and not math.isnan(one.centre)
    )
    return sum((2.0 * math.log(ratio) / math.log(factor)) ** 2 for ratio, factor in ratios)


def _square(predictor: Predictor, at: Array, error: Array) -> float:
    off = (predictor.values.value - predictor.at_trials(at[None])[0]) / error
    return max(float(off @ off), 1e-9)


def _better(predictor: Predictor, at: Array, others: list[_Reading]) -> Iterator[str]:
    """Name the readings that are far more likely, by more than the model's own errors explain."""
    scatter, most = _scatter(predictor, at), max((one.gained for one in others), default=0.0)
    for one in others:
        size = 0.0 if one.allowed is None else one.allowed.size / predictor.values.value
        unlikely = scatter > 2.0 * np.sqrt(np.mean(np.square(size)))
        if unlikely and one.gained > max(_EVIDENCE, most - _EVIDENCE):
            off = f"{percent(_scatter(one.predictor, one.at))} off (rms) in place of"
            yield f"the data fit better with {one.words}: {off} {percent(scatter)}"


def _scatter(predictor: Predictor, at: Array) -> float:
    """Rms residual, relative to the values."""
    return math.sqrt(_square(predictor, at, predictor.values.value) / predictor.values.value.size)
