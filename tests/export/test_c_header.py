"""The C header, by gcc and g++: to the last bit what uncompiled Python computes, and the model."""

import ctypes
import dataclasses
import functools
import itertools
import math
import os
import pickle
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import header
import metal
import numpy as np
import polymer
import pytest
from own_laws import measured, own
from places import ROOT
from staying import STAYING
from verlet import drop

import contactlaw as cl
from contactlaw import Validity, cli, laws
from contactlaw import table as tables
from contactlaw._version import VERSION
from contactlaw.equation import zener
from contactlaw.equation.edge import KINDS
from contactlaw.export import c_header, functions
from contactlaw.laws import Law
from contactlaw.laws._branches import Loading
from contactlaw.physical.scaling import scales, sphere_on_plate
from contactlaw.physical.validity import flags_of
from contactlaw.softsphere import Contacts, resized, unit_spring
from contactlaw.table import Settings, nodes
from contactlaw.table.nodes import POINTS
from validation.hostile import headers

COMPILERS = {"gcc": ["-std=c99"], "g++": ["-std=c++11", "-x", "c++"]}
PAIR = cl.Pair("gamma-alumina", "glass")
STEEL = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
# Every registered law; fem, which has corrections to the thin-plate dashpot, for three kinds of
# bodies; two laws of a user's own; bodies with losses, with a rate of strain.
MODELS = {name: (PAIR, name) for name in laws.names()}
MODELS |= {"fem, metals": (STEEL, "fem"), "fem, elastic": (cl.Pair("glass", "glass"), "fem")}
MODELS |= {"own": (PAIR, own()), "measured": (PAIR, measured()), "a rate": (metal.PAIR, "fem")}
MODELS |= {"losses": (polymer.PAIRS[0], "fem"), "both": (polymer.PAIRS[2], "fem")}
MODELS["losses and flow"] = polymer.WEAK_MODEL.pair, "fem"
# Headers of other laws differ from that of myc in their numbers alone.
QUICK = "fem", "fem, metals", "myc", "own", "losses and flow", "a rate"
NAMES = [one if one in QUICK else pytest.param(one, marks=pytest.mark.long) for one in MODELS]
RATED = {"a rate": 1e-3, "both": 5e-3}  # whose laws are made at a few strengths, and their error
# Errors of steps near an edge, where they are not below 1e-3.
STEPS_NEAR = {"a rate": 2e-3, "both": 2e-3, "fem, elastic": 2e-3, "losses and flow": 5e-3}
FIELDS = functions.Impact._fields
DOUBLE = ctypes.c_double
# `answers` is the same as in uncompiled.py.
SOURCE = """
#include "contactlaw.h"
#include <string.h>
#ifdef __cplusplus
#define CALLED extern "C"
#else
#define CALLED
#endif

CALLED void answers(int n, const double *in, double *out)
{
    for (; n > 0; --n, in += 7) {
        const double v = in[0], r = in[1], h = in[2], mu = in[5], dt = in[6];
        const double normal[3] = { 0.0, 0.6, 0.8 }, still[3] = { 0.0, 0.0, 0.0 };
        const double leaning[3] = { 0.1, 0.0, 1.0 };
        const double surface[3] = { 0.3 * v, -0.7 * v, 0.1 * v };
        double velocity[3] = { 0.4 * v, 0.1 * v, -v }, spin[3] = { 3.0, 5.0, 7.0 };
        const contactlaw_impact hit = contactlaw_rebound(v, r, h);
        contactlaw_spring bead = contactlaw_spring_of(r, h);
        contactlaw_state state = CONTACTLAW_APART;
        contactlaw_sliding row = CONTACTLAW_STILL;
        double x = 0.0, u = v;
        int k, step;
        memcpy(out, &hit, sizeof hit);
        out += sizeof hit / sizeof *out;
        *out++ = contactlaw_flags(&hit, v, r, h);
        *out++ = contactlaw_restitution(v, r, h);
        *out++ = contactlaw_restitution_near(v, r, h, (int)in[3], in[4]);
        contactlaw_set_edge(&bead, (int)in[3], in[4]);
        for (step = 0; step < 45; ++step) {
            u -= 0.5 * dt * state.force / bead.mass;
            x += dt * u;
            *out++ = contactlaw_step(&bead, &state, x, dt);
            u -= 0.5 * dt * state.force / bead.mass;
            contactlaw_friction_step(&bead, &state, &row, x, dt, normal, surface, mu);
            *out++ = state.largest_compression;
            for (k = 0; k < 3; ++k)
                *out++ = row.force[k];
        }
        out[6] = contactlaw_collide(velocity, spin, leaning, still, r, h, mu);
        memcpy(out, velocity, sizeof velocity);
        memcpy(out + 3, spin, sizeof spin);
        out += 7;
    }
}

CALLED void impacts(int n, const double *v, const double *r, const double *h, double *flags,
                    double *cor, contactlaw_impact *hits)
{
    for (--n; n >= 0; --n) {
        hits[n] = contactlaw_rebound(v[n], r[n], h[n]);
        flags[n] = contactlaw_flags(hits + n, v[n], r[n], h[n]);
        cor[n] = contactlaw_restitution(v[n], r[n], h[n]);
    }
}

CALLED void lookups(int n, const double *v, const double *r, const double *h, double *out)
{
    for (--n; n >= 0; --n)
        out[n] = contactlaw_restitution(v[n], r[n], h[n]);
}

CALLED void collided(int n, double *v, double *spin, const double *r, const double *h,
                     const double *mu, double *status)
{
    const double normal[3] = { 0.0, -3.0, 4.0 }, still[3] = { 0.0, 0.0, 0.0 };
    for (--n; n >= 0; --n)
        status[n] = contactlaw_collide(v + 3 * n, spin + 3 * n, normal, still, r[n], h[n], mu[n]);
}

CALLED double near_edge(double v, double r, double h, int edge, double distance)
{
    return contactlaw_restitution_near(v, r, h, edge, distance);
}

CALLED void drops(int n, const double *v, const double *r, const double *h, const double *dt,
                  const double *phase, double *out)
{
    for (--n; n >= 0; --n) {
        const contactlaw_spring spring = contactlaw_spring_of(r[n], h[n]);
        contactlaw_state state = CONTACTLAW_APART;
        double x = -phase[n] * v[n] * dt[n], u = v[n];
        int i;
        for (i = 0; i < 4 || (i < 1000000 && (state.force > 0.0 || u > 0.0)); ++i) {
            u -= 0.5 * dt[n] * state.force / spring.mass;
            x += u * dt[n];
            contactlaw_step(&spring, &state, x, dt[n]);
            u -= 0.5 * dt[n] * state.force / spring.mass;
        }
        out[n] = -u / v[n];
    }
}
"""


