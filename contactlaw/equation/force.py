"""A force law as one array of numbers: its layout, and the force that kernels read from it.

A law is known along two lines. The loading curve is a force over the root compression q = sqrt(d),
in pieces, each a polynomial in t = scale q - offset. The unloading curve from the largest
compression dm is F = a |q|^b over q = sqrt(d - dr), a such that it begins on the loading curve;
residual dr and exponent b are functions of dm, and so is the loss, loading work minus unloading
work. These, too, come in pieces, each (dm - 1)^power times a polynomial in t = scale dm - offset,
so that what begins at yield as (dm - 1)^2 keeps its digits there. With dm below the first piece
the contact goes back along the loading curve and nothing is lost.

A law may be capped: where the unloading curve would lie above the loading curve, from the
compression `cap_high` down to `cap_low`, the contact goes back along the loading curve.

The array begins with a header, then come the rows, then the coefficients from the constant one up:

    PIECES       pieces of the loading curve       UNLOADINGS     pieces of the unloading family
    UNLOADING    where the rows of those begin     CAPPED         1 for a capped law

    row of the loading curve   START  q at which it begins     SCALE, OFFSET  of t
                               DEGREE, AT  of its polynomial   FIRST, NEXT    pieces at the kinks
    row of the unloading       START  dm at which it begins    SCALE, OFFSET  of t
                               and POWER, DEGREE, AT of each of the functions of dm

A last row of either kind begins at infinity. Between two kinks the loading curve is smooth,
however many pieces it takes: an integration has to stop at kinks only.

Legend: compressions in d_Y, forces in F_Y = K d_Y^1.5, works in F_Y d_Y.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel

Array = NDArray[np.float64]

PIECES, UNLOADINGS, UNLOADING, CAPPED, HEADER = range(5)
START, SCALE, OFFSET, DEGREE, AT, FIRST, NEXT, PIECE = range(8)
_POWER, _DEGREE, _AT, _FUNCTION = range(4)
RESIDUAL, EXPONENT, LOSS, CAP_LOW, CAP_HIGH = range(5)  # functions of dm, in the order of a row
UNLOADING_ROW = OFFSET + 1 + 5 * _FUNCTION

HERTZ: Array = np.array(
    [1, 0, HEADER + 2 * PIECE + 4, 0]
    + [0, 1, 0, 3, HEADER + 2 * PIECE, 0, 1]
    + [math.inf, 1, 0, 0, 0, 1, 1]
    + [0, 0, 0, 1]
    + [math.inf] * UNLOADING_ROW,
    dtype=np.float64,
)
"""The elastic law, F = q^3, to which the scales of every impact refer."""


class Curve(NamedTuple):
    """The way back from a largest compression dm."""

    residual: float  # dr
    stiffness: float  # a; 0 where the way back is the loading curve
    exponent: float  # b
    cap_low: float  # between these compressions it is the loading curve too, if they differ
    cap_high: float


@kernel
def polynomial(law: Array, at: int, degree: int, t: float) -> float:
    """Polynomial whose coefficients begin at `at`; two chains of products at a time."""
    square = t * t
    even = odd = 0.0
    k = degree
    if k % 2 == 0:
        even = law[at + k]
        k -= 1
    while k > 0:
        odd = odd * square + law[at + k]
        even = even * square + law[at + k - 1]
        k -= 2
    return even + odd * t


@kernel
def piece_at(law: Array, q: float) -> int:
    """Index of the loading curve's piece at a root compression; a kink belongs to what follows."""
    k = 0
    while q >= law[HEADER + (k + 1) * PIECE + START]:
        k += 1
    return k


@kernel
def piece_force(law: Array, k: int, q: float) -> float:
    """Force of the loading curve's piece k at q, also a little beyond its ends."""
    row = HEADER + k * PIECE
    t = law[row + SCALE] * q - law[row + OFFSET]
    return polynomial(law, int(law[row + AT]), int(law[row + DEGREE]), t)


@kernel(cache=True)
def loading(law: Array, q: float) -> float:
    """Force while the compression q^2 grows."""
    return piece_force(law, piece_at(law, q), q)


@kernel
def _unloading_row(law: Array, dm: float) -> int:
    """Where the row of a largest compression begins; 0 where the contact is elastic."""
    row = int(law[UNLOADING])
    if not dm > law[row + START]:
        return 0
    while dm >= law[row + UNLOADING_ROW + START]:
        row += UNLOADING_ROW
    return row


