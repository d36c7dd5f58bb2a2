"""Tangential motion of a contact against 400 springs of scipy, closed forms and limits."""

import math

import numpy as np
import pytest
from lasting import long
from oracle import contact
from overloads import solved_at

from contactlaw import laws
from contactlaw.table.slides import after

MYC = laws.law("myc")
PSI = np.array([0.0, 0.02, 0.1, 0.3, 0.7, 1.0, 1.5, 2.2, 3.0, 4.0, 5.0, 6.0, 7.0, 9.0, 12.0])
SPRINGS, STEPS = 400, 8000


def slide(lam, y, kappa, psi):
    """Speeds of contact points after impacts that came with psi, in mu V0; the law MYC by scipy.

    This shares no code with contactlaw. Springs stand at places x across the contact, in units of its
    incremental stiffness k = dF/dd of unloading, each held to its own share of the normal force,
    1 - (x/k)^2 of Hertz's pressure. While a contact flows the stretch s of a spring relaxes as
    ds/s = -1.5 (1 - y/d) dd/d.
    """
    end, _, at = contact(lam, y)
    dt = end / STEPS
    path, kept, top = [], [], 0.0
    for n in range(1, STEPS + 1):
        f, d = at(n * dt)
        kept.append(1 - 1.5 * (1 - y / d) * (d - top) / d if d > top > y else 1.0)
        top = max(top, d)
        left = top - y * math.sqrt(2 * top / y - 1) if top > y else 0.0
        path.append((f, 1.5 * f / (d - left) if d > left else 0.0))
    width = max(k for _, k in path) / SPRINGS
    place = (np.arange(SPRINGS) + 0.5) * width
    v = np.array(psi, dtype=float)
    stretch, pull = np.zeros((SPRINGS, v.size)), np.zeros(v.size)
    for (f, k), share in zip(path, kept, strict=True):
        stretch *= share
        half = v - 0.5 * dt * 3.5 * pull  # 3.5: a solid sphere
        parts = np.maximum(1 - (place / k) ** 2, 0) if k > 0 else np.zeros(SPRINGS)
        limit = f * parts / parts.sum() if parts.any() else parts
        most = limit[:, None] / (kappa * width)
        stretch = np.clip(stretch + dt * half, -most, most)
        pull = kappa * width * stretch.sum(axis=0)
        v = half - 0.5 * dt * 3.5 * pull
    return v


def solved(lam, chi, law=MYC):
    """Outcome of one impact, and its yield ratio."""
    return solved_at(law, np.array([lam]), np.array([chi]), 1e-11)


@pytest.mark.parametrize("kappa", [0.8, *(long(kappa) for kappa in (0.6, 1.0))])
@pytest.mark.parametrize(("lam", "chi"), [(0.0, 0.9), (0.3, 3.0), (1.0, 12.0), (2.0, 40.0)])
def test_springs_of_scipy(lam, chi, kappa):
    found = solved(lam, chi)
    ours = after(MYC.data, found, kappa, PSI[None])[0]
    y = found.yield_ratio[0]
    assert np.abs(ours - slide(lam, y, kappa, PSI)).max() < 1e-3


def test_full_sliding_takes_the_whole_impulse():
    for lam, chi in ((0.0, 0.9), (0.5, 5.0), (2.0, 30.0)):
        found = solved(lam, chi)
        for samples, springs in ((11, 2), (801, 64)):
            speed = after(MYC.data, found, 0.8, np.array([[20.0, -20.0]]), samples, springs)[0]
            left = 20.0 - 3.5 * (1.0 + found.restitution[0])
            assert speed == pytest.approx([left, -left], abs=1e-9)


@pytest.mark.parametrize(("kappa", "beta"), [(2 / 3, 0.11), (0.83, -0.24), (1.0, -0.39)])
def test_a_contact_that_sticks(kappa, beta):
    # the limit of small psi, found by another program and given with two digits
    speed = after(MYC.data, solved(0.0, 0.9), kappa, np.array([[1e-4]]))[0, 0]
    assert -speed / 1e-4 == pytest.approx(beta, abs=0.01)


def test_no_impact_makes_energy():
    generator = np.random.default_rng(0)
    worst = -math.inf
    for _ in range(200):
        lam, chi = generator.uniform(0, 1.5) ** 2, np.exp(generator.uniform(-1, 3.6))
        psi = generator.uniform(-12, 12, 500)
        kappa = generator.uniform(0.66, 1.34)
        speed = after(MYC.data, solved(lam, chi), kappa, psi[None], 101, 8)[0]
        worst = max(worst, (np.abs(speed) - np.abs(psi)).max())
    assert worst < 1e-12