@pytest.fixture(scope="module", autouse=True)
def compilers():
    for name in COMPILERS:
        if not shutil.which(name):
            pytest.skip(f"no {name} on PATH: the header is not compiled")


# Of half a second each, for tables that an export and several tests thin out.
thinned = functools.cache(nodes.thinned)


@pytest.fixture(scope="module", autouse=True)
def thinned_once():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(c_header, "thinned", thinned)
        yield


@functools.cache
def model_of(name):
    pair, law = MODELS[name]
    return cl.ImpactModel(pair, law=law)


@functools.cache
def text_of(name, table="cor"):
    """Header of a model, which several tests compile: half a second each."""
    with tempfile.TemporaryDirectory() as folder:
        return exported(Path(folder), model_of(name), table=table)


def write_header(folder, name, table="cor"):
    (folder / "contactlaw.h").write_text(text_of(name, table))


def build(folder, source, *flags, compiler="gcc", out="out"):
    """Compile a source beside a header; the file that comes of it."""
    path = folder / "source.c"
    path.write_text(source)
    command = [compiler, *COMPILERS[compiler], *flags, path, "-o", folder / out, "-lm"]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[:2000]
    assert done.stderr == ""
    return folder / out


@pytest.fixture(scope="module", params=NAMES, ids=str)
def compiled(request, tmp_path_factory):
    """A model's name, and its header as a library."""
    folder = tmp_path_factory.mktemp("header")
    write_header(folder, request.param)
    flags = "-O2", "-ffp-contract=off", "-shared", "-fPIC", *header.WARNINGS
    return request.param, ctypes.CDLL(build(folder, SOURCE, *flags, out="out.so"))


def called(function, *columns):
    """Call a C function of arrays, into the last of which it writes."""
    assert all(one.flags.c_contiguous and one.dtype == float for one in columns)
    function(len(columns[0]), *(one.ctypes.data_as(ctypes.c_void_p) for one in columns))
    return columns[-1]


def impacts(count, seed):
    """Speeds, radii and thicknesses: lambda from 0 to 100, speeds far below and above yield."""
    rng = np.random.default_rng(seed)
    v = np.exp(rng.uniform(math.log(1e-3), math.log(60.0), count))
    r = np.exp(rng.uniform(math.log(1e-4), math.log(1e-2), count))
    h = r * np.exp(rng.uniform(math.log(0.05), math.log(30.0), count))
    h[rng.random(count) < 0.05] = math.inf
    return v, r, h


def rebounding(model, count, seed, largest):
    """Impacts up to an inelasticity."""
    v, r, h = impacts(count, seed)
    units = scales(sphere_on_plate(model.pair, model.force_law, r, h), v)
    keep = units.inelasticity < largest
    return v[keep], r[keep], h[keep]


def given():
    """Impacts near and far from edges of each kind, with friction; then absurd ones."""
    rng, rows = np.random.default_rng(3), []
    for n in range(4):
        v, r = 10 ** rng.uniform(-1.0, 1.2), 10 ** rng.uniform(-3.5, -2.7)
        h, dt = r / rng.uniform(0.2, 2.0), 6e-3 * r * v**-0.2 / rng.uniform(20.0, 60.0)
        rows.append((v, r, h, n, h * rng.uniform(0.3, 3.0), rng.uniform(0.05, 0.6), dt))
    usual = (3.0, 1e-3, 1e-3, 1, 1e-3, 0.3, 1e-7)
    for place, odd in itertools.product((0, 1, 2, 4, 6), (0.0, -1.0, math.nan, math.inf, 1e300)):
        rows.append((*usual[:place], odd, *usual[place + 1 :]))
    return np.array(rows)


def uncompiled(name, folder):
    """What Python gives for `given` impacts."""
    model = model_of(name)
    bodies = functions.bodies_of(model, c_header._nodes(model))
    (folder / "in").write_bytes(pickle.dumps((tuple(bodies), given())))
    script = ROOT / "tests/shared/uncompiled.py"
    subprocess.run(
        [sys.executable, script, folder / "in", folder / "out.npy"],
        check=True, env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
    )  # fmt: skip
    return np.load(folder / "out.npy")


def test_c_computes_what_uncompiled_python_does(compiled, tmp_path):
    """To the last bit: integrations, lookups, flags, steps near edges, friction, collisions."""
    name, library = compiled
    expected = uncompiled(name, tmp_path)
    found = called(library.answers, given(), np.full_like(expected, -2.0))
    assert np.isfinite(expected[:4]).all() and np.isnan(expected[4:, 0]).sum() > 10
    different = (found != expected) & ~(np.isnan(found) & np.isnan(expected))
    assert not different.any(), (found[different], expected[different])


