"""A C header of a model, compiled with functions that a test calls."""

import ctypes
import shutil
import subprocess

import pytest

import contactlaw as cl

WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
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
    const double dt = contactlaw_rebound(v, r, h).contact_time / 40.0;
    contactlaw_state state = CONTACTLAW_APART;
    double x = -0.3 * v * dt, u = v;
    int n;
    for (n = 0; n < 200 && (n < 3 || state.force > 0.0); ++n) {
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
double near(double v, double r, double h)
{
    return contactlaw_restitution_near(v, r, h, CONTACTLAW_FREE_EDGE, h);
}
double flags(double v, double r, double h)
{
    const contactlaw_impact hit = contactlaw_rebound(v, r, h);
    return contactlaw_flags(&hit, v, r, h);
}
double rubs(double v, double r, double h)
{
    const double normal[3] = { 0.0, 0.0, 1.0 }, velocity[3] = { 0.5, 0.1, -v };
    const contactlaw_spring spring = contactlaw_spring_of(r, h);
    const double dt = contactlaw_rebound(v, r, h).contact_time / 40.0;
    contactlaw_state state = CONTACTLAW_APART;
    contactlaw_sliding sliding = CONTACTLAW_STILL;
    int n;
    for (n = 1; n < 8; ++n) {
        contactlaw_step(&spring, &state, n * v * dt, dt);
        contactlaw_friction_step(&spring, &state, &sliding, n * v * dt, dt, normal, velocity, 0.2);
    }
    return sliding.force[0] / state.force;
}
"""


class Library:
    """Compiled functions of speed, radius and thickness, and the text of the header."""

    def __init__(self, folder, model):
        if not shutil.which("gcc"):
            pytest.skip("no gcc on PATH: the header is not compiled")
        cl.export.header(folder / "contactlaw.h", model)
        (folder / "source.c").write_text(SOURCE)
        command = ["gcc", "-std=c99", "-O2", *WARNINGS, "-shared", "-fPIC", "source.c", "-o", "out"]
        subprocess.run([*command, "-lm"], cwd=folder, check=True)
        self.text = (folder / "contactlaw.h").read_text()
        self._compiled = ctypes.CDLL(folder / "out")

    def __call__(self, name, *numbers):
        function = self._compiled[name]
        function.restype, function.argtypes = ctypes.c_double, [ctypes.c_double] * 3
        return function(*numbers)
