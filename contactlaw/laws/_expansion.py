"""From the formulas of a law to the array that kernels read, see `contactlaw.equation.force`.

Formulas become piecewise polynomials that agree with them to 1e-13: they are expanded in Chebyshev
polynomials on pieces that are halved until the last terms vanish. A `numpy.polynomial.Polynomial`
is used without expansion.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, NoReturn

import numpy as np
from numpy.polynomial import Polynomial, chebyshev

from contactlaw._arrays import Array, Mask
from contactlaw._errors import ArgumentError
from contactlaw.equation import force as _force
from contactlaw.laws._branches import HERTZ, Formula, Loading, Unloading

_TERMS = 18  # Chebyshev terms per piece
_WIDEST = 1.7  # largest ratio of the ends of a piece, before any is halved
_VANISHED = 2e-14  # a term counts as zero below this share of the least value on its piece
_ROUNDING = 1e-13  # a value may be negative by this share of its size, from rounding
_MOST_PIECES = 400  # per branch; a formula that needs more is not smooth
_NODES = np.cos(math.pi * (np.arange(_TERMS) + 0.5) / _TERMS)
# values at the nodes -> coefficients of Chebyshev polynomials -> of powers
_TO_CHEBYSHEV = chebyshev.chebvander(_NODES, _TERMS - 1) * 2.0 / _TERMS
_TO_CHEBYSHEV[:, 0] *= 0.5
_TO_POWERS = np.array([np.pad(chebyshev.cheb2poly(e), (0, _TERMS))[:_TERMS] for e in np.eye(_TERMS)])


@dataclass(frozen=True, eq=False)
class _Piece:
    """Polynomials over one piece of a line, in t = scale x - offset."""

    start: float
    scale: float
    offset: float
    parts: list[Array]


@dataclass(frozen=True)
class _Function:
    """A function to expand, its name in messages, and the size that its error is relative to."""

    what: str
    function: Formula
    size: Formula | None = None  # None: its own values


class Resolution(NamedTuple):
    """How finely the formulas of a law are expanded."""

    vanished: float = _VANISHED  # a term counts as zero below this share of the least value on its piece
    widest: float = _WIDEST  # largest ratio of the ends of a piece, before any is halved
    checked: bool = True  # whether formulas are checked, as those of users have to be: half of the time


def _expand(
    name: str, parts: Sequence[_Function | float], low: float, high: float, resolution: Resolution
) -> list[_Piece]:
    """Expand functions on [low, high], all on the same pieces; a constant stays exact."""
    count = max(1, math.ceil(math.log(high / low) / math.log(resolution.widest)))
    edges = low * np.power(high / low, np.linspace(0.0, 1.0, count + 1))
    edges[[0, -1]] = low, high
    todo, done = list(itertools.pairwise(edges.tolist())), []
    while todo:
        left, right = np.array(todo).T
        middle, half = 0.5 * (left + right), 0.5 * (right - left)
        at = middle[:, None] + half[:, None] * _NODES
        found = [_powers(name, part, at, resolution.vanished) for part in parts]
        smooth = np.all([converged for _, converged in found], axis=0)
        lengths = [_lengths(rows) for rows, _ in found]
        for n in np.flatnonzero(smooth):
            powers = [rows[n, : size[n]] for (rows, _), size in zip(found, lengths, strict=True)]
            done.append(_Piece(left[n], 1.0 / half[n], middle[n] / half[n], powers))
        todo = [ends for n in np.flatnonzero(~smooth) for ends in ((left[n], middle[n]), (middle[n], right[n]))]
        if len(todo) + len(done) > _MOST_PIECES:
            near = f"{todo[0][0]:.6g} d_Y"
            reason = f"it is not smooth near {near}; give each kink a branch that begins there"
            raise ArgumentError("law", name, reason)
    done.sort(key=lambda piece: piece.start)
    return done


def _lengths(rows: Array) -> list[int]:
    """Count the terms of each row up to the last that is not zero, at least one."""
    beyond = np.argmax(rows[:, ::-1] != 0.0, axis=1)  # 0 where all are zero, too
    sizes = np.where(rows.any(axis=1), rows.shape[1] - beyond, 1)
    return [int(size) for size in sizes]


def _powers(name: str, part: _Function | float, at: Array, vanished: float) -> tuple[Array, Mask]:
    """Coefficients of powers of t for rows of values, and which rows have converged."""
    if isinstance(part, float):
        return np.full((len(at), 1), part), np.ones(len(at), dtype=bool)
    values = _values(name, part.what, part.function, at)
    size = np.abs(values) if part.size is None else part.size(at)
    wrong = ~(np.isfinite(values) & (values >= -_ROUNDING * size))
    if wrong.any():
        n = int(np.argmax(wrong))
        _refuse(name, part.what, values.flat[n], at.flat[n])
    level = values[:, :1]  # subtracted, so that rounding is relative to the values' variation
    terms = (values - level) @ _TO_CHEBYSHEV
    terms[:, :1] += level
    small = np.abs(terms) <= vanished * size.min(axis=1, keepdims=True)
    kept = np.cumsum(~small[:, ::-1], axis=1)[:, ::-1] > 0  # up to the last that is not small
    return (terms * kept) @ _TO_POWERS, small[:, -2:].all(axis=1)


def _refuse(name: str, what: str, value: float, at: float) -> NoReturn:
    gain = "; a loop would gain energy" if what == "loss" and value < 0.0 else ""
    reason = f"its {what} is {value:.6g} at {at:.6g} d_Y: must be finite, not negative{gain}"
    raise ArgumentError("law", name, reason)


def _values(name: str, what: str, function: Formula, at: Array) -> Array:
    """Evaluate a user's formula; refuse one that does not take arrays."""
    with np.errstate(all="ignore"):
        try:
            return np.broadcast_to(np.asarray(function(at), dtype=np.float64), at.shape)
        except (TypeError, ValueError) as error:
            rule = "an array, as numpy's functions do, and return one number for each element"
            reason = f"its {what} has to take {rule}; it raised: {error}"
            raise ArgumentError("law", name, reason) from error