def test_a_lookup_is_the_models(compiled):
    """Of 2e4 random impacts, some of them outside of the table."""
    name, library = compiled
    model, (v, r, h) = model_of(name), impacts(20_000, seed=1)
    found, cor = called(library.lookups, v, r, h, np.empty(v.size)), model.kernel
    expected = np.array([cor(*one) for one in zip(v, r, h, strict=True)])
    outside = np.isnan(found)
    assert 0.005 < outside.mean() < 0.6
    # several tables reach a little less far than one made for the strength
    assert (outside | ~np.isnan(expected)).all()
    assert (np.isnan(expected) != outside).mean() <= (0.01 if name == "both" else 0.0)
    error = np.abs(found - expected)[~outside]
    assert error.max() < (1e-2 if name in RATED else 1e-5)
    assert np.quantile(error, 0.98) < 4e-3


def test_a_rebound_is_the_solvers(compiled):
    name, library = compiled
    model = model_of(name)
    v, r, h = rebounding(model, 300, 4, 10.0)
    flags, cor, found = np.empty(v.size), np.empty(v.size), np.empty((v.size, len(FIELDS)))
    called(library.impacts, v, r, h, flags, cor, found)
    hit = model.solve(v, r, h)
    units = scales(sphere_on_plate(model.pair, model.force_law, r, h), v)
    expected = dataclasses.asdict(hit)
    if name not in RATED:
        y = np.where(np.isfinite(units.yield_ratio), units.yield_ratio, 1.0)
        solved = [
            zener.solve(model.force_law.data, *at, 1e-10)
            for at in zip(units.inelasticity, y, strict=True)
        ]
        expected["loading_time"] = [one.loading_time for one in solved] * units.time
    for field, values in zip(FIELDS, found.T, strict=True):
        if field not in expected:
            continue
        # residual compression begins at yield as (chi - 1)^2; lambda is 0 on a half-space
        absolute = field.endswith("fraction") or field in ("restitution", "inelasticity")
        scale = 1.0 if absolute else expected[field.replace("residual", "peak")]
        # both integrate to 1e-10 a step, in other steps; neither controls the error of the time
        bound = 1e-7 if field.endswith("time") else 1e-9
        bound = RATED.get(name, bound)
        assert np.abs((values - expected[field]) / scale).max() < bound, field
    lost = [field.endswith("_fraction") for field in FIELDS]
    energy = found[:, 0] ** 2 + found[:, lost].sum(axis=1)
    assert np.abs(energy - 1.0).max() < (1e-6 if name in RATED else 1e-8)
    assert len(set(flags)) > 1
    if name in RATED:  # whose limits are those of the slowest impacts
        assert (flags != hit.flags).mean() < 0.05
        return
    # only impacts within the integration's error of a limit may have other flags
    for n in np.flatnonzero(flags != hit.flags):
        at = hit.contact_time[n], hit.peak_compression[n], hit.peak_force[n]
        low, high = (
            flags_of(model.limits, r[n], h[n], one * units.compression[n], *(one * x for x in at))
            for one in (1.0 - 1e-9, 1.0 + 1e-9)
        )
        assert low != high


def test_an_oblique_impact_is_that_of_the_integration(compiled):
    name, library = compiled
    model = model_of(name)
    v, r, h = rebounding(model, 300, 5, 2.0)
    rng, count = np.random.default_rng(6), v.size
    mu = rng.uniform(0.0, 0.6, count)
    n, across = np.array([0.0, -0.6, 0.8]), np.array([1.0, 0.0, 0.0])
    turned = np.cross(n, across)
    angle, size = rng.uniform(0.0, 6.3, count), rng.uniform(0.0, 10.0, count) * mu * v
    along = np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * turned
    spin = rng.normal(size=(count, 3)) * (v / r)[:, None]
    velocity = size[:, None] * along - v[:, None] * n + r[:, None] * np.cross(spin, n)
    new, turns = velocity.copy(), spin.copy()
    assert (called(library.collided, new, turns, r, h, mu, np.empty(count)) == 1.0).all()
    hit = model.oblique(v, size, r, h, mu, method="solve")
    point = new - r[:, None] * np.cross(turns, n)
    error = (point * along).sum(axis=1) - hit.sliding_speed
    bound = {"a rate": 3e-3, "both": 1e-2}.get(name, 2e-3)
    assert np.abs(error / np.maximum(mu * v, 1e-3 * v)).max() < bound
    assert (new @ n) / v == pytest.approx(hit.restitution, abs=RATED.get(name, 1e-8))
    # all forces act at the contact point
    shift = np.cross(-r[:, None] * n, new - velocity) - 0.4 * (r**2)[:, None] * (turns - spin)
    assert np.abs(shift / (r * v)[:, None]).max() < 1e-12
    bad = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [math.nan, 0.0, -1.0], [0.0, 0.0, -1.0]])
    sizes, spins = np.array([1e-3, 1e-3, 1e-3, -1e-3]), np.zeros((4, 3))
    rest = sizes, np.full(4, 1e-2), np.full(4, 0.1), np.empty(4)
    assert called(library.collided, bad, spins, *rest).tolist() == [1.0, 0.0, -1.0, -1.0]
    assert np.array_equal([*bad[1], *spins[1]], [0, 0, 1, 0, 0, 0])
    assert np.isnan([bad[2:], spins[2:]]).all()


