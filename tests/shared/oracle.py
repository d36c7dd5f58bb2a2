"""The modified Zener model by scipy; of contactlaw it takes the laws, see `reference_laws`.

First-order form of Eq. (1) of Peng et al. 2021 on Hertz's scale: w' = u - lam f(w), u' = -f(w),
w(0) = 0, u(0) = 1; d_Y = y there.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

from contactlaw import laws

MYC = laws.law("myc")
# Numbers besides d_Y that laws take from the pair, for gamma-alumina on glass.
NUMBERS = {
    "modulus_ratio": 23.1922,
    "poissons_ratio": 0.21,
    "sphere_ratio": 23.1922,
    "plate_ratio": 0.0,
    "modulus_share": 0.1435,
    "plate_poissons_ratio": 0.21,
}
# Laws that follow Hertz until yield, and the one that does not.
ALL_LAWS = [laws.law(name, **NUMBERS) for name in laws.names() if name != "fem"]
FEM = laws.law("fem", **NUMBERS)
OPTIONS = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13}


def yield_ratio(speed_ratio):
    """d_Y/(V0 T_H) at v = V0/V_Y0: the elastic half-space impact at v = 1 just reaches d_Y."""
    return (5 / 4) ** 0.4 * speed_ratio**-0.8


def impact(lam, y, law=MYC):
    """COR, contact time and largest compression of one impact, in terms of w."""
    return _integrated(law, lam, y)[:3]


def force_history(lam, y, share):
    """Force and speed of the sphere at shares of the contact time, under the law MYC."""
    _, end, _, at = _integrated(MYC, lam, y, dense_output=True)
    return np.array([at(t)[:2] for t in end * share]).T


def contact(lam, y):
    """Contact time, largest compression, and force and compression as functions of time."""
    _, end, largest, at = _integrated(MYC, lam, y, dense_output=True)
    return end, largest, lambda time: at(time)[::2]


def series(mass, stiffness, mobility, speed, outward=lambda x: 0.0):
    """COR, contact time and force over time of a mass on Hertz's spring in series with a plate, in SI units.

    At an indentation x the mass is accelerated outward by this as well.
    """

    def rates(_, state):
        x, u, plate, _ = state
        force = stiffness * max(x - plate, 0.0) ** 1.5
        return [u, -force / mass - outward(x), mobility * force, mobility * force**2]

    def apart(time, state):
        return state[0] - state[2] + (time < 1e-9)

    apart.terminal, apart.direction = True, -1
    how = {"events": apart, "dense_output": True, "rtol": 1e-11, "atol": 1e-16}
    run = solve_ivp(rates, (0.0, 1e-3), [0.0, speed, 0.0, 0.0], **how)
    assert run.status == 1

    def force(time):
        x, _, plate, _ = run.sol(time)
        return stiffness * np.maximum(x - plate, 0.0) ** 1.5

    return math.sqrt(1 - 2 * run.y[3, -1] / (mass * speed**2)), run.t[-1], force


def _integrated(law, lam, y, **options):
    scale = y * math.sqrt(y)  # F_Y and d_Y on Hertz's scale
    parts = []

    def event(function, direction):
        function.terminal, function.direction = True, direction
        return function

    def follow(force, t, state, events):
        def rates(t, s):
            f = force(s[0])
            return [s[1] - lam * f, -f]

        run = solve_ivp(rates, [t, t + 1000], state, events=events, **OPTIONS, **options)
        parts.append((run, force))
        return run, run.t[-1], run.y[:, -1]

    def up(w):
        return scale * law.loading(math.sqrt(max(w, 0.0) / y))

    t, state = 0.0, [0.0, 1.0]
    turned = event(lambda t, s: s[1] - lam * up(s[0]), -1)
    for kink in (*law.loading_kinks, math.inf):  # the method keeps its order between kinks
        reached = event(lambda t, s, k=kink: s[0] - k * y, 1)
        run, t, state = follow(up, t, state, [turned, reached])
        if run.t_events[0].size:
            break
    largest = state[0]
    left, curve = law.residual(largest / y), law.unloading_curve(largest / y)

    def down(w):
        return scale * law.unloading(math.sqrt(max(w / y - left, 0.0)), curve)

    run, t, state = follow(down, t, state, [event(lambda t, s: s[0] - left * y, -1)])
    assert run.t_events[0].size == 1

    def at(time):
        part, force = next(p for p in parts if time <= p[0].t[-1] or p is parts[-1])
        w, speed = part.sol(time)
        return force(w), speed, w

    return -state[1], t, largest, at
