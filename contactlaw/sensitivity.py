"""How much the COR moves with each input: elasticities d ln e/d ln x.

The COR is a function of lambda and y = d_Y/(V0 T_H), and with some laws of r = E*/sigma_Y too. All
are products of powers of the inputs. With w = E*/E1' for the sphere and E*/E2' for the plate (they
sum to 1) the powers are

                V0    R    H    rho1   rho2    E1       E2             sigma_Y
    lambda     0.2    2   -2    0.6   -0.5    0.4 w    0.4 w - 0.5     0
    y         -0.8    0    0   -0.4    0     -1.6 w   -1.6 w           2
    r          0      0    0    0      0      w        w              -1

so d ln e/d ln x is a sum of terms, power by derivative. The derivatives are the table's own where
the table follows the COR everywhere; next to the corners of some laws' loading curves no spline
does, and there, and for r, they are central differences of the solver.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from contactlaw import laws, lookup
from contactlaw.arguments import shaped
from contactlaw.evaluation import solved
from contactlaw.impact import Scales
from contactlaw.laws import Law
from contactlaw.pair import Pair
from contactlaw.table import Table

Array = NDArray[np.float64]

# Of a central difference of ln e: the step errs by 2e-9 times the third derivative, up to 3e4 next
# to a corner; the solver, good to 1e-12 of ln e (1e-11 with Stronge's unloading), by 1e-8 to 1e-7.
_STEP = 1e-4
_RTOL = 1e-13


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


def follows(table: Table) -> bool:
    """Whether a table keeps its promise for the COR, so that its derivatives are the COR's."""
    return table.certificate is not None and "restitution" not in table.certificate.exceeded


def by_table(table: Array, fields: Array) -> tuple[Array, Array]:
    """Differentiate ln e with respect to ln(lambda) and ln(y), from a packed table.

    On a kink, the derivatives are those of the side with the smaller overload.

    Parameters
    ----------
    table : ndarray
        `Table.packed`.
    fields : ndarray
        (7, n), as `evaluation.tabulated` gives them inside the table.
    """
    lam, y = fields[5:]
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
    return (by_x + by_log_chi * slope) * x * (1.0 - x) / fields[0], -by_log_chi / fields[0]


def _weights(t: Array) -> tuple[Array, Array]:
    """Uniform cubic B-splines (n, 4) at t in [0, 1], and their derivatives."""
    s = 1.0 - t
    values = (s**3, (3.0 * t - 6.0) * t**2 + 4.0, (3.0 * s - 6.0) * s**2 + 4.0, t**3)
    slopes = (-3.0 * s**2, (9.0 * t - 12.0) * t, (12.0 - 9.0 * s) * s, 3.0 * t**2)
    return np.stack(values, axis=-1) / 6.0, np.stack(slopes, axis=-1) / 6.0


def by_solver(law: Law, units: Scales, fields: Array) -> tuple[Array, Array]:
    """Differentiate ln e with respect to ln(lambda) and ln(y), by integration.

    Nearer to a kink than the step, the derivatives are means of those on its two sides.
    """

    def log_cor(lam_step: float, y_step: float) -> Array:
        lam = units.inelasticity * math.exp(lam_step)
        y = units.yield_ratio * math.exp(y_step)
        moved = units._replace(inelasticity=lam, yield_ratio=y)
        return np.asarray(np.log(solved(law, moved, _RTOL)[0]))

    by_lam = (log_cor(_STEP, 0.0) - log_cor(-_STEP, 0.0)) / (2.0 * _STEP)
    by_y = (log_cor(0.0, _STEP) - log_cor(0.0, -_STEP)) / (2.0 * _STEP)
    return by_lam, np.where(_yields(fields), by_y, 0.0)


def by_modulus_ratio(pair: Pair, law: str, units: Scales, fields: Array) -> Array:
    """Differentiate ln e with respect to ln(E*/sigma_Y), if the law takes that from the pair."""
    if "modulus_ratio" not in laws.parameters(law):
        return np.zeros_like(fields[0])
    ratio = pair.effective_modulus / pair.sphere.require_yield_strength(law)
    # laws take six digits
    low, high = (float(f"{ratio * math.exp(step):.6g}") for step in (-_STEP, _STEP))
    below, above = (
        solved(
            laws.law(law, modulus_ratio=value, poissons_ratio=pair.sphere.poissons_ratio),
            units,
            _RTOL,
        )[0]
        for value in (low, high)
    )
    return np.where(_yields(fields), np.log(above / below) / math.log(high / low), 0.0)


def _yields(fields: Array) -> NDArray[np.bool_]:
    """Whether the elastic compression w_m is above y: elsewhere yield does not matter."""
    return np.asarray(fields[4] > fields[6])


def elasticities(
    pair: Pair, by_lam: Array, by_y: Array, by_ratio: Array, shape: tuple[int, ...] | None
) -> Sensitivity:
    """Chain the derivatives of ln e with the powers of the inputs."""
    sphere = pair.effective_modulus / pair.sphere.plane_modulus
    plate = 1.0 - sphere
    powers = {
        "speed": (0.2, -0.8, 0.0),
        "radius": (2.0, 0.0, 0.0),
        "thickness": (-2.0, 0.0, 0.0),
        "sphere_density": (0.6, -0.4, 0.0),
        "plate_density": (-0.5, 0.0, 0.0),
        "sphere_modulus": (0.4 * sphere, -1.6 * sphere, sphere),
        "plate_modulus": (0.4 * plate - 0.5, -1.6 * plate, plate),
        "yield_strength": (0.0, 2.0, -1.0),
    }
    return Sensitivity(
        **{
            name: shaped(a * by_lam + b * by_y + c * by_ratio, shape)
            for name, (a, b, c) in powers.items()
        }
    )