@kernel
def _function(law: Array, row: int, which: int, dm: float) -> float:
    """One of the functions of dm."""
    t = law[row + SCALE] * dm - law[row + OFFSET]
    entry = row + OFFSET + 1 + which * _FUNCTION
    value = polynomial(law, int(law[entry + _AT]), int(law[entry + _DEGREE]), t)
    power = law[entry + _POWER]
    if power == 2.0:
        return value * ((dm - 1.0) * (dm - 1.0))
    return value if power == 0.0 else value * math.pow(dm - 1.0, power)


@kernel(cache=True)
def residual(law: Array, dm: float) -> float:
    """Compression left after unloading from dm."""
    row = _unloading_row(law, dm)
    return _function(law, row, RESIDUAL, dm) if row > 0 else 0.0


@kernel(cache=True)
def loss(law: Array, dm: float) -> float:
    """Subtract unloading work from loading work, of a contact that reached dm."""
    row = _unloading_row(law, dm)
    return _function(law, row, LOSS, dm) if row > 0 else 0.0


@kernel(cache=True)
def unloading(law: Array, dm: float) -> Curve:
    """Find the unloading curve from dm."""
    row = _unloading_row(law, dm)
    if row == 0:
        return Curve(0.0, 0.0, 3.0, 0.0, 0.0)
    left = _function(law, row, RESIDUAL, dm)
    exponent = _function(law, row, EXPONENT, dm)
    span = dm - left
    if exponent == 3.0:
        reach = span * math.sqrt(span)
    else:
        reach = math.pow(span, 0.5 * exponent)
    low = high = 0.0
    if law[CAPPED] > 0.0:
        # next to yield its rounding errors are larger than it is
        low = max(_function(law, row, CAP_LOW, dm), left)
        high = _function(law, row, CAP_HIGH, dm)
    return Curve(left, loading(law, math.sqrt(dm)) / reach, exponent, low, high)


@kernel
def power_force(stiffness: float, exponent: float, q: float) -> float:
    """Force a |q|^b with the sign of q: a step on trial may pass q = 0."""
    if exponent == 3.0:
        return stiffness * (q * q * q)
    return math.copysign(stiffness * math.pow(abs(q), exponent), q)


@kernel(cache=True)
def unloading_force(law: Array, curve: Curve, q: float) -> float:
    """Force at the compression residual + q^2 on the way back."""
    if curve.stiffness == 0.0:
        return loading(law, q)
    force = power_force(curve.stiffness, curve.exponent, q)
    if law[CAPPED] > 0.0 and q > 0.0:
        force = min(force, loading(law, math.sqrt(curve.residual + q * q)))
    return force


def check(law: Array) -> None:
    """Refuse an array that is no law: kernels would follow its addresses out of memory.

    Raises
    ------
    ValueError
        With what is wrong of it.
    """
    size = law.size
    pieces, rows, at = (_whole(law, n, size) for n in (PIECES, UNLOADINGS, UNLOADING))
    if size < HEADER or not at == HEADER + (pieces + 1) * PIECE or pieces < 1:
        raise ValueError("its law has no loading curve")
    if not at + (rows + 1) * UNLOADING_ROW <= size:
        raise ValueError("its law ends within its rows")
    curve = law[HEADER:at].reshape(-1, PIECE)
    family = law[at : at + (rows + 1) * UNLOADING_ROW].reshape(-1, UNLOADING_ROW)
    entries = [(row, DEGREE) for row in curve[:-1]]
    entries += [
        (row, OFFSET + 1 + n * _FUNCTION + _DEGREE) for row in family[:-1] for n in range(5)
    ]
    for row, column in entries:
        degree, start = _whole(row, column, size), _whole(row, column + 1, size)
        if not start + degree < size:
            raise ValueError("its law has coefficients beyond its end")
    for table in (curve, family):
        starts = table[:, START]
        if not (np.diff(starts[:-1]) > 0.0).all() or starts[-1] != math.inf:
            raise ValueError("the pieces of its law do not follow each other")
    for n, row in enumerate(curve[:-1]):
        if not _whole(row, FIRST, size) <= n < _whole(row, NEXT, size) <= pieces:
            raise ValueError("the pieces of its law belong to no kink")


def _whole(row: Array, column: int, most: int) -> int:
    """Read a number that has to be whole, from 0 to a limit."""
    number = float(row[column]) if column < row.size else math.nan
    if not (0.0 <= number <= most and number == int(number)):
        raise ValueError(f"its law has {number} where there is a whole number up to {most}")
    return int(number)