class LoadingCurve:
    """The loading curve in pieces, with force and work at any compressions."""

    def __init__(
        self, name: str, branches: Sequence[Loading], yields: bool, end: float, resolution: Resolution
    ) -> None:
        if not branches or branches[0].start != 0.0 or not _begins_as_hertz(branches[0].force):
            forms = "a polynomial, HERTZ or HERTZ plus higher powers that make it stiffer"
            raise ArgumentError("law", name, f"its first branch has to begin at 0 with {forms}")
        self.end = end
        self.stiffer = branches[0].force != HERTZ
        self.kinks = tuple(float(branch.start) for branch in branches[1:])
        self.pieces: list[_Piece] = []
        self.first_of_branch: list[int] = []  # for each piece, the first piece of its branch
        for branch, end in _ends(branches, self.end):
            first = len(self.pieces)
            force = branch.force
            if isinstance(force, Polynomial):
                coefficients = np.asarray(force.coef, dtype=np.float64)
                self.pieces.append(_Piece(math.sqrt(branch.start), 1.0, 0.0, [coefficients]))
            else:
                if resolution.checked:
                    _check_rise(name, force, branch.start, end, 200)
                part = _Function("loading force", _over_root(force))
                self.pieces += _expand(name, [part], math.sqrt(branch.start), math.sqrt(end), resolution)
            self.first_of_branch += [first] * (len(self.pieces) - first)
        self._tabulate()
        if yields:
            self._extend_by_tangent()
        if resolution.checked:
            self._check(name, resolution)

    def _check(self, name: str, resolution: Resolution) -> None:
        for kink in self.kinks:
            before, after = self.force(np.array([kink * (1.0 - 1e-12), kink]))
            if not abs(after - before) <= max(1e-9, 1e3 * resolution.vanished) * before:
                said = f"{kink:.9g} d_Y: {before:.9g} and {after:.9g} F_Y"
                raise ArgumentError("law", name, f"its loading branches do not meet at {said}")
        _check_rise(name, self.force, 1e-3, self.end, 2000)

    def _extend_by_tangent(self) -> None:
        """Continue beyond the end along the tangent in d, as a polynomial in q."""
        end = np.array([self.end, self.end * (1.0 + 1e-6)])
        force, work = self.force(end), self.work(end)
        piece = self.pieces[-1]
        root = math.sqrt(self.end)
        t = piece.scale * root - piece.offset
        slope = 0.5 * piece.scale * Polynomial(piece.parts[0]).deriv()(t) / root
        self.tangent = float(force[0]), float(slope), float(work[0])
        if piece.scale == 1.0 and piece.parts[0].size <= 3 and piece.parts[0][1] == 0.0:
            return  # the last piece is linear in d already
        constant = float(force[0] - slope * self.end)
        tail = np.array([constant, 0.0, float(slope)])
        self.pieces.append(_Piece(root, 1.0, 0.0, [tail]))
        self.first_of_branch.append(self.first_of_branch[-1])
        self._tabulate()

    def _tabulate(self) -> None:
        pieces = self.pieces
        self._starts = np.array([piece.start for piece in pieces])
        self._scale, self._offset = (
            np.array([getattr(piece, name) for piece in pieces]) for name in ("scale", "offset")
        )
        terms = max(piece.parts[0].size for piece in pieces)
        self._force = np.zeros((len(pieces), terms))
        self._work = np.zeros((len(pieces), terms + 2))
        done = 0.0
        for n, piece in enumerate(pieces):
            force = piece.parts[0]
            self._force[n, : force.size] = force
            # dW = 2 q f dq with q = (t + offset)/scale
            product = np.convolve(force, [piece.offset, 1.0]) * (2.0 / piece.scale**2)
            work = np.concatenate(([0.0], product / np.arange(1, product.size + 1)))
            work[0] = done - horner(work, piece.scale * piece.start - piece.offset)
            self._work[n, : work.size] = work
            if n + 1 < len(pieces):
                done = float(horner(work, piece.scale * pieces[n + 1].start - piece.offset))

    def force(self, d: Array) -> Array:
        """Force at compressions."""
        return self._at(d, self._force)

    def work(self, d: Array) -> Array:
        """Integral of the force up to compressions."""
        return self._at(d, self._work)

    def _at(self, d: Array, coefficients: Array) -> Array:
        q = np.sqrt(d)
        k = np.searchsorted(self._starts, q, side="right") - 1
        return horner(coefficients.T[:, k], self._scale[k] * q - self._offset[k])


