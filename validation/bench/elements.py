"""The finite elements: time per element and step, and of the paper's whole impact."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from validation.bench.row import Row, seconds
from validation.fem.elements import Body, add_forces
from validation.fem.impact import Impact, impact
from validation.paper.setting import PAIR, RADIUS

Array = NDArray[np.float64]

_SPEED, _THICKNESS, _WIDTH = 26.0, 0.5e-3, 0.15  # impact of the paper's Figs 11 to 13 [m/s, m, m]


def rows() -> Iterator[Row]:
    """Measure a step of all elements, and an impact on a plate as wide as the paper's."""
    hit = impact(PAIR, _SPEED, RADIUS, _THICKNESS, size=0.02)  # compiles
    system = hit.system
    bodies = system.sphere, system.plate
    count = sum(len(body.elements) for body in bodies)

    def step() -> None:
        for body in bodies:
            add_forces(body, system.x, system.v, 0.0, system.force)

    def traffic() -> None:
        for body in bodies:
            _only_move(body, system.x, system.v, system.force)

    traffic()
    alone = seconds(traffic, 50) / count
    each = seconds(step, 50) / count
    yield Row(
        "finite element, forces and stress", each * 1e9, "ns", None, "moving its data alone",
        alone / each, note=f"{count} elements",
    )  # fmt: skip
    found: list[Impact] = []

    def whole() -> None:
        found.append(impact(PAIR, _SPEED, RADIUS, _THICKNESS, size=0.01, width=_WIDTH))

    taken = seconds(whole, 1)
    one = found[-1]
    each = taken / one.elements / one.steps
    yield Row(
        "finite element and step, impact", each * 1e9, "ns", 30, "moving its data alone",
        alone / each, note="forces, nodes, contact, history",
    )  # fmt: skip
    yield Row("the paper's impact, 0.01 R", taken, "s", 15, note=f"{one.elements} elements")


@kernel(entry=True)
def _only_move(body: Body, x: Array, v: Array, force: Array) -> None:
    """Read and write what an element must, and compute next to nothing."""
    for e in range(body.elements.shape[0]):
        for c in range(2):
            total = 0.0
            for k in range(4):
                n = body.elements[e, k]
                total += x[n, c] + v[n, c]
            for k in range(4):
                force[body.elements[e, k], c] += 0.0 * total
        for k in range(4):
            body.stress[e, k] += 0.0
        for k in range(2):
            body.hourglass[e, k] += 0.0
