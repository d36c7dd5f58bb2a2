"""A force law as one array of numbers: its layout, and the force that kernels read from it.

A law has a loading curve and a family of unloading curves. The loading curve is a force over the
root compression q = sqrt(d), in pieces, each a polynomial in t = scale q - offset. The unloading
curve from the largest compression dm is F = a |q|^b over q = sqrt(d - dr), where a is such that it
begins on the loading curve. Functions of dm are the residual dr, the exponent b, the loss (loading
work minus unloading work) and the part of it that is not plastic work. They come in pieces too,
each (dm - 1)^power times a polynomial in t = scale dm - offset: what begins at yield as (dm - 1)^2
keeps its digits. With dm below the first piece the contact unloads along the loading curve without
a loss.

The array begins with a header, then come the starts of the pieces, the rows, and the coefficients
from the constant one up:

    PIECES  number of pieces of loading      UNLOADINGS     number of pieces of unloading
    STARTS  index of the q of their starts   FAMILY_STARTS  index of the dm of their starts
    CURVE   index of their rows              FAMILY         index of their rows

    row of loading     SCALE, OFFSET  of t, and DEGREE and AT, the index of its coefficients
                       FIRST, NEXT    pieces that begin at the kink below, and at that above
    row of unloading   SCALE, OFFSET  of t, and for each function of dm its power, DEGREE and AT

Coefficients are padded with zeros to a multiple of four. The last of the starts, and of the family
starts, is infinity. Between two kinks the loading curve is smooth, however many pieces it has: an
integration has to stop at kinks only.

Laws of one pair that grow stronger with the rate of an impact stand in one array, too: a negative
number of pieces of ln k, the strength over that of a slow test, the numbers of the longest law, and
for each piece

    TOP     ln k at its end         PER, CENTRE  of t = PER (ln k - CENTRE), from -1 to 1
    BEGINS  index of its block      POWERS       of t, less one
    WIDTH   numbers of a law, LOG_SCALE the logarithm of its d_Y over that of the slow pair, and
            LOG_ONSET, likewise of the compression at which flow begins

A block has these numbers, then those that t multiplies, those that its square multiplies, and so
on; but SCALE and OFFSET are half the length of a piece and its middle, which are smooth where a
length vanishes. Within a piece of ln k all laws have one layout. `at_strength` writes the law of an
impact into an array of its own, of `room_for` numbers.

Legend: compressions in d_Y, forces in F_Y = K d_Y^1.5, works in F_Y d_Y.
"""

import math
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel

PIECES, UNLOADINGS, STARTS, CURVE, FAMILY_STARTS, FAMILY, HEADER = range(7)
SCALE, OFFSET, DEGREE, AT, FIRST, NEXT, PIECE = range(7)
FUNCTION_POWER, FUNCTION_DEGREE, FUNCTION_AT, FUNCTION = range(4)
FUNCTIONS = 4
# Energy lost before the largest compression, by ln of the work given back: fem.json's, to 2.5 %.
EARLY, LESS_EARLY = 0.296, 0.0175
TOP, CENTRE, PER, BEGINS, POWERS, WIDTH, STRENGTHS = range(7)
LOG_SCALE, LOG_ONSET, HEADS = range(3)  # numbers after those of a law
LONGEST, FIRST_ROW = 1, 2
# functions of dm, in the order of a row
RESIDUAL, EXPONENT, LOSS, OTHER = range(FUNCTIONS)
_U = tuple(np.uint64(n) for n in range(5))
UNLOADING_ROW = OFFSET + 1 + FUNCTIONS * FUNCTION

HERTZ: Array = np.array(
    [1, 0, HEADER, HEADER + 2, HEADER + 2 + PIECE, HEADER + 3 + PIECE]
    + [0, math.inf]
    + [1, 0, 3, HEADER + 3 + PIECE, 0, 1]
    + [math.inf]
    + [0, 0, 0, 1],
    dtype=np.float64,
)
"""The elastic law, F = q^3, to which the scales of every impact refer."""


class UnloadingCurve(NamedTuple):
    """The unloading curve from a largest compression dm."""

    residual: float  # dr
    stiffness: float  # a; 0 where the contact unloads along the loading curve
    exponent: float  # b


