"""Splines through the nodes of a table, packed into the array that the lookup kernels read."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlaw.lookup import (
    BLOCK,
    COLUMNS,
    COR_AT,
    DEGREE,
    HEADER,
    LOG_CHI_MAX,
    NODES_PER_X,
    OTHERS_AT,
    SEGMENTS,
    STRETCH,
    X_MAX,
)

Array = NDArray[np.float64]

FIELDS = ("restitution", "contact_time", "wave_rate", "compression_ratio")  # as they are packed


def spline_coefficients(values: Array) -> Array:
    """Coefficients of the cubic B-spline through uniform nodes along axis 0, not-a-knot ends.

    With v = (c[i-1] + 4 c[i] + c[i+1])/6 at each node and no jump of the third derivative next to
    the ends, c is known there; a tridiagonal system is left between. Solved without LAPACK, whose
    threads would fight for the cores with those of an MPI run.
    """
    n = len(values)
    if n < 5:
        raise ValueError(f"values: a spline with not-a-knot ends needs at least 5 nodes, got {n}")
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


def blocks(segments: tuple[Array, ...]) -> Array:
    """First ln chi, nodes per unit of ln chi and first column of coefficients of each segment."""
    lengths = np.array([nodes.size for nodes in segments])
    start, end = np.array([(nodes[0], nodes[-1]) for nodes in segments]).T
    return np.column_stack(
        (start, (lengths - 1) / (end - start), np.cumsum(lengths + 2) - (lengths + 2))
    )


def surface(values: Array, segments: tuple[Array, ...]) -> Array:
    """Coefficients of bicubic splines along axes 0 and 1; along 1, one for each segment."""
    across = spline_coefficients(values).swapaxes(0, 1)
    parts = np.split(across, np.cumsum([nodes.size for nodes in segments])[:-1])
    both = np.concatenate([spline_coefficients(part) for part in parts])
    return both.swapaxes(0, 1)


def chebyshev_nodes(count: int) -> Array:
    """Places in [0, 1] at which ln w_m is given along x/x_max."""
    nodes: Array = 0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / count)
    return nodes


def _power_series_of(log_elastic: Array) -> Array:
    """Fit a polynomial in t = 2 x/x_max - 1 to values at `chebyshev_nodes`."""
    t = 2.0 * chebyshev_nodes(log_elastic.size) - 1.0
    basis = np.polynomial.chebyshev.chebvander(t, DEGREE)
    # the nodes make the basis orthogonal, so no system is to be solved
    coefficients = (basis * log_elastic[:, None]).sum(axis=0) * (2.0 / log_elastic.size)
    coefficients[0] /= 2.0
    return np.asarray(np.polynomial.chebyshev.cheb2poly(coefficients))


def pack(
    stretch: float,
    lam_max: float,
    segments: tuple[Array, ...],
    elastic_compression: Array,
    fields: dict[str, Array],
) -> Array:
    """Fit splines through the values of a table's nodes and pack them into one array."""
    both = surface(np.stack([fields[name] for name in FIELDS], axis=-1), segments)
    # a kernel reads one coefficient too many at the very end, with the weight 0, and needs no test
    padded = np.pad(both, ((0, 1), (0, 1), (0, 0)), mode="edge")
    cor, others = padded[..., 0], padded[..., 1:]
    x_max = lam_max / (lam_max + stretch)
    power_series = _power_series_of(np.log(elastic_compression))
    header = np.empty(HEADER)
    header[[STRETCH, X_MAX, LOG_CHI_MAX]] = stretch, x_max, segments[-1][-1]
    header[NODES_PER_X] = (len(both) - 3) / x_max
    header[[COLUMNS, SEGMENTS]] = cor.shape[1], len(segments)
    start = HEADER + power_series.size + BLOCK * len(segments)
    header[[COR_AT, OTHERS_AT]] = start, start + cor.size
    parts = header, power_series, blocks(segments).ravel(), cor.ravel(), others.ravel()
    return np.concatenate(parts)
