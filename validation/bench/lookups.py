"""Lookups: many at once, one by one from Python, and inside compiled loops."""

from __future__ import annotations

import ctypes
import dataclasses
import functools
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numba
import numpy as np
from interpn import interpn
from scipy.interpolate import RectBivariateSpline

import contactlaw as cl
from contactlaw import laws
from contactlaw.table import file
from validation.bench.row import Row, per_call, seconds

N = 1_000_000
_INPUT_AND_OUTPUT = 4 * 8  # bytes per impact: speed, radius, thickness in, COR out


def impacts(model: cl.ImpactModel) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Random impacts all over the table: speed, radius, thickness."""
    rng = np.random.default_rng(0)
    speed = model.pair.yield_speed * np.exp(rng.uniform(np.log(0.05), np.log(50), N))
    radius = rng.uniform(0.2e-3, 5e-3, N)
    return speed, radius, radius / rng.uniform(0.05, 4.0, N)


# Times of scipy's spline over those of the last release: this benchmark on that release's code.
RELEASED: dict[str, Any] = json.loads(Path(__file__).with_name("released.json").read_text("utf-8"))
_WORST = 0.8  # ratio over the last release's, below which a target is not met


def rows() -> Iterator[Row]:
    """Measure lookups; one that is 20 % slower than in the last release fails, beside scipy."""
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    v, r, h = impacts(model)
    batch = seconds(lambda: model.restitution(v, r, h)) / N
    spline, cubic = peers(model, v, r, h)
    log_exp = seconds(lambda: np.exp(np.log(v))) / N
    copied = np.empty_like(v)
    bandwidth = 2 * 8 / (seconds(lambda: np.copyto(copied, v)) / N)
    limit = _INPUT_AND_OUTPUT / bandwidth
    yield Row(
        "batch, SI in, COR out", batch * 1e9, "ns", 20, "RectBivariateSpline.ev", spline / batch,
        8, f"memory alone would take {limit * 1e9:.1f} ns ({bandwidth / 1e9:.0f} GB/s): "
        f"{batch / limit:.0f}x; numpy's exp(log(v)) takes {log_exp * 1e9:.1f} ns",
    )  # fmt: skip
    yield Row(
        "the same", batch * 1e9, "ns", None, "interpn, cubic, one thread", cubic / batch,
        note="the peers are given table coordinates: they convert no SI units",
    )  # fmt: skip
    metal = cl.Material("copper", 124e9, 0.34, 8960, 90e6, kind="metal", rate=(0.025, 1.0))
    polymer = cl.Material("PMMA", 5e9, 0.35, 1190, 64e6, loss_factor=(0.06, 1e4), kind="polymer")
    yield beside("a rate of strain", metal, "rate", "a third axis: the strength")
    yield beside("a loss factor", polymer, "loss_factor", "a logarithm and three powers more")
    full = seconds(lambda: model.lookup(v, r, h)) / N
    yield Row(
        "batch, all fields of Rebound", full * 1e9, "ns", 60,
        note="17 arrays of 8 bytes are written and read; the splines take 27 ns, the law 24 ns",
    )  # fmt: skip
    plain = cl.ImpactModel(cl.Pair(dataclasses.replace(metal, rate=None), "glass"))
    rated = cl.ImpactModel(cl.Pair(metal, "glass"))
    h = np.maximum(h, r / 1.5)  # inelasticities in the tables
    looked_up = {"myc": batch, "all fields, myc": full}
    for name, one in (("fem", plain), ("fem, a rate", rated)):
        speed = impacts(one)[0]
        looked_up[name] = seconds(functools.partial(one.restitution, speed, r, h)) / N
    looked_up["scalar, myc"] = per_call(lambda: model.restitution(5.0, 0.9e-3, 1e-3))
    for name, took in looked_up.items():
        before = RELEASED["ratios"][name]
        yield Row(
            f"as released: {name}", took * 1e9, "ns", None, "scipy", spline / took,
            _WORST * before, f"{before:.3g}x in {RELEASED['version']}",
        )  # fmt: skip
    yield from one_by_one(model, v, r, h)


def beside(what: str, body: cl.Material, field: str, note: str) -> Row:
    """Time of a COR of a bead on glass, beside that of the bead without a field of its material."""
    without: dict[str, Any] = {field: None}
    pairs = (cl.Pair(one, "glass") for one in (body, dataclasses.replace(body, **without)))
    models = [cl.ImpactModel(pair) for pair in pairs]
    v, r, h = impacts(models[0])
    h = np.maximum(h, r / 1.5)  # inelasticities in the table
    times = [seconds(functools.partial(one.restitution, v, r, h)) / N for one in models]
    return Row(
        f"batch, with {what}", times[0] * 1e9, "ns", 25, "without", times[1] / times[0], note=note
    )  # fmt: skip


def peers(
    model: cl.ImpactModel, v: np.ndarray, r: np.ndarray, h: np.ndarray
) -> tuple[float, float]:
    """Time per point of scipy's and interpn's interpolation on the same nodes [s]."""
    table = file.packaged(laws.law("myc"))
    assert table is not None
    nodes = table.grid.nodes()[1][0]  # both kinks of myc are lines of constant chi
    at_kink = table.grid.axes[1].sizes[0]
    nodes = np.delete(nodes, at_kink)
    values = np.delete(table.fields["restitution"], at_kink, axis=1)
    c = table.settings.stretch
    x_nodes = table.grid.axes[0].mapped(table.grid.rows)
    some = slice(0, N, 10)
    hit = model.lookup(v[some], r[some], h[some])
    x = np.asarray(hit.inelasticity / (hit.inelasticity + c))
    y = np.maximum(np.log(hit.overload), 0.0)
    spline = RectBivariateSpline(x_nodes, nodes, values, s=0)
    at_spline = seconds(lambda: spline.ev(x, y), 3) / x.size
    grid, points = [x_nodes, nodes], [np.ascontiguousarray(x), y]
    at_cubic = seconds(lambda: interpn(points, grid, values, method="cubic", max_threads=1), 3)
    return at_spline, at_cubic / x.size


def one_by_one(model: cl.ImpactModel, v: np.ndarray, r: np.ndarray, h: np.ndarray) -> Iterator[Row]:
    """Measure scalar calls: from Python, inside a jitted loop, through the C function."""
    scalar = per_call(lambda: model.restitution(5.0, 0.9e-3, 1e-3))
    yield Row("scalar, from Python", scalar * 1e6, "us", 2)
    curve = model.curve(0.9e-3, 1e-3)
    yield Row("model.curve, from Python", per_call(lambda: curve(5.0)) * 1e6, "us", 0.4)
    cor = model.kernel

    @numba.njit
    def loop(v: np.ndarray, r: np.ndarray, h: np.ndarray, out: np.ndarray) -> None:
        for i in range(v.size):
            out[i] = cor(v[i], r[i], h[i])

    out = np.empty_like(v)
    inside = seconds(lambda: loop(v, r, h, out)) / N
    yield Row(
        "model.kernel in a jitted loop", inside * 1e9, "ns", 40,
        note="one impact at a time leaves the vector units idle: the batch needs a quarter",
    )  # fmt: skip
    double = ctypes.c_double
    pointer = ctypes.CFUNCTYPE(double, double, double, double)(model.address)
    yield oblique(model, v, r, h, inside)
    through = per_call(lambda: pointer(5.0, 0.9e-3, 1e-3))
    yield Row("model.address, through ctypes", through * 1e6, "us", note="ctypes' own overhead")


def oblique(
    model: cl.ImpactModel, v: np.ndarray, r: np.ndarray, h: np.ndarray, normal: float
) -> Row:
    """Time that the tangential rebound adds to that of the normal answer, on one core."""
    collide = model.collide_kernel

    @numba.njit
    def loop(v: np.ndarray, s: np.ndarray, r: np.ndarray, h: np.ndarray, out: np.ndarray) -> None:
        up, still = (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
        for i in range(v.size):
            after, _ = collide((s[i], 0.0, -v[i]), still, up, r[i], h[i], 0.3, still)
            out[i] = after[0]

    slides = np.random.default_rng(1).uniform(0.0, 8.0, N) * 0.3 * v
    out = np.empty_like(v)
    with_friction = seconds(lambda: loop(v, slides, r, h, out)) / N
    some = slice(0, N, 1000)
    given = v[some], slides[some], r[some], h[some], 0.3
    integrated = seconds(lambda: model.oblique(*given, method="solve"), 3) / (N / 1000)
    added = with_friction - normal
    return Row(
        "model.collide_kernel, beyond model.kernel", added * 1e9, "ns", 60,
        "integration", integrated / added,
    )  # fmt: skip
