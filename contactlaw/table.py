"""The table of one contact law: solve the equation at every node, and certify the result.

Axes: the inelasticity lambda, and ln chi, the logarithm of the overload. Nodes are uniform in
x = lambda/(lambda + c) and, between two kinks of the law, in ln chi; a kink is a node twice, once
as the end of a segment and once as the beginning of the next. See `contactlaw.lookup`. Shapes of
force histories have a coarser grid of the same kind, see `contactlaw.shapes`.
"""

from __future__ import annotations

import dataclasses
import functools
import math
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactlaw import lookup, packing, shapes, zener
from contactlaw.laws import Law
from contactlaw.laws import law as find_law

Array = NDArray[np.float64]
Progress = Callable[[Iterator[Array], int], Iterable[Array]]

FIELDS = {
    "restitution": "rebound speed over impact speed [-]",
    "contact_time": "time from touch to separation [T_H]",
    "wave_rate": "share of the initial energy in the bending wave, over lambda [-]",
    "compression_ratio": "largest compression over the elastic one, d_m/(chi d_Y) [-]",
}


# The bounds of a certificate: COR absolutely, a force history by its peak, the others relatively.
BOUNDS = {
    "restitution": 1e-6,
    "contact_time": 1e-5,
    "peak_force": 1e-5,
    "peak_compression": 1e-5,
    "residual_compression": 1e-5,
    "plastic_fraction": 1e-5,
    "wave_fraction": 1e-5,
    "force_history": 1e-4,
}
# Residual compression and plastic share start from 0 at chi = 1 as (chi - 1)^2: no number of digits
# of chi gives them relatively there. Below this they count absolutely (chi - 1 < 2e-6).
_SMALLEST = 1e-12
_PART = 1000  # points of a certificate that a thread solves at a time, 0.1 s
_SAMPLES = 33  # of a force history that is compared
_NEAR_KINK = 0.01  # in ln chi; a share of the certificate's points lies this near on either side


