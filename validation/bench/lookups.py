"""Lookups: many at once, one by one from Python, and inside compiled loops.

The targets of batches are 17 times scipy's speed for myc, 10 for fem and 5.5 with a rate of strain. Measured on one
core of 2.6 GHz with vectors of four numbers: 12, 6 and 4. For four impacts of myc some 115 vector instructions
find the places, in 7 ns an impact, and a value takes 4 to 5 ns; fem's corrections are 130 instructions more. So the
places limit the speed. Cell polynomials in place of B-splines gained 0.8 ns, single weights per impact nothing.
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
from contactlaw._jit import kernel
from contactlaw.equation import outcome
from contactlaw.table import lookup
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
        17,
        "which is given table coordinates: it converts no SI units",
    )
    thick = np.maximum(h, r / 1.5)  # inelasticities in the tables
    rated, metal, lossy, polymer = (
        of(body, r, thick)
        for one, field in ((_METAL, "rate"), (_POLYMER, "loss_factor"))
        for body in (one, dataclasses.replace(one, **{field: None}))  # type: ignore[arg-type]
    )
    yield Row("batch, fem", metal * 1e9, "ns", None, "RectBivariateSpline.ev", spline / metal, 10)
    yield Row("batch, fem with a rate", rated * 1e9, "ns", None, "RectBivariateSpline.ev", spline / rated, 5.5)
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
    yield Row("batch, all fields of Rebound", full * 1e9, "ns", 80)
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
    """Time per point of scipy's interpolation on the same nodes beyond yield [s]."""
    grid = model.table.grid
    axes, (lam, y, _) = grid.axes, (each[0, :, int(grid.axes.below) + 1 :] for each in grid.nodes())
    found = outcome.at(lam.ravel(), y.ravel())
    lookup.fields(model.table.packed, True, found)
    nodes = [np.linspace(0.0, 1.0, count) for count in lam.shape]
    spline = RectBivariateSpline(*nodes, found.restitution.reshape(lam.shape), s=0)
    some = slice(0, N, 10)
    hit = model.lookup(v[some], r[some], h[some])
    x = np.asarray(hit.inelasticity / (hit.inelasticity + lookup.STRETCH)) / axes.x_max
    place = np.clip(np.log(hit.overload) / np.log(model.table.settings.largest_overload), 0.0, 1.0)
    return seconds(lambda: spline.ev(x, place), 3) / x.size


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
