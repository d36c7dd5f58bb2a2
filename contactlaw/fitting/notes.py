"""Remarks on a fit, in words."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from contactlaw._readable import percent, rounded
from contactlaw.fitting import search
from contactlaw.fitting.measurements import KINDS
from contactlaw.fitting.predictions import Predictor, columns_of
from contactlaw.fitting.unknowns import UNKNOWNS
from contactlaw.physical.oblique import ObliqueRebound
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.validity import count_flags, explain

Array = NDArray[np.float64]

_FAR = 4.0  # standard errors; values that are further off the fit are named
_MISFIT = 1.5  # scatter over the scatter to be expected; a larger ratio is reported
_AT_BOUND = 1e-3  # relative distance from a bound; a nearer value is at the bound
_SLIDES = 1.0 - 1e-6  # share of the friction at which an impulse is that of full sliding
_LISTED = 8  # rows or runs of rows that are listed; more are only counted


def notes(
    predictor: Predictor,
    at: Array,
    hit: Rebound,
    standard: Array,
    freedom: float,
    model: Array | None,
) -> Iterator[str]:
    """Say what is unusual about a fit.

    Parameters
    ----------
    predictor : Predictor
        Model and parameters of the fit.
    at : ndarray (p,)
        Values found.
    hit : Rebound
        Fitted rebounds.
    standard : ndarray (m,)
        Standard errors of the values, as given or found, relative to the fitted values.
    freedom : float
        Degrees of freedom; inf where all errors were given.
    model : ndarray (m,) or None
        Relative errors of the model; None where they are not known.
    """
    values = predictor.values
    fitted = columns_of(hit, predictor.setting(at))[values.kind, values.row]
    off = values.value / fitted - 1.0
    if freedom <= 0.0:
        yield (
            "as many unknowns as values, and no errors of these: the errors stated are those of "
            "the model alone"
        )
    else:
        yield from _found_errors(predictor, standard)
    yield from _misfits(
        predictor, off, np.hypot(standard, 0.0 if model is None else model), freedom
    )
    if model is None:
        yield (
            f"how far law {predictor.law.family!r} is from finite elements is not known: the "
            "errors stated are those of the data alone"
        )
    low, high = search.limits(predictor)
    for one, value, least, largest in zip(predictor.parameters, at, low, high, strict=True):
        if not least * (1.0 + _AT_BOUND) < value < largest * (1.0 - _AT_BOUND):
            yield f"{one.name} is at an end of what is searched, {least:.3g} to {largest:.3g}"
    if any(one.is_strength for one in predictor.parameters):
        yielded = int(np.count_nonzero(np.asarray(hit.overload) > 1.0))
        yield f"{yielded} of {len(predictor.data)} rebounds are beyond yield and give the strength"
    friction = predictor.setting(at).friction
    if isinstance(hit, ObliqueRebound) and friction is not None:
        sliding = int(np.count_nonzero(np.asarray(hit.impulse_ratio) > _SLIDES * friction))
        yield f"{sliding} of {len(predictor.data)} rebounds slide all the time"
    flags = np.asarray(hit.flags)
    for flag, _ in count_flags(flags).items():
        (words,) = explain(flag)
        yield f"{flag.name}, rebounds {listed(np.flatnonzero(flags & flag))}: {words}"


def alternative_note(names: tuple[str, ...], values: Array) -> str:
    """Say that other values fit as well."""
    what = ", ".join(
        f"{name} {value:.4g} {UNKNOWNS[name].unit}".rstrip()
        for name, value in zip(names, values.tolist(), strict=False)
    )
    return (
        f"the data are fitted as well by {what}: the stated errors do not reach there. Measure "
        "another quantity or other speeds, or give a prior"
    )


def listed(rows: NDArray[np.intp]) -> str:
    """Write indices of rebounds; of three and more in a row only the ends.

    Examples
    --------
    >>> listed(np.array([0, 1, 2, 5, 7, 8]))
    '0 to 2, 5, 7, 8'
    """
    runs = np.split(rows, np.flatnonzero(np.diff(rows) != 1) + 1)
    parts = []
    for run in runs:
        parts += [f"{run[0]} to {run[-1]}"] if run.size > 2 else [str(row) for row in run]
    more = len(parts) - _LISTED
    return ", ".join(parts[:_LISTED]) + (f" and {more} more" if more > 0 else "")


def _found_errors(predictor: Predictor, standard: Array) -> Iterator[str]:
    values = predictor.values
    for n, name in enumerate(KINDS):
        of_kind = (values.kind == n) & np.isnan(values.error)
        if of_kind.any():
            share = float(standard[of_kind][0])
            yield (
                f"{name}: no errors were given; one of {percent(share)} was found from the "
                f"scatter of {np.count_nonzero(of_kind)} values"
            )


def _misfits(predictor: Predictor, off: Array, expected: Array, freedom: float) -> Iterator[str]:
    values = predictor.values
    given = np.isfinite(values.error)
    free = max(1, sum(one.prior is None for one in predictor.parameters))
    if np.count_nonzero(given) > free:
        ratio = float(np.sqrt(((off / expected)[given] ** 2).sum() / (given.sum() - free)))
        if ratio > _MISFIT:
            yield (
                f"the values are off by {rounded(ratio)} times what their errors and the model's "
                "allow: another number may be wrong, or the errors too small"
            )
    if freedom < 3.0:
        return
    for n in np.flatnonzero(np.abs(off) > _FAR * expected):
        name = list(KINDS)[values.kind[n]]
        sign = "+" if off[n] > 0.0 else ""
        yield (
            f"{name} of {predictor.data.rebound(values.row[n])} is {sign}{percent(off[n])} off the "
            f"fit, {rounded(abs(off[n]) / expected[n])} standard errors: a mistake?"
        )
