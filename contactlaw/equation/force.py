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

Coefficients are padded with zeros to a multiple of four. The last of the starts is infinity. The last of the family
starts is the dm at which the law ends, infinity for a law without unloading curves. Beyond its end
the force goes on along its tangent over the compression, the residual keeps its share of dm, the
exponent its value, and plastic work its share of the loading work. Between two kinks the loading
curve is smooth, however many pieces it has: an integration has to stop at kinks only.

The laws of a pair that grows stronger with the rate of an impact stand in one array, too, a ladder:
minus the number of its rungs, then a row for each rung, with rising strengths, then their laws:

    STRENGTH  ln k, k the strength over that of a slow test      BEGINS, SIZE  place of its law
    LOG_SCALE the logarithm of its d_Y over that of the slow pair
    LOG_ONSET likewise of the compression at which flow begins   END  up to where it holds [d_Y]

The law of an impact is a blend of the two rungs around its strength. At the same compression, in
the d_Y of each, these are linear in ln k: ln d_Y, the end, the force, the residual compression, the
losses, and the work that unloading gives back, from which its exponent follows. So the energies of a
blend add up as those of its laws. A stronger law ends at fewer d_Y; each rung follows its formulas up
to the end of its weaker neighbour.

Legend: compressions in d_Y, forces in F_Y = K d_Y^1.5, works in F_Y d_Y.
"""

import math
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array, Places
from contactlaw._jit import kernel

PIECES, UNLOADINGS, STARTS, CURVE, FAMILY_STARTS, FAMILY, HEADER = range(7)
SCALE, OFFSET, DEGREE, AT, FIRST, NEXT, PIECE = range(7)
FUNCTION_POWER, FUNCTION_DEGREE, FUNCTION_AT, FUNCTION = range(4)
FUNCTIONS = 4
# Energy lost before the largest compression, by ln of the work given back: fem.json's, to 2.5 %.
EARLY, LESS_EARLY = 0.296, 0.0175
STRENGTH, BEGINS, SIZE, LOG_SCALE, LOG_ONSET, END, RUNG = range(7)
_STEP = 2e-5  # relative step in d to either side of a law's end, of the difference that is its slope
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


class Deepest(NamedTuple):
    """What follows from the largest compression dm of a contact."""

    force: float
    residual: float  # dr
    exponent: float  # b
    loss: float  # loading work minus unloading work
    other: float  # part of the loss that is not plastic work


class BlendedLaw(NamedTuple):
    """The law of an impact, a share of the way from one law to another."""

    low: Array
    high: Array
    share: float  # 0: `low` alone
    end: float  # compression up to which it holds


@kernel(inline=True)
def alone(law: Array) -> BlendedLaw:
    """Take a law by itself."""
    return BlendedLaw(law, law, 0.0, law[int(law[FAMILY_STARTS] + law[UNLOADINGS])])


@kernel
def _rungs_around(ladder: Array, strength: float) -> tuple[int, int, float]:
    """Find the rows of the rungs below and above a strength, and the share of the way between."""
    row, last = 1, 1 - (int(ladder[PIECES]) + 1) * RUNG
    while row < last and strength >= ladder[row + RUNG]:
        row += RUNG
    if row == last or not strength > ladder[row]:  # beyond the ends, and for NaN
        return row, row, 0.0
    return row, row + RUNG, (strength - ladder[row]) / (ladder[row + RUNG] - ladder[row])


@kernel(inline=True)
def _law_of_rung(ladder: Array, row: int) -> Array:
    begins = int(ladder[row + BEGINS])
    return ladder[begins:]


@kernel
def at_strength(laws: Array, strength: float) -> BlendedLaw:
    """Law of an impact; beyond a ladder's ends that of its last rung."""
    if laws[PIECES] > 0.0:
        return alone(laws[0:])
    low, high, share = _rungs_around(laws, strength)
    end = laws[low + END] + share * (laws[high + END] - laws[low + END])
    return BlendedLaw(_law_of_rung(laws, low), _law_of_rung(laws, high), share, end)


@kernel
def scale_at(laws: Array, strength: float, column: int) -> float:
    """Value whose logarithm is in a column of the rungs, such as LOG_ONSET; 1 for an array of one law."""
    if laws[PIECES] > 0.0:
        return 1.0
    low, high, share = _rungs_around(laws, strength)
    return math.exp(laws[low + column] + share * (laws[high + column] - laws[low + column]))


@kernel
def growth_at(laws: Array, strength: float) -> float:
    """Yield compression of an impact over that of the slow pair."""
    return scale_at(laws, strength, LOG_SCALE)


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
def piece_force(law: Array, k: int, q: float) -> float:
    """Force of the loading curve's piece k at q, also a little beyond its ends."""
    row = row_of(law, k)
    t = law[row + SCALE] * q - law[row + OFFSET]
    return polynomial(law, int(law[row + AT]), int(law[row + DEGREE]), t)


