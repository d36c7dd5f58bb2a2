"""The C header: compiled by gcc and g++, called through ctypes, beside what Python answers."""

import ctypes
import dataclasses
import functools
import math
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

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
from contactlaw._jit import kernel
from contactlaw._version import VERSION
from contactlaw.equation import force, zener
from contactlaw.equation.corrections import CONTACT_TIME
from contactlaw.equation.edge import KINDS
from contactlaw.export import c_header
from contactlaw.laws import Law
from contactlaw.laws._branches import Loading
from contactlaw.physical import validity
from contactlaw.physical.oblique import surface_velocity
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.responses import response_of
from contactlaw.physical.scaling import scales, sphere_on_plate
from contactlaw.physical.validity import flags_of
from contactlaw.softsphere import PARTED, Contacts, State, advance, resized, unit_spring
from contactlaw.stepping.edge import Near, rate_of
from contactlaw.stepping.friction import FRICTION, clear_friction, tangential_force
from contactlaw.stepping.spring import RELAXATION
from contactlaw.table import Settings, lookup, nodes
from contactlaw.table.nodes import POINTS
from validation.hostile import headers

COMPILERS = {"gcc": ["-std=c99"], "g++": ["-std=c++11", "-x", "c++"]}
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
PAIR = cl.Pair("gamma-alumina", "glass")
STEEL = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
# Every registered law; fem, which has corrections to the thin-plate dashpot, for three kinds of
# bodies; and two laws of a user's own.
MODELS = {name: (PAIR, name) for name in laws.names()}
MODELS |= {"fem, metals": (STEEL, "fem"), "fem, elastic": (cl.Pair("glass", "glass"), "fem")}
MODELS |= {"own": (PAIR, own()), "measured": (PAIR, measured())}
# Headers of these laws differ from that of myc in their numbers alone.
NAMES = [
    pytest.param(name, marks=pytest.mark.long)
    if name in ("jackson_green", "kogut_etsion", "stronge", "thornton")
    else name
    for name in MODELS
]
MODELS["losses and flow"] = polymer.WEAK_MODEL.pair, "fem"
DOUBLE = ctypes.c_double
FIELDS = [one.name for one in dataclasses.fields(Rebound) if one.name not in ("overload", "flags")]
FIELDS.insert(2, "loading_time")


class SpringOfC(ctypes.Structure):
    """The last number holds the kind of an edge."""

    _fields_ = [("v", DOUBLE * 11)]


