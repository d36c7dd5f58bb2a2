"""The table of one contact law: solve the equation at every node, in parallel.

Axes: the inelasticity lambda, and ln chi, the logarithm of the overload. Nodes are uniform in
x = lambda/(lambda + c) and, between two kinks of the law, in ln chi; a kink is a node twice, once
as the end of a segment and once as the beginning of the next. See `contactlaw.lookup`.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contactlaw import lookup, zener
from contactlaw.laws import Law
from contactlaw.laws import law as find_law

Array = NDArray[np.float64]

FIELDS = {
    "restitution": "rebound speed over impact speed [-]",
    "contact_time": "time from touch to separation [T_H]",
    "wave_rate": "share of the initial energy in the bending wave, over lambda [-]",
    "compression_ratio": "largest compression over the elastic one, d_m/(chi d_Y) [-]",
}


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
        Nodes along lambda of the one-dimensional w_m(lambda).
    stretch : float
        c in x = lambda/(lambda + c), in which the nodes along lambda are uniform.
    rtol : float
        Tolerance of the solver at each node.
    """

    largest_inelasticity: float = 5.0
    largest_overload: float = 40.0
    inelasticity_nodes: int = 81
    log_overload_step: float = 0.03
    elastic_nodes: int = 641
    stretch: float = 2.0
    rtol: float = 1e-12


@dataclass(frozen=True, eq=False)
class Table:
    """Values at the nodes, as they are stored."""

    law: str
    settings: Settings
    segments: tuple[Array, ...]  # ln chi of the nodes of each segment
    elastic_compression: Array  # w_m at the elastic nodes [V0 T_H]
    fields: dict[str, Array]  # name -> (inelasticity nodes, nodes of all segments)

    @property
    def inelasticity(self) -> Array:
        """Nodes along lambda."""
        return _inelasticity_nodes(self.settings, self.settings.inelasticity_nodes)

    def packed(self) -> Array:
        """Pack splines through the values for the lookup kernels."""
        return lookup.pack(
            self.settings.stretch,
            self.settings.largest_inelasticity,
            self.segments,
            self.elastic_compression,
            self.fields,
        )


def _inelasticity_nodes(settings: Settings, count: int) -> Array:
    x_max = settings.largest_inelasticity / (settings.largest_inelasticity + settings.stretch)
    x = np.linspace(0.0, x_max, count)
    nodes = settings.stretch * x / (1.0 - x)
    nodes[-1] = settings.largest_inelasticity  # not one rounding error beyond
    return nodes


def _segments(law: Law, settings: Settings) -> tuple[Array, ...]:
    bounds = [math.log(kink) for kink in law.kinks if kink < settings.largest_overload]
    bounds.append(math.log(settings.largest_overload))
    return tuple(
        np.linspace(low, high, max(5, 1 + math.ceil((high - low) / settings.log_overload_step)))
        for low, high in zip(bounds[:-1], bounds[1:], strict=True)
    )


def _no_progress(rows: Iterator[Array], total: int) -> Iterable[Array]:
    return rows


def build(
    law: str,
    settings: Settings | None = None,
    *,
    progress: Callable[[Iterator[Array], int], Iterable[Array]] = _no_progress,
) -> Table:
    """Sweep the equation over all nodes, on all cores.

    Parameters
    ----------
    law : str
        Name of a law that yields.
    settings : Settings, optional
        Extent and fineness.
    progress : callable, optional
        ``progress(rows, total)`` wraps the iterator over finished rows, as ``tqdm`` does.

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
    functions, hertz = chosen.functions, find_law("hertz").functions
    lam = _inelasticity_nodes(settings, settings.inelasticity_nodes)
    segments = _segments(chosen, settings)
    log_chi = np.concatenate(segments)

    def elastic_peak(value: float) -> float:
        status, w_m = zener.elastic_compression(hertz, value, settings.rtol)
        if status != zener.OK:
            raise RuntimeError(f"w_m({value:.6g}) did not solve: {zener.MESSAGES[status]}")
        return float(w_m)

    def row(value: float) -> Array:
        y = elastic_peak(value) / np.exp(log_chi)
        out = np.empty((len(FIELDS) + 1, y.size))
        lams = np.full_like(y, value)
        status, j = zener.solve_all(functions, hertz, lams, y, settings.rtol, out)
        if status != zener.OK:
            raise RuntimeError(
                f"table for law {law!r}: the node lambda = {value:.6g}, chi = "
                f"{math.exp(log_chi[j]):.6g} did not solve: {zener.MESSAGES[status]}"
            )
        return out[:-1]

    row(lam[0])  # compile once, before the threads ask for it
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        values = np.stack(list(progress(pool.map(row, lam), len(lam))), axis=1)
    return Table(
        law=law,
        settings=settings,
        segments=segments,
        elastic_compression=np.array(
            [elastic_peak(v) for v in _inelasticity_nodes(settings, settings.elastic_nodes)]
        ),
        fields=dict(zip(FIELDS, values, strict=True)),
    )