@dataclass(frozen=True)
class Certificate:
    """How far lookups are from the solver, at random points off the grid.

    Errors of COR are absolute, those of force histories (the largest at any time) in terms of the
    peak force, those of the other fields relative.

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

    @property
    def exceeded(self) -> dict[str, float]:
        """Largest errors above the bound of their field."""
        return {name: e for name, e in self.largest.items() if not e <= BOUNDS[name]}


@dataclass(frozen=True)
class Settings:
    """Extent and fineness of a table; the defaults are those of the packaged one.

    Parameters
    ----------
    largest_inelasticity : float
        Largest lambda.
    largest_overload : float
        Largest chi. 40 is what V0 = 100 V_Y0 reaches on a half-space, and less on any plate.
    inelasticity_nodes : int
        Nodes along lambda.
    log_overload_step : float
        Largest distance of two nodes in ln chi.
    elastic_nodes : int
        Chebyshev nodes along lambda of the one-dimensional w_m(lambda).
    stretch : float
        c in x = lambda/(lambda + c), in which the nodes along lambda are uniform.
    rtol : float
        Tolerance of the solver at each node.
    """

    largest_inelasticity: float = 5.0
    largest_overload: float = 40.0
    inelasticity_nodes: int = 81
    log_overload_step: float = 0.02
    elastic_nodes: int = 48
    stretch: float = 2.0
    rtol: float = 1e-12

    def __post_init__(self) -> None:
        for name, (low, high) in _RANGES.items():
            value = getattr(self, name)
            if not low <= value <= high:
                raise ValueError(f"{name}: must lie between {low:g} and {high:g}, got {value!r}")


_RANGES = {
    "largest_inelasticity": (1e-3, 10.0),  # 10: COR is 7e-6 there
    "largest_overload": (1.1, 1e6),
    "inelasticity_nodes": (5, 100_000),  # 5: not-a-knot ends
    "log_overload_step": (1e-4, 1.0),
    "elastic_nodes": (24, 1000),  # 24: enough for a polynomial of degree 20
    "stretch": (1e-3, 1e3),
    "rtol": (1e-13, 1e-4),
}


@dataclass(frozen=True, eq=False)
class Table:
    """Values at the nodes, as they are stored."""

    law: str
    settings: Settings
    segments: tuple[Array, ...]  # ln chi of the nodes of each segment
    elastic_compression: Array  # w_m at `elastic_inelasticity` [V0 T_H]
    fields: dict[str, Array]  # name -> (inelasticity nodes, nodes of all segments)
    states: NDArray[np.float32]  # of the shapes, on `shape_axes`: (rows, columns, 2, SIZE)
    certificate: Certificate | None = None

    @property
    def inelasticity(self) -> Array:
        """Nodes along lambda."""
        return axes(find_law(self.law), self.settings)[0]

    @property
    def elastic_inelasticity(self) -> Array:
        """Nodes along lambda of w_m."""
        return _elastic_nodes(self.settings)

    @functools.cached_property
    def packed_shapes(self) -> shapes.Shapes:
        """Splines through the shapes of force histories."""
        lam_max = self.settings.largest_inelasticity
        _, *segments = shape_axes(find_law(self.law), self.settings)
        return shapes.pack(self.settings.stretch, lam_max, tuple(segments), self.states)

    @functools.cached_property
    def packed(self) -> Array:
        """Splines through the values, for the lookup kernels."""
        return packing.pack(
            self.settings.stretch,
            self.settings.largest_inelasticity,
            self.segments,
            self.elastic_compression,
            self.fields,
        )


def _rows(settings: Settings, count: int) -> Array:
    nodes = _inelasticity(settings, np.linspace(0.0, 1.0, count))
    nodes[-1] = settings.largest_inelasticity  # not one rounding error beyond
    return nodes


def _elastic_nodes(settings: Settings) -> Array:
    return _inelasticity(settings, packing.chebyshev_nodes(settings.elastic_nodes))


def _inelasticity(settings: Settings, share: Array) -> Array:
    """Inelasticity lambda at shares of the largest x = lambda/(lambda + c)."""
    c = settings.stretch
    x = share * settings.largest_inelasticity / (settings.largest_inelasticity + c)
    return np.asarray(c * x / (1.0 - x))


def _segments(law: Law, settings: Settings, step: float) -> tuple[Array, ...]:
    bounds = [math.log(kink) for kink in law.kinks if kink < settings.largest_overload]
    bounds.append(math.log(settings.largest_overload))
    return tuple(
        np.linspace(low, high, max(5, 1 + math.ceil((high - low) / step)))
        for low, high in zip(bounds[:-1], bounds[1:], strict=True)
    )


def axes(law: Law, settings: Settings) -> tuple[Array, ...]:
    """Nodes along lambda, then those along ln chi of each segment."""
    rows = _rows(settings, settings.inelasticity_nodes)
    return (rows, *_segments(law, settings, settings.log_overload_step))


def shape_axes(law: Law, settings: Settings) -> tuple[Array, ...]:
    """Nodes of the shapes along lambda, then those along ln chi of each segment."""
    return (_rows(settings, shapes.ROWS), *_segments(law, settings, shapes.STEP))


def _no_progress(rows: Iterator[Array], total: int) -> Iterable[Array]:
    return rows


def build(
    law: str,
    settings: Settings | None = None,
    *,
    progress: Progress = _no_progress,
) -> Table:
    """Sweep the equation over all nodes, on all cores, and certify the table.

    Parameters
    ----------
    law : str
        Name of a law that yields.
    settings : Settings, optional
        Extent and fineness.
    progress : callable, optional
        ``progress(rows, total)`` wraps the iterator over finished rows, as ``tqdm`` does.

    Returns
    -------
    Table
        With its certificate.

    Raises
    ------
    ValueError
        If the law is unknown or never yields: the elastic edge of any table serves it.
    RuntimeError
        If a node does not solve; the message names it.
    """
    chosen = find_law(law)
    if not chosen.kinks:
        raise ValueError(f"law: {law!r} never yields; the edge chi = 1 of any table serves it")
    settings = settings or Settings()
    lam, *segments = axes(chosen, settings)
    chi = np.exp(np.concatenate(segments))
    grid = np.repeat(lam, chi.size), np.tile(chi, lam.size)
    values = _solve(chosen, *grid, settings.rtol, lam.size, progress)
    fields = {
        name: row.reshape(lam.size, chi.size) for name, row in zip(FIELDS, values, strict=False)
    }
    elastic = _elastic(_elastic_nodes(settings), settings.rtol)
    states = _states(chosen, settings)
    table = Table(law, settings, tuple(segments), elastic, fields, states)
    return dataclasses.replace(table, certificate=certify(table))


def _solve(
    law: Law,
    lam: Array,
    chi: Array,
    rtol: float,
    parts: int,
    progress: Progress = _no_progress,
) -> Array:
    """Fields (5, n) of `zener.solve_overloads` at many points, in parallel parts."""
    functions, hertz = law.functions, find_law("hertz").functions

    def solve(part: Array) -> Array:
        out = np.empty((5, part.shape[1]))
        status, n = zener.solve_overloads(functions, hertz, part[0], part[1], rtol, out)
        if status != zener.OK:
            raise RuntimeError(
                f"table for law {law.name!r}: the node lambda = {part[0, n]:.6g}, chi = "
                f"{part[1, n]:.6g} did not solve: {zener.MESSAGES[status]}"
            )
        return out

    return _in_parts(solve, np.stack((lam, chi)), parts, progress)


def _in_parts(
    function: Callable[[Array], Array], points: Array, parts: int, progress: Progress
) -> Array:
    """Apply a function that lets other threads run to columns of points, on all cores."""
    function(points[:, :1])  # compile once, before the threads ask for it
    pool = ThreadPoolExecutor(os.cpu_count())
    try:
        pieces = pool.map(function, np.array_split(points, parts, axis=1))
        return np.concatenate(list(progress(pieces, parts)), axis=-1)
    finally:  # on Ctrl-C, wait for the parts that run and start no others
        pool.shutdown(cancel_futures=True)


def _states(law: Law, settings: Settings) -> NDArray[np.float32]:
    """Shapes at the nodes of `shape_axes`; their error is far above that of single precision."""
    lam, *segments = shape_axes(law, settings)
    chi = np.exp(np.concatenate(segments))
    out = np.empty((lam.size, chi.size, 2, shapes.SIZE), dtype=np.float32)
    states = np.empty((2, shapes.SIZE + 1))
    for row, w_m in enumerate(_elastic(lam, settings.rtol)):
        for column in range(chi.size):
            y = w_m / chi[column]
            status = zener.shape(law.functions, lam[row], y, settings.rtol, shapes.SHARES, states)
            if status != zener.OK:
                raise RuntimeError(
                    f"table for law {law.name!r}: the shape at lambda = {lam[row]:.6g}, chi = "
                    f"{chi[column]:.6g} did not solve: {zener.MESSAGES[status]}"
                )
            out[row, column] = states[:, :-1]
    return out


def _elastic(lam: Array, rtol: float) -> Array:
    """Largest elastic compressions w_m."""
    hertz = find_law("hertz").functions
    out = np.empty_like(lam)
    for n, value in enumerate(lam):
        status, out[n] = zener.elastic_compression(hertz, value, rtol)
        if status != zener.OK:
            raise RuntimeError(f"w_m({value:.6g}) did not solve: {zener.MESSAGES[status]}")
    return out


def certify(
    table: Table, points: int = 10_000, seed: int = 0, *, progress: Progress = _no_progress
) -> Certificate:
    """Compare lookups with the solver at random points off the grid.

    The points fall into equal shares: below yield, each segment between two kinks, and the close
    neighbourhood of each kink on either side.

    Parameters
    ----------
    table : Table
    points : int, optional
        Number of points, at least 100.
    seed : int, optional
        Seed of their generator.
    progress : callable, optional
        As in `build`.

    Returns
    -------
    Certificate

    Raises
    ------
    ValueError
        If there are too few or too many points, or the seed is negative.
    """
    if not 100 <= points <= 10_000_000:
        raise ValueError(f"points: at least 100 and at most 10 000 000 are taken, got {points!r}")
    if seed < 0:
        raise ValueError(f"seed: must not be negative, got {seed!r}")
    law = find_law(table.law)
    lam, chi = _points(table, points, np.random.default_rng(seed))
    rtol = max(table.settings.rtol / 10, _RANGES["rtol"][0])
    parts = -(-lam.size // _PART)
    exact = _solve(law, lam, chi, rtol, parts, progress)
    looked = np.empty_like(exact)
    y = exact[4] / chi
    lookup.fields(table.packed, lam, y, True, looked)
    errors = {}
    both = (_outcome(law, lam, y, values) for values in (looked, exact))
    for name, ours, truth in zip(BOUNDS, *both, strict=False):
        scale = 1.0 if name == "restitution" else np.maximum(np.abs(truth), _SMALLEST)
        errors[name] = np.abs(ours - truth) / scale

    def deviations(fields: Array) -> Array:
        out = np.empty(fields.shape[1])
        shapes.deviations(law.functions, table.packed_shapes, fields, rtol, _SAMPLES, out)
        return out

    fields = np.concatenate((looked, [lam, y]))
    errors["force_history"] = _in_parts(deviations, fields, parts, _no_progress)
    return Certificate(
        points=lam.size,
        seed=seed,
        median={name: float(np.median(e)) for name, e in errors.items()},
        percentile_99={name: float(np.percentile(e, 99)) for name, e in errors.items()},
        largest={name: float(np.max(e)) for name, e in errors.items()},
    )


def _points(table: Table, count: int, generator: np.random.Generator) -> tuple[Array, Array]:
    kinks = [nodes[0] for nodes in table.segments]
    strata = [(-2.0, 0.0), *((nodes[0], nodes[-1]) for nodes in table.segments)]
    strata += [(kink - _NEAR_KINK, kink) for kink in kinks]
    strata += [(kink, kink + _NEAR_KINK) for kink in kinks]
    share = -(-count // len(strata))
    log_chi = np.concatenate([generator.uniform(low, high, share) for low, high in strata])
    # uniform in the root: COR changes most where lambda is small
    root = generator.uniform(0.0, math.sqrt(table.settings.largest_inelasticity), log_chi.size)
    return root**2, np.exp(log_chi)


def _outcome(law: Law, lam: Array, y: Array, fields: Array) -> tuple[Array, ...]:
    """Fields of `BOUNDS` from those of `zener.solve_all`, as `contactlaw.evaluation` has them."""
    restitution, time, wave_rate, ratio, w_m = fields
    compression = ratio * w_m
    state = np.empty((3, lam.size))
    zener.contact_state(law.functions, compression, y, state)
    force, residual, plastic = state
    return restitution, time, force, compression, residual, plastic, lam * wave_rate
