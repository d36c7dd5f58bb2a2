"""The table of one contact law: the equation solved at every node."""

import dataclasses
import functools
from dataclasses import dataclass

import numpy as np

from contactlaw._arrays import Array
from contactlaw.equation import outcome, zener
from contactlaw.equation.outcome import Outcome
from contactlaw.laws import Law
from contactlaw.table import grid as grids
from contactlaw.table import shapes, sweep
from contactlaw.table.certificate import CORNERED, Certificate, bounds, measured
from contactlaw.table.grid import Grid, Settings

POINTS = 2000  # points of the certificate of a table that is built on demand
_DOUBLINGS = 4  # numbers of columns, and distances of rungs, that are tried
# Shares of the promised errors that a new table may use: ten times as many points may find a larger one, most of all
# next to corners, which are rarely met.
_MARGIN, _CORNERS_MARGIN = 0.6, 0.4
_APART = 0.03  # largest distance of rungs in ln k at first


@dataclass(frozen=True, eq=False)
class Table:
    """A table, as it is stored.

    Parameters
    ----------
    law : Law
        Force law of the impacts.
    settings : Settings
        Extent, and fineness to begin with.
    packed : ndarray of float64
        Grid and splines, for the kernels of `contactlaw.table.lookup`; without a pair.
    histories : ndarray of float64, optional
        The same for the shapes of force histories; None until they are needed.
    certificate : Certificate, optional
        How far lookups are from the solver.
    """

    law: Law
    settings: Settings
    packed: Array
    histories: Array | None = None
    certificate: Certificate | None = None

    @functools.cached_property
    def grid(self) -> Grid:
        """Nodes of the fields."""
        return Grid.of(self.packed)

    def exceeded(self, share: float = 1.0) -> dict[str, float]:
        """Errors of the certificate that are above this share of what is promised."""
        largest, promised = self.certificate.largest if self.certificate else {}, bounds(self.law)
        return {name: error for name, error in largest.items() if not error <= share * promised[name]}


def build(law: Law, settings: Settings | None = None, *, points: int = POINTS) -> Table:
    """Solve the equation at all nodes, on all cores, until the certificate of the table passes.

    Parameters
    ----------
    law : Law
        A law that yields.
    settings : Settings, optional
        Extent and fineness.
    points : int, optional
        Number of random places at which the table is compared with the solver.

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
    settings = settings or grids.on_demand(law)
    slow = dataclasses.replace(law, strengths=None)
    grid = grids.grid(slow, settings)
    margin = _CORNERS_MARGIN if bounds(law)["restitution"] == CORNERED else _MARGIN
    for doubling in range(_DOUBLINGS):
        grid = grid.with_axes(beyond=settings.columns * 2**doubling)
        table = _certified(slow, settings, grid, points)
        if not table.exceeded(margin):
            break
    for halving in range(_DOUBLINGS if law.strengths else 0):
        ladder = grids.ladder_of(law, _APART / 2**halving)
        table = _certified(law, settings, grid.on_ladder(law, ladder), points)
        if not table.exceeded(margin):
            break
    return table


def _certified(law: Law, settings: Settings, grid: Grid, points: int) -> Table:
    """Make a table from the nodes of a grid."""
    table = Table(law, settings, sweep.at_nodes(law, grid, settings.rtol, functools.partial(_stored, law)))
    return dataclasses.replace(table, certificate=certify(table, points))


def _stored(law: Law, found: Outcome) -> Array:
    """Fields that tables keep, see `contactlaw.equation.outcome.STORED`."""
    lost, extremes = 1.0 - found.restitution, outcome.extremes(found.restitution.size)
    zener.extremes(law.at_any_strength, found, extremes)
    still = found.inelasticity == 0.0  # no waves: energies alone give the COR, 1 exactly without losses
    lost[still] = 1.0 - np.sqrt(1.0 - extremes.plastic_fraction[still] - extremes.other_fraction[still])
    return np.stack([lost, 1.0 / found.contact_time, found.wave_rate, found.compression_ratio], axis=1)


def with_shapes(table: Table, *, points: int = POINTS) -> Table:
    """Add the shapes of force histories, and their error to the certificate.

    Parameters
    ----------
    table : Table
        Table from `build`.
    points : int, optional
        As in `build`.

    Returns
    -------
    Table

    Raises
    ------
    RuntimeError
        If a shape does not solve; the message names it.
    """
    whole = dataclasses.replace(table, histories=shapes.build(table.law, table.grid, table.settings.rtol))
    return dataclasses.replace(whole, certificate=certify(whole, points))


def certify(table: Table, points: int = 20_000, seed: int = 0) -> Certificate:
    """Compare lookups with the solver at random points off the grid.

    A fifth of the points lie below yield, a fifth within 2 % of the speed of yield, a tenth beyond
    the end of the law where the table goes on, the others between. A twentieth of the points are on
    the half-space, another has the largest inelasticity.

    Parameters
    ----------
    table : Table
    points : int, optional
        Number of points, at least 100.
    seed : int, optional
        Seed of their generator.

    Returns
    -------
    Certificate
        With the error of force histories if the table has them.

    Raises
    ------
    ValueError
        If there are too few or too many points, or the seed is negative.
    """
    return measured(table.law, table.settings.rtol, table.packed, table.histories, points, seed)
