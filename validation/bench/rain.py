"""The rain of the demo in pymunk: what the model costs an engine."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any
from unittest import mock

import numpy as np
import pymunk

import contactlaw as cl
from contactlaw.engines import pymunk as adapter
from dem_demo.rain.engine import Rain
from dem_demo.rain.scene import rain as drawn
from validation.bench.row import Row, in_turns

BEADS, COR = 1000, 0.9
DURATION = 0.6  # [s]; beads enter in the first third, all have hit a plate by the end


class _Constant(cl.ImpactModel):
    """One COR for all contacts, near edges and far from them."""

    def curve(self, *_: Any) -> Callable[..., float]:
        return lambda *impact: COR

    sphere_sphere_curve = edge_kernel = curve  # type: ignore[assignment]


class _Elasticities:
    """pymunk as it comes: a constant COR, no adapter, no records."""

    def __init__(self, space: pymunk.Space, model: _Constant) -> None:
        self.each = COR**0.5  # pymunk multiplies the two

    def add_plate(self, segment: pymunk.Segment, thickness: float, **_: object) -> None:
        segment.elasticity = self.each

    def add_bead(self, circle: pymunk.Circle) -> None:
        circle.elasticity = self.each

    def loads(self) -> tuple[float, Any]:
        return 0.0, np.zeros((5, 7))  # of the five plates


def rows() -> Iterator[Row]:
    """Measure the same rain with the model, with one COR, and with pymunk alone."""
    pair = cl.Pair("gamma-alumina", "glass")
    scene, constant = drawn(beads=BEADS, duration=DURATION), _Constant(pair, law="myc")

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
