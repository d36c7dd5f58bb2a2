"""One COR for each wall of a machine, one per thickness, as text or CSV."""

import csv
from collections import Counter
from collections.abc import Iterator
from typing import Any, NamedTuple, TextIO

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._escaped import cell
from contactlaw._readable import relative
from contactlaw.answers.constant import Constant, Keep
from contactlaw.cli.constant.records import Recorded
from contactlaw.cli.parts import wording
from contactlaw.cli.parts.impacts import aligned, explained
from contactlaw.model import ImpactModel

_MOST = 100  # walls of different thickness; in an engine, each takes a type of its own


class Wall(NamedTuple):
    """A wall, its impacts with speeds [m/s], radii [m] and weights [-], and one COR for all."""

    thickness: float
    speed: Array
    radius: Array
    weights: Array
    best: Constant


def walls(model: ImpactModel, recorded: Recorded, keep: Keep) -> list[Wall]:
    """Find one COR for all impacts on plates of one thickness; walls are sorted by it."""
    plates = np.unique(recorded.thickness)
    if plates.size > _MOST:
        reason = f"{plates.size} different ones, {_MOST} is the most: round them to those of walls"
        raise ArgumentError("thickness", None, reason)
    found = []
    for plate in plates:
        on_it = recorded.thickness == plate
        v, r, _, w = (column[on_it] for column in recorded[:4])
        mass = None if recorded.mass is None else recorded.mass[on_it]
        with wording.naming_impact(v, r, plate):
            found.append(Wall(float(plate), v, r, w, model.constant(v, r, plate, keep, w, mass)))
    return found


def meaning(keep: Keep) -> str:
    """Explain the columns beside a constant."""
    return (
        f"COR keeps the {keep} that the wall takes in all. energy: relative error of the "
        "dissipated energy with it, and with the plain mean of the CORs. rebound: 95 of 100 "
        "impacts rebound to a height that is within this share of their own."
    )


def text(found: list[Wall], keep: Keep) -> Iterator[str]:
    """Lines for a terminal: a row per wall with its COR and errors, and what these mean."""
    best = [wall.best for wall in found]
    yield from aligned(
        [
            ["thickness", "[mm]", *(f"{1e3 * wall.thickness:g}" for wall in found)],
            ["impacts", "[-]", *(f"{one.impacts}" for one in best)],
            ["COR", "[-]", *(f"{one.restitution:.4f}" for one in best)],
            ["spread", "[-]", *(f"{one.spread:.4f}" for one in best)],
            ["energy", "[%]", *(relative(one.energy_error, "z.2%")[:-1] for one in best)],
            ["rebound", "[%]", *(relative(one.rebound_error)[:-1] for one in best)],
            ["mean", "[-]", *(f"{one.mean:.4f}" for one in best)],
            ["energy", "[%]", *(relative(one.mean_energy_error, "z.2%")[:-1] for one in best)],
            ["flags", "", *(", ".join(str(flag.name) for flag in one.flags) for one in best)],
        ]
    )
    yield ""
    yield meaning(keep)
    flags = sum((Counter(one.flags) for one in best), Counter())
    yield from explained(flags, sum(one.impacts for one in best))


def write_csv(found: list[Wall], keep: Keep, out: TextIO, asked: dict[str, Any], head: bool = True) -> None:
    """Write a row per wall with every digit; flags are NAME:impacts, with bars between them."""
    writer = csv.writer(out, lineterminator="\n")
    errors = ("energy_error", "rebound_error", "mean", "mean_energy_error")
    numbers = ("restitution", "spread", *errors)
    if head:
        writer.writerow(["thickness_m", "impacts", "keep", *numbers, *asked, "flags"])
    for wall in found:
        flags = "|".join(f"{flag.name}:{count}" for flag, count in wall.best.flags.items())
        values = (getattr(wall.best, name) for name in numbers)
        said = map(cell, asked.values())
        writer.writerow([wall.thickness, wall.best.impacts, keep, *values, *said, flags])