@kernel(inline=True)
def loading_of(law: Array, q: float) -> float:
    """Compute `loading` of a law that is not blended."""
    pieces_begun = _count(law, int(law[STARTS]), int(law[PIECES]), q)  # a kink belongs to the piece that begins there
    return piece_force(law, max(pieces_begun - 1, 0), q)


@kernel(inline=True)
def _blended_loading(law: BlendedLaw, q: float) -> float:
    f = loading_of(law.low, q)
    return f + law.share * (loading_of(law.high, q) - f) if law.share > 0.0 else f


@kernel(cache=True)
def loading(law: BlendedLaw, q: float) -> float:
    """Force while the compression q^2 grows."""
    if not q * q > law.end:
        return float(_blended_loading(law, q))
    step = _STEP * law.end
    rise = _blended_loading(law, math.sqrt(law.end + step)) - _blended_loading(law, math.sqrt(law.end - step))
    return float(_blended_loading(law, math.sqrt(law.end)) + 0.5 * rise / step * (q * q - law.end))


@kernel(inline=True)
def lossless(law: BlendedLaw) -> float:
    """Largest compression from which a contact unloads without a loss."""
    return float(max(law.low[int(law.low[FAMILY_STARTS])], law.high[int(law.high[FAMILY_STARTS])]))


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


@kernel
def solvable(law: BlendedLaw, y: float) -> float:
    """Yield compression to solve with: 1 in place of inf, which an elastic law has.

    Slower impacts under a law with losses lose the same share, but it knows no loss of the shallowest contacts.
    """
    y = y if y < math.inf else 1.0
    if y * lossless(law) > 0.05 and returned(law)[0] < 1.0:
        return 0.05 / lossless(law)
    return y


@kernel(inline=True)
def _deepest_of(law: Array, dm: float) -> Deepest:
    f, row = loading_of(law, math.sqrt(dm)), _unloading_row(law, dm)
    if row == 0:
        return Deepest(f, 0.0, 3.0, 0.0, 0.0)
    return Deepest(
        f,
        _function(law, row, RESIDUAL, dm),
        _function(law, row, EXPONENT, dm),
        _function(law, row, LOSS, dm),
        _function(law, row, OTHER, dm),
    )


@kernel(inline=True)
def deepest(law: BlendedLaw, dm: float) -> Deepest:
    """Find what follows from the largest compression."""
    inside = min(dm, law.end)
    f, left, exponent, lost, other = _deepest_of(law.low, inside)
    if law.share > 0.0:
        high = _deepest_of(law.high, inside)
        back = f * (inside - left) / (exponent + 2.0)  # half the work that is given back
        back += law.share * (high.force * (inside - high.residual) / (high.exponent + 2.0) - back)
        f += law.share * (high.force - f)
        left += law.share * (high.residual - left)
        lost += law.share * (high.loss - lost)
        other += law.share * (high.other - other)
        exponent = f * (inside - left) / back - 2.0
    if dm > inside:  # plastic work stays the same share of the loading work
        work, last = lost + 2.0 * f * (inside - left) / (exponent + 2.0), f
        f, plastic = loading(law, math.sqrt(dm)), (lost - other) / work
        work += 0.5 * (last + f) * (dm - inside)
        left *= dm / inside
        lost = work - 2.0 * f * (dm - left) / (exponent + 2.0)
        other = lost - plastic * work
    return Deepest(f, left, exponent, lost, other)


@kernel(inline=True)
def is_hertz(law: BlendedLaw) -> bool:
    """Whether the loading curve begins as Hertz's, q^3, and not as one that is stiffer."""
    return bool(law.low[row_of(law.low, 0) + DEGREE] == 3.0)


@kernel(inline=True)
def _stiffening_of(law: Array) -> float:
    row = row_of(law, 0)
    return float(law[int(law[row + AT]) + 4]) if law[row + DEGREE] > 3.0 else 0.0


@kernel(inline=True)
def stiffening(law: BlendedLaw) -> float:
    """Return s of a loading curve that begins as q^3 (1 + s q); 0 for Hertz's."""
    s = _stiffening_of(law.low)
    return s + law.share * (_stiffening_of(law.high) - s)


@kernel(inline=True)
def _work_at_yield_of(law: Array) -> float:
    row, work = row_of(law, 0), 0.0
    at = int(law[row + AT])
    for n in range(int(law[row + DEGREE]) + 1):
        work += 2.0 * law[at + n] / (n + 2.0)
    return work


@kernel
def work_at_yield(law: BlendedLaw) -> float:
    """Compute the loading work up to yield, from the first piece, a polynomial in q [F_Y d_Y]."""
    work = _work_at_yield_of(law.low)
    return work + law.share * (_work_at_yield_of(law.high) - work)


