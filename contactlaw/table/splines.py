"""Splines through the nodes of a table, packed into the arrays that the kernels read."""

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.table import lookup
from contactlaw.table.axes import TableGrid, power_series
from contactlaw.table.lookup import BLOCK, DEGREE, HEADER


def spline_coefficients(values: Array) -> Array:
    """Coefficients of the cubic B-spline through uniform nodes along axis 0, not-a-knot ends.

    With v = (c[i-1] + 4 c[i] + c[i+1])/6 at each node and no jump of the third derivative next to
    the ends, c is known there; a tridiagonal system is left between. Solved without LAPACK, whose
    threads would fight for the cores with those of an MPI run.
    """
    n = len(values)
    if n < 4:
        raise ArgumentError("values", n, "a spline with not-a-knot ends needs at least 4 nodes")
    c = np.empty((n + 2, *values.shape[1:]))
    c[2], c[n - 1] = ((8.0 * values[k] - values[k - 1] - values[k + 1]) / 6.0 for k in (1, n - 2))
    gain = np.zeros(n + 2)
    for k in range(3, n - 1):
        gain[k] = 1.0 / (4.0 - gain[k - 1])
        c[k] = (6.0 * values[k - 1] - c[k - 1]) * gain[k]
    for k in range(n - 2, 2, -1):
        c[k] -= gain[k] * c[k + 1]
    for edge, inwards in ((1, 1), (n, -1)):
        node = edge - 1
        c[edge] = 6.0 * values[node + inwards] - 4.0 * c[edge + inwards] - c[edge + 2 * inwards]
        c[edge - inwards] = 6.0 * values[node] - 4.0 * c[edge] - c[edge + inwards]
    return c


def surface(values: Array, grid: TableGrid) -> Array:
    """Coefficients of cubic splines along each axis of the grid, one spline for each segment.

    Each of the first two axes ends with one more coefficient: kernels read it with the weight 0,
    without a test.
    """
    for k, axis in enumerate(grid.axes):
        parts = np.split(values.swapaxes(0, k), np.cumsum(axis.sizes)[:-1])
        values = np.concatenate([spline_coefficients(part) for part in parts]).swapaxes(0, k)
    beyond = [(0, int(k < 2)) for k in range(values.ndim)]
    return np.pad(values, beyond, mode="edge")


def header(grid: TableGrid) -> Array:
    """Make the beginning of a packed array, by which `lookup.locate` finds coefficients."""
    inelasticity, overload, *strength = grid.axes
    x_max = float(inelasticity.mapped(inelasticity.largest))
    sizes = np.array(overload.sizes)
    head = np.zeros(HEADER)
    head[[lookup.STRETCH, lookup.X_MAX]] = inelasticity.stretch, x_max
    head[lookup.LOG_CHI_MAX] = overload.largest
    head[lookup.NODES_PER_X] = (inelasticity.sizes[0] - 1) / x_max
    head[lookup.COLUMNS], head[lookup.SEGMENTS] = (sizes + 2).sum() + 1, sizes.size
    blocks = np.zeros((sizes.size, BLOCK))
    series = [power_series(np.log(grid.elastic_compression), DEGREE)]
    lines_at = HEADER + DEGREE + 1 + blocks.size
    for block, segment, first in zip(blocks, overload.segments, np.cumsum(sizes + 2) - (sizes + 2), strict=True):
        cells = segment.shares.size - 1
        length = segment.end[0] - segment.start[0]
        block[[lookup.START, lookup.END]] = segment.start[0], segment.end[0]
        block[[lookup.PER_LOG, lookup.COLUMN]] = cells / length, first
        block[[lookup.CELLS, lookup.GRADED]] = cells, segment.graded
        if np.ptp(segment.start) > 0.0:
            head[lookup.CURVED] = 1.0
            block[lookup.LINE] = lines_at + (len(series) - 1) * (DEGREE + 1)
            series.append(power_series(segment.start, DEGREE))
    parts = [head, series[0], blocks.ravel(), *series[1:]]
    if strength and grid.by_strength is not None:
        sizes = np.array(strength[0].sizes)
        head[lookup.LAYERS], head[lookup.STRENGTHS] = (sizes + 2).sum(), sizes.size
        head[lookup.STRENGTHS_AT] = sum(map(len, parts))
        begins = np.cumsum(sizes + 2) - (sizes + 2)
        for segment, first, rows in zip(strength[0].segments, begins, grid.by_strength, strict=True):
            ends = segment.start[0], segment.end[0]
            parts.append(np.array([*ends, segment.shares.size - 1.0, first, *rows.ravel()]))
    return np.concatenate(parts)


def _growth(ratio: Array, grid: TableGrid) -> Array:
    """Logarithm of the largest compression over that of the overload, p in d_m/d_Y = chi^p.

    Just above yield, where residual compression and plastic share begin with d_m - d_Y, an error of
    p is a relative error of that difference; an error of the ratio could be any multiple of it.
    """
    nodes, log_chi = grid.nodes()[1], np.log(grid.points()[1]).reshape(grid.shape)
    with np.errstate(invalid="ignore", divide="ignore"):
        growth = 1.0 + np.log(ratio) / log_chi
    nodes = nodes.reshape(*nodes.shape[:2], -1)[0, :, 0]
    at_yield = nodes == 0.0
    if nodes[0] == 0.0:
        growth[:, at_yield] = 1.0  # Hertz's limit
        return growth
    for column in np.flatnonzero(at_yield):
        side = 1 if column > 0 and not at_yield[column - 1] else -1
        near = column - side * np.arange(1, 6)
        growth[:, column] = _lagrange(nodes[near], growth[:, near])
    return growth


def _lagrange(x: Array, values: Array) -> Array:
    """Continue values (n, m, ...) at x (m,) to x = 0, by the polynomial through all of them."""
    gaps = x[:, None] - x[None, :]
    ahead = np.broadcast_to(-x, gaps.shape).copy()
    np.fill_diagonal(gaps, 1.0)
    np.fill_diagonal(ahead, 1.0)
    return np.asarray(np.tensordot(values, (ahead / gaps).prod(axis=1), (1, 0)))


def pack(grid: TableGrid, fields: dict[str, Array]) -> Array:
    """Fit splines through the values of a table's nodes and pack them into one array."""
    packed = {**fields, "compression_ratio": _growth(fields["compression_ratio"], grid)}
    cor, *others = (surface(values, grid) for values in packed.values())
    head = header(grid)
    head[lookup.COR_AT], head[lookup.OTHERS_AT] = head.size, head.size + cor.size
    return np.concatenate((head, *(values.ravel() for values in (cor, *others))))