def test_restitution_near_an_edge_is_the_solvers(compiled):
    (name, library), at = compiled, (2.0, 1e-3, 1e-3)
    model, near, bound = model_of(name), library.near_edge, STEPS_NEAR.get(name, 1e-3)
    near.restype, near.argtypes = DOUBLE, [DOUBLE] * 3 + [ctypes.c_int, DOUBLE]
    for n, kind in enumerate(KINDS, 1):
        for s in (0.5e-3, 1e-3, 3e-3):
            hit = model.solve(*at, edge=kind, edge_distance=s)
            assert near(*at, n, s) == pytest.approx(hit.restitution, abs=bound)
    whole = model.solve(*at).restitution
    for n, s in ((1, math.inf), (0, 1e-3)):
        assert near(*at, n, s) == pytest.approx(whole, abs=RATED.get(name, 1e-9))
    for n, s in ((1, -1e-3), (2, math.nan), (4, 1e-3), (-1, 1e-3)):
        assert math.isnan(near(*at, n, s))


def test_a_contact_by_steps_is_that_of_softsphere(compiled):
    """Compare random impacts at 15 to 120 steps per contact."""
    name, library = compiled
    model, rng = model_of(name), np.random.default_rng(3)
    v, r, h = rebounding(model, 500, 2, 3.0)
    units = scales(sphere_on_plate(model.pair, model.force_law, r, h), v)
    dt = 3.2 * units.time / np.exp(rng.uniform(math.log(15.0), math.log(120.0), v.size))
    phase = rng.uniform(0.02, 0.98, v.size)
    springs = [resized(unit_spring(model, h[n]), r[n]) for n in range(v.size)]
    law = model.force_law.data
    expected = [drop(law, springs[n], v[n], dt[n], phase[n]) for n in range(v.size)]
    found = called(library.drops, v, r, h, dt, phase, np.empty(v.size))
    assert v.size > 200
    assert 0.0 < found.min() <= found.max() <= 1.001
    assert np.abs(found - expected).max() < (2e-3 if name in RATED else 1e-10)


def test_a_header_names_the_flags_of_validity():
    found = re.findall(r"^    CONTACTLAW_([A-Z_]+) = (\d+),?$", text_of("myc"), re.MULTILINE)
    assert dict(found) == {one.name: str(one.value) for one in Validity}


def solved_in_c(folder, model, v, r, h):
    """Impacts by a header without a table."""
    cl.export.header(folder / "contactlaw.h", model, table="none")
    source = re.sub(r"contactlaw_restitution\(.*?\)", "0.0", SOURCE)
    library = ctypes.CDLL(build(folder, source, "-O2", "-shared", "-fPIC"))
    found = np.empty((v.size, len(FIELDS)))
    called(library.impacts, v, r, h, np.empty(v.size), np.empty(v.size), found)
    return functions.Impact(*found.T)


def test_a_rebound_of_a_sphere_that_stays_is_the_solvers(tmp_path):
    """The COR is 1e-2 to 0: the contact ends once its remaining energy is negligible."""
    model = cl.ImpactModel(STAYING)
    v, h = np.array(np.meshgrid(np.geomspace(1e-6, 1.0, 16), np.geomspace(1.5e-4, 4e-3, 9)))
    v, h = v.ravel(), h.ravel()
    r = np.full_like(v, 1e-3)
    lam = scales(sphere_on_plate(model.pair, model.force_law, r, h), v).inelasticity
    v, r, h = v[lam < 60.0], r[lam < 60.0], h[lam < 60.0]
    found, expected = solved_in_c(tmp_path, model, v, r, h), model.solve(v, r, h)
    assert expected.restitution.min() < 2e-6 < 1e-2 < expected.restitution.max()
    assert np.abs(found.restitution - expected.restitution).max() < 1e-10
    assert found.contact_time == pytest.approx(expected.contact_time, rel=1e-7)
    assert np.abs(found.wave_fraction - expected.wave_fraction).max() < 1e-8


def test_the_series_is_not_for_the_loading_curve(tmp_path):
    """An elastic contact unloads along the loading curve, which is no power law here."""
    stiffening = np.polynomial.Polynomial([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1e3])
    law = Law.of(name="stiffening", source="s", yield_coefficient=None, scale=1e-5,
                 loading=[Loading(0.0, stiffening)])  # fmt: skip
    model = cl.ImpactModel(cl.Pair("zirconia", "glass"), law)
    at = np.array([[100.0], [1e-3], [0.2e-3]])
    found, expected = solved_in_c(tmp_path, model, *at), model.solve(*at[:, 0])
    assert found.contact_time[0] == pytest.approx(expected.contact_time, rel=1e-6)
    assert found.wave_fraction[0] == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_compilers_have_nothing_to_say(name, tmp_path):
    """`compiled` has built the header with a table by gcc and the same warnings already."""
    write_header(tmp_path, name)
    text = (tmp_path / "contactlaw.h").read_text()
    assert len(text) <= 500_000
    assert all(len(line) <= 100 for line in text.splitlines())
    build(tmp_path, SOURCE, "-c", "-O1", *header.WARNINGS, compiler="g++")
    write_header(tmp_path, name, "none")
    for compiler in COMPILERS:
        source = '#include "contactlaw.h"\n'
        build(tmp_path, source, "-c", *header.WARNINGS, compiler=compiler)


