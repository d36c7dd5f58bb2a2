"""What `contactlaw.fit` finds from single impacts by finite elements that no fit has seen.

Of each impact one number is taken for unknown, and found from its COR alone, from its contact time
alone, or from COR, contact time and peak force together. The finite elements are right to about
0.5 %, which is what their values are given for errors.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

import contactlaw as cl
from contactlaw import Validity
from contactlaw.fitting.measurements import KINDS
from validation.inverse.model import Impact, unseen

_ERROR = 0.005  # of finite elements; half the mean difference of two meshes
BY = {"COR": ("restitution",), "contact time": ("contact_time",), "all three": tuple(KINDS)}
SLENDERNESS = {
    "R/H above 1.4": (1.4, math.inf), "R/H 0.9 to 1.2": (0.9, 1.2),
    "R/H 0.5 to 0.9": (0.5, 0.9), "R/H below 0.5": (0.0, 0.5),
}  # fmt: skip


class Found(NamedTuple):
    """One impact: how far off a number was, and how far it was said to be; both relative."""

    slenderness: float
    off: float
    error: float
    flagged: bool


class Score(NamedTuple):
    """What became of some impacts."""

    answered: int
    median: float  # |off|
    within: tuple[float, float]  # shares within 2 and 5 %
    covered: tuple[float, float]  # shares within one and two standard errors
    largest: float


def score(found: list[Found]) -> Score:
    """Count.

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
    """Find a number from each impact, and count those of which the fit says that it cannot.

    Parameters
    ----------
    unknown : {"thickness", "yield_strength"}
        The strength is that of the weaker body, where it has yielded.
    kinds : tuple of str
        What is taken for measured.
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


def one_found(
    one: Impact, name: str, true: float, kinds: tuple[str, ...], law: str = "fem"
) -> Found:
    """Find a number from one impact.

    Raises
    ------
    UnidentifiedError
        If its values do not tell it.
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
    """Name and true value of what is asked for; no name where it cannot be asked."""
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
    lines = [f"{title}; {refused} refused as not told by the data"]
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
    """Strengths and thicknesses, by what is taken for measured."""
    lines = [_HEAD]
    for unknown in ("yield_strength", "thickness"):
        for by in ("COR", "all three"):
            lines += _lines(f"{unknown} from {by}", *found(unknown, BY[by]))
    return "\n".join(lines)


def contact_time() -> str:
    """Thickness from contact times: by law fem, and by Zener's equation as others take it.

    Law "hertz" integrates Zener's own equation, to which Tsai's formula is an approximation; the
    formula itself could not be had. Elastic impacts alone, for which it is meant.
    """
    lines = [_HEAD]
    for law in ("fem", "hertz"):
        lines += _lines(
            f"thickness from contact time, law {law}", *found("thickness", BY["contact time"], law)
        )
    return "\n".join(lines)