LINKAGE = """
#include "contactlaw.h"
#ifdef __cplusplus
#define CALLED extern "C"
#else
#define CALLED
#endif
"""
LOOKUPS = """
CALLED void lookups(int n, const double *v, const double *r, const double *h, double *out)
{
    int k;
    for (k = 0; k < n; ++k)
        out[k] = contactlaw_restitution(v[k], r[k], h[k]);
}
"""
CALLS = """
CALLED void rebounds(int n, const double *v, const double *r, const double *h,
                     contactlaw_impact *out)
{
    int k;
    for (k = 0; k < n; ++k)
        out[k] = contactlaw_rebound(v[k], r[k], h[k]);
}

CALLED void flagged(int n, const double *v, const double *r, const double *h, double *out)
{
    int k;
    for (k = 0; k < n; ++k) {
        const contactlaw_impact impact = contactlaw_rebound(v[k], r[k], h[k]);
        out[k] = contactlaw_flags(&impact, v[k], r[k], h[k]);
    }
}

CALLED void collided(int n, const double *v, const double *omega, const double *r,
                     const double *h, const double *mu, double *out)
{
    const double normal[3] = { 0.0, -3.0, 4.0 }, still[3] = { 0.0, 0.0, 0.0 };
    int k;
    for (k = 0; k < n; ++k) {
        memcpy(out + 7 * k, v + 3 * k, 3 * sizeof *v);
        memcpy(out + 7 * k + 3, omega + 3 * k, 3 * sizeof *v);
        out[7 * k + 6] = contactlaw_collide(out + 7 * k, out + 7 * k + 3, normal, still, r[k], h[k],
                                            mu[k]);
    }
}

CALLED double step(const contactlaw_spring *spring, contactlaw_state *state, double x, double dt)
{
    return contactlaw_step(spring, state, x, dt);
}

CALLED contactlaw_spring spring_of(double radius, double thickness)
{
    return contactlaw_spring_of(radius, thickness);
}

CALLED void set_edge(contactlaw_spring *spring, int edge, double distance)
{
    contactlaw_set_edge(spring, edge, distance);
}

CALLED double near_edge(double v, double r, double h, int edge, double distance)
{
    return contactlaw_restitution_near(v, r, h, edge, distance);
}

/* Friction on beads in each step; the wall rocks, and another bead strikes them in the middle. */
CALLED void slides(int n, int steps, const double *v, const double *spin, const double *r,
                   const double *h, const double *dt, const double *mu, double *out)
{
    int i, j, k;
    for (k = 0; k < n; ++k) {
        const contactlaw_spring spring = contactlaw_spring_of(r[k], h[k]);
        contactlaw_state state = CONTACTLAW_APART;
        contactlaw_sliding sliding = CONTACTLAW_STILL;
        double u[3] = { v[3 * k], v[3 * k + 1], v[3 * k + 2] }, x = 0.3 * dt[k] * u[2];
        for (i = 0; i < steps; ++i) {
            const double lean = 0.01 * (i % 20), size = sqrt(1.0 + lean * lean);
            const double normal[3] = { lean / size, 0.0, 1.0 / size };
            double point[3];
            x -= dt[k] * u[2];
            contactlaw_step(&spring, &state, x, dt[k]);
            for (j = 0; j < 3; ++j) {
                const int a = (j + 1) % 3, b = (j + 2) % 3;
                const double *w = spin + 3 * k;
                point[j] = u[j] - r[k] * (w[a] * normal[b] - w[b] * normal[a]);
            }
            contactlaw_friction_step(&spring, &state, &sliding, x, dt[k], normal, point, mu[k]);
            u[2] += dt[k] * state.force / spring.mass;
            for (j = 0; j < 3; ++j) {
                u[j] += dt[k] * sliding.force[j] / spring.mass;
                out[3 * (k * steps + i) + j] = sliding.force[j];
            }
            if (i == steps / 2)
                u[2] = 0.7 * v[3 * k + 2];
        }
    }
}

CALLED void drops(int n, const double *v, const double *r, const double *h, const double *dt,
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
            contactlaw_step(&spring, &state, x, dt[k]);
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


# Of half a second each, for tables that an export and several tests thin out.
thinned = functools.cache(nodes.thinned)


@pytest.fixture(scope="module", autouse=True)
def thinned_once():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(c_header, "thinned", thinned)
        yield


def model_of(name, **options):
    pair, law = MODELS[name]
    return cl.ImpactModel(pair, law=law, **options)


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
    """A model, its header's table, and the header as a library."""
    model, folder = model_of(request.param), tmp_path_factory.mktemp("header")
    write_header(folder, request.param)
    source = LINKAGE + LOOKUPS + CALLS
    library = ctypes.CDLL(build(folder, source, "-O2", "-shared", "-fPIC", *WARNINGS, out="out.so"))
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


@kernel(entry=True)
def lookups(table, c_lam, c_chi, v, r, h, out):
    for n in range(out.size):
        out[n] = lookup.restitution_on_plate(table, c_lam, c_chi, v[n], r[n], h[n])


def test_a_lookup_is_that_of_numba_in_the_same_table(compiled):
    """Compare 1e5 random impacts, some of them outside the table."""
    model, library, _ = compiled
    table = thinned(model.table, c_header.ERROR)
    bare = dataclasses.replace(table, certificate=None)  # of which a model would warn
    peer = cl.ImpactModel(model.pair, model.force_law, table=bare)
    v, r, h = impacts(100_000, seed=1)
    expected = np.empty(v.size)
    lookups(peer._tabulated.packed, peer._tabulated.c_lam, peer._tabulated.c_chi, v, r, h, expected)
    found = called(library.lookups, v.size, v, r, h)
    outside = np.isnan(expected)
    assert 0.005 < outside.mean() < 0.6
    assert (np.isnan(found) == outside).all()
    assert np.abs(found - expected)[~outside].max() < 1e-12
    whole = np.empty(v.size)
    lookups(model._tabulated.packed, model._tabulated.c_lam, model._tabulated.c_chi, v, r, h, whole)
    assert np.abs(found - whole)[~outside].max() < 1e-5
    assert table.certificate.largest["restitution"] < 1e-5


