"""How far a table is from the solver, at random places off the grid."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.equation import outcome, zener
from contactlaw.equation.outcome import FIELDS, Outcome
from contactlaw.laws import Law
from contactlaw.table import lookup, shapes, sweep
from contactlaw.table.axes import TableGrid
from contactlaw.table.grid import RANGES, Settings
from contactlaw.table.shapes import Shapes
from contactlaw.table.sweep import Progress

BOUNDS = {name: one.error for name, one in FIELDS.items() if one.error} | {"force_history": 1e-4}
"""Promised errors: absolute for COR, relative to the peak for force histories, else relative."""

PAIR_BOUNDS = {n: FIELDS[n].of_pair for n in BOUNDS if n in FIELDS} | {"force_history": 3e-3}
"""Promised errors of tables built for one pair: they are coarser, so that they are made soon."""


def bounds(law: Law) -> dict[str, float]:
    """Promised errors of a table of this law."""
    return BOUNDS if math.isinf(law.range[1]) else PAIR_BOUNDS


# Residual compression and plastic share start from 0 at chi = 1 as (chi - 1)^2, where rounding of
# chi alone makes any relative error. Smaller values (chi - 1 < 2e-6) have errors relative to this.
_SMALLEST = 1e-12
_RETURNING = 1e-6  # least COR at which contact times are compared
_PART = 500  # points that a thread solves at a time
_SAMPLES = 33  # samples of a force history that are compared
_NEAR_KINK = 0.01  # in ln chi; some of the points lie this near to a kink, on either side
_HALF_SPACE = 0.1  # share of the points with lambda = 0


@dataclass(frozen=True)
class Certificate:
    """How far lookups are from the solver, at random points off the grid.

    Errors of COR are absolute, those of force histories (the largest at any time) relative to the
    peak force, those of the other fields relative. Contact times are compared where COR is at least
    1e-6: the contact of a sphere that stays has no end.

    Parameters
    ----------
    points, seed : int
        Number of points and seed of their generator.
    median, percentile_99, largest : dict of str to float
        Errors, by field.
    """

    points: int
    seed: int
    median: dict[str, float]
    percentile_99: dict[str, float]
    largest: dict[str, float]

    @classmethod
    def of(cls, errors: dict[str, Array], points: int, seed: int) -> Certificate:
        """Summarise errors."""
        return cls(
            points=points,
            seed=seed,
            median={name: float(np.median(e)) for name, e in errors.items()},
            percentile_99={name: float(np.percentile(e, 99)) for name, e in errors.items()},
            largest={name: float(np.max(e)) for name, e in errors.items()},
        )

    def exceeded(self, bounds: dict[str, float] = BOUNDS) -> dict[str, float]:
        """Largest errors above the bound of their field."""
        return {name: e for name, e in self.largest.items() if not e <= bounds[name]}


def compare_outcomes(
    law: Law, settings: Settings, grid: TableGrid, packed: Array, points: int, seed: int, progress: Progress
) -> tuple[Outcome, dict[str, Array]]:
    """Outcomes that are looked up at random points, and their errors by field."""
    if not 100 <= points <= 10_000_000:
        raise ArgumentError("points", points, "at least 100 and at most 10 000 000 are taken")
    if seed < 0:
        raise ArgumentError("seed", seed, "must not be negative")
    lam, log_chi, strength = random_points(grid, points, np.random.default_rng(seed))
    chi, parts = np.exp(grid.own(lam, log_chi, strength)), -(-lam.size // _PART)
    exact = sweep.solve_overloads(law, lam, chi, strength, _finer(settings), parts, progress)
    looked = outcome.at(exact.inelasticity, exact.yield_ratio, strength)
    lookup.fields(packed, True, looked)
    errors = {}
    both = (_named(law, values) for values in (looked, exact))
    for (name, ours), (_, truth) in zip(*(values.items() for values in both), strict=True):
        scale = 1.0 if name == "restitution" else np.maximum(np.abs(truth), _SMALLEST)
        errors[name] = np.abs(ours - truth) / scale
    errors["contact_time"][exact.restitution < _RETURNING] = 0.0
    return looked, errors


def compare_histories(law: Law, settings: Settings, packed: Shapes, looked: Outcome) -> Array:
    """Errors of the force histories of outcomes that were looked up."""
    ours, exact = (outcome.history(looked.restitution.size, _SAMPLES) for _ in range(2))
    data = law.at_any_strength
    shapes.sample(data, packed, looked, ours)
    lam, y, s, rtol = looked.inelasticity, looked.yield_ratio, looked.strength, _finer(settings)

    def solve(part: slice) -> None:
        known = lam[part], y[part], rtol, ours.time[part]
        exact.force[part], _, _ = zener.history(data, *known, strength=s[part])

    sweep.in_parts(solve, lam.size, -(-lam.size // _PART), sweep.no_progress)
    return np.asarray(np.abs(ours.force - exact.force).max(axis=1) / exact.force.max(axis=1))


def _finer(settings: Settings) -> float:
    return max(settings.rtol / 10, RANGES["rtol"][0])


def random_points(grid: TableGrid, count: int, generator: np.random.Generator) -> tuple[Array, Array, Array]:
    """Draw points of the grid's axes; a curved kink counts at its least and its largest chi.

    Without a third axis ln k is 0.
    """
    inelasticity, overload, *strength = grid.axes
    lows = [float(segment.start.min()) for segment in overload.segments]
    highs = [float(segment.start.max()) for segment in overload.segments]
    hertz = lows[0] == 0.0  # such a table begins at yield and serves slower impacts, too
    strata = [(-2.0, 0.0)] * hertz + [*zip(lows, [*highs[1:], overload.largest], strict=True)]
    strata += [(low - _NEAR_KINK, low) for low in lows[not hertz :]]
    strata += [(high, high + _NEAR_KINK) for high in highs]
    share = -(-count // len(strata))
    log_chi = np.concatenate([generator.uniform(low, high, share) for low, high in strata])
    # uniform in the root: COR changes most where lambda is small
    root = generator.uniform(0.0, math.sqrt(inelasticity.largest), log_chi.size)
    root[generator.random(log_chi.size) < _HALF_SPACE] = 0.0
    most = strength[0].largest if strength else 0.0
    return root**2, log_chi, generator.uniform(0.0, most, log_chi.size)


def _named(law: Law, values: Outcome) -> dict[str, Array]:
    """Fields of `BOUNDS` from an outcome, computed as in `contactlaw.physical.rebound`."""
    compression = values.compression_ratio * values.elastic_compression
    extremes = outcome.extremes(compression.size)
    zener.extremes(law.at_any_strength, values, extremes)
    return {
        "restitution": values.restitution,
        "contact_time": values.contact_time,
        "peak_compression": compression,
        "wave_fraction": values.inelasticity * values.wave_rate,
        **extremes._asdict(),
    }
