"""Response of plates on a foundation and of shells, and the fit of it that the model takes.

``python -m validation.derivations.walls`` writes those of `contactlaw.physical.responses`, in some
minutes. Unit of time: 1/w0. docs/walls.md has the equations.
"""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.special import j0

from validation.derivations.edges import FILE, rates_of

Array = NDArray[np.float64]

# Of the fits; `contactlaw.physical.plates` refuses contacts that are longer, and time steps flag them.
REACH = {"equation": 60.0, "steps": 10.0}
_DIRECTIONS = (np.arange(600) + 0.5) * math.pi / 1200.0
# Complex rates, and real ones: across a cylinder some waves meet next to no stiffness.
SIZES = {"sphere": {"equation": (6, 0), "steps": (3, 0)}, "cylinder": {"equation": (5, 2), "steps": (2, 2)}}


def kernel(kind: str, x: Any) -> Array:
    """Displacement at the times x after a unit impulse, over the plate's mobility."""
    if kind == "sphere":
        return np.asarray(j0(x))
    return np.asarray(j0(np.multiply.outer(x, np.cos(_DIRECTIONS) ** 2)).mean(axis=-1))


def restitution(lam: float, swing: float, kind: str, steps: int = 1500) -> float:
    """COR of an elastic impact by `convolved`; `swing` is w0 T_H."""
    step = 3.2181 / steps
    return convolved(lam, kernel(kind, swing * step * np.arange(10 * steps)), step)


def convolved(lam: float, back: Array, step: float) -> float:
    """COR of an elastic impact by a convolution in time with samples of a kernel, without any fit.

    In units of T_H: x'' = -f, f = d^1.5, d = x - lam times the integral of f(t') K(t - t').
    """
    f, u, x = np.zeros(back.size), 1.0, 0.0
    for n in range(1, back.size):
        x += u * step - 0.5 * step * step * f[n - 1]
        known, now = x - lam * step * float(f[1:n] @ back[n - 1 : 0 : -1]), f[n - 1]
        for _ in range(40):
            now = max(known - 0.5 * lam * step * now, 0.0) ** 1.5
        f[n] = now
        u -= 0.5 * step * (f[n] + f[n - 1])
        if now == 0.0 and n > 10:
            return float(-u)
    raise RuntimeError(f"the sphere stays at lambda = {lam}")


def columns(rates: list[complex], x: Array) -> Array:
    """Columns that the weights multiply: one of a real rate, two of a complex one."""
    found = []
    for rate in rates:
        gone = 1.0 - np.exp(-rate * x)
        found += [gone.real, gone.imag] if rate.imag else [gone.real]
    return np.array(found).T


def fitted(kind: str, size: str) -> tuple[list[complex], Array, float]:
    """Rates, weights, and the largest error of the kernel, by least squares at even times.

    Those of time steps, in which a bead may rest, end where the kernel ends, at 0.
    """
    x, (turning, real) = np.linspace(0.0, REACH[size], 1500), SIZES[kind][size]
    wanted = kernel(kind, x) - 1.0
    rests = 1.0 if size == "steps" else 0.0

    def unpacked(logs: Array) -> list[complex]:
        values = np.exp(logs)
        both = zip(values[:turning], values[turning : 2 * turning], strict=True)
        return [complex(*one) for one in both] + [complex(one) for one in values[2 * turning :]]

    def solved(logs: Array) -> tuple[Array, Array]:
        matrix = columns(unpacked(logs), x)
        ridge, ends = 1e-9 * np.eye(matrix.shape[1]), columns(unpacked(logs), np.array([1e9]))
        right = np.concatenate([wanted, [-rests], np.zeros(matrix.shape[1])])
        weights = np.asarray(np.linalg.lstsq(np.vstack([matrix, rests * ends, ridge]), right, rcond=None)[0], float)
        return weights, np.asarray(matrix @ weights - wanted)

    angle = np.linspace(0.06, 1.2 if rests else 1.45, turning)
    start = np.concatenate([0.005 + 0.9 * np.sin(angle) ** 2, np.cos(angle), np.geomspace(0.05, 0.5, real)])
    found = least_squares(lambda logs: solved(logs)[1], np.log(start), max_nfev=300, bounds=(-7.0, 3.0))
    weights, errors = solved(found.x)
    return unpacked(found.x), weights, float(abs(errors).max())


def main() -> None:
    """Write the numbers."""
    known = json.loads(FILE.read_text())
    for kind, size in ((kind, size) for kind, sizes in SIZES.items() for size in sizes):
        rates, weights, error = fitted(kind, size)
        real = [rate.real for rate in rates if not rate.imag]
        blocks = [[one.real, one.real, one.imag] for one in rates if one.imag] + ([[*real, 0.0]] if real else [])
        assert len(rates_of(blocks)) == len(rates)
        of_one = {"rates": blocks, "weights": [[[one] for one in weights.tolist()]]}
        known["responses"].setdefault(kind, {})[size] = of_one
        print(f"{kind}, {size}: largest error {error:.1e}", flush=True)
    FILE.write_text(json.dumps(known, indent=None, separators=(",", ":")).replace("},", "},\n"))


if __name__ == "__main__":
    main()
