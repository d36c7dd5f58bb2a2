"""The table of one contact law: the equation solved at every node."""

import dataclasses
import functools
import itertools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw._arrays import Array
from contactlaw.equation import outcome, zener
from contactlaw.equation.outcome import STORED, Outcome
from contactlaw.laws import Law
from contactlaw.table import grid as grids
from contactlaw.table import lookup, shapes, splines, sweep
from contactlaw.table.axes import TableGrid
from contactlaw.table.certificate import Certificate, bounds, compare_histories, compare_outcomes, random_points
from contactlaw.table.grid import RANGES, Settings
from contactlaw.table.sweep import Progress, no_progress

POINTS = 1000  # points of the certificate of a table that is built on demand
_COMPARED = 20_000  # points at which a coarser table is compared
_ROW_FACTORS = 4, 2, 1  # factors by which a coarser table may have fewer rows
_LAYER_FACTORS = 1, 2, 4  # likewise of cells in ln k
# Factors by which a coarser table's steps in ln chi may be wider, one for each segment: the COR of
# elastic impacts bends far less than that beyond yield, for which a single step has to be fine.
_STEP_FACTORS = 1.25, 1.5, 2.0, 3.0, 4.0, 8.0
# How many times fewer rows and wider steps most layers of strength have, with their limits, and how
# far apart in ln k are those that have all nodes, our choices. The COR moves by 2e-6 at most.
_FEWER, _FEWEST_ROWS = 2.2, 19
_WIDER, _WIDEST = 2.0, 0.1
_APART = 0.75


@dataclass(frozen=True, eq=False)
class Table:
    """Values at the nodes, as they are stored.

    Parameters
    ----------
    law : Law
        Force law of the impacts.
    settings : Settings
        Extent and fineness.
    grid : TableGrid
        Nodes of the fields.
    fields : dict of str to ndarray
        Fields of `contactlaw.equation.outcome.STORED`, each of the grid's shape.
    states : ndarray of float32, optional
        Shapes of force histories on `shape_grid`, with (2, SIZE) at each node; None until they are
        needed.
    certificate : Certificate, optional
        How far lookups are from the solver.
    """

    law: Law
    settings: Settings
    grid: TableGrid
    fields: dict[str, Array]
    states: NDArray[np.float32] | None = None
    certificate: Certificate | None = None

    @property
    def exceeded(self) -> dict[str, float]:
        """Errors of the certificate that are larger than promised."""
        return {} if self.certificate is None else self.certificate.exceeded(bounds(self.law))

    @functools.cached_property
    def packed(self) -> Array:
        """Splines through the values, for the lookup kernels."""
        return splines.pack(self.grid, self.fields)

    @functools.cached_property
    def packed_shapes(self) -> shapes.Shapes:
        """Splines through the shapes of force histories; for a table that has them."""
        assert self.states is not None, "with_shapes(table) adds them"
        return shapes.pack(shape_grid(self), self.states)


def shape_grid(table: Table) -> TableGrid:
    """Nodes of the shapes: coarser, with the same segments."""
    settings = dataclasses.replace(table.settings, inelasticity_nodes=shapes.ROWS)
    return grids.with_steps(table.law, table.grid, settings, shapes.STEP, shapes.COARSER)


def build(
    law: Law, settings: Settings | None = None, *, points: int = POINTS, progress: Progress = no_progress
) -> Table:
    """Sweep the equation over all nodes, on all cores, and certify the table.

    Parameters
    ----------
    law : Law
        A law that yields.
    settings : Settings, optional
        Extent and fineness.
    points : int, optional
        Number of random places at which the table is compared with the solver.
    progress : callable, optional
        ``progress(rows, total)`` wraps the iterator over finished rows, as ``tqdm`` does.

    Returns
    -------
    Table
        With its certificate; without shapes of force histories.

    Raises
    ------
    ValueError
        If the law never yields: the elastic edge of any table serves it.
    RuntimeError
        If a node does not solve; the message names it.
    """
    settings = settings or (Settings() if law.is_hertz else grids.on_demand(law))
    grid = grids.grid(law, settings)
    solve = _solved if law.strengths is None else _solved_layers
    table = Table(law, settings, grid, solve(law, grid, settings, progress))
    return dataclasses.replace(table, certificate=certify(table, points))


def _solved(
    law: Law, grid: TableGrid, settings: Settings, progress: Progress, layers: Any = slice(None)
) -> dict[str, Array]:
    """Solve the nodes of a grid; of one with strengths, those of all layers or of some."""
    chosen = [values.reshape(grid.shape)[..., layers] for values in grid.points()]
    lam, chi, strength = (values.ravel() for values in chosen)
    found = sweep.solve_overloads(law, lam, chi, strength, settings.rtol, len(grid.rows), progress)
    return {name: getattr(found, name).reshape(chosen[0].shape) for name in STORED}


def _solved_layers(law: Law, grid: TableGrid, settings: Settings, progress: Progress) -> dict[str, Array]:
    """Solve a few layers at all nodes, among them those that end the axis, and others coarsely.

    Between the few, fields are nearly straight lines along the strength. How far they are from them
    varies so little with the other coordinates that splines over a coarser grid give it.
    """
    rows, step = settings.inelasticity_nodes, settings.log_overload_step
    fewer = max(round(rows / _FEWER), min(rows, _FEWEST_ROWS))
    wider = max(min(_WIDER * step, _WIDEST), step)
    few = dataclasses.replace(settings, inelasticity_nodes=fewer, log_overload_step=wider)
    coarse = grids.with_steps(law, grid, few, wider)
    table = Table(law, few, coarse, _solved(law, coarse, few, progress))
    fields = _resampled(table, rows, step, 1).fields
    strength = grid.axes[2].nodes(np.zeros(1))[0]
    count = 1 + math.ceil(strength[-1] / _APART)
    layers = np.linspace(0, strength.size - 1, count).round().astype(int)
    shares = [np.interp(strength, strength[layers], one) for one in np.eye(count)]
    exact = _solved(law, grid, settings, progress, layers)
    for name, values in fields.items():
        values += (exact[name] - values[..., layers]) @ shares
    fields["restitution"].clip(0.0, 1.0, out=fields["restitution"])
    return fields


