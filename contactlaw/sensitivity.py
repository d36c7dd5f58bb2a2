"""How much the COR moves with each input: elasticities, from the table's own derivatives.

The COR is a function of lambda and y = d_Y/(V0 T_H) alone, and both are products of powers of the
inputs. With w = E*/E1' for the sphere and E*/E2' for the plate (they sum to 1) the powers are

                V0    R    H    rho1   rho2    E1       E2             sigma_Y
    lambda     0.2    2   -2    0.6   -0.5    0.4 w    0.4 w - 0.5     0
    y         -0.8    0    0   -0.4    0     -1.6 w   -1.6 w           2

so d ln e/d ln x is a sum of two terms, power by derivative.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from contactlaw import lookup
from contactlaw.arguments import shaped
from contactlaw.pair import Pair

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sensitivity:
    """Elasticities d ln(COR)/d ln(input): by how many per cent the COR rises with one per cent.

    Each field is a float, or an array of one shape.

    Attributes
    ----------
    speed, radius, thickness
        Of the impact, the sphere, the plate.
    sphere_density, plate_density
        Mass densities.
    sphere_modulus, plate_modulus
        Young's moduli, at fixed Poisson's ratios.
    yield_strength
        Of the sphere.
    """

    speed: float | Array
    radius: float | Array
    thickness: float | Array
    sphere_density: float | Array
    plate_density: float | Array
    sphere_modulus: float | Array
    plate_modulus: float | Array
    yield_strength: float | Array


def gradient(table: Array, lam: Array, y: Array) -> tuple[Array, Array]:
    """Differentiate the COR of a packed table with respect to ln(lambda) and ln(y).

    Inside the table only. On a kink, the derivative is that of the side with the smaller overload.
    """
    stretch, x_max = table[lookup.STRETCH], table[lookup.X_MAX]
    x = lam / (lam + stretch)
    series = table[lookup.HEADER : lookup.HEADER + lookup.DEGREE + 1]
    t = 2.0 * x / x_max - 1.0
    log_chi = polynomial.polyval(t, series) - np.log(y)
    slope = polynomial.polyval(t, polynomial.polyder(series)) * 2.0 / x_max

    blocks = table[lookup.HEADER + lookup.DEGREE + 1 :][
        : lookup.BLOCK * int(table[lookup.SEGMENTS])
    ].reshape(-1, lookup.BLOCK)
    block = blocks[np.maximum(np.searchsorted(blocks[:, lookup.START], log_chi) - 1, 0)]
    per_log = block[:, lookup.PER_LOG]
    across = x * table[lookup.NODES_PER_X]
    along = np.maximum(log_chi - block[:, lookup.START], 0.0) * per_log
    row, cell = across.astype(int), along.astype(int)
    steps = np.arange(4)
    first = int(table[lookup.COR_AT]) + block[:, lookup.COLUMN].astype(int) + cell
    rows = (row[:, None] + steps) * int(table[lookup.COLUMNS])
    c = table[first[:, None, None] + rows[:, :, None] + steps]  # (n, 4, 4)

    (a, da), (b, db) = _weights(across - row), _weights(along - cell)
    by_x = np.einsum("nij,ni,nj->n", c, da, b) * table[lookup.NODES_PER_X]
    by_log_chi = np.einsum("nij,ni,nj->n", c, a, db) * per_log
    by_log_chi[log_chi <= 0.0] = 0.0  # elastic: the overload does not matter
    return (by_x + by_log_chi * slope) * x * (1.0 - x), -by_log_chi


def _weights(t: Array) -> tuple[Array, Array]:
    """Uniform cubic B-splines (n, 4) at t in [0, 1], and their derivatives."""
    s = 1.0 - t
    values = (s**3, (3.0 * t - 6.0) * t**2 + 4.0, (3.0 * s - 6.0) * s**2 + 4.0, t**3)
    slopes = (-3.0 * s**2, (9.0 * t - 12.0) * t, (12.0 - 9.0 * s) * s, 3.0 * t**2)
    return np.stack(values, axis=-1) / 6.0, np.stack(slopes, axis=-1) / 6.0


def elasticities(
    pair: Pair, cor: Array, by_lam: Array, by_y: Array, shape: tuple[int, ...] | None
) -> Sensitivity:
    """Chain the derivatives of the COR with the powers of the inputs."""
    sphere = pair.effective_modulus / pair.sphere.plane_modulus
    plate = 1.0 - sphere
    powers = {
        "speed": (0.2, -0.8),
        "radius": (2.0, 0.0),
        "thickness": (-2.0, 0.0),
        "sphere_density": (0.6, -0.4),
        "plate_density": (-0.5, 0.0),
        "sphere_modulus": (0.4 * sphere, -1.6 * sphere),
        "plate_modulus": (0.4 * plate - 0.5, -1.6 * plate),
        "yield_strength": (0.0, 2.0),
    }
    return Sensitivity(
        **{name: shaped((a * by_lam + b * by_y) / cor, shape) for name, (a, b) in powers.items()}
    )
