"""The rain of the demo in pymunk: what the model costs an engine."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any
from unittest import mock

import numpy as np
import pymunk

import contactlaw as cl
from contactlaw._arrays import Array
from contactlaw.engines import pymunk as adapter
from dem_demo.rain.engine import Rain
from dem_demo.rain.scene import rain as drawn
from validation.bench.row import Row, in_turns

BEADS, COR = 1000, 0.9
DURATION = 0.6  # [s]; beads enter in the first third, all have hit a plate by the end


class _Constant:
    """One COR for all contacts, which an engine takes like an `ImpactModel`."""

    restitution = COR

    def __init__(self, pair: cl.Pair) -> None:
        self.pair = pair

    def curve(self, radius: float, thickness: float) -> Callable[[float], float]:
        return lambda speed: COR

    sphere_sphere_curve = curve
    edge_kernel = None

    def solve(self, *_: float) -> SimpleNamespace:
        return SimpleNamespace(contact_time=1e-12)  # so short that no edge is felt


class _Elasticities:
    """pymunk as it comes: a constant COR, no adapter, no records."""

    def __init__(self, space: pymunk.Space, model: _Constant) -> None:
        self.each = model.restitution**0.5  # pymunk multiplies the two

    def add_plate(self, segment: pymunk.Segment, thickness: float, **_: object) -> None:
        segment.elasticity = self.each

    def add_bead(self, circle: pymunk.Circle) -> None:
        circle.elasticity = self.each

    def loads(self) -> tuple[float, Array, Array, Array]:
        return 0.0, np.zeros((5, 3)), np.zeros((5, 3)), np.zeros(5)  # of the five plates


def rows() -> Iterator[Row]:
    """Measure the same rain with the model, with one COR, and with pymunk alone."""
    pair = cl.Pair("gamma-alumina", "glass")
    scene, constant = drawn(beads=BEADS, duration=DURATION), _Constant(pair)

    def run(model: Any) -> None:
        rain = Rain(scene, model)
        for _ in range(scene.frames):
            rain.advance()

    def plain() -> None:
        with mock.patch.object(adapter, "attach", _Elasticities):
            run(constant)

    model = cl.ImpactModel(pair, law="myc")
    tasks = {"model": lambda: run(model), "adapter": lambda: run(constant), "plain": plain}
    least = {name: float(taken.min()) for name, taken in in_turns(tasks, 2).items()}
    for peer, target in (("adapter", 1.25), ("plain", None)):
        yield Row(
            f"rain, {BEADS} beads, over one COR, {peer}",
            least["model"] / least[peer],
            "x",
            target,
            note=f"{least['model']:.2f} s; with one COR {least[peer]:.2f} s",
        )
