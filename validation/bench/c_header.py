"""The C header against the numba kernels: lookups and time steps of the same impacts."""

from __future__ import annotations

import ctypes
import math
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw._jit import kernel
from contactlaw.softsphere import PARTED, Spring, advance, resized, unit_spring
from validation.bench.row import Row, in_turns
from validation.hostile.headers import compiled

Array = NDArray[np.float64]

N, WALK = 200_000, 400  # impacts; overlaps of one contact, loading and unloading
ROUNDS = 30
_SOURCE = """
#include "contactlaw.h"
void lookups(int n, const double *v, const double *r, const double *h, double *out)
{
    int k;
    for (k = 0; k < n; ++k)
        out[k] = contactlaw_restitution(v[k], r[k], h[k]);
}
void steps(int n, const double *x, int walks, double radius, double thickness, double dt,
           double *out)
{
    const contactlaw_spring spring = contactlaw_spring_of(radius, thickness);
    int i, k;
    for (i = 0; i < walks; ++i) {
        contactlaw_state state = CONTACTLAW_APART;
        for (k = 0; k < n; ++k)
            out[k] = contactlaw_step(&spring, &state, x[k], dt);
    }
}
"""


def rows() -> Iterator[Row]:
    """Measure with the laws myc and fem."""
    if not shutil.which("gcc"):
        raise RuntimeError("no gcc on PATH: the C header cannot be measured")
    pairs = {"myc": ("gamma-alumina", "glass"), "fem": ("bearing-steel-52100", "aluminium-6061-t6")}
    for law, bodies in pairs.items():
        model = cl.ImpactModel(cl.Pair(*bodies), law=law)
        with tempfile.TemporaryDirectory() as folder:
            library = compiled(model, Path(folder), _SOURCE, "-O3")
        yield _lookups(model, library)
        yield _steps(model, library)


def _pointer(values: Array) -> Any:
    return values.ctypes.data_as(ctypes.c_void_p)


def _in_turns(in_c: Callable[[], object], in_numba: Callable[[], object]) -> tuple[float, float]:
    """Least CPU time of each [s]; wall time would count other processes."""
    taken = in_turns({"C": in_c, "numba": in_numba}, ROUNDS, time.process_time)
    return float(taken["C"].min()), float(taken["numba"].min())


def _lookups(model: cl.ImpactModel, library: ctypes.CDLL) -> Row:
    rng = np.random.default_rng(0)
    v = np.exp(rng.uniform(math.log(0.05), math.log(20.0), N))
    r = rng.uniform(0.2e-3, 3e-3, N)
    h = r * rng.uniform(0.8, 10.0, N)
    cor, ours, theirs = model.kernel, np.empty(N), np.empty(N)

    @kernel(entry=True)
    def loop(v: Array, r: Array, h: Array, out: Array) -> None:
        for n in range(v.size):
            out[n] = cor(v[n], r[n], h[n])

    arguments = (ctypes.c_int(N), *map(_pointer, (v, r, h, ours)))
    in_c, in_numba = _in_turns(lambda: library.lookups(*arguments), lambda: loop(v, r, h, theirs))
    inside = ~np.isnan(theirs)
    assert np.abs(ours - theirs)[inside].max() < 1e-5
    return Row(
        f"C header, {model.force_law.family}: lookup",
        in_c / N * 1e9,
        "ns",
        peer="model.kernel",
        ratio=in_numba / in_c,
        least_ratio=1.0,
        note="gcc -O3, one by one",
    )


@kernel(entry=True)
def _walk(law: Array, spring: Spring, x: Array, walks: int, dt: float, out: Array) -> None:
    for _ in range(walks):
        state = PARTED
        for n in range(x.size):
            state = advance(law, spring, state, x[n], dt)
            out[n] = state.force


def _steps(model: cl.ImpactModel, library: ctypes.CDLL) -> Row:
    """Measure the time steps of a contact far above yield."""
    radius, thickness = 0.9e-3, 3e-3
    hit = model.solve(10.0, radius, thickness)
    dt = float(hit.contact_time) / WALK
    x = float(hit.peak_compression) * np.sin(np.pi * (np.arange(WALK) + 0.5) / WALK)
    spring = resized(unit_spring(model, thickness), radius)
    ours, theirs, walks = np.empty(WALK), np.empty(WALK), N // WALK
    law, double = model.force_law.data, ctypes.c_double
    arguments = (
        ctypes.c_int(WALK),
        _pointer(x),
        ctypes.c_int(walks),
        double(radius),
        double(thickness),
        double(dt),
        _pointer(ours),
    )
    in_c, in_numba = _in_turns(lambda: library.steps(*arguments), lambda: _walk(law, spring, x, walks, dt, theirs))
    assert np.abs(ours - theirs).max() < 1e-10 * theirs.max()
    return Row(
        f"C header, {model.force_law.family}: step",
        in_c / N * 1e9,
        "ns",
        peer="softsphere.advance",
        ratio=in_numba / in_c,
        least_ratio=1.0,
        note="gcc -O3",
    )
