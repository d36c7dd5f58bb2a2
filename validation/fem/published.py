"""What the finite elements are compared with: published formulas, and the model's force history."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw.impact import scales, sphere_on_plate
from contactlaw.laws import law

Array = NDArray[np.float64]

_C = 0.0935  # Peng et al. 2021, below Eq. 22
_CRITICAL = 1.1  # mean pressure at first yield over yield strength (Stronge, Impact Mechanics)


def mueller(inelasticity: Array) -> Array:
    """COR of an elastic impact [-], Zener's equation made linear (Peng et al. 2021, Eq. 3)."""
    lam = np.asarray(inelasticity)
    cor: Array = np.exp(-math.pi * lam / np.sqrt(4.0 - lam**2))
    return cor


def closed_form(inelasticity: Array, speed_ratio: Array, slenderness: Array) -> Array:
    """COR by the paper's Eq. 22 [-], with its elastic COR at yield as a factor.

    Parameters
    ----------
    inelasticity, speed_ratio, slenderness : ndarray
        lambda, V0/V_Y0 and R/H of each impact.

    Notes
    -----
    As printed, Eq. 22 jumps to 1 at yield; V_Y is that of Eq. 14.
    """
    at_yield0 = inelasticity * speed_ratio**-0.2
    q = at_yield0 * (5.0 / 4.0) ** 0.6
    g = q + (1.0 + q) ** -0.2  # V_Y/V_Y0, Eq. 14
    over = np.maximum(speed_ratio / g, 1.0)
    plastic = (1.0 - (1.0 - over**-0.8) ** 2) ** (0.25 + _C * slenderness**2)
    elastic = mueller(np.where(speed_ratio > g, at_yield0 * g**0.2, inelasticity))
    cor: Array = elastic * plastic
    return cor


def thornton(compression: Array) -> Array:
    """Compute the loading force [F_Y of MYC] at a compression [d_Y of MYC] (Thornton 1997).

    Thornton, J. Appl. Mech. 64 (1997) 383. With the yield compression that Peng et al. 2021 give
    it, 0.25 pi^2 sigma_Y^2 R*/E*^2, beyond which the pressure no longer grows: the force is linear
    with the slope of Hertz's curve there.
    """
    d, y = np.asarray(compression), 0.25 / 0.68
    force: Array = np.where(d < y, np.abs(d) ** 1.5, y**1.5 + 1.5 * y**0.5 * (d - y))
    return force


def stronge(compression: Array) -> Array:
    """Compute the loading force [F_Y of MYC] at a compression [d_Y of MYC] (Stronge 2000).

    Stronge, Impact Mechanics (2000), section 6.2. Elastic to d_Y, whose coefficient
    (3/4 x 1.1)^2 = 0.6806 is MYC's to 0.1 %, then elastic-plastic to 84 d_Y.
    """
    d = np.asarray(compression)
    rise = np.maximum(2.0 * d - 1.0, 1.0)
    force: Array = np.where(
        d < 1.0, np.abs(d) ** 1.5, rise * (1.0 + np.log(rise) / (3 * _CRITICAL))
    )
    return force


def force_history(
    pair: cl.Pair, speed: float, radius: float, thickness: float, steps: int = 4000
) -> tuple[Array, Array]:
    """Time [s] and force [N] of the modified Zener model with the MYC law, by Runge and Kutta.

    Parameters
    ----------
    pair : contactlaw.Pair
        Materials of sphere and plate.
    speed, radius, thickness : float
        Impact [m/s, m, m].
    steps : int, optional
        Steps of the integration.
    """
    myc = law("myc")
    contact = sphere_on_plate(pair, myc, np.array(radius), np.array(thickness))
    units = scales(contact, np.array(speed))
    lam, y = float(units.inelasticity), float(units.yield_ratio)
    solved = cl.ImpactModel(pair).solve(speed, radius, thickness)
    end = float(solved.contact_time) / float(units.time)

    def force(w: float, largest: float) -> float:
        d, dm = max(w, 0.0) / y, max(largest, w) / y
        if d >= dm:
            return float(myc.loading(math.sqrt(d)) * y**1.5)
        q = math.sqrt(max(d - myc.residual(dm), 0.0))
        return float(myc.unloading(q, *myc.unloading_curve(dm)) * y**1.5)

    def rates(state: Array, largest: float) -> Array:
        f = force(state[0], largest)
        return np.array([state[1] - lam * f, -f])

    state, largest, h = np.array([0.0, 1.0]), 0.0, end / steps
    out = np.zeros(steps + 1)
    for n in range(steps):
        a = rates(state, largest)
        b = rates(state + 0.5 * h * a, largest)
        c = rates(state + 0.5 * h * b, largest)
        d = rates(state + h * c, largest)
        state = state + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        largest = max(largest, state[0])
        out[n + 1] = force(state[0], largest)
    time: Array = np.linspace(0.0, end, steps + 1) * float(units.time)
    return time, out * float(units.force)