def test_a_contact_by_steps_is_that_of_softsphere(compiled):
    """Compare 2000 random impacts at 15 to 120 steps per contact."""
    model, library, _ = compiled
    v, r, h = impacts(2000, seed=2)
    rng = np.random.default_rng(3)
    units = scales(sphere_on_plate(model.pair, model.force_law, r, h), v)
    keep = units.inelasticity < 3.0  # beyond 3 spheres do not rebound
    v, r, h = v[keep], r[keep], h[keep]
    dt = 3.2 * units.time[keep] / np.exp(rng.uniform(math.log(15.0), math.log(120.0), v.size))
    phase = rng.uniform(0.02, 0.98, v.size)
    expected = np.array(
        [
            drop(
                model.force_law.data, resized(unit_spring(model, h[n]), r[n]), v[n], dt[n], phase[n]
            )
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
    solved = [
        zener.solve(model.force_law.data, *at, 1e-10)
        for at in zip(units.inelasticity, y, strict=True)
    ]
    expected["loading_time"] = [one.loading_time for one in solved] * units.time
    for name, values in zip(FIELDS, found.T, strict=True):
        # residual compression begins at yield as (chi - 1)^2; lambda is 0 on a half-space
        absolute = name.endswith("fraction") or name in ("restitution", "inelasticity")
        whole = name.replace("residual", "peak")
        scale = 1.0 if absolute else expected[whole]
        # both integrate to 1e-10 a step, in other steps; neither controls the error of the time
        bound = 1e-7 if name.endswith("time") else 1e-9
        assert np.abs((values - expected[name]) / scale).max() < bound, name
    lost = [name.endswith("_fraction") for name in FIELDS]
    energy = found[:, 0] ** 2 + found[:, lost].sum(axis=1)
    assert np.abs(energy - 1.0).max() < 1e-8


def test_an_oblique_impact_is_that_of_the_integration(compiled):
    model, library, _ = compiled
    v, r, h = impacts(400, seed=5)
    units = scales(sphere_on_plate(model.pair, model.force_law, r, h), v)
    keep = units.inelasticity < 2.0
    v, r, h, count = v[keep], r[keep], h[keep], keep.sum()
    rng = np.random.default_rng(6)
    mu = rng.uniform(0.0, 0.6, count)
    n, across = np.array([0.0, -0.6, 0.8]), np.array([1.0, 0.0, 0.0])
    turned = np.cross(n, across)
    angle, size = rng.uniform(0.0, 6.3, count), rng.uniform(0.0, 10.0, count) * mu * v
    along = np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * turned
    spin = rng.normal(size=(count, 3)) * (v / r)[:, None]
    velocity = size[:, None] * along - v[:, None] * n + r[:, None] * np.cross(spin, n)
    out = np.empty((count, 7))
    given = (np.ascontiguousarray(one) for one in (velocity, spin, r, h, mu))
    library.collided(ctypes.c_int(count), *map(pointer, given), pointer(out))
    assert (out[:, 6] == 1.0).all()
    hit = model.oblique(v, size, r, h, mu, method="solve")
    new, turns = out[:, :3], out[:, 3:6]
    point = new - r[:, None] * np.cross(turns, n)
    error = (point * along).sum(axis=1) - hit.sliding_speed
    assert np.abs(error / np.maximum(mu * v, 1e-3 * v)).max() < 2e-3
    assert (new @ n) / v == pytest.approx(hit.restitution, abs=1e-8)
    # all forces act at the contact point
    shift = np.cross(-r[:, None] * n, new - velocity) - 0.4 * (r**2)[:, None] * (turns - spin)
    assert np.abs(shift / (r * v)[:, None]).max() < 1e-12
    bad = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [math.nan, 0.0, -1.0], [0.0, 0.0, -1.0]])
    sizes = np.array([1e-3, 1e-3, 1e-3, -1e-3])
    given = bad, np.zeros((4, 3)), sizes, np.full(4, 1e-2), np.full(4, 0.1)
    out = np.empty((4, 7))
    library.collided(ctypes.c_int(4), *map(pointer, given), pointer(out))
    assert out[:, 6].tolist() == [1.0, 0.0, -1.0, -1.0]
    assert np.array_equal(out[1, :6], [0, 0, 1, 0, 0, 0])
    assert np.isnan(out[2:, :6]).all()