@kernel
def _piece(laws: Array, strength: float) -> int:
    """Where the row of the piece of a strength begins."""
    at = FIRST_ROW
    last = at + (int(-laws[PIECES]) - 1) * STRENGTHS
    while at < last and strength > laws[at + TOP]:
        at += STRENGTHS
    return at


@kernel(inline=True)
def _place(laws: Array, at: int, strength: float) -> float:
    """Return t of a strength in the piece whose row begins at `at`; no negative one, and no NaN."""
    known = min(strength, laws[at + TOP]) if strength > 0.0 else 0.0
    t: float = laws[at + PER] * (known - laws[at + CENTRE])
    return t


@kernel
def _at_place(laws: Array, at: int, strength: float, number: int) -> float:
    """Value of one number at a strength, in the piece whose row begins at `at`."""
    t = _place(laws, at, strength)
    width, powers = int(laws[at + WIDTH]), int(laws[at + POWERS])
    k = int(laws[at + BEGINS]) + number + powers * width
    value: float = laws[k]
    for _ in range(powers):
        k -= width
        value = value * t + laws[k]
    return value


@kernel(inline=True)
def room_for(laws: Array) -> int:
    """Count the numbers that `at_strength` writes at most; 0 for an array that is one law."""
    return int(laws[LONGEST]) if laws[PIECES] < 0.0 else 0


@kernel(inline=True)
def _head_at(laws: Array, strength: float, head: int) -> float:
    """Value whose logarithm is one of the numbers after those of a law; 1 for an array of one."""
    if room_for(laws) == 0:
        return 1.0
    at = _piece(laws, strength)
    return math.exp(_at_place(laws, at, strength, int(laws[at + WIDTH]) - HEADS + head))


@kernel
def growth_at(laws: Array, strength: float) -> float:
    """Yield compression of an impact over that of the slow pair."""
    return _head_at(laws, strength, LOG_SCALE)


@kernel
def onset_at(laws: Array, strength: float) -> float:
    """Compression of an impact at which flow begins, over the slow pair's yield compression."""
    return _head_at(laws, strength, LOG_ONSET)


@kernel
def at_strength(laws: Array, strength: float, room: Array) -> Array:
    """Law of an impact among several, written into `room`; beyond them it is that of their end."""
    at = _piece(laws, strength)
    t = _place(laws, at, strength)
    width, powers = int(laws[at + WIDTH]), int(laws[at + POWERS])
    last = int(laws[at + BEGINS]) + powers * width
    for n in range(width):
        room[n] = laws[last + n]
    for k in range(powers):
        begins = last - (k + 1) * width
        for n in range(width):
            room[n] = room[n] * t + laws[begins + n]
    if powers > 0:
        _by_scale(room, int(room[CURVE]), int(room[PIECES]), PIECE)
        _by_scale(room, int(room[FAMILY]), int(room[UNLOADINGS]), UNLOADING_ROW)
    return room


@kernel
def _put(laws: Array, at: int, t: float, begins: int, count: int, room: Array) -> None:
    """Write some of the numbers of a law at t of the piece whose row begins at `at`."""
    width, powers = int(laws[at + WIDTH]), int(laws[at + POWERS])
    last = int(laws[at + BEGINS]) + powers * width
    for n in range(begins, begins + count):
        room[n] = laws[last + n]
    for k in range(powers):
        row = last - (k + 1) * width
        for n in range(begins, begins + count):
            room[n] = room[n] * t + laws[row + n]


