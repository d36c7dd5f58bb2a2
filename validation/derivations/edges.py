"""Response of a thin plate near a straight edge, and the fit of it that the model takes.

``python -m validation.derivations.edges`` writes those of `contactlaw.physical.responses`, in ten
minutes. See edges.md; nothing here comes from contactlaw but the rates that a fit starts from.
Units: the distance from the edge and b = sqrt(D/(rho2 H)) are 1, and so tau = s^2/b is.
"""

from __future__ import annotations

import functools
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.special import ive, kve

import contactlaw
from contactlaw.equation.edge import KINDS

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

DURATIONS = np.geomspace(0.02, 2e3, 40)  # of the forces of the fit, over tau
FILE = Path(contactlaw.__file__).parent / "physical/responses.json"
# Radii of holes, over the distance from their rims; a straight edge has the first.
RADII = (
    math.inf,
    200.0,
    100.0,
    60.0,
    40.0,
    28.0,
    20.0,
    15.0,
    11.0,
    8.0,
    6.3,
    5.0,
    3.9,
    3.0,
    2.5,
    2.0,
    1.6,
    1.3,
    1.0,
    0.8,
    0.6,
    0.4,
    0.25,
    0.15,
)
_TIMES = np.linspace(0.02, 1.0, 50)  # over the duration
_FORCE = np.sin(math.pi * _TIMES) ** 2
RATIOS = 0.0, 0.25, 0.5  # Poisson's ratios of the fit; between them weights are parabolas
_DAMPED = 0.3  # least real part of a complex rate, over its imaginary part
_NODES = np.polynomial.legendre.leggauss(400)


def reflected(p: Complex, kind: str, poisson: float, distance: float = 1.0) -> Complex:
    """Mobility that the edge adds to the plate's own, over that, at Laplace's variable p.

    Integral over the wave number along the edge of what is reflected, section 1 of edges.md.
    """
    p = np.atleast_1d(np.asarray(p, complex))[:, None]
    root = np.sqrt(abs(p))
    x, weight = 0.5 * (_NODES[0] + 1.0), 0.5 * _NODES[1]
    reach = 20.0 * root + 40.0 / max(distance, 1e-9) if distance else 1e4 * root
    inner = root * (1.0 - x**2), 2.0 * root * x
    outer = root + reach * x**3, 3.0 * reach * x**2
    total = sum((_along(xi, p, kind, poisson, distance) * slope * weight).sum(axis=1) for xi, slope in (inner, outer))
    return np.asarray(8.0 / math.pi * p[:, 0] * total)


def _along(xi: Array, p: Complex, kind: str, poisson: float, distance: float) -> Complex:
    """Reflected deflection at one wave number along the edge, of a unit force over D."""
    a, c = np.sqrt(xi**2 + 1j * p), np.sqrt(xi**2 - 1j * p)
    came_a = -np.exp(-a * distance) / (4j * p * a)
    came_c = np.exp(-c * distance) / (4j * p * c)
    if kind == "free":  # no moment and no shear force, Kirchhoff's
        rows = [(m**2 - poisson * xi**2, m**3 - (2.0 - poisson) * xi**2 * m) for m in (a, c)]
    elif kind == "clamped":
        rows = [(np.ones_like(m), m) for m in (a, c)]
    else:
        rows = [(np.ones_like(m), m**3) for m in (a, c)]
    (even_a, odd_a), (even_c, odd_c) = rows
    if kind == "supported":  # the deflection and the moment vanish: the image of opposite sign
        sent_a, sent_c = -came_a, -came_c
    else:
        even, odd = -(even_a * came_a + even_c * came_c), odd_a * came_a + odd_c * came_c
        per = 1.0 / (even_a * odd_c - even_c * odd_a)
        sent_a, sent_c = per * (even * odd_c - even_c * odd), per * (even_a * odd - even * odd_a)
    return np.asarray(sent_a * np.exp(-a * distance) + sent_c * np.exp(-c * distance))


