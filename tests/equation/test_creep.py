"""Spheres that a plate never throws off, beside an implicit method that shares no code."""

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from contactlaw import laws
from contactlaw.equation import force, zener
from contactlaw.laws import fem

SOFT = fem.law(486795.0, 0.0, 0.999419, 0.0786415, 0.28555)  # a sphere of no strength
# law, lambda, overload: the force falls with a power below 2, so that all is creeping once it has
# begun; above 2, where it ends again; and with Hertz's power, in the first part of unloading only
CASES = {
    "power 1.6": (SOFT, 13.5, 5e6),
    "power 1.5": (SOFT, 30.0, 1e5),
    "power 2.07": (SOFT, 36.0, 1e7),
    "power 2.25": (SOFT, 300.0, 1e9),
    "Hertz": (laws.law("myc"), 300.0, 1e4),
}


def numbers(name):
    """Data of the law, lambda and yield compression of a case, and its solution."""
    law, lam, overload = CASES[name]
    status, w_m = zener.elastic_compression(law.data, lam, 1e-10)
    assert status == zener.OK
    return law.data, lam, w_m / overload, zener.solve(law.data, lam, w_m / overload, 1e-10)


def way_back(law, lam, y, dm):
    """Integrate implicitly from the largest compression until no energy is left.

    Returns the time with the last phase, in which the plate is held; the work on the plate; the
    time without that phase; and a function that gives speed and force at given times.
    """
    beta, curve = lam * y**0.25, force.unloading(law, dm)
    a, b = curve.stiffness, curve.exponent
    top = force.loading(law, math.sqrt(dm))

    def left(u, f):
        return u * u + 4.0 * f * (f / a) ** (2.0 / b) / (b + 2.0)

    def rates(_, state):
        u, f = np.exp(state[:2])
        return [-f / u, 0.5 * b * (f / a) ** (-2.0 / b) * (u - beta * f), f * f]

    def over(_, state):
        return math.log(left(*np.exp(state[:2])) / (1e-9 * y**-1.25) ** 2)

    over.terminal = True
    run = solve_ivp(
        rates, (0.0, 100.0 * beta), [math.log(beta * top), math.log(top), 0.0], "Radau",
        events=over, rtol=1e-10, atol=1e-11, first_step=1e-9 * beta, dense_output=True,
    )  # fmt: skip
    assert run.t_events[0].size == 1
    u, f, work = *np.exp(run.y[:2, -1]), run.y[2, -1]
    square = (f / a) ** (2.0 / b)  # square of the root compression

    def rate(share):  # d(time)/d(share), from the work that the force has yet to do
        ahead = 4.0 * f * square * share ** (b + 2.0) / (b + 2.0)
        return 2.0 * square * share / math.sqrt(left(u, f) - ahead)

    held, _ = quad(rate, 0.0, 1.0, epsabs=0.0, epsrel=1e-10)
    return run.t[-1] + held, work, run.t[-1], lambda times: np.exp(run.sol(times)[:2])


@pytest.mark.parametrize("name", CASES)
def test_a_creeping_contact_is_an_implicit_methods(name):
    law, lam, y, found = numbers(name)
    unit, first = y**0.25, y**-1.25
    dm = found.peak_compression / y
    time, work, _, _ = way_back(law, lam, y, dm)
    assert found.status == zener.OK
    assert found.steps < 100_000
    assert found.restitution == pytest.approx(1e-9, rel=1e-5)
    assert found.contact_time == pytest.approx(found.loading_time + time / unit, rel=1e-8)

    top = force.loading(law, math.sqrt(dm))
    kinks = [q for q in (1.0, math.sqrt(2.14 / 0.68)) if name == "Hertz"]
    pushed = sum(
        quad(lambda q: 2.0 * q * force.loading(law, q), *ends, epsabs=0.0, epsrel=1e-10)[0]
        for ends in zip([0.0, *kinks], [*kinks, math.sqrt(dm)], strict=True)
    )
    rising = 1.0 - (lam * unit * top / first) ** 2 - 2.0 * pushed / first**2
    falling = 2.0 * lam * unit * work / first**2
    assert found.wave_fraction == pytest.approx(rising + falling, abs=1e-8)


@pytest.mark.parametrize("name", CASES)
def test_times_and_levels_within_the_creep(name):
    """Forces at given times, and times at given compressions, are found within the creep."""
    law, lam, y, found = numbers(name)
    unit, dm = y**0.25, found.peak_compression / y
    curve = force.unloading(law, dm)
    _, _, end, at = way_back(law, lam, y, dm)
    times = np.geomspace(1e-3, 0.95, 24) * end
    u, f = at(times)
    since_touch = found.loading_time + times / unit
    answer, _, speed = zener.history(law, lam, y, 1e-10, since_touch)
    assert answer * y**-1.5 == pytest.approx(f, rel=1e-6)
    assert speed * y**-1.25 == pytest.approx(u, rel=1e-6)

    share = (f / curve.stiffness) ** (1.0 / curve.exponent) / math.sqrt(dm - curve.residual)
    share = share[share > 0.3]  # smaller ones are lost in the digits of the compressions
    assert share.size > 4
    shares = np.append(share[::-1], 1.0)
    status, (when,), _ = zener.shape(law, np.array([lam]), np.array([y]), 1e-10, shares)
    assert status == zener.OK
    falling = when[shares.size : -1]
    assert falling == pytest.approx(since_touch[: share.size], rel=1e-7)
