"""Laws that users bring, of plain functions and of measured points."""

import math

import numpy as np

import contactlaw as cl
from contactlaw import laws
from contactlaw.laws import HERTZ, Law, Loading, Unloading
from contactlaw.physical.scaling import yield_scales

R = 0.9e-3
PAIR = cl.Pair("gamma-alumina", "glass")
CUT_OFF = Loading(1.0, lambda d: 1.5 * d - 0.5)  # Hertz's curve, then its tangent


def residual(dm):
    return 0.6 * (dm - 1.0) ** 2 / dm


def own(name="mine", **changes):
    """Two kinks after yield, one of them a corner, and an exponent that falls."""
    options = {
        "source": "a test",
        "yield_coefficient": 0.5,
        "loading": [Loading(0.0, HERTZ), CUT_OFF, Loading(6.0, lambda d: 8.5 * (d / 6.0) ** 1.1)],
        "unloading": [
            Unloading(1.0, residual, lambda dm: 1.5 - 0.4 * residual(dm) / dm),
            Unloading(3.0, residual, 1.5 - 0.4 * residual(3.0) / 3.0),
        ],
    }
    return Law.of(name=name, **(options | changes))


def points(law, noise=0.0, count=30, deepest=40.0):
    """Compressions and forces [m], [N], as an indentation of a sphere of radius R gives them."""
    d = np.geomspace(0.5, deepest, count)
    force = np.array([law.loading(math.sqrt(one)) for one in d])
    force *= 1 + noise * np.random.default_rng(7).standard_normal(count)
    d_y, f_y = yield_scales(PAIR, law.yield_coefficient, R)
    return d * d_y, force * f_y


def measured(**changes):
    compression, force = points(laws.law("myc"))
    return cl.measured_law(PAIR, **({"radius": R, "compression": compression, "force": force} | changes))