@pytest.mark.parametrize("pair", [STEEL, polymer.PAIRS[1]], ids=["metals", "losses"])
def test_a_step_near_an_edge_is_that_of_softsphere(pair, tmp_path):
    """Compare the whole state in each step of an impact, 1.5 thicknesses from each kind of edge."""
    model, v, r, h, s = cl.ImpactModel(pair), 2.0, 1e-3, 1e-3, 1.5e-3
    library, spring = without_a_table(tmp_path, model), resized(unit_spring(model, h), r)
    library.spring_of.restype, dt = SpringOfC, float(model.solve(v, r, h).contact_time) / 50
    for n, kind in enumerate(KINDS, 1):
        near = Near(
            response_of(kind, pair.plate.poissons_ratio, size="steps"),
            float(rate_of(pair.plate, h, s)),
        )
        peer = library.spring_of(DOUBLE(r), DOUBLE(h))
        library.set_edge(ctypes.byref(peer), n, DOUBLE(s))
        x, u, state, expected, found = -0.3 * v * dt, v, PARTED, [], [np.zeros(len(PARTED))]
        while not expected or state.force > 0.0:
            u -= 0.5 * dt * state.force / spring.mass
            x += dt * u
            state = advance(model.force_law.data, spring, state, x, dt, near)
            u -= 0.5 * dt * state.force / spring.mass
            expected.append(state)
            found.append(found[-1].copy())
            library.step(ctypes.byref(peer), pointer(found[-1]), DOUBLE(x), DOUBLE(dt))
        size = np.abs(expected).max(axis=0)
        assert (size[5:] > 0.0).all()
        assert (np.abs(np.subtract(found[1:], expected)).max(axis=0) <= 1e-12 * size).all()


@pytest.mark.parametrize("pair", [STEEL, polymer.PAIRS[0]], ids=["metals", "losses"])
def test_restitution_near_an_edge_is_the_solvers(pair, tmp_path):
    model, drop = cl.ImpactModel(pair), (2.0, 1e-3, 1e-3)
    near = without_a_table(tmp_path, model).near_edge
    near.restype, near.argtypes = DOUBLE, [DOUBLE] * 3 + [ctypes.c_int, DOUBLE]
    for n, kind in enumerate(KINDS, 1):
        for s in (0.5e-3, 1e-3, 3e-3):
            hit = model.solve(*drop, edge=kind, edge_distance=s)
            assert near(*drop, n, s) == pytest.approx(hit.restitution, abs=1e-3)
    for n, s in ((1, math.inf), (0, 1e-3)):
        assert near(*drop, n, s) == pytest.approx(model.solve(*drop).restitution, abs=1e-9)
    for n, s in ((1, -1e-3), (2, math.nan), (4, 1e-3), (-1, 1e-3)):
        assert math.isnan(near(*drop, n, s))


@kernel(entry=True)
def slides(law, spring, kappa, steps, v, spin, r, dt, mu, row, out):
    """Friction on a bead in `contactlaw.stepping`, in each step of what `slides` does in C."""
    u, x, state, speed = v.copy(), 0.3 * dt * v[2], PARTED, 0.0
    for i in range(steps):
        lean = 0.01 * (i % 20)
        size = math.sqrt(1.0 + lean * lean)
        n = (lean / size, 0.0, 1.0 / size)
        x -= dt * u[2]
        before, last = state.largest_compression, state.force
        state = advance(law, spring, state, x, dt)
        slip = surface_velocity((u[0], u[1], u[2]), (spin[0], spin[1], spin[2]), r, n)
        if last == 0.0:
            clear_friction(row)
            speed = -(slip[0] * n[0] + slip[2] * n[2])
        force = (0.0, 0.0, 0.0)
        if state.force > 0.0:
            force = tangential_force(
                row, mu, kappa, law, spring, state, before, x, speed, n, slip, dt, 0.0
            )
        u[2] += dt * state.force / spring.mass
        for j in range(3):
            u[j] += dt * force[j] / spring.mass
            out[i, j] = force[j]
        if i == steps // 2:
            u[2] = 0.7 * v[2]