def _begins_as_hertz(force: Formula | Polynomial) -> bool:
    """Whether a branch is q^3, or q^3 and higher powers that make it stiffer."""
    if not isinstance(force, Polynomial):
        return False
    powers = np.asarray(force.coef, dtype=np.float64)
    return np.array_equal(powers[:4], HERTZ.coef) and bool((powers[4:] >= 0.0).all())


def horner(coefficients: Array, t: Array | float) -> Array:
    value = np.zeros_like(np.asarray(t))
    for c in coefficients[::-1]:
        value = value * t + c
    return value


def _check_rise(name: str, force: Formula, low: float, high: float, count: int) -> None:
    d = np.geomspace(low, high, count)
    values = _values(name, "loading force", force, d)
    for wrong in (~np.isfinite(values), values < 0.0):
        if wrong.any():
            n = int(np.argmax(wrong))
            _refuse(name, "loading force", values[n], d[n])
    falls = np.diff(values) <= 0.0
    if falls.any():
        at = d[int(np.argmax(falls))]
        reason = f"the loading force of {name!r} does not rise at {at:.6g} d_Y"
        raise ArgumentError("law", None, reason)


def check_yield(
    name: str, coefficient: float | None, loading: Sequence[Loading], unloading: Sequence[Unloading]
) -> None:
    """Refuse a law that would not begin to differ from Hertz's at yield."""
    starts = [branch.start for branch in loading[1:]]
    stiffer = bool(loading) and loading[0].force != HERTZ
    early = bool(unloading) and (unloading[0].start > 1.0 if stiffer else unloading[0].start != 1.0)
    if any(start < 1.0 for start in starts) or early:
        reason = (
            "has to follow Hertz's curve up to yield, 1 d_Y: no branch of loading but the first "
            "may begin before, and the first of unloading begins there"
        )
        raise ArgumentError("law", name, reason)
    if stiffer and coefficient is None:
        return
    if not (starts or unloading):
        right, needed = coefficient is None, "None: it never yields"
    else:
        right = coefficient is not None and 0.0 < coefficient < math.inf
        needed = "a positive number: the law yields"
    if not right:
        reason = f"yield_coefficient of {name!r} must be {needed}, got {coefficient}"
        raise ArgumentError("law", None, reason)