# Calls with numbers of all kinds, in any order: a call without a valid answer has to give NaN.
ANY_INPUT = """
#include "contactlaw.h"
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static uint64_t seed = 88172645463325252u;

static double uniform(void)
{
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return (double)(seed >> 11) * 0x1p-53;
}

static double any(double low, double high)
{
    static const double odd[] = { 0.0, -0.0, 1e-308, 5e-324, -5e-324, 1.7e308, -1.7e308, 1e-30,
                                  1e-9, 1e3, 1e5, -1.0, 1.0, 1e-160, 1e160, 2.2e-16 };
    const double kind = 48.0 * uniform();
    uint64_t bits;
    double x;
    if (kind < 16.0)
        return odd[(int)kind];
    if (kind < 17.0)
        return (double)NAN;
    if (kind < 18.0)
        return HUGE_VAL;
    if (kind < 19.0)
        return -HUGE_VAL;
    if (kind < 22.0) {
        bits = (uint64_t)(uniform() * 9007199254740992.0) * 2049u;
        memcpy(&x, &bits, sizeof x);
        return x;
    }
    return low * pow(high / low, uniform());
}

static double near(double value) { return uniform() < 0.9 ? value : any(1e-9, 1e3); }

int main(void)
{
    long n, k, numbers = 0, none = 0, wrong = 0;
    for (n = 0; n < 400000; ++n) {
        const double v = any(1e-4, 1e2), r = any(1e-5, 1e-1), h = any(1e-5, 1e-1);
        const double e = contactlaw_restitution(v, r, h);
        numbers += e >= 0.0 && e <= 1.0;
        none += e != e;
        wrong += !(e != e) && !(e >= 0.0 && e <= 1.0);
        wrong += e == e && !(v > 0.0 && r > 0.0 && h > 0.0);
    }
    printf("%ld %ld\\n", numbers, none);
    numbers = none = 0;
    for (n = 0; n < 3000; ++n) {
        contactlaw_spring spring = contactlaw_spring_of(any(1e-5, 1e-1), any(1e-5, 1e-1));
        contactlaw_state state = CONTACTLAW_APART;
        if (uniform() < 0.3) {
            spring = contactlaw_spring_of(1e-3, 1e-3);
            spring.mass = near(spring.mass);
            spring.stiffness = near(spring.stiffness);
            spring.mobility = near(spring.mobility);
            spring.scale = near(spring.scale);
            spring.relaxation = near(spring.relaxation);
            spring.ratio = near(spring.ratio);
        }
        if (uniform() < 0.3)
            contactlaw_set_edge(&spring, (int)(4.0 * uniform()), any(1e-5, 1e-1));
        for (k = 0; k < 60; ++k) {
            double x = any(1e-3, 1.0) * 1e-5, dt = any(1e-9, 1e-5), f;
            contactlaw_state before;
            if (uniform() < 0.05) {
                state.plate_displacement = any(1e-9, 1e-3);
                state.largest_compression = any(1e-9, 1e-3);
                state.force = any(1e-3, 1e3);
                state.mobility = any(1e-3, 1e3);
                state.stiffening = any(0.5, 2.0);
            }
            before = state;
            f = contactlaw_step(&spring, &state, x, dt);
            numbers += f == f;
            none += f != f;
            wrong += f < 0.0 || f == HUGE_VAL;
            wrong += f == f && !(x > -HUGE_VAL && x < HUGE_VAL && dt > 0.0);
            wrong += f != f && memcmp(&before, &state, sizeof state) != 0;
        }
    }
    printf("%ld %ld\\n", numbers, none);
    numbers = none = 0;
    for (n = 0; n < 600; ++n) {
        const contactlaw_impact one
            = contactlaw_rebound(any(1e-3, 1e2), any(1e-4, 1e-2), any(1e-3, 1e-1));
        numbers += one.restitution >= 0.0 && one.restitution <= 1.0;
        none += one.restitution != one.restitution && one.peak_force != one.peak_force;
    }
    printf("%ld %ld\\n", numbers, none);
    printf("%ld\\n", wrong + 600 - numbers - none);
    return 0;
}
"""
SANITIZERS = ["-fsanitize=address,undefined,float-cast-overflow", "-fno-sanitize-recover=all"]


@pytest.mark.parametrize("name", NAMES)
def test_sanitizers_find_nothing_whatever_the_input(name, tmp_path):
    """Arguments, springs and states may be NaN, inf, zero, negative, denormal or random bits."""
    write_header(tmp_path, name)
    program = build(tmp_path, ANY_INPUT, "-O1", "-g", *SANITIZERS)
    done = subprocess.run([program], capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stderr) == (0, "")
    *counts, wrong = done.stdout.splitlines()
    for line in counts:
        answers, none = map(int, line.split())
        assert min(answers, none) > 0.02 * (answers + none), line
    assert wrong == "0"


def exported(folder, model, **options):
    cl.export.header(folder / "contactlaw.h", model, **options)
    return (folder / "contactlaw.h").read_text()


def test_the_first_lines_say_what_it_is(tmp_path):
    model = model_of("fem, metals")
    text = exported(tmp_path, model)
    first = " ".join(line.strip(" *") for line in text.splitlines()[:18])
    assert f"contactlaw {VERSION}" in first
    assert f"law fem: {model.force_law.source}" in first
    assert "sphere bearing-steel-52100: E 2.034e+11 Pa, nu 0.296, rho 7833 kg/m3" in first
    assert "plate aluminium-6061-t6: E 6.89e+10 Pa" in first
    assert "flags of every impact: none flags of a body that yields: none table" in first
    error = thinned(model.table, c_header.ERROR).certificate.largest["restitution"]
    assert f"within {error:.1e} of the integrated equation" in first
    assert "SPDX-License-Identifier: BSD-3-Clause" in first
    licence = [line.removeprefix(" *").strip() for line in text.splitlines()[-40:]]
    for line in (ROOT / "LICENSE").read_text().splitlines():
        assert line.strip() in licence


