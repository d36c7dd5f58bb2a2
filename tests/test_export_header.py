"""The C header: compiled by gcc and g++, called through ctypes, beside what Python answers."""

import ctypes
import dataclasses
import math
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from test_own_laws import measured, own
from test_softsphere import drop

import contactlaw as cl
from contactlaw import cli, laws
from contactlaw._jit import kernel
from contactlaw._version import VERSION
from contactlaw.equation import zener
from contactlaw.export import c_header
from contactlaw.physical.scaling import scales, sphere_on_plate
from contactlaw.softsphere import resized, unit_spring
from contactlaw.table import lookup
from contactlaw.table.nodes import coarser

ROOT = Path(__file__).parent.parent
COMPILERS = {"gcc": ["-std=c99"], "g++": ["-std=c++11", "-x", "c++"]}
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
PAIR = cl.Pair("gamma-alumina", "glass")
STEEL = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
# every registered law, the one with next orders of the plate for three kinds of bodies, and two of
# a user's own
MODELS = {name: (PAIR, name) for name in laws.names()}
MODELS |= {"fem, metals": (STEEL, "fem"), "fem, elastic": (cl.Pair("glass", "glass"), "fem")}
MODELS |= {"own": (PAIR, own()), "measured": (PAIR, measured())}
FIELDS = (
    "restitution", "contact_time", "loading_time", "peak_force", "peak_compression",
    "residual_compression", "plastic_fraction", "wave_fraction", "other_fraction", "inelasticity",
)  # fmt: skip
CALLS = """
#include "contactlaw.h"
#ifdef __cplusplus
extern "C"
#endif
void lookups(int n, const double *v, const double *r, const double *h, double *out)
{
    int k;
    for (k = 0; k < n; ++k)
        out[k] = contactlaw_restitution(v[k], r[k], h[k]);
}

#ifdef __cplusplus
extern "C"
#endif
void rebounds(int n, const double *v, const double *r, const double *h, contactlaw_impact *out)
{
    int k;
    for (k = 0; k < n; ++k)
        out[k] = contactlaw_rebound(v[k], r[k], h[k]);
}

#ifdef __cplusplus
extern "C"
#endif
double step(const contactlaw_spring *spring, contactlaw_state *state, double x, double u, double dt)
{
    return contactlaw_step(spring, state, x, u, dt);
}

#ifdef __cplusplus
extern "C"
#endif
contactlaw_spring spring_of(double radius, double thickness)
{
    return contactlaw_spring_of(radius, thickness);
}

#ifdef __cplusplus
extern "C"
#endif
void drops(int n, const double *v, const double *r, const double *h, const double *dt,
           const double *phase, double *out)
{
    int i, k;
    for (k = 0; k < n; ++k) {
        const contactlaw_spring spring = contactlaw_spring_of(r[k], h[k]);
        contactlaw_state state = CONTACTLAW_APART;
        double x = -phase[k] * v[k] * dt[k], u = v[k];
        out[k] = (double)NAN;
        for (i = 0; i < 10000000; ++i) {
            u -= 0.5 * dt[k] * state.force / spring.mass;
            x += u * dt[k];
            contactlaw_step(&spring, &state, x, u, dt[k]);
            u -= 0.5 * dt[k] * state.force / spring.mass;
            if (i > 2 && state.force == 0.0 && u < 0.0) {
                out[k] = -u / v[k];
                break;
            }
        }
    }
}
"""


@pytest.fixture(scope="module", autouse=True)
def compilers():
    for name in COMPILERS:
        if not shutil.which(name):
            pytest.skip(f"no {name} on PATH: the header is not compiled")


def model_of(name, **options):
    pair, law = MODELS[name]
    return cl.ImpactModel(pair, law=law, **options)


def build(folder, source, *flags, compiler="gcc", out="out"):
    """Compile a source beside a header; the file that comes of it."""
    path = folder / "source.c"
    path.write_text(source)
    command = [compiler, *COMPILERS[compiler], *flags, path, "-o", folder / out, "-lm"]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[:2000]
    assert done.stderr == ""
    return folder / out


@pytest.fixture(scope="module", params=MODELS, ids=str)
def compiled(request, tmp_path_factory):
    """A model, its header's table, and the header as a library."""
    model, folder = model_of(request.param), tmp_path_factory.mktemp("header")
    cl.export.header(folder / "contactlaw.h", model)
    library = ctypes.CDLL(build(folder, CALLS, "-O2", "-shared", "-fPIC", *WARNINGS, out="out.so"))
    return model, library, folder


def pointer(values):
    return values.ctypes.data_as(ctypes.c_void_p)


def called(function, size, *columns, fields=1):
    """Call a C function of arrays; rows of what it gives."""
    out = np.full((size, fields), -1.0)
    columns = [np.ascontiguousarray(column, dtype=np.float64) for column in columns]
    assert all(column.size == size for column in columns)
    function(ctypes.c_int(size), *map(pointer, columns), pointer(out))
    return out[:, 0] if fields == 1 else out