@kernel
def at_compression(laws: Array, strength: float, dm: float, room: Array) -> Array:
    """`at_strength`, but only of what belongs to a contact that is loaded to dm.

    A law has thousands of numbers and a contact asks for a hundred of them.
    """
    at = _piece(laws, strength)
    t = _place(laws, at, strength)
    _put(laws, at, t, 0, HEADER, room)
    _put(laws, at, t, int(room[STARTS]), int(room[PIECES]) + 1, room)
    row = row_of(room, piece_at(room, math.sqrt(dm)))
    _put(laws, at, t, row, PIECE, room)
    _put(laws, at, t, int(room[row + AT]), int(room[row + DEGREE]) // 4 * 4 + 4, room)
    _put(laws, at, t, int(room[FAMILY_STARTS]), int(room[UNLOADINGS]) + 1, room)
    one = _unloading_row(room, dm)
    if one > 0:
        _put(laws, at, t, one, UNLOADING_ROW, room)
        for which in range(FUNCTIONS):
            k = one + OFFSET + 1 + which * FUNCTION
            count = int(room[k + FUNCTION_DEGREE]) // 4 * 4 + 4
            _put(laws, at, t, int(room[k + FUNCTION_AT]), count, room)
    if int(laws[at + POWERS]) > 0:
        _by_scale(room, row, 1, PIECE)
        _by_scale(room, one, min(one, 1), UNLOADING_ROW)
    return room


@kernel
def _by_scale(room: Array, at: int, count: int, length: int) -> None:
    """Put SCALE and OFFSET in place of half the length and the middle of each piece."""
    for k in range(at, at + count * length, length):
        room[k + SCALE] = 1.0 / room[k + SCALE]
        room[k + OFFSET] *= room[k + SCALE]


@kernel(inline=True)
def polynomial(law: Array, at: int, degree: int, t: float) -> float:
    """Evaluate the polynomial whose coefficients begin at `at`, four at a time in one vector."""
    square = t * t
    fourth = square * square
    k = np.uint64(at + degree // 4 * 4)  # unsigned: no test for a negative index
    a, b, c, d = law[k], law[k + _U[1]], law[k + _U[2]], law[k + _U[3]]
    for _ in range(degree // 4):
        k -= _U[4]
        a = a * fourth + law[k]
        b = b * fourth + law[k + _U[1]]
        c = c * fourth + law[k + _U[2]]
        d = d * fourth + law[k + _U[3]]
    value: float = (a + b * t) + square * (c + d * t)
    return value


@kernel(inline=True)
def _count(law: Array, at: int, most: int, x: float) -> int:
    """Count the starts that are not above x; to compare them all is faster than a search."""
    count, first = 0, np.uint64(at)
    for k in range(np.uint64(most)):
        count += x >= law[first + np.uint64(k)]
    return count


@kernel(inline=True)
def start_of(law: Array, k: int) -> float:
    """Root compression at which the loading curve's piece k begins."""
    start: float = law[int(law[STARTS]) + k]
    return start


@kernel(inline=True)
def row_of(law: Array, k: int) -> int:
    """Where the row of the loading curve's piece k begins."""
    return int(law[CURVE]) + k * PIECE


@kernel(inline=True)
def piece_at(law: Array, q: float) -> int:
    """Index of the loading curve's piece at q; a kink belongs to the piece that begins there."""
    return max(_count(law, int(law[STARTS]), int(law[PIECES]), q) - 1, 0)


@kernel(inline=True)
def piece_force(law: Array, k: int, q: float) -> float:
    """Force of the loading curve's piece k at q, also a little beyond its ends."""
    row = row_of(law, k)
    t = law[row + SCALE] * q - law[row + OFFSET]
    return polynomial(law, int(law[row + AT]), int(law[row + DEGREE]), t)


@kernel(cache=True)
def loading(law: Array, q: float) -> float:
    """Force while the compression q^2 grows."""
    return piece_force(law, piece_at(law, q), q)


@kernel(inline=True)
def lossless(law: Array) -> float:
    """Largest compression from which a contact unloads without a loss."""
    least: float = law[int(law[FAMILY_STARTS])]
    return least


@kernel(inline=True)
def _unloading_row(law: Array, dm: float) -> int:
    """Where the row for a largest compression begins; 0 if the contact stays elastic."""
    at = int(law[FAMILY_STARTS])
    if not dm > law[at]:
        return 0
    return int(law[FAMILY]) + (_count(law, at, int(law[UNLOADINGS]), dm) - 1) * UNLOADING_ROW


@kernel(inline=True)
def _function(law: Array, row: int, which: int, dm: float) -> float:
    """Evaluate one of the functions of dm that a row holds."""
    t = law[row + SCALE] * dm - law[row + OFFSET]
    entry = row + OFFSET + 1 + which * FUNCTION
    value = polynomial(law, int(law[entry + FUNCTION_AT]), int(law[entry + FUNCTION_DEGREE]), t)
    power = law[entry + FUNCTION_POWER]
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
    """Loss of a contact that was loaded to dm: loading work minus unloading work."""
    row = _unloading_row(law, dm)
    return _function(law, row, LOSS, dm) if row > 0 else 0.0


@kernel(cache=True)
def other_loss(law: Array, dm: float) -> float:
    """Part of the loss that is not plastic work."""
    row = _unloading_row(law, dm)
    return _function(law, row, OTHER, dm) if row > 0 else 0.0


@kernel(inline=True)
def residual_and_losses(law: Array, dm: float) -> tuple[float, float, float]:
    """`residual`, `loss` and `other_loss` at once."""
    row = _unloading_row(law, dm)
    if row == 0:
        return 0.0, 0.0, 0.0
    return (_function(law, row, RESIDUAL, dm), _function(law, row, LOSS, dm), _function(law, row, OTHER, dm))


@kernel(inline=True)
def is_hertz(law: Array) -> bool:
    """Whether the loading curve begins as Hertz's, q^3."""
    row = row_of(law, 0)
    at = int(law[row + AT])
    same = law[row + DEGREE] == 3.0 and law[row + SCALE] == 1.0 and law[row + OFFSET] == 0.0
    return bool(same and law[at] == law[at + 1] == law[at + 2] == 0.0 and law[at + 3] == 1.0)


@kernel(inline=True)
def stiffening(law: Array) -> float:
    """Return s of a loading curve that begins as q^3 (1 + s q); 0 for Hertz's and for others."""
    row = row_of(law, 0)
    at = int(law[row + AT])
    same = law[row + DEGREE] == 4.0 and law[row + SCALE] == 1.0 and law[row + OFFSET] == 0.0
    same &= law[at] == law[at + 1] == law[at + 2] == 0.0 and law[at + 3] == 1.0
    return float(law[at + 4]) if same else 0.0


@kernel(inline=True)
def work_at_yield(law: Array) -> float:
    """Compute the loading work up to yield, from the first piece, a polynomial in q [F_Y d_Y]."""
    row, work = row_of(law, 0), 0.0
    at = int(law[row + AT])
    for n in range(int(law[row + DEGREE]) + 1):
        work += 2.0 * law[at + n] / (n + 2.0)
    return work


@kernel
def returned(law: Array) -> tuple[float, float, float]:
    """Shares of compression and work that bodies with losses give back, 1 and 1 without losses.

    They are those of the shallowest contacts, whose loss-free unloading would be Hertz's. The third
    number is the part of the energy left at the largest compression that is lost before it.
    """
    dm = 2.0 * lossless(law)
    row = _unloading_row(law, dm) if dm < 1.0 else 0
    left = _function(law, row, RESIDUAL, dm) / dm if row > 0 else 0.0
    if left == 0.0:
        return 1.0, 1.0, 0.0
    work = 2.5 * (1.0 - left) / (0.5 * _function(law, row, EXPONENT, dm) + 1.0)
    return 1.0 - left, work, -math.log(work) * (EARLY + LESS_EARLY * math.log(work))


@kernel(inline=True)
def leaves_hertz(law: Array) -> float:
    """Compression up to which contacts follow Hertz's law and unload without a loss."""
    if not is_hertz(law):
        return 0.0
    leaves = start_of(law, 1)
    return min(leaves * leaves, lossless(law))


@kernel
def unloading(law: Array, dm: float) -> UnloadingCurve:
    """Find the unloading curve from dm."""
    row = _unloading_row(law, dm)
    if row == 0:
        return UnloadingCurve(0.0, 0.0, 3.0)
    left = _function(law, row, RESIDUAL, dm)
    exponent = _function(law, row, EXPONENT, dm)
    span = dm - left
    if exponent == 3.0:
        reach = span * math.sqrt(span)
    else:
        reach = math.pow(span, 0.5 * exponent)
    return UnloadingCurve(left, loading(law, math.sqrt(dm)) / reach, exponent)


@kernel(inline=True)
def power_force(stiffness: float, exponent: float, q: float) -> float:
    """Force a |q|^b with the sign of q, since a trial step may pass q = 0."""
    if exponent == 3.0:
        return stiffness * (q * q * q)
    return math.copysign(stiffness * math.pow(abs(q), exponent), q)


@kernel(cache=True)
def unloading_force(law: Array, curve: UnloadingCurve, q: float) -> float:
    """Force at the compression residual + q^2 on an unloading curve."""
    if curve.stiffness == 0.0:
        return loading(law, q)
    return power_force(curve.stiffness, curve.exponent, q)


def strongest(laws: Array) -> float:
    """Return ln k up to which laws reach; infinite for an array that is one law."""
    last = FIRST_ROW + (pieces_of(laws) - 1) * STRENGTHS
    return float(laws[last + TOP]) * (1.0 + 1e-12) if pieces_of(laws) else math.inf


def tops(laws: Array) -> Array:
    """Return 0 and ln k at the ends of the pieces."""
    rows = FIRST_ROW + STRENGTHS * np.arange(pieces_of(laws))
    return np.append(0.0, laws[rows + TOP])


def pieces_of(laws: Array) -> int:
    """Count the pieces of ln k; 0 for an array that is one law."""
    return max(int(-laws[PIECES]), 0)


def by_length(law: Array) -> None:
    """Put half the length and the middle of each piece in place of SCALE and OFFSET."""
    for block, count, length in ((CURVE, PIECES, PIECE), (FAMILY, UNLOADINGS, UNLOADING_ROW)):
        rows = int(law[block]) + length * np.arange(int(law[count]))
        law[rows + OFFSET] /= law[rows + SCALE]
        law[rows + SCALE] = 1.0 / law[rows + SCALE]


def check(law: Array) -> None:
    """Refuse an array that is no law, because kernels would follow its addresses out of bounds.

    Raises
    ------
    ValueError
        If the array is not a law; the message says what is wrong.
    """
    size = law.size
    header = [_whole(law, n, size) for n in range(HEADER)]
    pieces, rows = header[PIECES], header[UNLOADINGS]
    if pieces < 1:
        raise ValueError("its law has no loading curve")
    blocks = {
        "starts": (header[STARTS], pieces + 1),
        "loading curve": (header[CURVE], pieces * PIECE),
        "starts of unloading": (header[FAMILY_STARTS], rows + 1),
        "unloading": (header[FAMILY], rows * UNLOADING_ROW),
    }
    for name, (at, length) in blocks.items():
        if not HEADER <= at <= at + length <= size:
            raise ValueError(f"its law ends within its {name}")
    starts, curve, family_starts, family = (law[at : at + length] for at, length in blocks.values())
    for values in (starts, family_starts):
        if not (np.diff(values[:-1]) > 0.0).all() or values[-1] != math.inf:
            raise ValueError("the pieces of its law do not follow each other")
    curve, family = curve.reshape(-1, PIECE), family.reshape(-1, UNLOADING_ROW)
    entries = [(row, DEGREE) for row in curve]
    entries += [(row, OFFSET + 1 + n * FUNCTION + FUNCTION_DEGREE) for row in family for n in range(FUNCTIONS)]
    for row, column in entries:
        degree, start = _whole(row, column, size), _whole(row, column + 1, size)
        if not start + degree // 4 * 4 + 4 <= size:
            raise ValueError("its law has coefficients beyond its end")
    for n, row in enumerate(curve):
        if not _whole(row, FIRST, size) <= n < _whole(row, NEXT, size) <= pieces:
            raise ValueError("the pieces of its law belong to no kink")


def check_strengths(laws: Array) -> None:
    """Refuse an array that is not several laws, as `check` does for one."""
    for at in range(FIRST_ROW, FIRST_ROW + max(pieces_of(laws), 1) * STRENGTHS, STRENGTHS):
        row = laws[at : at + STRENGTHS]
        begins, terms, width = (_whole(row, n, laws.size) for n in (BEGINS, POWERS, WIDTH))
        longest = _whole(laws, LONGEST, laws.size)
        if not (HEADER + HEADS <= width <= longest and begins + (terms + 1) * width <= laws.size):
            raise ValueError("its laws of several strengths end within one of them")
        for strength in (row[CENTRE], row[TOP]):
            check(at_strength(laws, strength, np.empty(longest))[: width - HEADS])


def _whole(row: Array, column: int, most: int) -> int:
    """Read a number that has to be whole, from 0 to a limit."""
    number = float(row[column]) if column < row.size else math.nan
    if not (0.0 <= number <= most and number == int(number)):
        raise ValueError(f"its law has {number} where there is a whole number up to {most}")
    return int(number)