@pytest.mark.parametrize("compiled", [*NAMES, "losses and flow"], indirect=True)
def test_friction_by_steps_is_that_of_stepping(compiled):
    """In every step of some 200 impacts, of which a blow repeats most."""
    model, library, _ = compiled
    v, r, h = impacts(200, seed=7)
    units = scales(sphere_on_plate(model.pair, model.force_law, r, h), v)
    keep = units.inelasticity < 2.0
    v, r, h, count, steps = v[keep], r[keep], h[keep], keep.sum(), 120
    rng = np.random.default_rng(8)
    mu, dt = rng.uniform(0.0, 0.6, count), 3.2 * units.time[keep] / rng.uniform(15.0, 80.0, count)
    velocity = rng.normal(size=(count, 3)) * v[:, None] * (1, 1, 0) - np.outer(v, (0, 0, 1))
    spin = rng.normal(size=(count, 3)) * (v / r)[:, None]
    found, expected = np.empty((count, steps, 3)), np.empty((count, steps, 3))
    given = (velocity, spin, r, h, dt, mu)
    library.slides(ctypes.c_int(count), ctypes.c_int(steps), *map(pointer, given), pointer(found))
    kappa, law = model.pair.tangential_ratio, model.force_law.data
    for n in range(count):
        spring = resized(unit_spring(model, h[n]), r[n])
        row = np.recarray(1, FRICTION)[0]
        given = velocity[n], spin[n], r[n], dt[n], mu[n], row, expected[n]
        slides(law, spring, kappa, steps, *given)
    largest = np.abs(expected).max(axis=(1, 2))
    assert (largest > 0.0).all()
    assert (np.abs(found - expected).max(axis=(1, 2)) < 1e-9 * largest).all()


def test_flags_are_those_of_the_solver(compiled):
    """Of 1e5 impacts only those within the integration's error of a limit may have other flags."""
    model, library, _ = compiled
    v, r, h = impacts(10_000, seed=11)
    units = scales(sphere_on_plate(model.pair, model.force_law, r, h), v)
    keep = units.inelasticity < 10.0
    v, r, h, scale = v[keep], r[keep], h[keep], units.compression[keep]
    found, hit = called(library.flagged, v.size, v, r, h), model.solve(v, r, h)
    assert len(set(found)) > 1
    for n in np.flatnonzero(found != hit.flags):
        at = hit.contact_time[n], hit.peak_compression[n], hit.peak_force[n]
        low, high = (
            flags_of(model.limits, r[n], h[n], share * scale[n], *(share * x for x in at))
            for share in (1.0 - 1e-9, 1.0 + 1e-9)
        )
        assert low != high
    assert called(library.flagged, 1, *np.array([[math.nan], [1e-3], [1e-3]])) == -1.0


def test_a_header_names_the_flags_of_validity(compiled):
    text = (compiled[2] / "contactlaw.h").read_text()
    names = dict(re.findall(r"^    CONTACTLAW_([A-Z_]+) = (\d+),?$", text, re.MULTILINE))
    assert names == {one.name: str(one.value) for one in Validity}


CONSTANTS = [
    (module, name) for module, names in c_header._CONSTANTS.items() for name in names.split()
]
OFFSETS = [(force, name) for name in c_header._IN_LAW.split()]
OFFSETS += [(lookup, name) for name in c_header._IN_TABLE.split()]


def test_the_header_follows_the_definitions(monkeypatch):
    """Each constant of Python is in the template, and in the header as Python has it."""
    template = (Path(c_header.__file__).parent / "contactlaw.h.in").read_text()
    for module, name in [*CONSTANTS, *OFFSETS]:
        is_offset = (module, name) in OFFSETS
        assert f"contactlaw_{name}" in template if is_offset else f"${name}" in template, name
        with monkeypatch.context() as patch:
            patch.setattr(module, name, 12345)
            found = c_header._definitions()
        if is_offset:
            found = found["law_offsets" if module is force else "table_offsets"]
            assert f"    contactlaw_{name} = 12345" in found.replace(",", "").split("\n")
        else:
            assert found[name] == "12345"


