"""Oblique impacts by 400 springs, which share no code with contactlaw.

Springs at fixed places x across the contact, in units of its incremental stiffness k = dF/dd of
unloading, each held to its own share of the normal force, 1 - (x/k)^2 of Hertz's pressure. While a
contact flows the stretch s of a spring relaxes as ds/s = -1.5 (1 - y/d) dd/d.
"""

import math

import numpy as np
from oracle import contact

SPRINGS, STEPS = 400, 8000


def slide(lam, y, kappa, psi):
    """Speeds of contact points after impacts that came with psi, in mu V0; the MYC law by scipy."""
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
