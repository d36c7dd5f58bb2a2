"""The C header of a pair with a rate of strain: each impact has its own strength."""

import ctypes
import dataclasses
import shutil
import subprocess

import metal
import numpy as np
import pytest

import contactlaw as cl

SOURCE = """
#include "contactlaw.h"
double looked_up(double v, double r, double h) { return contactlaw_restitution(v, r, h); }
double rebounds(double v, double r, double h) { return contactlaw_rebound(v, r, h).restitution; }
double kept(double v, double r, double h)
{
    const contactlaw_impact hit = contactlaw_rebound(v, r, h);
    return hit.restitution * hit.restitution + hit.plastic_fraction + hit.wave_fraction
         + hit.other_fraction;
}
double time_of(double v, double r, double h) { return contactlaw_rebound(v, r, h).contact_time; }
double drops(double v, double r, double h)
{
    const contactlaw_spring spring = contactlaw_spring_of(r, h);
    const double dt = contactlaw_rebound(v, r, h).contact_time / 100.0;
    contactlaw_state state = CONTACTLAW_APART;
    double x = -0.3 * v * dt, u = v;
    int n;
    for (n = 0; n < 1000 && (n < 3 || state.force > 0.0); ++n) {
        u -= 0.5 * dt * state.force / spring.mass;
        x += u * dt;
        contactlaw_step(&spring, &state, x, dt);
        u -= 0.5 * dt * state.force / spring.mass;
    }
    return -u / v;
}
double slides(double v, double r, double h)
{
    double velocity[3] = { 1.0, 0.0, 0.0 }, spin[3] = { 0.0, 0.0, 0.0 };
    const double normal[3] = { 0.0, 0.0, 1.0 }, still[3] = { 0.0, 0.0, 0.0 };
    velocity[2] = -v;
    contactlaw_collide(velocity, spin, normal, still, r, h, 0.2);
    return velocity[0] - r * spin[1];
}
"""


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    folder = tmp_path_factory.mktemp("header")
    if not shutil.which("gcc"):
        pytest.skip("no gcc on PATH: the header is not compiled")
    cl.export.header(folder / "contactlaw.h", metal.MODEL)
    (folder / "source.c").write_text(SOURCE)
    warn = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
    command = ["gcc", "-std=c99", "-O2", *warn, "-shared", "-fPIC", "source.c", "-o", "out", "-lm"]
    subprocess.run(command, cwd=folder, check=True)
    return ctypes.CDLL(folder / "out"), (folder / "contactlaw.h").read_text()


def called(library, name, *numbers):
    function = library[0][name]
    function.restype, function.argtypes = ctypes.c_double, [ctypes.c_double] * 3
    return function(*numbers)


@pytest.mark.parametrize(("radius", "thickness", "speed"), metal.DROPS)
def test_an_impact_is_that_of_the_pair_at_its_strength(radius, thickness, speed, library):
    at, one = (speed, radius, thickness), metal.at_strength(speed, radius)
    hit = one.solve(*at)
    assert hit.restitution > 1.01 * cl.ImpactModel(metal.PLAIN).restitution(*at)
    for name in ("looked_up", "rebounds", "drops"):
        assert called(library, name, *at) == pytest.approx(hit.restitution, rel=2e-3), name
    assert called(library, "kept", *at) == pytest.approx(1.0, abs=1e-7)
    assert called(library, "time_of", *at) == pytest.approx(hit.contact_time, rel=2e-3)
    slid = one.oblique(speed, 1.0, radius, thickness, 0.2, method="solve").sliding_speed
    assert called(library, "slides", *at) == pytest.approx(slid, abs=5e-3 * 0.2 * speed)


def test_it_says_what_it_is(library):
    text = library[1]
    assert len(text) < 500_000
    said = " ".join(line.strip(" *") for line in text.splitlines()[:14])
    assert "2.05e+08 Pa, hardening 3e+08 Pa and 0.4, rate 0.07 above 1 1/s" in said
    assert text.count("table of COR at") == 4
    assert np.isnan(called(library, "looked_up", 1.0, 1e-3, 1e-5))


def test_a_table_is_refused_where_another_body_comes_to_yield(tmp_path):
    """Its COR was wrong by 0.014."""
    other = dataclasses.replace(metal.PLAIN.sphere, yield_strength=300e6)
    model = cl.ImpactModel(cl.Pair(metal.PAIR.sphere, other))
    with pytest.raises(ValueError, match=r"another body may yield.*contactlaw_rebound"):
        cl.export.header(tmp_path / "contactlaw.h", model)
    cl.export.header(tmp_path / "contactlaw.h", model, table="none")