def around_hole(p: Complex, poisson: float, radius: float) -> Complex:
    """Mobility that the rim of a hole adds, as `reflected`; the radius is over the distance.

    Sum over the waves around the hole, section 4 of edges.md. Bessel's functions enter as ratios of
    neighbours, because they themselves leave the range of floating point.
    """
    p = np.atleast_1d(np.asarray(p, complex))
    far, orders = radius + 1.0, int(min(700.0, 30.0 + 12.0 * radius))
    parts: list[Any] = []
    for sign in (1.0, -1.0):
        root = np.sqrt(sign * 1j * p)
        at, source = root * radius, root * far
        inner, ratio = np.empty((orders + 1, p.size), complex), np.zeros(p.size, complex)
        for n in range(orders + 60, -1, -1):  # of I(n + 1) over I(n), by its continued fraction
            ratio = 1.0 / (2.0 * (n + 1) / at + ratio)
            if n <= orders:
                inner[n] = ratio
        outgoing = kve(0, source) / kve(0, at) * np.exp(at - source)
        came = ive(0, at) * kve(0, source) * np.exp(abs(at.real) - source)
        ratios = kve(1, at) / kve(0, at), kve(1, source) / kve(0, source)
        parts.append([root, at, source, inner, outgoing, came * -sign / (4j * math.pi * p), *ratios])
    total = np.zeros(p.size, complex)
    for n in range(orders + 1):
        rows = []
        for root, at, _, inner, outgoing, came, ratio, _ in parts:
            slopes = root * (n / at - ratio), root * (n / at + inner[n])
            bent = (1.0 - poisson) * (n / radius) ** 2
            moments = [root**2 - (1.0 - poisson) * d / radius + bent for d in slopes]
            shears = [root**2 * d - bent * (d - 1.0 / radius) for d in slopes]
            rows.append((moments[0], shears[0], came * moments[1], came * shears[1], outgoing))
        (m, v, moment, shear, out), (m2, v2, moment2, shear2, out2) = rows
        moment, shear = -(moment + moment2), -(shear + shear2)
        sent = (moment * v2 - m2 * shear) * out + (m * shear - v * moment) * out2
        total += (2.0 if n else 1.0) * sent / (m * v2 - m2 * v)
        for part in parts:
            _, at, source, inner, outgoing, came, ratio, other = part
            part[4], part[5] = outgoing * other / ratio, came * inner[n] * other
            part[6], part[7] = (1.0 / r + 2.0 * (n + 1) / x for r, x in ((ratio, at), (other, source)))
    return np.asarray(8.0 * p * total)


@functools.cache
def at_the_edge(kind: str, poisson: float) -> float:
    """Say what the edge adds in the limit of long forces, and so of a force at the edge itself."""
    if kind != "free":
        return -1.0
    # the rest falls as the root of p
    near, far = reflected(np.array([1e-8, 4e-8]), kind, poisson).real
    return float(2.0 * near - far)


@functools.cache
def speeds(kind: str, poisson: float, radius: float = math.inf) -> Array:
    """Speed that the edge adds, over the plate's mobility, during forces sin^2; (durations, times).

    Laplace's transform is inverted along a line to the right of all that is singular.
    """
    rows = []
    for duration in DURATIONS:
        shift, step = 2.0 / duration, math.pi / (4.0 * duration)
        p = shift + 1j * step * np.arange(700)
        omega = 2.0 * math.pi / duration
        force = 0.5 * (1.0 - np.exp(-p * duration)) * (1.0 / p - p / (p * p + omega**2))
        straight = math.isinf(radius)
        added = reflected(p, kind, poisson) if straight else around_hole(p, poisson, radius)
        both = force * added
        both[0] *= 0.5
        t = _TIMES * duration
        rows.append(np.exp(shift * t) * step / math.pi * (np.exp(np.outer(t, 1j * p.imag)) @ both))
    return np.real(rows)


def answers(rate: complex) -> Complex:
    """Solutions of z' = rate (f - z) during the forces; (durations, times)."""
    t = np.outer(DURATIONS, _TIMES)
    omega = 2.0 * math.pi / DURATIONS[:, None]
    gone = np.exp(-rate * t)
    wave = rate * (rate * np.cos(omega * t) + omega * np.sin(omega * t) - rate * gone)
    return np.asarray(0.5 * (1.0 - gone) - 0.5 * wave / (rate**2 + omega**2))


def columns(rates: list[complex]) -> Array:
    """Columns that the weights multiply: one of a real rate, two of a complex one."""
    found = []
    for rate in rates:
        z = answers(rate)
        found += [z.real, z.imag] if rate.imag else [z.real]
    return np.array(found)


def work(added: Array) -> Array:
    """Work of the forces on the plate, over that of a plate without edges, less one."""
    return np.asarray((added * _FORCE).sum(axis=-1) / (_FORCE**2).sum())