@pytest.mark.parametrize(
    ("sphere", "law", "words"),
    [
        ("POM", "fem", "every impact: RATE_DEPENDENT: a polymer, or as soft and light"),
        ("stainless-steel-304", "myc", "a body that yields: OTHER_LAW: finite elements favour"),
    ],
)
def test_the_first_lines_say_which_flags_the_pair_has(sphere, law, words, tmp_path):
    pom = cl.Material("POM", 2.9e9, 0.37, 1410, yield_strength=65e6)
    pair = cl.Pair(pom if sphere == "POM" else sphere, "glass")
    text = exported(tmp_path, cl.ImpactModel(pair, law), table="none")
    assert f" * flags of {words}" in text.partition("SPDX")[0]


def test_a_table_of_ones_own_without_a_certificate(tmp_path):
    """A table too coarse to be thinned is exported as it is, and the header states its error."""
    settings = Settings(
        inelasticity_nodes=6, log_overload_step=0.4, largest_inelasticity=1.0, largest_overload=3.0
    )
    table = dataclasses.replace(tables.build(laws.law("myc"), settings), certificate=None)
    model = cl.ImpactModel(PAIR, law="myc", table=table)
    text = " ".join(line.strip(" *") for line in exported(tmp_path, model).splitlines()[:12])
    assert "table of COR, lambda to 1 and chi to 3" in text
    error = tables.certify(table, POINTS).largest["restitution"]
    assert error > 1e-5
    assert f"within {error:.1e} of the integrated equation" in text
    program = (
        '#include "contactlaw.h"\n#include <stdio.h>\n'
        'int main(void) { printf("%.17g", contactlaw_restitution(9.0, 0.9e-3, 1e-3)); return 0; }\n'
    )
    found = subprocess.run([build(tmp_path, program)], capture_output=True, text=True).stdout
    assert float(found) == pytest.approx(model.restitution(9.0, 0.9e-3, 1e-3), abs=5e-10)


@pytest.mark.parametrize(
    "name",
    ["*/int x;/*", "*\\int x;\\*", "a\nb\\", "\u202eback", "???/ \\u", 'q"%d$law', "x" * 300],
)
def test_whatever_a_law_or_a_material_is_called(name, tmp_path):
    sphere = dataclasses.replace(cl.material("gamma-alumina"), name=name)
    model = cl.ImpactModel(cl.Pair(sphere, "glass"), law=own(name=name, source=name))
    text = exported(tmp_path, model, table="none")
    assert text.isascii() and "??" not in text
    assert "int x;" not in re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    for compiler in COMPILERS:
        source = '#include "contactlaw.h"\n'
        build(tmp_path, source, "-c", *header.WARNINGS, compiler=compiler)


def test_nothing_that_threads_could_share(tmp_path):
    """The header has functions and constants only, and calls only the mathematical library."""
    write_header(tmp_path, "fem")
    compiled = build(tmp_path, SOURCE, "-c", "-O1", out="out.o")
    done = subprocess.run(["nm", compiled], capture_output=True, text=True)
    symbols = done.stdout.split("\n")
    kinds = {tuple(line.split()[-2:]) for line in symbols if line}
    assert {kind for kind, _ in kinds} <= {"T", "t", "r", "U"}
    outside = {name for kind, name in kinds if kind == "U"}
    known = {"sqrt", "pow", "exp", "expm1", "log", "floor", "memcpy"}
    assert outside <= known | {"_GLOBAL_OFFSET_TABLE_", "__stack_chk_fail"}


def test_several_source_files_may_include_it(tmp_path):
    write_header(tmp_path, "myc")
    other = tmp_path / "other.c"
    other.write_text(
        '#include "contactlaw.h"\n#include "contactlaw.h"\ndouble f(double v);\n'
        "double f(double v) { return contactlaw_restitution(v, 1e-3, 1e-3); }\n"
    )
    source = (
        '#include "contactlaw.h"\ndouble f(double v);\n'
        "int main(void) { return f(5.0) != contactlaw_restitution(5.0, 1e-3, 1e-3); }\n"
    )
    assert subprocess.run([build(tmp_path, source, *header.WARNINGS, other)]).returncode == 0


def test_a_blown_up_simulation_is_told_and_leaves_the_state(tmp_path):
    write_header(tmp_path, "myc", "none")
    source = """
#include "contactlaw.h"
#include <string.h>
int main(void)
{
    const contactlaw_spring spring = contactlaw_spring_of(1e-3, 1e-3);
    contactlaw_state state = CONTACTLAW_APART, before;
    int good = contactlaw_step(&spring, &state, 1e-6, 1e-7) > 0.0;
    before = state;
    good &= isnan(contactlaw_step(&spring, &state, 2.1e-3, 1e-7));
    good &= isnan(contactlaw_step(&spring, &state, NAN, 1e-7));
    good &= isnan(contactlaw_step(&spring, &state, -HUGE_VAL, 1e-7));
    good &= isnan(contactlaw_step(&spring, &state, 3.1e-6, 2e-11)); /* 2e-6 m more in it: 1e5 m/s */
    good &= isnan(contactlaw_step(&spring, &state, 1e-6, NAN));
    good &= isnan(contactlaw_step(&spring, &state, 1e-6, 0.0));
    good &= isnan(contactlaw_step(&spring, &state, 1e-6, 1.0e2));
    good &= memcmp(&before, &state, sizeof state) == 0;
    good &= contactlaw_step(&spring, &state, 0.0, 1e-7) == 0.0 && state.force == 0.0;
    good &= state.plate_displacement == 0.0 && state.largest_compression == 0.0;
    return !good;
}
"""
    assert subprocess.run([build(tmp_path, source, *header.WARNINGS)]).returncode == 0