@kernel
def returned(law: BlendedLaw) -> tuple[float, float, float]:
    """Shares of compression and work that bodies with losses give back, 1 and 1 without losses.

    They are those of the shallowest contacts, whose loss-free unloading would be Hertz's. The third
    number is the part of the energy left at the largest compression that is lost before it.
    """
    dm = 2.0 * lossless(law)
    curve = unloading(law, dm)
    if not dm < 1.0 or curve.residual == 0.0:
        return 1.0, 1.0, 0.0
    share = 1.0 - curve.residual / dm
    work = 2.5 * share / (0.5 * curve.exponent + 1.0)
    return share, work, -math.log(work) * (EARLY + LESS_EARLY * math.log(work))


@kernel(inline=True)
def leaves_hertz(law: BlendedLaw) -> float:
    """Compression up to which contacts follow Hertz's law and unload without a loss."""
    if not is_hertz(law):
        return 0.0
    leaves = start_of(law.low, 1)
    return min(leaves * leaves, lossless(law))


@kernel
def unloading(law: BlendedLaw, dm: float) -> UnloadingCurve:
    """Find the unloading curve from dm."""
    if not dm > lossless(law):
        return UnloadingCurve(0.0, 0.0, 3.0)
    f, left, exponent, _, _ = deepest(law, dm)
    span = dm - left
    reach = span * math.sqrt(span) if exponent == 3.0 else math.pow(span, 0.5 * exponent)
    return UnloadingCurve(left, f / reach, exponent)


@kernel(inline=True)
def power_force(stiffness: float, exponent: float, q: float) -> float:
    """Force a |q|^b with the sign of q, since a trial step may pass q = 0."""
    if exponent == 3.0:
        return stiffness * (q * q * q)
    return math.copysign(stiffness * math.pow(abs(q), exponent), q)


@kernel(cache=True)
def unloading_force(law: BlendedLaw, curve: UnloadingCurve, q: float) -> float:
    """Force at the compression residual + q^2 on an unloading curve."""
    if curve.stiffness == 0.0:
        return loading(law, q)
    return power_force(curve.stiffness, curve.exponent, q)


def rungs(ladder: Array) -> Array:
    """Rows of a ladder."""
    return ladder[1 : 1 - int(ladder[PIECES]) * RUNG].reshape(-1, RUNG)


def strongest(laws: Array) -> float:
    """Return ln k up to which laws reach; infinite for an array that is one law."""
    return float(rungs(laws)[-1, STRENGTH]) * (1.0 + 1e-12) if laws[PIECES] < 0.0 else math.inf


def check(law: Array) -> None:
    """Refuse an array that is no law, because kernels would follow its addresses out of bounds.

    Raises
    ------
    ValueError
        If the array is not a law; the message says what is wrong.
    """
    pieces, rows, *addresses = _whole(law[:HEADER], law.size).tolist()
    places = np.cumsum([HEADER, pieces + 1, pieces * PIECE, rows + 1, rows * UNLOADING_ROW]).tolist()
    if pieces < 1 or places[-1] > law.size or addresses != places[:-1]:
        raise ValueError("its law ends within its pieces")
    starts, curve, family_starts, family = np.split(law[HEADER : places[-1]], np.subtract(places[1:-1], HEADER))
    for values in (starts, family_starts):
        if not (np.diff(values) > 0.0).all() or starts[-1] != math.inf:
            raise ValueError("the pieces of its law do not follow each other")
    curve, functions = curve.reshape(-1, PIECE), family.reshape(-1, UNLOADING_ROW)[:, OFFSET + 1 :]
    entries = functions.reshape(-1, FUNCTION)[:, FUNCTION_DEGREE:]
    degree, at = _whole(np.vstack((curve[:, DEGREE:FIRST], entries)).T, law.size)
    if (degree // 4 * 4 + 4 + at > law.size).any():
        raise ValueError("its law has coefficients beyond its end")
    (first, following), n = _whole(curve[:, FIRST:].T, pieces), np.arange(pieces)
    if ((first > n) | (following <= n)).any():
        raise ValueError("the pieces of its law belong to no kink")


def check_strengths(laws: Array) -> None:
    """Refuse an array that is not a ladder of laws, as `check` does for one."""
    if not 0 < -laws[PIECES] * RUNG < laws.size:
        raise ValueError("it has no law of any strength")
    for begins, size in _whole(rungs(laws)[:, BEGINS : SIZE + 1], laws.size).tolist():
        if begins + size > laws.size:
            raise ValueError("its laws of several strengths end within one of them")
        check(laws[begins : begins + size])


def _whole(numbers: Array, most: int) -> Places:
    """Read numbers that have to be whole, from 0 to a limit."""
    wrong = numbers[~((numbers >= 0.0) & (numbers <= most) & (numbers == np.floor(numbers)))]
    if wrong.size:
        raise ValueError(f"its law has {wrong[0]} where there is a whole number up to {most}")
    return numbers.astype(np.int64)
