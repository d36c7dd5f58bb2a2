"""The everyday pairs: how many impacts a law answers, and how many of its answers carry a flag.

Metals, ceramics and glasses of the catalogue fall on each other, as `validation.fem.census` says;
speed and thickness are drawn anew for each pair.
"""

from __future__ import annotations

import itertools
import math
import time
import warnings
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

import contactlaw as cl
from contactlaw import Validity
from contactlaw.laws import Law
from contactlaw.table import file
from contactlaw.table.grid import Settings, on_demand
from validation.bench.row import Row
from validation.fem import census

Array = NDArray[np.float64]
Flags = NDArray[np.int64]

_SEED = 7  # differs from those in `validation.fem.census.SEEDS`
_LAWS = "fem", "myc"
_EACH = 100  # impacts per pair
_MOST_FLAGGED, _MOST_FLAGGED_OF_ALL = 10.0, 8.0  # %


class Census(NamedTuple):
    """Shares of all impacts [-]; one may count in several, `inside` counts those in no other."""

    impacts: int
    refused: float  # the law has no model of the pair
    outside: float  # beyond the end of the table of the pair
    inaccurate: float  # with a flag of `Validity.ACCURACY` other than CLAMPED
    damaging: float  # with `Validity.DAMAGE`
    inside: float
    flags: dict[Validity, float]  # share of each flag of accuracy that occurs
    warned: int  # pairs whose table is less accurate than it has to be

    @property
    def flagged(self) -> str:
        """Flags with their shares [%], in words."""
        return ", ".join(f"{flag.name} {100 * share:.2g}" for flag, share in self.flags.items())


def everything() -> list[tuple[str, str]]:
    """Pairs of all metals, ceramics and glasses that the catalogue has now."""
    return list(itertools.permutations((one for one in cl.materials() if cl.material(one).kind != "polymer"), 2))


def draw(pairs: int, each: int) -> tuple[Array, Array]:
    """Speeds [m/s] and thicknesses [m]: a row of each for every pair."""
    generator = np.random.default_rng(_SEED)

    def drawn(low: float, high: float) -> Array:
        return np.exp(generator.uniform(math.log(low), math.log(high), (pairs, each)))

    return drawn(*census.SPEED), drawn(*census.THICKNESS)


def count(
    law: str, each: int = _EACH, tables: bool = True, pairs: Callable[[], list[tuple[str, str]]] = census.pairs
) -> Census:
    """Count what a law answers and flags, pair by pair.

    Parameters
    ----------
    law : str
        Name of the law.
    each : int, optional
        Impacts per pair.
    tables : bool, optional
        Whether to look up, which builds all tables, or to integrate, which needs their extent.
    pairs : callable, optional
        List of the pairs.

    Returns
    -------
    Census
    """
    found, refused = [], 0
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        listed = pairs()
        drawn = zip(listed, *draw(len(listed), each), strict=True)
        for (sphere, plate), speed, thickness in tqdm(drawn, law, len(listed), disable=None, leave=False):
            pair = cl.Pair(sphere, plate)
            try:
                answer = _looked_up if tables else _integrated
                found.append(answer(pair, law, speed, thickness))
            except (ValueError, RuntimeError):  # the pair has no such law, or no table
                refused += each
    flags = np.concatenate([np.empty(0, dtype=np.int64), *found])
    total = flags.size + refused
    accuracy = Validity.ACCURACY & ~Validity.CLAMPED

    def share(some: int) -> float:
        return float(np.count_nonzero(flags & int(some)) / total)

    return Census(
        impacts=total,
        refused=refused / total,
        outside=share(Validity.CLAMPED),
        inaccurate=share(accuracy),
        damaging=share(Validity.DAMAGE),
        inside=1.0 - refused / total - share(Validity.ACCURACY | Validity.DAMAGE),
        flags={flag: share(flag) for flag in Validity if flag in accuracy and share(flag)},
        warned=sum("less accurate" in str(one.message) for one in warned),
    )


def _looked_up(pair: cl.Pair, law: str, speed: Array, thickness: Array) -> Flags:
    model = cl.ImpactModel(pair, law=law, outside="clamp")
    return np.asarray(model.lookup(speed, census.RADIUS, thickness).flags)


def _integrated(pair: cl.Pair, law: str, speed: Array, thickness: Array) -> Flags:
    model = cl.ImpactModel(pair, law=law)
    hit = model.solve(speed, census.RADIUS, thickness)
    extent = settings(model.force_law)
    outside = np.asarray(hit.inelasticity) > extent.largest_inelasticity
    outside |= np.asarray(hit.overload) > extent.largest_overload
    flags = np.array(hit.flags, dtype=np.int64)
    flags[outside] |= int(Validity.CLAMPED)
    return flags


def settings(law: Law) -> Settings:
    """Give the settings of the table of a law, packaged or built on demand."""
    packaged = file.packaged(law)
    return on_demand(law) if packaged is None else packaged.settings


def rows() -> Iterator[Row]:
    """Count for the laws fem and myc, and for fem of all materials of the catalogue."""
    found = count("fem", each=24, tables=False, pairs=everything)
    # At most 8 % was wanted. FROM_HARDNESS needs strengths of shot and balls, which no source states.
    yield Row("fem: flagged, all materials", 100 * found.inaccurate, "%", _MOST_FLAGGED_OF_ALL, note=found.flagged)
    for name in _LAWS:
        start = time.perf_counter()
        found = count(name)
        taken = time.perf_counter() - start
        made = name == "fem"
        none = 0.0 if made else None
        yield Row(
            f"{name}: everyday impacts refused",
            100 * found.refused,
            "%",
            none,
            note=f"of {found.impacts}; {found.warned} tables too coarse; {taken:.0f} s",
        )
        yield Row(f"{name}: outside the table", 100 * found.outside, "%", none)
        most = _MOST_FLAGGED if made else None
        yield Row(f"{name}: flagged on accuracy", 100 * found.inaccurate, "%", most, note=found.flagged)
        yield Row(f"{name}: flagged on damage", 100 * found.damaging, "%")
        yield Row(f"{name}: inside all limits", 100 * found.inside, "%")