def _check_joints(name: str, curve: LoadingCurve, branches: Sequence[Unloading], error: float) -> None:
    """Refuse unloading curves that jump at yield or between branches: outcomes would jump too."""
    before: tuple[float, float] | None = None if curve.stiffer else (0.0, 0.0)
    for branch, end in _ends(branches, curve.end):
        dm = np.array([branch.start * (1.0 + 1e-9), end * (1.0 - 1e-9)])
        left, lost = (np.asarray(f(dm)) for f in _residual_and_loss(curve, branch))
        if before is None:  # a stiffer law has friction: any contact loses energy
            before = float(left[0]), float(lost[0])
        for what, value, last, scale in (
            ("residual compression", left, before[0], branch.start),
            ("loss", lost, before[1], float(curve.work(dm)[0])),
        ):
            if not abs(value[0] - last) <= max(1e-6, error) * scale:
                jump = f"at {branch.start:.9g} d_Y, from {last:.6g} to {value[0]:.6g}"
                raise ArgumentError("law", name, f"its {what} jumps {jump}")
        before = float(left[1]), float(lost[1])


def _over_root(force: Formula) -> Formula:
    """Turn a function of d into one of the root compression."""
    return lambda q: force(q * q)


def _ends(branches: Sequence[Any], last: float) -> list[tuple[Any, float]]:
    """Pair branches with the compressions at which they end; refuse branches out of order."""
    starts = [branch.start for branch in branches]
    if any(not low < high for low, high in itertools.pairwise([*starts, last])):
        reason = f"branches have to begin one after the other, below {last:g} d_Y"
        raise ArgumentError("law", None, reason)
    return list(zip(branches, [*starts[1:], last], strict=True)) if starts else []


@dataclass(frozen=True, eq=False)
class _Row:
    """A piece of the unloading family: functions in the order of `equation.force`."""

    piece: _Piece
    powers: tuple[float, ...]
    other: bool  # whether some of the loss is not plastic work


def _residual_and_loss(curve: LoadingCurve, branch: Unloading) -> tuple[Formula, Formula]:
    """Residual compression and loss of a branch, multiplied by their powers of dm - 1."""
    exponent, given = branch.exponent, branch.loss

    def residual(dm: Array) -> Array:
        return branch.residual(dm) * (dm - 1.0) ** branch.order

    def difference(dm: Array) -> Array:
        n = exponent(dm) if callable(exponent) else exponent
        return curve.work(dm) - curve.force(dm) * (dm - residual(dm)) / (n + 1.0)

    if given is None:
        return residual, difference
    return residual, lambda dm: given(dm) * (dm - 1.0) ** branch.loss_order


def _unloading_rows(
    name: str, curve: LoadingCurve, branch: Unloading, end: float, resolution: Resolution
) -> list[_Row]:
    exponent = branch.exponent
    residual, loss = _residual_and_loss(curve, branch)
    some = np.geomspace(branch.start * (1.0 + 1e-9), end, 200 if resolution.checked else 0)
    deep = _values(name, "residual compression", residual, some) >= some
    if deep.any():
        at = some[int(np.argmax(deep))]
        reason = f"its residual compression is not below the largest one at {at:.6g} d_Y"
        raise ArgumentError("law", name, reason)

    # Sizes to which the expansion is accurate: for a residual, the span dm - dr keeps its digits;
    # for a loss, the loss itself. Rounding does not allow less than 0.05 of dm and of the work.
    def smaller(dm: Array) -> Array:
        return branch.residual(dm) * np.clip(1.0 - residual(dm) / dm, 0.05, 1.0)

    def lost(dm: Array) -> Array:
        work = curve.work(dm)
        return np.clip(loss(dm), 0.05 * work, 0.2 * work)

    parts: list[_Function | float] = [
        _Function("residual compression", branch.residual, smaller if branch.order else np.positive)
    ]
    parts.append(_Function("exponent", lambda dm: 2.0 * exponent(dm)) if callable(exponent) else 2.0 * exponent)
    if branch.loss is None:
        parts.append(_Function("loss", loss, lost))
    else:
        # divided by its power of dm - 1, a loss does not vanish and is its own size
        parts.append(_Function("loss", branch.loss, None if branch.loss_order else lost))
    parts.append(0.0 if branch.other is None else _Function("other loss", branch.other, lost))
    powers = (branch.order, 0.0, branch.loss_order, 0.0)
    # the loss has kinks where the loading curve has them
    inner = [kink for kink in curve.kinks if branch.start < kink < end]
    return [
        _Row(piece, powers, branch.other is not None)
        for ends in itertools.pairwise([branch.start, *inner, end])
        for piece in _expand(name, parts, *ends, resolution)
    ]


