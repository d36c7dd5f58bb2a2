"""The modified Zener model by scipy alone; `impact` shares no code with contactlaw.

First-order form of Eq. (1) of Peng et al. 2021 with the MYC law of Eqs. 16-18, on Hertz's scale:
w' = u - lam f(w), u' = -f(w), w(0) = 0, u(0) = 1; d_Y = y there.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

from contactlaw import laws

RATIO = 2.14 / 0.68  # d_P/d_Y
# Numbers besides d_Y that laws take from the pair, for gamma-alumina on glass.
NUMBERS = {
    "modulus_ratio": 23.1922, "poissons_ratio": 0.21,
    "sphere_ratio": 23.1922, "plate_ratio": 0.0, "modulus_share": 0.1435,
    "plate_poissons_ratio": 0.21,
}  # fmt: skip
# Laws that follow Hertz until yield, and the one that does not.
ALL_LAWS = [laws.law(name, **NUMBERS) for name in laws.names() if name != "fem"]
FEM = laws.law("fem", **NUMBERS)
OPTIONS = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13}


def yield_ratio(speed_ratio):
    """d_Y/(V0 T_H) at v = V0/V_Y0: the elastic half-space impact at v = 1 just reaches d_Y."""
    return (5 / 4) ** 0.4 * speed_ratio**-0.8


def loading(w, y):
    p = RATIO * y
    return w**1.5 if w < p else p**1.5 + 1.5 * math.sqrt(p) * (w - p)


def impact(lam, y, law="myc"):
    """COR, contact time and largest compression of one impact."""
    return _integrated(lam, y, law)[:3]


def force_history(lam, y, share):
    """Force and speed of the sphere at shares of the contact time."""
    _, end, _, at = _integrated(lam, y, "myc", dense_output=True)
    return np.array([at(t)[:2] for t in end * share]).T


def contact(lam, y):
    """Contact time, largest compression, and force and compression as functions of time."""
    _, end, largest, at = _integrated(lam, y, "myc", dense_output=True)

    def force_and_compression(time):
        force, _, compression = at(time)
        return force, compression

    return end, largest, force_and_compression


def _integrated(lam, y, law, **options):

    def force(w):
        w = max(w, 0.0)
        return loading(w, y) if law == "myc" else w**1.5

    def turned(t, s):
        return s[1] - lam * force(s[0])

    def reached_kink(t, s):
        return s[0] - RATIO * y

    turned.terminal, turned.direction = True, -1
    reached_kink.terminal, reached_kink.direction = True, 1

    def rise(t, s):
        f = force(s[0])
        return [s[1] - lam * f, -f]

    # The linear branch begins with a jump of F'': the integration stops there to keep its order.
    options |= OPTIONS
    run = solve_ivp(rise, [0, 100], [0, 1], events=[turned, reached_kink], **options)
    parts = [(run, force)]
    if run.t_events[1].size:
        run = solve_ivp(rise, [run.t[-1], 100], run.y[:, -1], events=[turned], **options)
        parts.append((run, force))
    t, wm, u = run.t[-1], run.y[0, -1], run.y[1, -1]

    plastic = law == "myc" and wm >= y
    left = wm - y * math.sqrt(2 * wm / y - 1) if plastic else 0.0
    fm = force(wm)

    def unloading(w):
        return fm * (max(w - left, 0.0) / (wm - left)) ** 1.5

    def fall(t, s):
        f = unloading(s[0])
        return [s[1] - lam * f, -f]

    def parted(t, s):
        return s[0] - left

    parted.terminal, parted.direction = True, -1
    run = solve_ivp(fall, [t, t + 1000], [wm, u], events=[parted], **options)
    parts.append((run, unloading))
    assert run.t_events[0].size == 1

    def at(time):
        part, law_there = next(p for p in parts if time <= p[0].t[-1] or p is parts[-1])
        w, speed = part.sol(time)
        return law_there(w), speed, w

    return -run.y[1, -1], run.t[-1], wm, at


def impact_of(law, lam, y):
    """COR, contact time and largest compression under any law's force, in terms of w."""
    scale = y * math.sqrt(y)  # F_Y and d_Y on Hertz's scale

    def event(function, direction):
        function.terminal, function.direction = True, direction
        return function

    def follow(force, t, s, events):
        def rates(t, s):
            f = force(s[0])
            return [s[1] - lam * f, -f]

        return solve_ivp(rates, [t, t + 1000], s, events=events, **OPTIONS)

    def up(w):
        return scale * law.loading(math.sqrt(max(w, 0.0) / y))

    t, state = 0.0, [0.0, 1.0]
    turned = event(lambda t, s: s[1] - lam * up(s[0]), -1)
    for kink in (*law.loading_kinks, math.inf):  # the method keeps its order between kinks
        run = follow(up, t, state, [turned, event(lambda t, s, k=kink: s[0] - k * y, 1)])
        t, state = run.t[-1], run.y[:, -1]
        if run.t_events[0].size:
            break
    largest = state[0]
    left, curve = law.residual(largest / y), law.unloading_curve(largest / y)

    def down(w):
        return scale * law.unloading(math.sqrt(max(w / y - left, 0.0)), curve)

    run = follow(down, t, state, [event(lambda t, s: s[0] - left * y, -1)])
    assert run.t_events[0].size == 1
    return -run.y[1, -1], run.t[-1], largest
