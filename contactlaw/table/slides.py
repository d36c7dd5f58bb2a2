"""Tangential rebound from a table: the change of the contact point's speed in oblique impacts.

With psi = v_s/(mu V0), v_s the speed of the contact point along the surface, the change over mu V0
is a function of psi, of the place of the normal impact in a table, and of kappa, which belongs to the
pair. It has two corners: up to psi = 1/kappa the contact sticks at first, and from

    psi = 7/2 (1 + e) - e/kappa

it slides all the time, so that the change is 7/2 (1 + e). Both follow from the speeds at first
touch and at separation, at which the springs' stretch and their share of the normal force change
alike. Each of the two ranges has an axis of its own from 0 to 1, along which the change over psi is
interpolated: a corner that moved between the nodes of the table would cost ten times as many.

The grid is as that of shapes, but finer; the packed array ends with kappa.
"""

import math

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw._spline import weights
from contactlaw.equation import outcome, tangential, zener
from contactlaw.equation.edge import Edges
from contactlaw.equation.outcome import Outcome
from contactlaw.equation.tangential import POINT
from contactlaw.table import lookup, sweep
from contactlaw.table.grid import ladder_of, spline_coefficients
from contactlaw.table.lookup import Axes, Place, Rung, field
from contactlaw.table.table import Table

_NODES = 49  # of each range of psi
_CELLS = {"rows": 24, "below": 4, "beyond": 32, "after": 4}
_APART = 0.2  # largest distance of rungs in ln k; straight between them errs by less than 2e-3
_WIDTH = 2 * (_NODES + 2)  # coefficients along psi
_SAMPLES, _SPRINGS = 401, 32  # of the histories at the nodes
_RTOL = 1e-10


@kernel(inline=True)
def _range(kappa: float, e: float) -> float:
    """Length in psi of the second range, that of contacts that slide first and stick later."""
    return (1.0 + e) * (POINT - 1.0 / kappa)


def build(table: Table, kappa: float) -> Array:
    """Solve oblique impacts at the nodes, on all cores, and fit splines."""
    law = table.law
    cells = _CELLS | {"after": _CELLS["after"] * (table.grid.axes.after > 0.0)}
    grid = table.grid.with_axes(**cells).on_ladder(law, ladder_of(law, _APART))
    return np.append(sweep.at_nodes(law, grid, _RTOL, lambda found: _along(law.at_any_strength, found, kappa)), kappa)


def _along(law: Array, found: Outcome, kappa: float) -> Array:
    """Coefficients along psi of the change over psi in both ranges, (impacts, _WIDTH)."""
    share, e = np.linspace(0.0, 1.0, _NODES), found.restitution[:, None]
    sticking = np.maximum(share**2, 1e-8) / kappa  # at rest there is a limit, but no share
    sliding = 1.0 / kappa + _range(kappa, e) * share
    psi = np.hstack((np.broadcast_to(sticking, sliding.shape), sliding))
    changes = (psi - after(law, found, kappa, psi, _SAMPLES, _SPRINGS)) / psi
    return np.hstack([spline_coefficients(half, 1) for half in np.split(changes, 2, axis=1)])


def after(
    law: Array,
    found: Outcome,
    kappa: float,
    psi: Array,
    samples: int = 801,
    springs: int = 64,
    edges: Edges | None = None,
) -> Array:
    """Speeds of the contact points after impacts (impacts, speeds) [mu V0], by integration."""
    path = outcome.history(found.contact_time, samples)
    zener.histories(law, found, _RTOL, path, edges)
    speed = np.array(psi)
    tangential.slide_all(law, found.yield_ratio, found.strength, kappa, path, speed, springs)
    return speed


@kernel(inline=True)
def change(slides: Array, axes: Axes, at: Place, on: Rung, e: float, psi: float) -> float:
    """Change of the contact point's speed in an impact inside the table [mu V0]."""
    kappa = slides[slides.size - 1]
    size, full = abs(psi), POINT * (1.0 + e)
    place = size * kappa
    if place > 1.0:
        place = 1.0 + (size - 1.0 / kappa) / _range(kappa, e)
    if not place < 2.0:
        return math.copysign(full, psi) if place >= 2.0 else math.nan
    second = place > 1.0
    along = (place - 1.0 if second else math.sqrt(place)) * (_NODES - 1)
    cell, value = min(int(along), _NODES - 2), 0.0
    first, c = cell + (_NODES + 2 if second else 0), weights(along - cell)
    for k in range(4):
        value += c[k] * field(slides, axes, first + k, at, on) / 6.0
    return math.copysign(min(size * value, full), psi)


@kernel(cache=True)
def changes(slides: Array, found: Outcome, psi: Array, out: Array) -> None:
    """`change` of many impacts whose normal outcomes are inside the table."""
    head = lookup.head_of(slides)
    for n in range(psi.size):
        at, on = lookup.place_at(slides, head, found.inelasticity[n], found.yield_ratio[n], found.strength[n], True)
        out[n] = change(slides, head.axes, at, on, found.restitution[n], psi[n])