def thinned(table: Table, error: float) -> Table:
    """Thin out a table's nodes while its COR stays within `error`; else return it as it is."""
    rows, fewest = table.settings.inelasticity_nodes - 1, int(RANGES["inelasticity_nodes"][0])
    points = random_points(table.grid, _COMPARED, np.random.default_rng(0))
    exact = _looked_up(table, *points).restitution
    found, layers = table, _LAYER_FACTORS if len(table.grid.axes) > 2 else (1,)
    for fewer, coarser in itertools.product(_ROW_FACTORS, layers):
        count = max(rows // fewer + 1, fewest)
        steps = _widest_steps(table, count, error, points, exact, coarser)
        if steps is not None:
            one = _resampled(table, count, steps, coarser)
            if one.packed.size < found.packed.size:
                found = one
    if found.certificate is None:
        found = dataclasses.replace(found, certificate=certify(found, POINTS))
    return found


def _widest_steps(
    table: Table, rows: int, error: float, points: tuple[Array, Array, Array], exact: Array, coarser: int
) -> Array | None:
    """Largest step in each segment with which its COR errs no more than `error`; None if none does.

    Splines do not run across kinks, so the error in a segment is that of its own steps.
    """
    inelasticity, overload = table.grid.axes[:2]
    segment = overload.segment_of(points[1], inelasticity.place(points[0]))
    step, widest = table.settings.log_overload_step, RANGES["log_overload_step"][1]
    steps = np.full(len(overload.segments), step)
    passing = np.ones(steps.size, dtype=bool)
    for wider in (1.0, *_STEP_FACTORS):
        one = min(step * wider, widest)
        off = np.abs(_looked_up(_resampled(table, rows, one, coarser), *points).restitution - exact)
        passing &= [off[segment == n].max(initial=0.0) <= error for n in range(steps.size)]
        if wider == 1.0 and not passing.all():
            return None
        steps[passing] = one
        if not passing.any():
            break
    return steps


def _looked_up(table: Table, lam: Array, log_chi: Array, strength: Array) -> Outcome:
    """Look points of the grid's axes up."""
    found = outcome.at(lam, np.empty_like(lam), strength)
    lookup.yield_ratios(table.packed, table.grid.own(lam, log_chi, strength), found)
    lookup.fields(table.packed, True, found)  # rounding may put nodes at the edge outside
    return found


def _resampled(table: Table, rows: int, steps: float | Array, coarser: int) -> Table:
    """Table on other nodes; one step along ln chi for all segments, or one for each."""
    settings = dataclasses.replace(table.settings, inelasticity_nodes=rows, log_overload_step=float(np.max(steps)))
    grid = grids.with_steps(table.law, table.grid, settings, steps, coarser)
    lam, log_chi, *_ = (values.ravel() for values in grid.nodes())
    found = _looked_up(table, lam, log_chi, grid.points()[2])  # just above a knot, where laws jump
    fields = {name: getattr(found, name).reshape(grid.shape) for name in STORED}
    return Table(table.law, settings, grid, fields)


def with_shapes(table: Table, *, points: int = POINTS, progress: Progress = no_progress) -> Table:
    """Add the shapes of force histories, and their error to the certificate.

    Parameters
    ----------
    table : Table
        Table from `build`.
    points, progress
        As in `build`.

    Returns
    -------
    Table

    Raises
    ------
    RuntimeError
        If a shape does not solve; the message names it.
    """
    states = _states(table, progress)
    whole = dataclasses.replace(table, states=states)
    return dataclasses.replace(whole, certificate=certify(whole, points))


def _states(table: Table, progress: Progress) -> NDArray[np.float32]:
    """Shapes at the nodes; their error is far above that of single precision."""
    law, rtol, grid = table.law, table.settings.rtol, shape_grid(table)
    lam, chi, strength = grid.points()
    out = np.empty((lam.size, 2, shapes.SIZE), dtype=np.float32)
    at = outcome.at(lam, np.empty_like(lam), strength)
    lookup.yield_ratios(table.packed, np.log(chi), at)

    def solve(part: slice) -> None:
        known = lam[part], at.yield_ratio[part], rtol, shapes.SHARES, strength[part]
        status, time, speed = zener.shape(law.at_any_strength, *known)
        if status.any():
            raise sweep.failure("shape", law, lam[part], chi[part], *zener.failure(status))
        out[part] = np.stack((time, speed), axis=1)[:, :, :-1]

    sweep.in_parts(solve, lam.size, len(grid.rows), progress)
    return out.reshape(*grid.shape, 2, shapes.SIZE)


def certify(table: Table, points: int = 10_000, seed: int = 0, *, progress: Progress = no_progress) -> Certificate:
    """Compare lookups with the solver at random points off the grid.

    The points fall into equal shares: below yield, each segment between two kinks, the close
    neighbourhood of each kink on either side. A tenth of the points are on the half-space.

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
        With the error of force histories if the table has them.

    Raises
    ------
    ValueError
        If there are too few or too many points, or the seed is negative.
    """
    looked, errors = compare_outcomes(table.law, table.settings, table.grid, table.packed, points, seed, progress)
    if table.states is not None:
        errors["force_history"] = compare_histories(table.law, table.settings, table.packed_shapes, looked)
    return Certificate.of(errors, looked.restitution.size, seed)
