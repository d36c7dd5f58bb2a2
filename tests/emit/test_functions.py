"""Impacts, steps, friction and flags of `contactlaw.export.functions` in C: those of Python."""

import ctypes
import itertools
import math
import os
import pickle
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import polymer
import pytest
from own_laws import measured, own

import contactlaw as cl
from contactlaw import laws
from contactlaw.emit import DOUBLE, INT, C, Known, Program
from contactlaw.export import functions
from contactlaw.physical.oblique import Sliding
from contactlaw.stepping.spring import Spring, State

PAIR = cl.Pair("gamma-alumina", "glass")
STEEL = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
RATED = cl.Material("copper", 124e9, 0.34, 8960, 90e6, kind="metal", rate=(0.025, 1.0))
MODELS = {name: (PAIR, name) for name in laws.names()}
MODELS |= {"fem, metals": (STEEL, "fem"), "fem, elastic": (cl.Pair("glass", "glass"), "fem")}
MODELS |= {"own": (PAIR, own()), "measured": (PAIR, measured())}
MODELS |= {"losses": (polymer.PAIRS[0], "fem"), "a rate": (cl.Pair(RATED, "glass"), "fem")}
MODELS["losses and flow"] = polymer.WEAK_MODEL.pair, "fem"
QUICK = "fem", "myc", "losses and flow", "a rate"
COMPILERS = ["gcc", "-std=c99"], ["g++", "-std=c++11", "-x", "c++"]
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
HEAD = """
#include <math.h>
#include <string.h>
typedef const double contactlaw_data;
static inline double contactlaw_min(double a, double b) { return b < a ? b : a; }
static inline double contactlaw_max(double a, double b) { return b > a ? b : a; }
static inline int contactlaw_min_int(int a, int b) { return b < a ? b : a; }
static inline int contactlaw_max_int(int a, int b) { return b > a ? b : a; }
static inline void contactlaw_fill(double *a, int n, double v) { while (n > 0) a[--n] = v; }
"""
# The same as `answers` in uncompiled.py.
ANSWERS = """
#ifdef __cplusplus
extern "C"
#endif
void answers(const double *in, double *out);
void answers(const double *in, double *out)
{
    const double v = in[0], r = in[1], h = in[2], mu = in[5], dt = in[6];
    const int edge = (int)in[3];
    const contactlaw_vector normal = contactlaw_make_vector(0.0, 0.6, 0.8);
    const contactlaw_vector surface = contactlaw_make_vector(0.3 * v, -0.7 * v, 0.1 * v);
    const contactlaw_impact hit = contactlaw_rebound(v, r, h);
    const contactlaw_spring bead = contactlaw_at_edge(contactlaw_spring_of(r, h), edge, in[4]);
    contactlaw_state state, after;
    contactlaw_sliding row;
    contactlaw_collision end;
    double x = 0.0, u = v;
    int n, k;
    memset(&state, 0, sizeof state);
    memset(&row, 0, sizeof row);
    memcpy(out, &hit, sizeof hit);
    out += sizeof hit / sizeof *out;
    *out++ = contactlaw_exceeded(hit, v, r, h);
    *out++ = contactlaw_restitution_near(v, r, h, edge, in[4]);
    for (n = 0; n < 45; ++n) {
        u -= 0.5 * dt * state.force / bead.mass;
        x += dt * u;
        after = contactlaw_after_step(bead, state, x, dt);
        if (after.force >= 0.0)
            state = after;
        u -= 0.5 * dt * state.force / bead.mass;
        contactlaw_rub(bead, state, &row, x, dt, normal, surface, mu);
        *out++ = after.force;
        *out++ = state.largest_compression;
        for (k = 0; k < 3; ++k)
            *out++ = row.force[k];
    }
    end = contactlaw_collided(
        contactlaw_make_vector(0.4 * v, 0.1 * v, -v), contactlaw_make_vector(3.0, 5.0, 7.0),
        contactlaw_make_vector(0.1, 0.0, 1.0), contactlaw_make_vector(0.0, 0.0, 0.0), r, h, mu);
    memcpy(out, &end.velocity, sizeof end.velocity);
    memcpy(out + 3, &end.spin, sizeof end.spin);
    out[6] = end.status;
}
"""


