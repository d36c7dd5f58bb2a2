"""The rain of the demo in pymunk: what the model costs an engine."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from unittest import mock

import pymunk

import contactlaw as cl
from contactlaw.engines import pymunk as adapter
from dem_demo.rain import nozzles
from dem_demo.rain.engine import Rain
from dem_demo.rain.scene import Scene
from validation.bench.row import Row

BEADS, COR, REPEAT = 1000, 0.9, 2
DURATION = 0.6  # [s]; beads enter in the first third, all have hit a plate by the end


class _Constant:
    """One COR for all contacts, which an engine takes like an `ImpactModel`."""

    restitution = COR

    def __init__(self, pair: cl.Pair) -> None:
        self.pair = pair

    def curve(self, radius: float, thickness: float) -> Callable[[float], float]:
        return lambda speed: COR

    sphere_sphere_curve = curve


class _Elasticities:
    """pymunk as it comes: a constant COR, no adapter, no records."""

    def __init__(self, space: pymunk.Space, model: _Constant) -> None:
        self.each = model.restitution**0.5  # pymunk multiplies the two

    def add_plate(self, segment: pymunk.Segment, thickness: float, **_: object) -> None:
        segment.elasticity = self.each

    def add_bead(self, circle: pymunk.Circle) -> None:
        circle.elasticity = self.each


def rows() -> Iterator[Row]:
    """Measure the same rain with the model, with one COR, and with pymunk alone, in turn."""
    pair = cl.Pair("gamma-alumina", "glass")
    scene = nozzles.rain(beads=BEADS, duration=DURATION)
    constant = _Constant(pair)
    times: dict[str, list[float]] = {"model": [], "adapter": [], "plain": []}
    for _ in range(REPEAT):
        times["model"].append(_run(scene, cl.ImpactModel(pair, law="myc")))
        times["adapter"].append(_run(scene, constant))
        with mock.patch.object(adapter, "attach", _Elasticities):
            times["plain"].append(_run(scene, constant))
    least = {name: min(values) for name, values in times.items()}
    yield Row(
        f"rain, {BEADS} beads, over one COR", least["model"] / least["adapter"], "x", 1.25,
        note=f"{least['model']:.2f} s; with one COR {least['adapter']:.2f} s",
    )  # fmt: skip
    yield Row(
        "the same over pymunk alone", least["model"] / least["plain"], "x",
        note=f"{least['plain']:.2f} s: no adapter, so no records and no look-ahead either",
    )  # fmt: skip


def _run(scene: Scene, model: cl.ImpactModel | _Constant) -> float:
    rain = Rain(scene, model)  # type: ignore[arg-type]
    start = time.perf_counter()
    for _ in range(scene.frames):
        rain.advance()
    return time.perf_counter() - start