def impacts(count, seed):
    """Speeds, radii and thicknesses: lambda from 0 to 100, speeds far below and above yield."""
    rng = np.random.default_rng(seed)
    v = np.exp(rng.uniform(math.log(1e-3), math.log(60.0), count))
    r = np.exp(rng.uniform(math.log(1e-4), math.log(1e-2), count))
    h = r * np.exp(rng.uniform(math.log(0.05), math.log(30.0), count))
    h[rng.random(count) < 0.05] = math.inf
    return v, r, h


@kernel
def lookups(table, c_lam, c_chi, v, r, h, out):
    for n in range(out.size):
        out[n] = lookup.restitution_on_plate(table, c_lam, c_chi, v[n], r[n], h[n])


def test_a_lookup_is_that_of_numba_in_the_same_table(compiled):
    """1e5 random impacts, some of them outside."""
    model, library, _ = compiled
    table = coarser(model.table, c_header.ERROR)
    bare = dataclasses.replace(table, certificate=None)  # which a model would warn of
    peer = cl.ImpactModel(model.pair, model.force_law, table=bare)
    v, r, h = impacts(100_000, seed=1)
    expected = np.empty(v.size)
    lookups(peer._table, peer._c_lam, peer._c_chi, v, r, h, expected)
    found = called(library.lookups, v.size, v, r, h)
    outside = np.isnan(expected)
    assert 0.005 < outside.mean() < 0.6
    assert (np.isnan(found) == outside).all()
    assert np.abs(found - expected)[~outside].max() < 1e-12
    whole = np.empty(v.size)
    lookups(model._table, model._c_lam, model._c_chi, v, r, h, whole)
    assert np.abs(found - whole)[~outside].max() < 1e-5
    assert table.certificate.largest["restitution"] < 1e-5


def test_a_contact_by_steps_is_that_of_softsphere(compiled):
    """2000 random impacts at 15 to 120 steps a contact."""
    model, library, _ = compiled
    v, r, h = impacts(2000, seed=2)
    rng = np.random.default_rng(3)
    units = scales(sphere_on_plate(model.pair, model.force_law, r, h), v)
    keep = units.inelasticity < 3.0  # at most; beyond, nothing comes back
    v, r, h = v[keep], r[keep], h[keep]
    dt = 3.2 * units.time[keep] / np.exp(rng.uniform(math.log(15.0), math.log(120.0), v.size))
    phase = rng.uniform(0.02, 0.98, v.size)
    expected = np.array(
        [
            drop(model.force_law.data, resized(unit_spring(model, h[n]), r[n]), v[n], dt[n], phase[n])
            for n in range(v.size)
        ]
    )
    found = called(library.drops, v.size, v, r, h, dt, phase)
    assert v.size > 1000
    assert 0.0 < found.min() <= found.max() <= 1.001
    assert np.abs(found - expected).max() < 1e-10


def test_a_rebound_is_the_solvers(compiled):
    model, library, _ = compiled
    v, r, h = impacts(300, seed=4)
    units = scales(sphere_on_plate(model.pair, model.force_law, r, h), v)
    keep = units.inelasticity < 10.0
    v, r, h = v[keep], r[keep], h[keep]
    found = called(library.rebounds, v.size, v, r, h, fields=len(FIELDS))
    expected = dataclasses.asdict(model.solve(v, r, h))
    units = scales(sphere_on_plate(model.pair, model.force_law, r, h), v)
    y = np.where(np.isfinite(units.yield_ratio), units.yield_ratio, 1.0)
    solved = [zener.solve(model.force_law.data, *at, 1e-10) for at in zip(units.inelasticity, y)]
    expected["loading_time"] = [one.loading_time for one in solved] * units.time
    for name, values in zip(FIELDS, found.T, strict=True):
        # residual compression begins at yield as (chi - 1)^2; lambda is 0 on a half-space
        absolute = name.endswith("fraction") or name in ("restitution", "inelasticity")
        whole = name.replace("residual", "peak")
        scale = 1.0 if absolute else expected[whole]
        assert np.abs((values - expected[name]) / scale).max() < 1e-8, name
    energy = found[:, 0] ** 2 + found[:, 6] + found[:, 7] + found[:, 8]
    assert np.abs(energy - 1.0).max() < 1e-8


@pytest.mark.parametrize("table", ["cor", "none"])
@pytest.mark.parametrize("name", MODELS)
def test_compilers_have_nothing_to_say(name, table, tmp_path):
    cl.export.header(tmp_path / "contactlaw.h", model_of(name), table)
    assert (tmp_path / "contactlaw.h").stat().st_size <= 500_000
    source = CALLS if table == "cor" else '#include "contactlaw.h"\n'
    for compiler in COMPILERS:
        build(tmp_path, source, "-c", "-O1", *WARNINGS, compiler=compiler)