def test_a_field_of_an_impact_adds_itself_to_the_header(monkeypatch):
    @dataclasses.dataclass(frozen=True)
    class Longer(Rebound):
        __doc__ = Rebound.__doc__.replace(
            "    inelasticity\n", "    slip_fraction\n        Lost to slip [-].\n    inelasticity\n"
        )
        slip_fraction: float = 0.0

    monkeypatch.setattr(c_header, "Rebound", Longer)
    text = c_header._text(model_of("myc"), {})
    assert "    /* Lost to slip [-]. */\n    double slip_fraction;\n" in text
    none = re.search(r"contactlaw_impact impact = { (.*) };", text)[1]
    assert none.count("none") == len(FIELDS) + 1


def test_a_state_in_c_is_softspheres():
    text = c_header._text(model_of("myc"), {})
    inside = re.search(r"struct contactlaw_state {(.*?)}", text, re.DOTALL)[1]
    assert re.findall(r"double (\w+);", inside) == list(State._fields[:5])
    assert "double memory[6];" in inside
    assert len(State._fields) == 5 + 6


def test_no_constant_of_python_is_repeated_in_the_template():
    """Constants with distinctive values are searched for; small whole numbers mean many things."""
    folder = Path(c_header.__file__).parent
    values = {float(getattr(module, name)): name for module, name in CONSTANTS}
    values |= {RELAXATION: "RELAXATION", validity.SLENDER: "THINNEST"}
    del values[1.5]  # RELAXING, but also Hertz's exponent
    del values[1e-3]  # NEAREST, but also a bound of the integration
    number = re.compile(r"(?<![\w.$])\d+(?:\.\d*)?(?:e-?\d+)?(?![\w.])")
    for path in (folder / "contactlaw.h.in", *folder.glob("liggghts/*.h.in")):
        code = path.read_text().partition("BSD 3-Clause License")[0]
        found = {float(one) for one in number.findall(code)}
        repeated = {values[one] for one in found & values.keys() if one % 1.0 or one > 10.0}
        assert repeated == set()


def without_a_table(folder, model):
    """Library of a header without a table, which integrates."""
    cl.export.header(folder / "contactlaw.h", model, table="none")
    return ctypes.CDLL(build(folder, LINKAGE + CALLS, "-O2", "-shared", "-fPIC", *WARNINGS))


def test_a_rebound_of_a_sphere_that_stays_is_the_solvers(tmp_path):
    """The COR is 1e-2 to 0: the contact ends once its remaining energy is negligible."""
    model = cl.ImpactModel(STAYING)
    library = without_a_table(tmp_path, model)
    v, h = np.array(np.meshgrid(np.geomspace(1e-6, 1.0, 16), np.geomspace(1.5e-4, 4e-3, 9)))
    v, h = v.ravel(), h.ravel()
    r = np.full_like(v, 1e-3)
    lam = scales(sphere_on_plate(model.pair, model.force_law, r, h), v).inelasticity
    v, r, h = v[lam < 60.0], r[lam < 60.0], h[lam < 60.0]
    found = called(library.rebounds, v.size, v, r, h, fields=len(FIELDS))
    expected = model.solve(v, r, h)
    assert expected.restitution.min() < 2e-6 < 1e-2 < expected.restitution.max()
    assert np.abs(found[:, 0] - expected.restitution).max() < 1e-10
    assert found[:, 1] == pytest.approx(expected.contact_time, rel=1e-7)
    waves = FIELDS.index("wave_fraction")
    assert np.abs(found[:, waves] - expected.wave_fraction).max() < 1e-8


def test_the_series_is_not_for_the_loading_curve(tmp_path):
    """An elastic contact unloads along the loading curve, which is no power law here."""
    stiffening = np.polynomial.Polynomial([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1e3])
    law = Law.of(name="stiffening", source="s", yield_coefficient=None, scale=1e-5,
                 loading=[Loading(0.0, stiffening)])  # fmt: skip
    model = cl.ImpactModel(cl.Pair("zirconia", "glass"), law)
    library = without_a_table(tmp_path, model)
    (found,) = called(library.rebounds, 1, [100.0], [1e-3], [0.2e-3], fields=len(FIELDS))
    expected = model.solve(100.0, 1e-3, 0.2e-3)
    assert found[1] == pytest.approx(expected.contact_time, rel=1e-6)
    assert found[FIELDS.index("wave_fraction")] == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("table", ["cor", "none"])