def rates_of(blocks: Any) -> list[complex]:
    """Rates of blocks (p, p', 0) or (p, p, p'): real ones, or complex ones p + i p'."""
    found = []
    for first, second, turn in blocks:
        found += [complex(first, turn)] if turn else [complex(first), complex(second)]
    return found


def weights(rates: list[complex], kind: str, poisson: float, radius: float) -> tuple[Array, Array]:
    """Weights by least squares, and the errors: of the work, of the speed with half that weight.

    For a straight edge the limit of long forces is a condition, too. All are relative to the work.
    """
    exact = speeds(kind, poisson, radius)
    per = 1.0 / np.maximum(1.0 + work(exact), 0.3)

    def errors(values: Array, end: float) -> Array:
        speed = 0.5 / math.sqrt(_TIMES.size) * per[:, None] * values
        last = 2.0 * end / max(1.0 + limit, 0.3) if math.isinf(radius) else 0.0
        return np.concatenate([speed.ravel(), per * work(values), [last]])

    limit = at_the_edge(kind, poisson) if math.isinf(radius) else 0.0
    steady = np.concatenate([[1.0, 0.0] if rate.imag else [1.0] for rate in rates])
    basis = columns(rates)
    matrix = np.array([errors(one, end) for one, end in zip(basis, steady, strict=True)]).T
    wanted = errors(exact, limit)
    # a little less than the best, for smaller weights
    damped = np.vstack([matrix, 1e-5 * np.eye(steady.size) * np.linalg.norm(matrix) ** 0.5])
    found = np.linalg.lstsq(damped, np.append(wanted, np.zeros(steady.size)), rcond=None)[0]
    return found, matrix @ found - wanted


def fitted_rates(kind: str, rates: list[complex]) -> list[complex]:
    """Rates of a straight edge by least squares of the errors; of a free one at all ratios."""
    turns = [bool(rate.imag) for rate in rates]
    ratios = RATIOS if kind == "free" else RATIOS[:1]

    def unpacked(logs: Array) -> list[complex]:
        values = iter(np.exp(logs).tolist())
        return [complex(next(values), next(values) if turn else 0.0) for turn in turns]

    def errors(logs: Array) -> Array:
        now = unpacked(logs)
        return np.concatenate([weights(now, kind, nu, math.inf)[1] for nu in ratios])

    start, least = [], []
    for rate in rates:
        start += [rate.real, rate.imag] if rate.imag else [rate.real]
        # What would ring on for ever is made to decay, because explicit steps blow it up.
        least += [_DAMPED * rate.imag, 0.0] if rate.imag else [0.0]
    with np.errstate(divide="ignore"):
        lowest = np.log(least)
    logs = np.maximum(np.log(start), lowest + 1e-3)
    return unpacked(least_squares(errors, logs, bounds=(lowest, math.inf), max_nfev=60).x)


def _blocks(rates: list[complex]) -> list[list[float]]:
    """Blocks of rates, as `rates_of` takes them."""
    real = [rate.real for rate in rates if not rate.imag]
    found = [[one, two, 0.0] for one, two in zip(real[::2], real[1::2], strict=True)]
    found += [[rate.real, rate.real, rate.imag] for rate in rates if rate.imag]
    return [[float(f"{one:.6g}") for one in row] for row in found]


def numbers(kind: str, blocks: Any) -> dict[str, Any]:
    """Rates of a straight edge, and weights at all radii and as polynomials of Poisson's ratio."""
    radii: tuple[float, ...] = RADII if kind == "free" else RADII[:1]
    rates = fitted_rates(kind, rates_of(blocks))
    ratios = RATIOS if kind == "free" else RATIOS[:1]
    powers = np.vander(ratios, increasing=True)
    each = [np.linalg.solve(powers, [weights(rates, kind, nu, radius)[0] for nu in ratios]).T for radius in radii]
    return {"rates": _blocks(rates), "weights": np.round(each, 5).tolist()}


def main() -> None:
    """Write the numbers, beginning with the rates that the file has."""
    known = json.loads(FILE.read_text())
    for kind in KINDS:
        of_one = known["responses"][kind]
        of_one["equation"] = numbers(kind, of_one["equation"]["rates"])
        print(kind, of_one["equation"]["rates"], flush=True)
    known["shares"] = [round(1.0 / (1.0 + radius), 6) for radius in RADII] + [1.0]
    FILE.write_text(json.dumps(known, indent=None, separators=(",", ":")).replace("},", "},\n"))


if __name__ == "__main__":
    main()
