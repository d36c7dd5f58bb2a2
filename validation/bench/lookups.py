"""Lookups: many at once, one by one from Python, and inside compiled loops.

The targets of batches, 18 times scipy's speed for myc and 14 for fem, are not met: 13 and 7.7 on a
quiet machine with 512-bit vectors. Beside the fastest code of before, in the same run, today's takes
the same time (myc 12.5 ns for 12.3, fem 21.5 for 21.0). Of an impact's time the coordinates take 4 ns
with a thin plate and 11 with a real one, whose corrections have eight divisions; finding the cell
takes 2 to 4.5, reading 16 coefficients and their sum 6. Tried, and left out: coefficients as float32
(slower by half: vectors of four are put together anew), vectors of 512 bits (4 % faster), weights of
rows and sums in memory (3 %), two divisions less and kinks that neighbours share (5 % for fem),
chunks of 64 to 256 impacts (slower).
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RectBivariateSpline

import contactlaw as cl
from contactlaw import laws
from contactlaw._jit import kernel
from contactlaw.table import file
from validation.bench.row import Row, per_call, seconds

Array = NDArray[np.float64]

N = 1_000_000
# Times of scipy's spline over those of the last release: this benchmark on that release's code.
RELEASED: dict[str, Any] = json.loads(Path(__file__).with_name("released.json").read_text("utf-8"))
_WORST = 0.8  # ratio over the last release's, below which a target is not met
_METAL = cl.Material("copper", 124e9, 0.34, 8960, 90e6, kind="metal", rate=(0.025, 1.0))
_POLYMER = cl.Material("PMMA", 5e9, 0.35, 1190, 64e6, loss_factor=(0.06, 1e4), kind="polymer")


def rows() -> Iterator[Row]:
    """Measure lookups; one that is 20 % slower than in the last release fails, beside scipy."""
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    v, r, h = impacts(model)
    batch = seconds(lambda: model.restitution(v, r, h)) / N
    spline = by_scipy(model, v, r, h)
    yield Row(
        "batch, SI in, COR out",
        batch * 1e9,
        "ns",
        20,
        "RectBivariateSpline.ev",
        spline / batch,
        18,
        "which is given table coordinates: it converts no SI units",
    )
    thick = np.maximum(h, r / 1.5)  # inelasticities in the tables
    rated, metal, lossy, polymer = (
        of(body, r, thick)
        for one, field in ((_METAL, "rate"), (_POLYMER, "loss_factor"))
        for body in (one, dataclasses.replace(one, **{field: None}))  # type: ignore[arg-type]
    )
    yield Row("batch, fem", metal * 1e9, "ns", None, "RectBivariateSpline.ev", spline / metal, 14)
    for name, took, without in (("a rate", rated, metal), ("a loss factor", lossy, polymer)):
        yield Row(f"batch, with {name}", took * 1e9, "ns", 25, "without", without / took)
    scalar = per_call(lambda: model.restitution(5.0, 0.9e-3, 1e-3))
    full = seconds(lambda: model.lookup(v, r, h)) / N
    for name, took in {
        "myc": batch,
        "all fields, myc": full,
        "fem": metal,
        "fem, a rate": rated,
        "scalar, myc": scalar,
    }.items():
        before = RELEASED["ratios"][name]
        yield Row(
            f"as released: {name}",
            took * 1e9,
            "ns",
            None,
            "scipy",
            spline / took,
            _WORST * before,
            f"{before:.3g}x in {RELEASED['version']}",
        )
    yield Row("batch, all fields of Rebound", full * 1e9, "ns", 60)
    yield Row("scalar, from Python", scalar * 1e6, "us", 0.3)
    curve = model.curve(0.9e-3, 1e-3)
    yield Row("model.curve, from Python", per_call(lambda: curve(5.0)) * 1e6, "us", 0.4)
    yield from compiled(model, v, r, h)


def of(bead: cl.Material, r: Array, h: Array) -> float:
    """Time of a COR of a bead on glass, in a batch [s]."""
    model = cl.ImpactModel(cl.Pair(bead, "glass"))
    given = impacts(model)[0], r, h
    return seconds(lambda: model.restitution(*given)) / N


def impacts(model: cl.ImpactModel) -> tuple[Array, Array, Array]:
    """Random impacts all over the table: speed, radius, thickness."""
    rng = np.random.default_rng(0)
    speed = model.pair.yield_speed * np.exp(rng.uniform(np.log(0.05), np.log(50), N))
    radius = rng.uniform(0.2e-3, 5e-3, N)
    return speed, radius, radius / rng.uniform(0.05, 4.0, N)


def by_scipy(model: cl.ImpactModel, v: Array, r: Array, h: Array) -> float:
    """Time per point of scipy's interpolation on the same nodes [s]."""
    table = file.packaged(laws.law("myc"))
    assert table is not None
    nodes = table.grid.nodes()[1][0]  # both kinks of myc are lines of constant chi
    at_kink = table.grid.axes[1].sizes[0]
    values = np.delete(table.fields["restitution"], at_kink, axis=1)
    x_nodes = table.grid.axes[0].mapped(table.grid.rows)
    some = slice(0, N, 10)
    hit = model.lookup(v[some], r[some], h[some])
    x = np.asarray(hit.inelasticity / (hit.inelasticity + table.settings.stretch))
    y = np.maximum(np.log(hit.overload), 0.0)
    spline = RectBivariateSpline(x_nodes, np.delete(nodes, at_kink), values, s=0)
    return seconds(lambda: spline.ev(x, y), 3) / x.size


def compiled(model: cl.ImpactModel, v: Array, r: Array, h: Array) -> Iterator[Row]:
    """Measure one impact at a time in jitted loops, normal and oblique."""
    cor, collide, out = model.kernel, model.collide_kernel, np.empty_like(v)
    slides = np.random.default_rng(1).uniform(0.0, 8.0, N) * 0.3 * v

    @kernel(entry=True)
    def normal(v: Array, r: Array, h: Array, out: Array) -> None:
        for i in range(v.size):
            out[i] = cor(v[i], r[i], h[i])

    @kernel(entry=True)
    def oblique(v: Array, s: Array, r: Array, h: Array, out: Array) -> None:
        up, still = (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
        for i in range(v.size):
            after, _ = collide((s[i], 0.0, -v[i]), still, up, r[i], h[i], 0.3, still)
            out[i] = after[0]

    straight = seconds(lambda: normal(v, r, h, out)) / N
    yield Row("model.kernel in a jitted loop", straight * 1e9, "ns", 40)
    added = seconds(lambda: oblique(v, slides, r, h, out)) / N - straight
    yield Row("model.collide_kernel, beyond it", added * 1e9, "ns", 60)
