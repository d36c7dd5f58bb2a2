"""Tangential rebound from a table: the change of the contact point's speed in oblique impacts.

With psi = v_s/(mu V0), v_s the speed of the contact point along the surface, the change over mu V0
is a function of psi, of the normal impact's lambda and ln chi, and of kappa, which belongs to the
pair. It has two corners: up to psi = 1/kappa the contact sticks at first, and from

    psi = 7/2 (1 + e) - e/kappa

it slides all the time, so that the change is 7/2 (1 + e). Both follow from the speeds at first
touch and at separation, at which the springs' stretch and their share of the normal force change
alike. Each of the two ranges has an axis of its own from 0 to 1, along which the change over psi is
interpolated: a corner that moved between the nodes of lambda and chi would cost ten times as many.

The grid has the same kinks as the table's. All is packed into one array, as `contactlaw.table.
lookup` does it: a header, the coefficients, kappa.
"""

import dataclasses
import math

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel
from contactlaw.equation import outcome, tangential, zener
from contactlaw.equation.edge import Edges
from contactlaw.equation.outcome import Outcome
from contactlaw.equation.tangential import POINT
from contactlaw.table import grid as grids
from contactlaw.table import lookup, splines, sweep
from contactlaw.table.nodes import Table

_CHANGE_AT, _KAPPA_AT = lookup.COR_AT, lookup.OTHERS_AT  # entries of the header
_NODES = 49  # of each range of psi
_ROWS = 49  # along lambda
_STEP, _ELASTIC_STEP = 0.12, 0.25  # largest distances in ln chi, beyond yield and below
_COARSER = 3  # factor on distances in ln k
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
    segments = table.grid.axes[1].segments
    steps = np.where([s.end.max() <= 0.0 for s in segments], _ELASTIC_STEP, _STEP)
    settings = dataclasses.replace(table.settings, inelasticity_nodes=_ROWS)
    grid = grids.with_steps(law, table.grid, settings, steps, _COARSER)
    lam, chi, strength = grid.points()
    change = np.empty((lam.size, 2 * _NODES))
    strengths = grid.axes[2].sizes if len(grid.axes) > 2 else [1]
    last = np.cumsum(strengths) - 1
    first = last + 1 - strengths
    layer = np.arange(lam.size) % sum(strengths)
    solved = np.flatnonzero(np.isin(layer, [*first, *last]))

    def solve(part: slice) -> None:
        some = solved[part]
        out = outcome.at(lam[some], np.empty_like(lam[some]), strength[some])
        zener.solve_overloads(law.at_any_strength, _RTOL, chi[some], out)
        change[some] = _changes(law.at_any_strength, out, kappa)

    sweep.in_parts(solve, solved.size, len(grid.rows), sweep.no_progress)
    layers = change.reshape(-1, sum(strengths), 2 * _NODES)
    for a, b in zip(first, last, strict=True):
        for n in range(a + 1, b):  # straight in ln k, which errs by less than 2e-3
            layers[:, n] = layers[:, a] + (n - a) / (b - a) * (layers[:, b] - layers[:, a])
    along = [splines.spline_coefficients(half).T for half in np.split(change.T, 2)]
    values = np.concatenate(along, axis=1).reshape(*grid.shape, _WIDTH)
    coefficients = splines.surface(values, grid)
    head = splines.header(grid)
    head[_CHANGE_AT], head[_KAPPA_AT] = head.size, head.size + coefficients.size
    return np.concatenate((head, coefficients.ravel(), [kappa]))


def _changes(law: Array, out: Outcome, kappa: float) -> Array:
    """Change over psi at the nodes of both ranges, (impacts, 2 _NODES)."""
    share, e = np.linspace(0.0, 1.0, _NODES), out.restitution[:, None]
    sticking = np.maximum(share**2, 1e-8) / kappa  # at rest there is a limit, but no share
    sliding = 1.0 / kappa + _range(kappa, e) * share
    psi = np.hstack((np.broadcast_to(sticking, sliding.shape), sliding))
    return (psi - after(law, out, kappa, psi, _SAMPLES, _SPRINGS)) / psi


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
    path = outcome.history(found.inelasticity.size, samples)
    zener.histories(law, found, _RTOL, path, edges)
    speed = np.array(psi)
    tangential.slide_all(law, found.yield_ratio, found.strength, kappa, path, speed, springs)
    return speed


@kernel(inline=True)
def change(slides: Array, x: float, log_chi: float, strength: float, e: float, psi: float) -> float:
    """Change of the contact point's speed in an impact inside the table [mu V0].

    x maps lambda; ln chi is that of the slow impact which is like it.
    """
    kappa = slides[int(slides[_KAPPA_AT])]
    size, full = abs(psi), POINT * (1.0 + e)
    place = size * kappa
    if place > 1.0:
        place = 1.0 + (size - 1.0 / kappa) / _range(kappa, e)
    if not place < 2.0:
        return math.copysign(full, psi) if place >= 2.0 else math.nan
    second = place > 1.0
    along = (place - 1.0 if second else math.sqrt(place)) * (_NODES - 1)
    cell = min(int(along), _NODES - 2)
    row, column, s, t = lookup.locate(slides, x, log_chi)
    at, layers = lookup.at_strength(slides, strength), max(int(slides[lookup.LAYERS]), 1)
    a, b, c = lookup.weights(s), lookup.weights(t), lookup.weights(along - cell)
    columns, d = int(slides[lookup.COLUMNS]), lookup.layer_weights(at)
    first = int(slides[_CHANGE_AT]) + ((row * columns + column) * layers + at.layer) * _WIDTH
    first += cell + (_NODES + 2 if second else 0)
    v0 = v1 = v2 = v3 = 0.0
    for i in range(4):
        for j in range(4):
            for m in range(min(layers, 4)):
                p = np.uint64(first + ((i * columns + j) * layers + m) * _WIDTH)
                w = a[i] * b[j] * d[m]
                v0 += w * slides[p]
                v1 += w * slides[p + np.uint64(1)]
                v2 += w * slides[p + np.uint64(2)]
                v3 += w * slides[p + np.uint64(3)]
    value = (c[0] * v0 + c[1] * v1 + c[2] * v2 + c[3] * v3) * (1.0 / 1296.0)
    return math.copysign(min(size * value, full), psi)


@kernel(cache=True)
def changes(slides: Array, found: Outcome, psi: Array, out: Array) -> None:
    """`change` of many impacts whose normal outcomes are inside the table."""
    for n in range(psi.size):
        y = found.yield_ratio[n]
        log_chi = math.log(found.elastic_compression[n] / y) if y < math.inf else -math.inf
        lam = found.inelasticity[n]
        x, strength = lam / (lam + slides[lookup.STRETCH]), found.strength[n]
        at = lookup.at_strength(slides, strength)
        log_chi = lookup.like(log_chi, lookup.stretched(slides, x, at))
        out[n] = change(slides, x, log_chi, strength, found.restitution[n], psi[n])
