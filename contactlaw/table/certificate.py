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
from contactlaw.table.grid import Grid
from contactlaw.table.lookup import STRETCH

BOUNDS = {name: one.error for name, one in FIELDS.items() if one.error} | {"force_history": 1e-3}
"""Promised errors: absolute for COR and shares, relative to the largest value for the other fields."""

RATED, CORNERED = 1e-4, 1.5e-4
"""Promised error of COR for a pair with a rate of strain, and for a law whose slope jumps."""

_FINER = 0.1  # tolerance of the solver beside that of the nodes
_RETURNING = 1e-6  # least COR at which contact times are compared
_SMALL_DENT = 0.01  # of the largest residual compression, above which errors of it are relative
_SAMPLES = 33  # samples of a force history that are compared
_HISTORIES = 1000  # at most so many histories are compared
_AT_ENDS = 0.05  # share of the points with lambda = 0, and of those with the largest
_NEAR_KINK = 0.01  # of a block of columns; some of the points lie this near to yield, on either side
_CORNER = 1e-3  # jump of a loading curve's slope, relatively, that makes outcomes less smooth


def bounds(law: Law) -> dict[str, float]:
    """Promised errors of a table of this law."""
    cor = BOUNDS["restitution"] if law.strengths is None else RATED
    return BOUNDS | {"restitution": CORNERED if _has_corners(law) else cor}


def _has_corners(law: Law) -> bool:
    """Whether the slope of the loading curve jumps beyond yield."""
    roots = [math.sqrt(kink) for kink in law.loading_kinks if kink > 1.0]
    rises = (np.diff([law.loading(q * near) for near in (1.0 - 1e-6, 1.0, 1.0 + 1e-6)]) for q in roots)
    return any(abs(after - before) > _CORNER * before for before, after in rises)


@dataclass(frozen=True)
class Certificate:
    """How far lookups are from the solver, at random points off the grid.

    Errors of COR and of shares of the energy are absolute, those of force histories (the largest at
    any time) relative to the peak force, those of the other fields relative to their largest value in
    the table; but residual compressions above 1 % of that have relative errors. Contact times are
    compared where COR is at least 1e-6: the contact of a sphere that stays has no end.

    Parameters
    ----------
    points, seed : int
        Number of points and seed of their generator.
    largest : dict of str to float
        Largest error of each field.
    """

    points: int
    seed: int
    largest: dict[str, float]


def measured(law: Law, rtol: float, packed: Array, histories: Array | None, points: int, seed: int) -> Certificate:
    """Compare a table with the solver at random points."""
    if not 100 <= points <= 10_000_000:
        raise ArgumentError("points", points, "at least 100 and at most 10 000 000 are taken")
    numbers, rtol = random_points(Grid.of(packed), points, np.random.default_rng(seed)), _FINER * rtol
    looked, exact = outcome.at(*numbers), outcome.at(*numbers)
    sweep.solve(law, exact, rtol, lambda part: part)
    lookup.fields(packed, True, looked)  # rounding may put points at the border outside
    errors, ours = {}, _named(law, looked, True)
    for name, values in _named(law, exact, False).items():
        scale = 1.0 if name == "restitution" or "fraction" in name else np.abs(values).max()
        if name == "residual_compression":
            scale = np.maximum(np.abs(values), max(_SMALL_DENT * scale, 1e-12))
        errors[name] = np.abs(ours[name] - values) / scale
    errors["contact_time"][exact.restitution < _RETURNING] = 0.0
    if histories is not None:
        some = outcome.part(looked, slice(None, None, -(-points // _HISTORIES)))
        sampled, solved = (outcome.history(some.contact_time, _SAMPLES) for _ in range(2))
        shapes.sample(law.at_any_strength, histories, some, sampled)
        zener.histories(law.at_any_strength, some, rtol, solved)
        errors["force_history"] = np.abs(sampled.force - solved.force).max(axis=1) / solved.force.max(axis=1)
    return Certificate(points, seed, {name: float(one.max()) for name, one in errors.items()})


def random_points(grid: Grid, count: int, generator: np.random.Generator) -> tuple[Array, Array, Array]:
    """Draw inelasticities, yield ratios and ln k: some on the half-space, near yield, and below it."""
    axes, u = grid.axes, generator.random((4, count))
    # uniform in the root: COR changes most where lambda is small
    root = np.clip((1.0 + 2.0 * _AT_ENDS) * u[0] - _AT_ENDS, 0.0, 1.0)
    lam = root**2 * (STRETCH * axes.x_max / (1.0 - axes.x_max))
    log_k = np.sort(u[1]) * math.log(grid.rungs[-1, 0])
    rung = np.array([np.interp(np.exp(log_k), grid.rungs[:, 0], column) for column in grid.rungs.T])
    kinds = [u[2] < 0.2, u[2] < 0.4, u[2] < 0.4 + 0.1 * (axes.after > 0.0)]
    t = np.select(kinds, [u[3], 1.0 + _NEAR_KINK * (2.0 * u[3] - 1.0), 2.0 + u[3]], 1.0 + u[3])
    return lam, grid.yield_ratios(lam / (lam + STRETCH), t, rung), log_k


def _named(law: Law, values: Outcome, balanced: bool) -> dict[str, Array]:
    """Fields of `BOUNDS` from an outcome, computed as in `contactlaw.physical.rebound`."""
    found = outcome.extremes(values.restitution.size)
    zener.extremes(law.at_any_strength, values, found)
    compression = values.compression_ratio * values.elastic_compression
    shares = np.array([found.plastic_fraction, values.inelasticity * values.wave_rate, found.other_fraction])
    if balanced:
        shares *= outcome.balance(values.restitution, shares.sum(axis=0))
    fields = values.restitution, values.contact_time, found.peak_force, compression, found.residual_compression, *shares
    return dict(zip(BOUNDS, fields, strict=False))
