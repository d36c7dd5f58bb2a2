"""Fits of `contactlaw.fit` to single impacts by finite elements that no law was fitted to.

One number of each impact is taken as unknown, and fitted to its COR alone, to its contact time
alone, or to COR, contact time and peak force together. The stated error of these values is 0.5 %,
about that of the finite elements.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

import contactlaw as cl
from contactlaw import Validity
from contactlaw.fitting.measurements import NORMAL
from validation.inverse.model import Impact, unseen

_ERROR = 0.005  # relative error of finite elements: half the mean difference of two meshes
BY = {"COR": ("restitution",), "contact time": ("contact_time",), "all three": tuple(NORMAL)}
SLENDERNESS = {
    "R/H above 1.4": (1.4, math.inf),
    "R/H 0.9 to 1.2": (0.9, 1.2),
    "R/H 0.5 to 0.9": (0.5, 0.9),
    "R/H below 0.5": (0.0, 0.5),
}


class Found(NamedTuple):
    """The fit to one impact: its error `off` and its stated `error`, both relative."""

    slenderness: float
    off: float
    error: float
    flagged: bool


class Score(NamedTuple):
    """Accuracy of the fits to some impacts."""

    answered: int
    median: float  # |off|
    within: tuple[float, float]  # shares within 2 and 5 %
    covered: tuple[float, float]  # shares within one and two standard errors
    largest: float


def score(found: list[Found]) -> Score:
    """Summarise the fits to some impacts.

    Examples
    --------
    >>> score([Found(1.0, 0.01, 0.02, False), Found(1.0, -0.03, 0.02, False)]).covered
    (0.5, 1.0)
    """
    off, error = (np.array([getattr(one, name) for one in found]) for name in ("off", "error"))
    size = np.abs(off)
    return Score(
        len(found),
        float(np.median(size)),
        (float(np.mean(size < 0.02)), float(np.mean(size < 0.05))),
        (float(np.mean(size < error)), float(np.mean(size < 2.0 * error))),
        float(size.max()),
    )


def found(unknown: str, kinds: tuple[str, ...], law: str = "fem") -> tuple[list[Found], int]:
    """Fit a number to each impact, and count the impacts that the fit refuses.

    Parameters
    ----------
    unknown : {"thickness", "yield_strength"}
        The strength is that of the weaker body, where it has yielded.
    kinds : tuple of str
        Values that are taken as measured.
    law : str, optional
        Name of the law.

    Returns
    -------
    list of Found
    int
    """
    answers, refused = [], 0
    for one in unseen():
        name, true = asked(unknown, one)
        if not name:
            continue
        try:
            answers.append(one_found(one, name, true, kinds, law))
        except cl.UnidentifiedError:
            refused += 1
    return answers, refused


def one_found(one: Impact, name: str, true: float, kinds: tuple[str, ...], law: str = "fem") -> Found:
    """Fit a number to one impact.

    Raises
    ------
    UnidentifiedError
        If the number does not follow from the values.
    """
    data = {"speed": one.speed, "radius": one.radius}
    if name != "thickness":
        data["thickness"] = one.thickness
    data |= {kind: one.values[kind] for kind in kinds}
    data |= {f"{kind}_error": _ERROR * one.values[kind] for kind in kinds}
    fit = cl.fit(one.pair, data, name, law)
    flagged = bool(fit.flags[0] & Validity.ACCURACY)
    off, error = fit.values[name] / true - 1.0, fit.errors[name] / true
    return Found(one.slenderness, off, error, flagged)


def asked(unknown: str, one: Impact) -> tuple[str, float]:
    """Name and true value of the unknown; no name where the impact does not depend on it."""
    if unknown == "thickness":
        return unknown, one.thickness
    sphere, plate = (body.yield_strength or math.inf for body in (one.pair.sphere, one.pair.plate))
    if not one.yields or min(sphere, plate) == math.inf:
        return "", math.nan
    return ("yield_strength", sphere) if sphere <= plate else ("plate_yield_strength", plate)


def _line(title: str, some: list[Found]) -> str:
    if not some:
        return f"  {title:28s} none"
    got = score(some)
    return (
        f"  {title:28s} {got.answered:4d} {100 * got.median:8.2f} {100 * got.within[0]:6.0f} "
        f"{100 * got.within[1]:6.0f} {100 * got.largest:8.1f} {100 * got.covered[0]:8.0f} "
        f"{100 * got.covered[1]:6.0f}"
    )


def _lines(title: str, answers: list[Found], refused: int) -> list[str]:
    lines = [f"{title}; {refused} refused as not identified by the data"]
    lines.append(_line("all", answers))
    lines.append(_line("without a flag of accuracy", [one for one in answers if not one.flagged]))
    for part, (low, high) in SLENDERNESS.items():
        chosen = [one for one in answers if low <= one.slenderness < high]
        lines.append(_line(part, [one for one in chosen if not one.flagged]))
    return lines


_HEAD = (
    f"  {'':28s} {'':4s} {'median':>8s} {'< 2 %':>6s} {'< 5 %':>6s} {'largest':>8s} "
    f"{'in 1 se':>8s} {'in 2':>6s}   [%]; by R/H those without a flag"
)


def report() -> str:
    """Write the fits of strength and thickness, by the values taken as measured."""
    lines = [_HEAD]
    for unknown in ("yield_strength", "thickness"):
        for by in ("COR", "all three"):
            lines += _lines(f"{unknown} from {by}", *found(unknown, BY[by]))
    return "\n".join(lines)


def contact_time() -> str:
    """Write the fits of thickness to contact times, by the laws fem and hertz.

    Law "hertz" integrates Zener's equation for elastic impacts, which Tsai's formula approximates.
    """
    lines = [_HEAD]
    for law in ("fem", "hertz"):
        lines += _lines(f"thickness from contact time, law {law}", *found("thickness", BY["contact time"], law))
    return "\n".join(lines)