def bodies(name):
    pair, law = MODELS[name]
    return functions.bodies_of(cl.ImpactModel(pair, law=law), {})


def written(pair):
    """All functions for a pair, in C."""
    vector = (DOUBLE, DOUBLE, DOUBLE)
    names = {
        vector: "vector", functions.SLIDING: "sliding", Sliding: "approach", State: "state",
        functions.BeadSpring: "spring", Spring: "contact_spring", functions.Impact: "impact",
    }  # fmt: skip
    program, one = Program(C(), ("goal",), names, functions.INSTEAD), Known(value=pair)
    point, sliding = program.tuple_of(vector), program.row("sliding", functions.SLIDING)
    state = program.struct(State, tuple((name, DOUBLE) for name in State._fields))
    _, bead = program.add(functions.spring_of, one, DOUBLE, DOUBLE)
    _, impact = program.add(functions.rebound, one, *vector)
    program.add(functions.at_edge, one, bead, INT, DOUBLE)
    program.add(functions.after_step, one, bead, state, DOUBLE, DOUBLE)
    program.add(functions.restitution_near, one, *vector, INT, DOUBLE)
    program.add(functions.exceeded, one, impact, *vector)
    program.add(
        functions.rub, one, bead, state, sliding, DOUBLE, DOUBLE, point, point, DOUBLE
    )  # fmt: skip
    program.add(functions.collided, one, point, point, point, point, *vector)
    return f"{HEAD}{program.text()}{ANSWERS}"


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
    return rows


def uncompiled(pair, folder):
    """What Python gives for `given` impacts."""
    (folder / "in").write_bytes(pickle.dumps((tuple(pair), given())))
    script = Path(__file__).parent.parent / "shared/uncompiled.py"
    subprocess.run(
        [sys.executable, script, folder / "in", folder / "out.npy"],
        check=True, env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
    )  # fmt: skip
    return np.load(folder / "out.npy")


@pytest.mark.skipif(not shutil.which("g++"), reason="no g++ on PATH: the header is not compiled")
@pytest.mark.parametrize(
    "name", [one if one in QUICK else pytest.param(one, marks=pytest.mark.long) for one in MODELS]
)
def test_c_computes_what_uncompiled_python_does(name, tmp_path):
    """To the last bit: integrations, flags, steps near edges, friction, oblique impacts."""
    pair = bodies(name)
    (tmp_path / "a.c").write_text(written(pair))
    flags = [*WARNINGS, "-O1", "-ffp-contract=off", "-shared", "-fPIC", "a.c"]
    for compiler in COMPILERS if name in ("fem", "a rate") else COMPILERS[:1]:
        command = [*compiler, *flags, "-o", f"{compiler[0]}.so", "-lm"]
        subprocess.run(command, cwd=tmp_path, check=True)
    library, expected = ctypes.CDLL(tmp_path / "gcc.so"), uncompiled(pair, tmp_path)
    found = np.full_like(expected, -2.0)
    for row, out in zip(given(), found, strict=True):
        numbers = np.array(row, float)
        library.answers(*(one.ctypes.data_as(ctypes.c_void_p) for one in (numbers, out)))
    assert np.isfinite(expected[:4]).all() and np.isnan(expected[4:, 0]).sum() > 10
    different = (found != expected) & ~(np.isnan(found) & np.isnan(expected))
    assert not different.any(), (found[different], expected[different])


@pytest.mark.parametrize("name", ["fem, metals", "losses", "a rate", "myc"])
def test_a_rebound_is_the_solvers(name):
    pair, law = MODELS[name]
    model, numbers = cl.ImpactModel(pair, law=law), functions.bodies_of
    own = numbers(model, {}, 0.05)
    for v, r, h in ((0.3, 1e-3, 1e-3), (3.0, 1e-3, math.inf), (8.0, 2e-3, 1e-3)):
        found, hit = functions.rebound(own, v, r, h), model.solve(v, r, h)
        bound = 2e-4 if model.pair.sphere.rate else 1e-9
        assert found.restitution == pytest.approx(hit.restitution, abs=bound)
        assert found.peak_force == pytest.approx(hit.peak_force, rel=10 * bound)
        assert found.contact_time == pytest.approx(hit.contact_time, rel=max(10 * bound, 1e-7))