def test_what_is_refused(tmp_path, monkeypatch):
    path, model = tmp_path / "contactlaw.h", model_of("myc")
    with pytest.raises(TypeError, match="model: expected a contactlaw.ImpactModel, got 'myc'"):
        cl.export.header(path, "myc")
    with pytest.raises(ValueError, match="table: must be 'cor' or 'none', got 'all'"):
        cl.export.header(path, model, table="all")
    with pytest.raises(FileNotFoundError):
        cl.export.header(tmp_path / "nowhere" / "contactlaw.h", model, table="none")
    monkeypatch.setattr(c_header, "LARGEST", 100_000)
    with pytest.raises(ValueError, match=r"table: the header would have \d+ bytes, above 100000"):
        cl.export.header(path, model)
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_leaves_the_file_that_was_there(tmp_path):
    path, model = tmp_path / "contactlaw.h", model_of("myc")
    path.write_text("before")
    code = (
        "import resource, signal, contactlaw as cl\n"
        "model = cl.ImpactModel(cl.Pair('gamma-alumina', 'glass'), law='myc')\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))\n"
        f"cl.export.header({str(path)!r}, model, table='none')\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "OSError: [Errno 27] File too large" in done.stderr
    assert path.read_text() == "before"
    assert list(tmp_path.iterdir()) == [path]
    cl.export.header(path, model, table="none")
    assert path.stat().st_mode & 0o777 == 0o644


PLAIN = ["export", "header", "--sphere", "bearing-steel-52100", "--plate", "aluminium-6061-t6"]


def test_the_command_writes_the_same_file(tmp_path, capsys):
    for options in (["--law", "fem"], ["--law", "myc", "--table", "none", "--prefix", "steel"]):
        out = tmp_path / "out.h"
        assert cli.main([*PLAIN, *options, "--out", str(out)]) == 0
        assert capsys.readouterr().out == f"{out}\n"
        named = {name[2:]: value for name, value in zip(options[2::2], options[3::2], strict=True)}
        model = cl.ImpactModel(STEEL, law=options[1])
        assert out.read_text() == exported(tmp_path, model, **named)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (["--out", "nowhere/contactlaw.h"], "--out: there is no folder nowhere"),
        (["--out", "."], "--out: . is a folder"),
        (["--sphere", "stel"], "--sphere: unknown material 'stel'"),
        (["--sphere", "glass", "--law", "myc"], "--sphere: law 'myc' needs a yield strength"),
        (["--law", "mcy"], "--law: unknown law 'mcy'"),
        (["--prefix", "Steel"], "--prefix: must be lower-case words"),
    ],
)
def test_the_command_refuses_in_its_own_words(change, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.main([*PLAIN, *change]) == 1
    assert message in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def example(folder, name):
    """What an example prints, its numbers line by line; compiled as its first lines say."""
    path = ROOT / "docs/examples" / f"{name}.c"
    text = path.read_text()
    assert len(text.splitlines()) <= 40
    export, compilation = re.findall(r"^ \*     (.*)$", text, re.MULTILINE)
    assert shlex.split(export)[0] == "contactlaw"
    (folder / path.name).write_text(text)
    done = subprocess.run([sys.executable, "-m", *shlex.split(export)], cwd=folder)
    assert done.returncode == 0
    command = compilation.replace("cc ", "gcc -std=c99 " + " ".join(header.WARNINGS) + " ")
    done = subprocess.run(command, shell=True, cwd=folder, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    numbers = re.compile(r"(?<![\w.])-?\d+\.\d+")
    return [[float(one) for one in numbers.findall(line)] for line in done.stdout.splitlines()]


def test_the_event_driven_example_is_pythons(tmp_path):
    model = cl.ImpactModel(PAIR)
    peer = cl.ImpactModel(
        model.pair,
        table=dataclasses.replace(thinned(model.table, c_header.ERROR), certificate=None),
    )  # fmt: skip
    found = example(tmp_path, "event_driven")
    for row, thickness in zip(found, (0.5e-3, 1e-3, 3e-3, math.inf), strict=True):
        speed = math.sqrt(2 * 9.81 * 0.5)
        time, expected = speed / 9.81, []
        for _ in range(5):
            expected.append(peer.restitution(speed, 0.9e-3, thickness))
            speed *= expected[-1]
            time += 2 * speed / 9.81
        assert row[-7:] == pytest.approx([*expected, speed, time], abs=1.1e-9)


def test_the_documented_c_compiles(tmp_path):
    (shown,) = re.findall(r"```c\n(.*?)```", (ROOT / "docs/c.md").read_text(), re.DOTALL)
    include, _, calls = shown.partition("\n")
    write_header(tmp_path, "myc")
    arguments = "double speed, double radius, double thickness, double overlap, double dt, "
    arguments += "double friction, double *velocity, double *spin, const double *normal, "
    arguments += "const double *wall_velocity, double distance"
    body = f"{calls} return e + near + force + impact.peak_force + flags;"
    source = f"{include}\ndouble f({arguments});\ndouble f({arguments}) {{ {body} }}\n"
    build(tmp_path, source, "-c", *header.WARNINGS)


def test_the_soft_sphere_example_is_pythons(tmp_path):
    model = cl.ImpactModel(PAIR)
    found = example(tmp_path, "soft_sphere")
    v = np.linspace(2.0, 10.0, 5)
    dt = model.solve(10.0, 0.9e-3, 1e-3).contact_time / 50
    contacts = Contacts(model, np.full(5, 0.9e-3), 1e-3)
    x, u, peak = np.full(5, -1e-5), v.copy(), np.zeros(5)
    for _ in range(500):
        u += 0.5 * dt * (9.81 - contacts.force / contacts.mass)
        x += dt * u
        u += 0.5 * dt * (9.81 - contacts.advance(x, dt) / contacts.mass)
        peak = np.maximum(peak, contacts.force)
    assert np.array(found) == pytest.approx(np.column_stack([v, peak, -u]), abs=1e-6)
    # Its COR is the integrated one, but for gravity.
    assert -u / v == pytest.approx(model.solve(v, 0.9e-3, 1e-3).restitution, abs=2e-4)


# The table of steel on carbide has the most columns: ln chi runs from -7 to 8.6. All pairs of the
# catalogue are tried by `python -m validation.hostile headers`.
@pytest.mark.parametrize(
    "pair", [("stainless-steel-316", "tungsten-carbide"), ("hdpe", "polycarbonate")]
)
def test_headers_of_the_largest_tables_are_as_small_as_the_docs_say(pair):
    assert list(headers.of_pair(*pair)) == []


@pytest.mark.parametrize("compiler", COMPILERS)
def test_headers_of_two_pairs_in_one_source_file_stop_the_compiler(compiler, tmp_path):
    for name, (pair, law) in {"one": MODELS["myc"], "other": (STEEL, "myc")}.items():
        cl.export.header(tmp_path / f"{name}.h", cl.ImpactModel(pair, law=law), table="none")
    source = tmp_path / "source.c"
    source.write_text('#include "one.h"\n#include "one.h"\n#include "other.h"\nint main(void);\n')
    done = subprocess.run(
        [compiler, *COMPILERS[compiler], "-c", source, "-o", tmp_path / "out.o"],
        capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode != 0
    assert done.stderr.count("error:") == 1, done.stderr  # no redefinitions after it
    assert "other.h" in done.stderr
    assert "export one of them with --prefix" in done.stderr
    source.write_text('#include "one.h"\n#include "one.h"\nint main(void) { return 0; }\n')
    command = [compiler, *COMPILERS[compiler], source, "-o", tmp_path / "out", "-lm"]
    subprocess.run(command, check=True)


@pytest.mark.parametrize("flag", ["-ffast-math", "-ffinite-math-only", "-Ofast", "-D_M_FP_FAST"])
def test_a_compiler_that_drops_nan_is_refused(flag, tmp_path):
    write_header(tmp_path, "myc", "none")
    source = tmp_path / "source.c"
    source.write_text('#include "contactlaw.h"\n')
    command = ["gcc", flag, "-c", source, "-o", tmp_path / "out.o"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode != 0
    assert "no -ffast-math" in done.stderr


@pytest.mark.parametrize("compiler", COMPILERS)
def test_several_pairs_live_in_one_source_file(compiler, tmp_path):
    """Each prefix has its own pair's numbers, and no name of another."""
    models = {
        "contactlaw": model_of("myc"),
        "steel": cl.ImpactModel(STEEL),
        "steel2": model_of("fem"),
    }
    for prefix, model in models.items():
        cl.export.header(tmp_path / f"{prefix}.h", model, prefix=prefix)
        assert prefix == "contactlaw" or "contactlaw_" not in (tmp_path / f"{prefix}.h").read_text()
    calls = ", ".join(f"{prefix}_restitution(5.0, 1e-3, 2e-3)" for prefix in models)
    source = "".join(f'#include "{prefix}.h"\n' for prefix in models) + "#include <stdio.h>\n"
    source += f'int main(void) {{ printf("%.17g %.17g %.17g", {calls}); return 0; }}\n'
    program = build(tmp_path, source, *header.WARNINGS, compiler=compiler)
    found = subprocess.run([program], capture_output=True, text=True).stdout.split()
    for one, model in zip(found, models.values(), strict=True):
        assert float(one) == pytest.approx(model.restitution(5.0, 1e-3, 2e-3), abs=1e-5)


@pytest.mark.parametrize("prefix", ["", "Steel", "steel-glass", "2pairs", "a__b", "a_", None])
def test_a_prefix_that_c_does_not_take_is_refused(prefix, tmp_path):
    with pytest.raises(ValueError, match="prefix: must be lower-case words of letters and digits"):
        cl.export.header(tmp_path / "out.h", model_of("myc"), prefix=prefix)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("sphere", ["pom", "gamma-alumina"])
def test_the_first_lines_warn_of_polymers(sphere, tmp_path):
    text = exported(tmp_path, cl.ImpactModel(cl.Pair(sphere, "glass")), table="none")
    assert ("WARNING: a polymer" in text.split("\n")[2]) == (sphere == "pom")


@pytest.mark.parametrize("other_rate", [None, (0.02, 1.0)])
def test_a_table_is_refused_where_another_body_comes_to_yield(other_rate, tmp_path):
    """Its COR was wrong by 0.014."""
    other = dataclasses.replace(metal.PLAIN.sphere, yield_strength=300e6, rate=other_rate)
    model = cl.ImpactModel(cl.Pair(metal.PAIR.sphere, other))
    with pytest.raises(ValueError, match=r"another body may yield.*contactlaw_rebound"):
        cl.export.header(tmp_path / "contactlaw.h", model)
    cl.export.header(tmp_path / "contactlaw.h", model, table="none")


def test_a_header_is_refused_where_one_body_far_outgrows_the_other(tmp_path):
    """The few laws that it had for such pairs knew the rate of the weaker body alone."""
    with pytest.raises(ValueError, match="above 500000.*a rate for one of two bodies"):
        cl.export.header(tmp_path / "contactlaw.h", cl.ImpactModel(metal.STEEP), "none")