def _beyond(curve: LoadingCurve, last: _Row) -> _Row:
    """Row beyond the end: residual in proportion to dm, same exponent, loss from the works."""
    piece, end = last.piece, curve.end
    values = [horner(part, piece.scale * end - piece.offset) for part in piece.parts]
    share = float(values[_force.RESIDUAL]) * (end - 1.0) ** last.powers[_force.RESIDUAL] / end
    exponent = float(values[_force.EXPONENT])
    force, slope, work = curve.tangent
    at_zero = force - slope * end
    up = np.array([work - at_zero * end - 0.5 * slope * end**2, at_zero, 0.5 * slope])
    down = np.array([0.0, at_zero, slope]) * (2.0 * (1.0 - share) / (exponent + 2.0))
    # plastic work stays the same share of the loading work
    lost = float(values[_force.LOSS]) * (end - 1.0) ** last.powers[_force.LOSS]
    other = up - down - (lost - float(values[_force.OTHER])) / work * up
    if not last.other:
        other = np.zeros(1)
    parts = [np.array([0.0, share]), np.array([exponent]), up - down, other]
    return _Row(_Piece(end, 1.0, 0.0, parts), (0.0,) * len(parts), last.other)


class Expanded(NamedTuple):
    """A law in pieces."""

    curve: LoadingCurve
    rows: list[_Row]  # of the unloading curves


def expanded(
    name: str, loading: Sequence[Loading], unloading: Sequence[Unloading], end: float, resolution: Resolution
) -> Expanded:
    """Expand the formulas of a law."""
    curve = LoadingCurve(name, loading, bool(unloading), end, resolution)
    rows = [row for branch in _ends(unloading, curve.end) for row in _unloading_rows(name, curve, *branch, resolution)]
    if resolution.checked:
        _check_joints(name, curve, unloading, 1e3 * resolution.vanished)
    if rows:
        rows.append(_beyond(curve, rows[-1]))
    return Expanded(curve, rows)


def packed(law: Expanded) -> Array:
    """Lay out a law in pieces as one array, see `contactlaw.equation.force`."""
    curve, rows = law.curve, law.rows
    pieces = curve.pieces
    # A function has one length on all pieces: the processor predicts loops of constant length.
    lengths = [max((row.piece.parts[n].size for row in rows), default=0) for n in range(_force.FUNCTIONS)]
    starts = [*(piece.start for piece in pieces), math.inf]
    family_starts = [*(row.piece.start for row in rows), math.inf]
    starts_at = _force.HEADER
    curve_at = starts_at + len(starts)
    family_starts_at = curve_at + len(pieces) * _force.PIECE
    family_at = family_starts_at + len(family_starts)
    at = family_at + len(rows) * _force.UNLOADING_ROW
    header = [len(pieces), len(rows), starts_at, curve_at, family_starts_at, family_at]
    coefficients: list[Array] = []

    def put(part: Array, length: int) -> list[float]:
        nonlocal at
        room = np.zeros(length + -length % 4)  # np.pad takes ten times as long
        room[: part.size] = part
        coefficients.append(room)
        at += room.size
        return [length - 1, at - room.size]

    curve_rows: list[float] = []
    for piece, first in zip(pieces, curve.first_of_branch, strict=True):
        following = next((k for k in curve.first_of_branch if k > first), len(pieces))
        entries = put(piece.parts[0], piece.parts[0].size)
        curve_rows += [piece.scale, piece.offset, *entries, first, following]
    family_rows: list[float] = []
    for row in rows:
        family_rows += [row.piece.scale, row.piece.offset]
        for power, part, length in zip(row.powers, row.piece.parts, lengths, strict=True):
            family_rows += [power, *put(part, length)]
    numbers = [*header, *starts, *curve_rows, *family_starts, *family_rows]
    return np.concatenate([np.array(numbers, dtype=np.float64), *coefficients])