@pytest.mark.parametrize("name", NAMES)
def test_compilers_have_nothing_to_say(name, table, tmp_path):
    write_header(tmp_path, name, table)
    assert (tmp_path / "contactlaw.h").stat().st_size <= 500_000
    source = LINKAGE + LOOKUPS + CALLS if table == "cor" else LINKAGE
    # `compiled` has built the header with gcc and the same warnings already.
    for compiler in COMPILERS if table == "none" else ["g++"]:
        build(tmp_path, source, "-c", "-O1", *WARNINGS, compiler=compiler)


# Calls with numbers of all kinds, in any order: a call without a valid answer has to give NaN.
ANY_INPUT = """
#include "contactlaw.h"
#include <stdio.h>

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
            spring.transit = near(spring.transit);
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


def test_the_data_are_those_that_python_reads(compiled):
    model, _, folder = compiled
    text = (folder / "contactlaw.h").read_text()
    table = thinned(model.table, c_header.ERROR).packed.copy()
    plate = slice(lookup.TRANSIT, lookup.HEADER)
    table[plate] = model._tabulated.packed[plate]  # the pair adds these constants of the plate
    for array, values in (("law", model.force_law.data), ("table", table)):
        inside = re.search(rf"contactlaw_{array}\[\] = {{(.*?)}}", text, re.DOTALL)[1]
        found = np.array(inside.replace("HUGE_VAL", "inf").split(","), dtype=np.float64)
        assert found.size == (values.size if array == "law" else table[lookup.OTHERS_AT])
        assert (found == values[: found.size]).all()


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
    assert float(found) == pytest.approx(model.restitution(9.0, 0.9e-3, 1e-3), abs=1e-12)


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
        build(tmp_path, source, "-c", *WARNINGS, compiler=compiler)


def test_nothing_that_threads_could_share(tmp_path):
    """The header has functions and constants only, and calls only the mathematical library."""
    write_header(tmp_path, "fem")
    compiled = build(tmp_path, LINKAGE + LOOKUPS + CALLS, "-c", "-O1", out="out.o")
    done = subprocess.run(["nm", compiled], capture_output=True, text=True)
    symbols = done.stdout.split("\n")
    kinds = {tuple(line.split()[-2:]) for line in symbols if line}
    assert {kind for kind, _ in kinds} <= {"T", "t", "r", "U"}
    outside = {name for kind, name in kinds if kind == "U"}
    known = {"sqrt", "pow", "exp", "expm1", "log"}
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
    assert subprocess.run([build(tmp_path, source, *WARNINGS, other)]).returncode == 0


def test_a_spring_is_that_of_softsphere(compiled):
    model, library, _ = compiled
    for radius, thickness in ((0.9e-3, 1e-3), (1e-9, math.inf), (1e3, 10.0), (1e-7, 1e-9)):
        library.spring_of.argtypes = (ctypes.c_double, ctypes.c_double)
        library.spring_of.restype = SpringOfC
        found = list(library.spring_of(radius, thickness).v)[:8]
        spring = resized(unit_spring(model, thickness), radius)
        plate = model.pair.plate
        shear = 0.5 * plate.youngs_modulus / (1.0 + plate.poissons_ratio)
        transit = thickness * math.sqrt(plate.density / shear) / CONTACT_TIME
        theirs = *spring[:5], transit, spring.ratio, radius
        assert found == pytest.approx(theirs, rel=1e-14)
    for radius, thickness in ((0.0, 1e-3), (-1.0, 1e-3), (1e-3, 0.0), (1e-3, math.nan), (2e3, 1.0)):
        assert np.isnan(list(library.spring_of(radius, thickness).v)[:8]).all()


def test_a_blown_up_simulation_is_told_and_leaves_the_state(tmp_path):
    write_header(tmp_path, "myc", "none")
    source = """
#include "contactlaw.h"
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
    assert subprocess.run([build(tmp_path, source, *WARNINGS)]).returncode == 0


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
    command = compilation.replace("cc ", "gcc -std=c99 " + " ".join(WARNINGS) + " ")
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
    build(tmp_path, source, "-c", *WARNINGS)


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
    program = build(tmp_path, source, *WARNINGS, compiler=compiler)
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
