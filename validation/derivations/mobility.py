"""Energy that a Hertz pulse leaves in an elastic plate, and the fit of it that the model takes.

``python -m validation.derivations.mobility`` prints the numbers of
`contactlaw.equation.corrections`, in two minutes. See mobility.md; nothing here comes from
contactlaw. Units: thickness, density and shear modulus of the plate are 1, so the frequency is
omega H/c.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog
from scipy.special import beta, betainc

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

MEAN = 2.7134  # mean of omega T_d over the energy spectrum of a Hertz pulse
SQUARE = 1.44 * beta(0.8, 1.5) / beta(1.6, 0.5) * beta(0.4, 0.5) ** 2  # mean of (omega T_d)^2
CENTRE = 1.07  # the coefficients of P are polynomials in 1/h_c - CENTRE
_RATIOS = np.linspace(0.0, 0.45, 10)  # Poisson's ratios of the fit
_DEGREES = 4, 4  # degree in 1/h_c - CENTRE; number of free coefficients of P, those from x^2 on
_USUAL = (0.14, 0.41)  # Poisson's ratios between which Phi is fitted to `norm`, with more weight
_WORST = 0.012  # largest relative error of Phi


def kirchhoff(poisson: float) -> float:
    """Mobility of a thin plate, in the units of this module."""
    return math.sqrt(6.0 * (1.0 - poisson)) / 8.0


def ratio(poisson: float) -> float:
    """Square of the shear wave's speed over the compression wave's."""
    return (1.0 - 2.0 * poisson) / (2.0 * (1.0 - poisson))


def panels(edges: Array) -> tuple[Array, Array]:
    """Nodes and weights of Gauss' rule on each panel between some edges."""
    nodes, weights = np.polynomial.legendre.leggauss(16)
    half = np.diff(edges)[:, None] / 2.0
    return (edges[:-1, None] + half * (1.0 + nodes)).ravel(), (half * weights).ravel()


def elastic(k: Complex, omega: complex, poisson: float, thickness: float) -> tuple[Complex, ...]:
    """Antisymmetric and symmetric displacement of the loaded face of an elastic plate.

    The Rayleigh function is multiplied out and the difference of two tanh is one, so that static
    response and large wave numbers lose no digits.
    """
    y, x, r = complex(omega) ** 2, k * k, ratio(poisson)
    a, b = np.sqrt(x - r * y), np.sqrt(x - y)
    square = (2.0 * x - y) ** 2
    cubic = 16.0 * (1.0 - r) * x**3 - (24.0 - 16.0 * r) * x**2 * y + 8.0 * x * y**2 - y**3
    rayleigh = y * cubic / (4.0 * x * a * b + square)
    ta, tb = np.tanh(a * thickness / 2.0), np.tanh(b * thickness / 2.0)
    gap = np.tanh((r - 1.0) * y / (a + b) * thickness / 2.0) * (1.0 - ta * tb)  # tb - ta
    return (0.5 * a * y / (rayleigh * tb + square * gap), 0.5 * a * y * ta * tb / (rayleigh * ta - square * gap))


def regular(omega: complex, poisson: float, thickness: float) -> complex:
    """Mobility less that of the static half-space, i omega times a constant."""
    scale = max(abs(omega), math.sqrt(abs(omega) / thickness))
    u, weight = panels(np.linspace(0.0, 1.0, 41))
    k = (scale * u / (1.0 - u)).astype(complex)
    both = np.sum(elastic(k, omega, poisson, thickness), axis=0) - (1.0 - poisson) / k
    return complex(1j * omega / (2.0 * math.pi) * np.sum(weight * scale / (1.0 - u) ** 2 * k * both))


def half_space(poisson: float) -> float:
    """C in Re Y = C omega^2; on the imaginary axis of frequency nothing oscillates."""
    return abs(regular(-1j, poisson, 1e3))


def energy(h: float, poisson: float) -> float:
    """Energy a Hertz pulse leaves in the plate over Kirchhoff's, below the poles of frequency."""
    p, weight = panels(np.linspace(0.0, 1.0, 13))
    angle = math.pi / 2.0 * p**1.25
    weight *= 0.625 * math.pi * p**0.25 / np.sin(angle) ** 0.2 / beta(0.4, 0.5)
    force, time = np.sin(angle) ** 1.2, 0.5 * betainc(0.4, 0.5, np.sin(angle) ** 2)
    t, step = panels(150.0 * np.linspace(0.0, 1.0, 25) ** 1.5)
    total = 0.0
    for omega, part in zip(t - 1j, step, strict=True):
        spectrum = 2.0 * np.sum(weight * force * np.cos(omega * (time - 0.5)))
        total += part * (regular(omega, poisson, h) * spectrum**2).real
    return float(total * h**2 / kirchhoff(poisson) / math.pi / (2.0 * np.sum(weight * force**2)))


