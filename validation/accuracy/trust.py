"""Scores of the laws beside finite elements, for people who simulate."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import contactlaw as cl
from validation.accuracy import acceptance
from validation.accuracy.acceptance import TARGETS, Errors, Member, Row, Target, within
from validation.fem import census

LAWS = "fem", "myc"
PAPER = TARGETS["paper"]
# No fit has seen these two sets.
EVERYDAY = TARGETS["kept out"]._replace(studies=("everyday_5", "kept_out"))
_WORDS = {"restitution": "COR"}


class Score(NamedTuple):
    """Accuracy of a law over some impacts, beside finite elements."""

    law: str
    impacts: int
    answered: int  # the law has an answer
    right: int  # within every bound
    shares: Errors  # share of the answered impacts within each bound
    rms: float  # error in COR [-]
    largest: float  # error in COR, with its sign [-]
    silent: int  # beyond a bound, without a flag of accuracy


def score(law: str, target: Target, chosen: Callable[[Member], bool] = lambda one: True) -> Score:
    """Hold a law to the bounds of one of `TARGETS`.

    Parameters
    ----------
    law : str
        Name of the law.
    target : Target
        Impacts, and their bounds.
    chosen : callable, optional
        Whether an impact counts; by default all do.

    Returns
    -------
    Score

    Raises
    ------
    ValueError
        If the law answers none of them.

    Examples
    --------
    >>> found = score("myc", PAPER, lambda one: one.study == "matrix")
    >>> found.impacts, round(found.largest, 3)
    (64, 0.046)
    """
    every = [one for one in acceptance.members(target) if chosen(one)]
    answered = tuple(one for one in acceptance.members(target, law) if chosen(one))
    if not answered:
        raise ValueError(f"law: got {law!r}, which answers none of the chosen impacts")
    row = Row(target, answered)
    return Score(
        law=law,
        impacts=len(every),
        answered=len(answered),
        right=sum(within(one.errors, row.target.bounds) for one in answered),
        shares=row.shares,
        rms=row.rms,
        largest=max((one.errors.restitution for one in answered), key=abs),
        silent=len(row.silent),
    )


def overall() -> dict[str, list[Score]]:
    """Scores of both laws on each set of impacts.

    Examples
    --------
    >>> [[found.impacts for found in scores] for scores in overall().values()]
    [[160, 160], [64, 64], [48, 48]]
    """
    sets: dict[str, tuple[Target, Callable[[Member], bool]]] = {
        "everyday impacts, kept out of the fit": (EVERYDAY, lambda one: True),
        "the paper's pair, gamma-alumina on glass": (PAPER, lambda one: one.study == "matrix"),
        "steel, and alumina of other strengths": (PAPER, lambda one: one.study != "matrix"),
    }
    return {title: [score(law, *chosen) for law in LAWS] for title, chosen in sets.items()}


def where() -> dict[str, list[Score]]:
    """Scores of both laws on parts of the everyday impacts.

    Examples
    --------
    >>> sum(fem.impacts for fem, _ in list(where().values())[:3])
    160
    """
    parts: dict[str, Callable[[Member], bool]] = {
        "plate thinner than the bead's radius": lambda one: one.slenderness > 1.0,
        "1 to 3 radii thick": lambda one: 1.0 / 3.0 < one.slenderness <= 1.0,
        "3 to 10 radii thick": lambda one: one.slenderness <= 1.0 / 3.0,
        "0.5 to 1.5 m/s": lambda one: one.speed <= 1.5,
        "1.5 to 4 m/s": lambda one: 1.5 < one.speed <= 4.0,
        "4 to 10 m/s": lambda one: one.speed > 4.0,
        "neither body yields": lambda one: one.yielding == "none",
        "the bead yields": lambda one: one.yielding == "sphere",
        "the plate yields": lambda one: one.yielding == "plate",
        "both yield": lambda one: one.yielding == "both",
    }
    return {title: [score(law, EVERYDAY, part) for law in LAWS] for title, part in parts.items()}


def materials() -> dict[str, list[Score]]:
    """Scores on the everyday impacts by the kinds of bead and plate, of laws that answer.

    Examples
    --------
    >>> sum(fem.impacts for fem, *_ in materials().values())
    160
    """
    found: dict[str, list[Score]] = {}
    for bead in ("metal", "ceramic", "glass"):
        for plate in ("metal", "ceramic", "glass"):

            def chosen(one: Member, kinds: tuple[str, str] = (bead, plate)) -> bool:
                return (cl.material(one.sphere).kind, cl.material(one.plate).kind) == kinds

            answered = [law for law in LAWS if any(map(chosen, acceptance.members(EVERYDAY, law)))]
            if answered:
                found[f"{bead} on {plate}"] = [score(law, EVERYDAY, chosen) for law in answered]
    return found


class Miss(NamedTuple):
    """An everyday impact beyond a bound of law fem."""

    what: str  # bead, plate, speed, thickness
    fem: float  # COR by finite elements
    law: float  # COR by the law
    beyond: dict[str, float]  # error of each number that is beyond its bound [-]


def misses() -> list[Miss]:
    """List everyday impacts beyond a bound.

    Examples
    --------
    >>> all(one.beyond for one in misses())
    True
    """
    row = Row(EVERYDAY, acceptance.members(EVERYDAY))
    found = []
    for one in row.beyond:
        numbers = zip(Errors._fields, one.errors, row.target.bounds, strict=True)
        beyond = {
            _WORDS.get(name, name.replace("_", " ")): error for name, error, bound in numbers if abs(error) > bound
        }
        thickness = 1e3 * census.RADIUS / one.slenderness  # [mm]
        what = f"{one.sphere} on {thickness:.2g} mm of {one.plate} at {one.speed:.2g} m/s"
        found.append(Miss(what, one.fem, one.law, beyond))
    return found
