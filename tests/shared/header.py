"""A C header, compiled with a function that calls all functions of it."""

import ctypes
import math
import subprocess

import numpy as np

from contactlaw.export import functions

COMPILERS = {"gcc": ["-std=c99"], "g++": ["-std=c++11", "-x", "c++"]}
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
FIELDS = functions.Answer._fields[:-1]  # but for the mass
STEPS = 45
MASS, HEAVY = 5e4, 0.3  # kg/m3 of beads that are no solid spheres, those with more friction
NORMAL, LEANING = (0.0, 0.6, 0.8), (0.1, 0.0, 1.0)
GIVEN, WIDTH = 7, len(FIELDS) + 3 + 5 * STEPS + 7
# All fields of a rebound, flags, COR near an edge, steps with friction, a collision; in CUDA and OpenCL, too.
SOURCE = f"""
#include "contactlaw.h"
#ifdef __OPENCL_VERSION__
#define AT __global
#else
#define AT
#endif

CONTACTLAW_FN void contactlaw_answer(AT const double *in, AT double *out)
{{
    const double v = in[0], r = in[1], h = in[2], mu = in[5], dt = in[6];
    const int edge = (int)in[3];
    const double normal[3] = {{ 0.0, 0.6, 0.8 }}, still[3] = {{ 0.0, 0.0, 0.0 }};
    const double leaning[3] = {{ 0.1, 0.0, 1.0 }};
    const double surface[3] = {{ 0.3 * v, -0.7 * v, 0.1 * v }};
    double velocity[3] = {{ 0.4 * v, 0.1 * v, -v }}, spin[3] = {{ 3.0, 5.0, 7.0 }};
    const double mass = {MASS} * r * r * r;
    const contactlaw_impact heavy = contactlaw_rebound_with_mass(v, r, h, mass);
    const contactlaw_impact hit = mu > {HEAVY} ? heavy : contactlaw_rebound(v, r, h);
    contactlaw_spring bead = contactlaw_spring_of(r, h);
    contactlaw_state state = CONTACTLAW_APART;
    contactlaw_sliding row = CONTACTLAW_STILL;
    double x = 0.0, u = v;
    int k, step;
    for (k = 0; k < {len(FIELDS)}; ++k)
        *out++ = ((const double *)&hit)[k];
    *out++ = contactlaw_flags(&hit, v, r, h);
    *out++ = contactlaw_restitution(v, r, h);
    *out++ = contactlaw_restitution_near(v, r, h, edge, in[4]);
    contactlaw_set_edge(&bead, edge, in[4]);
    if (mu > {HEAVY})
        bead.mass = mass;
    for (step = 0; step < {STEPS}; ++step) {{
        u -= 0.5 * dt * state.force / bead.mass;
        x += dt * u;
        *out++ = contactlaw_step(&bead, &state, x, dt);
        u -= 0.5 * dt * state.force / bead.mass;
        contactlaw_friction_step(&bead, &state, &row, x, dt, normal, surface, mu);
        *out++ = state.largest_compression;
        for (k = 0; k < 3; ++k)
            *out++ = row.force[k];
    }}
    out[6] = contactlaw_collide(velocity, spin, leaning, still, r, h, mu);
    for (k = 0; k < 3; ++k) {{
        out[k] = velocity[k];
        out[k + 3] = spin[k];
    }}
}}

#ifdef __OPENCL_VERSION__
__kernel void contactlaw_all(__global const double *in, __global double *out)
{{
    contactlaw_answer(in + {GIVEN} * get_global_id(0), out + {WIDTH} * get_global_id(0));
}}
#else
void contactlaw_answers(int n, const double *in, double *out)
{{
    for (; n > 0; --n, in += {GIVEN}, out += {WIDTH})
        contactlaw_answer(in, out);
}}
#endif
#ifdef __CUDACC__
__global__ void contactlaw_all(const double *in, double *out)
{{
    contactlaw_answer(in, out);
}}
#endif
"""


def compiled(folder, source, *flags, compiler="gcc", out="out"):
    """Run a compiler on a source beside a header."""
    (folder / "source.c").write_text(source)
    command = [compiler, *COMPILERS[compiler], *flags, "source.c", "-o", out, "-lm"]
    return subprocess.run(list(map(str, command)), cwd=folder, capture_output=True, text=True)


def build(folder, source, *flags, **options):
    """Compile a source without a complaint; the file that comes of it."""
    done = compiled(folder, source, *flags, **options)
    assert (done.returncode, done.stderr[:2000]) == (0, "")
    return folder / options.get("out", "out")


class Library:
    """`SOURCE` as a library, beside the header in a folder."""

    def __init__(self, folder, *flags, out="out.so"):
        self._compiled = ctypes.CDLL(build(folder, SOURCE, "-O2", "-shared", "-fPIC", *WARNINGS, *flags, out=out))

    def answers(self, rows):
        """All answers for impacts: speed, radius, thickness, kind and distance of an edge, friction, time step."""
        rows, out = np.ascontiguousarray(rows, float), np.full((len(rows), WIDTH), -2.0)
        places = [ctypes.c_void_p(one.ctypes.data) for one in (rows, out)]
        self._compiled.contactlaw_answers(len(rows), *places)
        return out


def rows(count, seed):
    """Impacts: lambda from 0 to 100, speeds far below and above yield; plates with edges."""
    rng = np.random.default_rng(seed)

    def between(low, high):
        return np.exp(rng.uniform(np.log(low), np.log(high), count))

    v, r, ratio = between(1e-3, 60.0), between(1e-4, 1e-2), between(0.05, 30.0)
    ratio[rng.random(count) < 0.05] = np.inf
    edge = np.arange(count) % 4
    h, dt = r * ratio, 6e-3 * r * v**-0.2 / between(15.0, 60.0)
    return np.column_stack([v, r, h, edge, h * between(0.5, 3.0), between(0.03, 2.0), dt])


def errors(given, found, expected):
    """Largest differences; of times, forces and depths over those of the impact.

    Of collisions that of the speed normal to the plate, and of the velocity of the bead's surface
    along it over friction times speed.
    """
    off, (v, r, mu) = np.abs(found - expected), given.T[[0, 1, 5], :, None]
    time, force, depth = found.T[[1, 3, 4], :, None]
    change, normal = (found - expected)[:, -7:-4], np.array(LEANING) / math.sqrt(1.01)
    up = (change @ normal)[:, None]
    along = np.abs(change - up * normal) + r * off[:, -4:-1]
    parts = {
        "shares": off[:, [0, 6, 7, 8, 9]],
        "times": off[:, 1:3] / time,
        "peaks": off[:, 3:6] / np.hstack([force, depth, depth]),
        "flags": off[:, 10],
        "cor": off[:, 11],
        "near": off[:, 12],
        "steps": off[:, 13:-7] / np.tile(np.hstack([force, depth, *3 * [force]]), STEPS),
        "up": up / v,
        "sliding": along / (mu * v),
        "status": off[:, -1],
    }
    return {name: np.nanmax(np.abs(one)) for name, one in parts.items()}


def assert_close(given, found, expected):
    """Whether answers differ by rounding alone, on which it may depend which springs hold."""
    assert np.array_equal(np.isnan(found), np.isnan(expected))
    off = errors(given, found, expected)
    assert off.pop("sliding") < 2e-3
    assert max(off.values()) < 1e-11, off