def echo(poisson: float) -> float:
    """Find h_c, the thickness from which no echo returns within the contact."""
    return 0.5 / math.sqrt(ratio(poisson))


def bulk(poisson: float) -> float:
    """Fit k2, of the half-space."""
    d = poisson - 0.3
    return 6.0994 - 4.8895 * d + 6.5469 * d**2 + 7.4075 * d**3


def slope(poisson: float) -> float:
    """First coefficient of P, which makes Phi begin as 1 + k1 h."""
    return 3.0 + 8.0 * kirchhoff(poisson) / 5.0 * MEAN * echo(poisson)


def norm(x: Array, poisson: float) -> Array:
    """Phi with P fitted to the n-norm for one Poisson's ratio, at x = h/h_c."""
    h_c, d = echo(poisson), poisson - 0.3
    k2, k1 = 6.1035 - 4.848 * d + 5.63 * d**2, (slope(poisson) - 3.0) / h_c
    nodes = np.linspace(0.0, 1.0, 65)[1:-1]
    h, n = nodes * h_c, 6.0 / h_c**1.2
    found = ((1.0 + k1 * h + 0.95 * h**2) ** n + (k2 * h**2) ** n) ** (1.0 / n)
    fall = (1.0 - nodes) ** 3
    rest = found - k2 * h**2 - fall * (1.0 + slope(poisson) * nodes)
    powers = (fall * nodes ** np.arange(2, 6)[:, None] / found).T
    others = np.linalg.lstsq(powers, rest / found, rcond=None)[0]
    p = np.polynomial.polynomial.polyval(x, [1.0, slope(poisson), *others])
    return np.asarray(k2 * (x * h_c) ** 2 + (1.0 - x) ** 3 * p)


def coefficients() -> Array:
    """Fit the coefficients of P from x^2 on, each a polynomial in 1/h_c - `CENTRE`.

    They minimise the sum over Poisson's ratios of the largest relative error of Phi, against the
    exact one, but within `_USUAL` against `norm`, by which the law was fitted to impacts. Phi/h^2
    must not rise, as lambda is not larger on a thicker plate: with N = (1 - x)^3 P this is
    2 N - x N' >= 0, which keeps N above 0, too.
    """
    x, (powers, free) = np.linspace(0.04, 0.96, 24), _DEGREES
    count = (powers + 1) * free
    weights = [0.0] * count
    rows: list[Array] = []
    right: list[Array] = []
    for n, poisson in enumerate(_RATIOS):
        h = x * echo(poisson)
        usual = _USUAL[0] < poisson < _USUAL[1]
        exact = norm(x, poisson) if usual else np.array([energy(one, poisson) for one in h])
        fall, first = (1.0 - x) ** 3, slope(poisson)
        weights.append(5.0 if usual else 1.0)
        left = 1.0 - (bulk(poisson) * h**2 + fall * (1.0 + first * x)) / exact
        basis = _row(poisson, fall / exact * x ** np.arange(2, 2 + free)[:, None])
        errors = np.zeros((x.size, _RATIOS.size))
        errors[:, n] = -1.0
        rows += [np.hstack([basis, errors]), np.hstack([-basis, errors])]
        right += [left, -left]
    places = np.linspace(0.0, 1.0, 101)
    for poisson in np.linspace(0.0, 0.45, 46):
        falls = [3.0 * places ** (j + 1) + (1.0 - places) * (2 - j) * places**j for j in range(2 + free)]
        basis = _row(poisson, np.array(falls[2:]))
        rows.append(np.hstack([-basis, np.zeros((places.size, _RATIOS.size))]))
        right.append(falls[0] + slope(poisson) * falls[1] - 0.01)
    found = linprog(
        weights,
        np.vstack(rows),
        np.concatenate(right),
        bounds=[(None, None)] * count + [(0.0, _WORST)] * _RATIOS.size,
        method="highs",
    )
    return np.asarray(found.x[:count]).reshape(free, powers + 1)


def _row(poisson: float, basis: Array) -> Array:
    """Columns for each power of x and of 1/h_c - CENTRE."""
    powers = (1.0 / echo(poisson) - CENTRE) ** np.arange(_DEGREES[0] + 1)
    row: Array = np.einsum("jn,k->njk", basis, powers).reshape(basis.shape[1], -1)
    return row


if __name__ == "__main__":
    for row in coefficients().round(3).tolist():
        print(row)
