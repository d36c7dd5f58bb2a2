"""From the formulas of a law to the array that kernels read, see `contactlaw.equation.force`.

Formulas become piecewise polynomials that agree with them to 1e-13: they are expanded in Chebyshev
polynomials on pieces that are halved until the last terms vanish. A `numpy.polynomial.Polynomial`
is used without expansion.
"""

import itertools
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import Polynomial, chebyshev

from contactlaw._arrays import Array, Mask
from contactlaw._errors import ArgumentError
from contactlaw.equation import force as _force
from contactlaw.laws._branches import HERTZ, Formula, Loading, Unloading, once

_TERMS = 18  # Chebyshev terms per piece
_ROUNDING = 1e-13  # a value may be negative by this share of its size, from rounding
_MOST_PIECES = 400  # per branch; a formula that needs more is not smooth
_NODES = np.cos(math.pi * (np.arange(_TERMS) + 0.5) / _TERMS)
# values at the nodes -> coefficients of Chebyshev polynomials -> of powers
_TO_CHEBYSHEV = chebyshev.chebvander(_NODES, _TERMS - 1) * 2.0 / _TERMS
_TO_CHEBYSHEV[:, 0] *= 0.5
_TO_POWERS = np.array([np.pad(chebyshev.cheb2poly(e), (0, _TERMS))[:_TERMS] for e in np.eye(_TERMS)])


class Resolution(NamedTuple):
    """How finely the formulas of a law are expanded."""

    vanished: float = 2e-14  # a term counts as zero below this share of the least value on its piece
    widest: float = 1.7  # largest ratio of the ends of a piece, before any is halved


class _Piece(NamedTuple):
    """Polynomials over one piece of a line, in t = scale x - offset."""

    start: float
    scale: float
    offset: float
    parts: list[Array]
    powers: Sequence[float] = ()  # of dm - 1, which multiply the parts of unloading curves


class _Function(NamedTuple):
    """A function to expand, its name in messages, and the size that its error is relative to."""

    what: str
    function: Formula
    size: Formula | None = None  # None: its own values


def _expand(
    name: str, parts: Sequence[_Function], low: float, high: float, resolution: Resolution, powers: Sequence[float] = ()
) -> list[_Piece]:
    """Expand functions on [low, high], all on the same pieces."""
    count = max(1, math.ceil(math.log(high / low) / math.log(resolution.widest)))
    edges = low * np.power(high / low, np.linspace(0.0, 1.0, count + 1))
    edges[[0, -1]] = low, high
    todo, done = list(itertools.pairwise(edges.tolist())), []
    while todo:
        left, right = np.array(todo).T
        middle, half = 0.5 * (left + right), 0.5 * (right - left)
        at = middle[:, None] + half[:, None] * _NODES
        rows, converged = zip(*(_powers(name, part, at, resolution.vanished) for part in parts), strict=True)
        smooth = np.all(converged, axis=0)
        for n in np.flatnonzero(smooth):
            done.append(_Piece(left[n], 1.0 / half[n], middle[n] / half[n], [part[n] for part in rows], powers))
        todo = [ends for n in np.flatnonzero(~smooth) for ends in ((left[n], middle[n]), (middle[n], right[n]))]
        if len(todo) + len(done) > _MOST_PIECES:
            near = f"{todo[0][0]:.6g} d_Y"
            reason = f"it is not smooth near {near}; give each kink a branch that begins there"
            raise ArgumentError("law", name, reason)
    return sorted(done)  # by their starts


def _powers(name: str, part: _Function, at: Array, vanished: float) -> tuple[Array, Mask]:
    """Coefficients of powers of t for rows of values, and which rows have converged."""
    values, size = _values(name, part, at)
    level = values[:, :1]  # subtracted, so that rounding is relative to the values' variation
    terms = (values - level) @ _TO_CHEBYSHEV
    terms[:, :1] += level
    small = np.abs(terms) <= vanished * size.min(axis=1, keepdims=True)
    kept = np.cumsum(~small[:, ::-1], axis=1)[:, ::-1] > 0  # up to the last that is not small
    return (terms * kept) @ _TO_POWERS, small[:, -2:].all(axis=1)


def _values(name: str, part: _Function, at: Array) -> tuple[Array, Array]:
    """Evaluate a user's formula, and its size; refuse one that does not take arrays or is no law's."""
    with np.errstate(all="ignore"):
        try:
            values = np.broadcast_to(np.asarray(part.function(at), dtype=np.float64), at.shape)
        except (TypeError, ValueError) as error:
            rule = "an array, as numpy's functions do, and return one number for each element"
            reason = f"its {part.what} has to take {rule}; it raised: {error}"
            raise ArgumentError("law", name, reason) from error
    size = np.abs(values) if part.size is None else part.size(at)
    wrong = ~(np.isfinite(values) & (values >= -_ROUNDING * size))
    if wrong.any():
        value, place = values[wrong][0], at[wrong][0]
        gain = "; a loop would gain energy" if part.what == "loss" and value < 0.0 else ""
        reason = f"its {part.what} is {value:.6g} at {place:.6g} d_Y: must be finite, >= 0; a force has to rise{gain}"
        raise ArgumentError("law", name, reason)
    return values, size


class LoadingCurve:
    """The loading curve in pieces, and force and work at any compressions."""

    def __init__(self, name: str, branches: Sequence[Loading], end: float, resolution: Resolution) -> None:
        self.branches, self.end = branches, end
        self.pieces: list[_Piece] = []
        self.kinks: list[int] = []  # first piece of each branch, and the number of all pieces
        for branch, stop in ends(branches, end):
            self.kinks.append(len(self.pieces))
            if isinstance(branch.force, Polynomial):
                self.pieces.append(
                    _Piece(math.sqrt(branch.start), 1.0, 0.0, [np.asarray(branch.force.coef, dtype=np.float64)])
                )
            else:
                part = [_Function("loading force", _over_root(branch.force))]
                self.pieces += _expand(name, part, math.sqrt(branch.start), math.sqrt(stop), resolution)
        self.kinks.append(len(self.pieces))
        terms = max(piece.parts[0].size for piece in self.pieces)
        self._work = np.zeros((len(self.pieces), terms + 2))
        starts, self._scale, self._offset = np.array([piece[:3] for piece in self.pieces]).T
        self._starts, done = starts, 0.0
        for n, (piece, stop) in enumerate(zip(self.pieces, [*starts[1:], math.sqrt(end)], strict=True)):
            force = Polynomial(piece.parts[0])
            # dW = 2 q f dq with q = (t + offset)/scale
            rate = force * Polynomial([piece.offset, 1.0]) * (2.0 / piece.scale**2)
            work = rate.integ(lbnd=piece.scale * piece.start - piece.offset, k=done)
            done = work(piece.scale * stop - piece.offset)
            self._work[n, : work.coef.size] = work.coef

    def force(self, d: Array) -> Array:
        """Force at compressions, by the formulas: pieces would meet with small jumps."""
        k, force = np.searchsorted([branch.start for branch in self.branches], d, side="right") - 1, np.empty_like(d)
        for n in np.unique(k):
            force[k == n] = self.branches[n].at(d[k == n])
        return force

    def work(self, d: Array) -> Array:
        """Integral of the force up to compressions."""
        q = np.sqrt(d)
        k = np.searchsorted(self._starts, q, side="right") - 1
        t, value = self._scale[k] * q - self._offset[k], np.zeros_like(q)
        for c in self._work.T[::-1]:
            value = value * t + c[k]
        return value


def _over_root(force: Formula) -> Formula:
    """Turn a function of d into one of the root compression."""
    return lambda q: force(q * q)


def ends(branches: Sequence[Any], last: float) -> list[tuple[Any, float]]:
    """Pair branches with the compressions at which they end; refuse branches out of order."""
    starts = [branch.start for branch in branches]
    if any(not low < high for low, high in itertools.pairwise([*starts, last])):
        reason = f"branches have to begin one after the other, below {last:g} d_Y"
        raise ArgumentError("law", None, reason)
    return list(zip(branches, [*starts[1:], last], strict=False))  # no branch, no end


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


def check_formulas(name: str, loading: Sequence[Loading], unloading: Sequence[Unloading], end: float) -> None:
    """Refuse a loading curve that does not begin as Hertz's, falls or jumps, and too large residuals."""
    first = loading[0].force if loading and loading[0].start == 0.0 else None
    powers: Any = first.coef if isinstance(first, Polynomial) else np.zeros(4)
    if not np.array_equal(powers[:4], HERTZ.coef) or (powers[4:] < 0.0).any():
        forms = "a polynomial, HERTZ or HERTZ plus higher powers that make it stiffer"
        raise ArgumentError("law", name, f"its first branch has to begin at 0 with {forms}")
    before = 0.0
    for branch, stop in ends(loading, end):
        d = np.geomspace(max(branch.start, 1e-3), stop, 1000)
        force, _ = _values(name, _Function("loading force", branch.at), d)
        if branch.start and not abs(force[0] - before) <= 1e-9 * before:
            jump = f"{branch.start:.9g} d_Y: {before:.9g} and {force[0]:.9g} F_Y"
            raise ArgumentError("law", name, f"its loading branches do not meet at {jump}")
        falls = np.diff(force) <= 0.0
        if falls.any():
            reason = f"the loading force of {name!r} does not rise at {d[np.argmax(falls)]:.6g} d_Y"
            raise ArgumentError("law", None, reason)
        before = force[-1]
    for flow, stop in ends(unloading, end):
        dm = np.geomspace(flow.start * (1.0 + 1e-9), stop, 200)
        residual, _ = _values(name, _Function("residual compression", flow.residual), dm)
        deep = residual * (dm - 1.0) ** flow.order >= dm
        if deep.any():
            reason = f"its residual compression is not below the largest one at {dm[np.argmax(deep)]:.6g} d_Y"
            raise ArgumentError("law", name, reason)


def check_unloading(name: str, curve: LoadingCurve, branches: Sequence[Unloading]) -> None:
    """Refuse unloading curves that jump at yield or between branches, as outcomes would; and a wrong `loss`."""
    before: Any = (0.0, 0.0) if curve.branches[0].force == HERTZ else None
    for branch, stop in ends(branches, curve.end):
        dm = np.geomspace(branch.start * (1.0 + 1e-9), stop * (1.0 - 1e-9), 9)
        contacts = _Contacts(curve, branch)
        values = contacts.residual(dm), contacts.loss(dm)
        if before is None:  # a stiffer law has friction: any contact loses energy
            before = values[0][0], values[1][0]
        work = curve.work(dm)
        if branch.loss and not np.allclose(
            branch.loss(dm) * (dm - 1.0) ** branch.loss_order, values[1], 0.0, 1e-6 * work
        ):
            raise ArgumentError("law", name, "its loss is not the work of loading minus that of unloading")
        scales = dm[0], work[0]
        for what, value, last, scale in zip(("residual compression", "loss"), values, before, scales, strict=True):
            if not abs(value[0] - last) <= 1e-6 * scale:
                jump = f"at {branch.start:.9g} d_Y, from {last:.6g} to {value[0]:.6g}"
                raise ArgumentError("law", name, f"its {what} jumps {jump}")
        before = values[0][-1], values[1][-1]


class _Contacts:
    """Contacts of one branch, as its formulas have them, for arrays of largest compressions."""

    def __init__(self, curve: LoadingCurve, branch: Unloading) -> None:
        # divided: the residual compression over (dm - 1)^order
        self.curve, self.branch, self.divided = curve, branch, once(branch.residual)
        self.work, self.loss = once(curve.work), once(self._loss)

    def residual(self, dm: Array) -> Array:
        return self.divided(dm) * (dm - 1.0) ** self.branch.order

    def exponent(self, dm: Array) -> Array:
        exponent, recovery = self.branch.exponent, self.branch.recovery
        if recovery is not None:
            return self._over_work(dm) / recovery(dm) - 1.0
        return exponent(dm) if callable(exponent) else np.full_like(dm, exponent)

    def _loss(self, dm: Array) -> Array:
        recovery = self.branch.recovery
        share = recovery(dm) if recovery is not None else self._over_work(dm) / (self.exponent(dm) + 1.0)
        return (1.0 - share) * self.work(dm)

    def _over_work(self, dm: Array) -> Array:
        """Force times the compression that is given back, over the loading work."""
        return self.curve.force(dm) * (dm - self.residual(dm)) / self.work(dm)

    def rows(self, name: str, edges: Sequence[float], resolution: Resolution) -> list[_Piece]:
        """Pieces of the unloading curves."""
        branch = self.branch

        # Sizes to which the expansion is accurate: for a residual, the span dm - dr keeps its digits;
        # for a loss, the loss itself; for an exponent, what rounding of the span leaves. Rounding does
        # not allow less than 0.05 of dm and of the work.
        def smaller(dm: Array) -> Array:
            return self.divided(dm) * np.clip(1.0 - self.residual(dm) / dm, 0.05, 1.0)

        def lost(dm: Array) -> Array:
            work = self.work(dm)
            return np.clip(self.loss(dm), 0.05 * work, 0.2 * work)

        def per_span(dm: Array) -> Array:
            return 2.0 * dm / (dm - self.residual(dm))

        other = branch.other or np.zeros_like
        parts = [
            _Function("residual compression", self.divided, smaller if branch.order else np.positive),
            _Function("exponent", lambda dm: 2.0 * self.exponent(dm), branch.recovery and per_span),
            # divided by its power of dm - 1, a loss does not vanish and is its own size
            _Function("loss", branch.loss or self.loss, None if branch.loss_order else lost),
            _Function("other loss", lambda dm: other(dm) * self.work(dm), lost),
        ]
        powers = (branch.order, 0.0, branch.loss_order, 0.0)
        return [
            row
            for low, high in itertools.pairwise(edges)
            for row in _expand(name, parts, low, high, resolution, powers)
        ]


def expanded(
    name: str, loading: Sequence[Loading], unloading: Sequence[Unloading], end: float, resolution: Resolution
) -> tuple[LoadingCurve, list[_Piece]]:
    """Expand the formulas of a law: the loading curve, and pieces of the unloading curves."""
    curve, rows = LoadingCurve(name, loading, end, resolution), list[_Piece]()
    for branch, stop in ends(unloading, end):
        # the loss has kinks where the loading curve has them
        kinks = [above.start for above in loading if branch.start < above.start < stop]
        rows += _Contacts(curve, branch).rows(name, [branch.start, *kinks, stop], resolution)
    return curve, rows


def packed(curve: LoadingCurve, rows: Sequence[_Piece]) -> Array:
    """Lay out a law in pieces as one array, see `contactlaw.equation.force`."""
    pieces = curve.pieces
    starts = [*(piece.start for piece in pieces), math.inf]
    family_starts = [*(row.start for row in rows), curve.end if rows else math.inf]
    sizes = len(starts), len(pieces) * _force.PIECE, len(family_starts), len(rows) * _force.UNLOADING_ROW
    *places, at = itertools.accumulate(sizes, initial=_force.HEADER)
    coefficients: list[Array] = []

    def put(part: Array, length: int) -> list[float]:
        nonlocal at
        room = np.zeros(length + -length % 4)  # np.pad takes ten times as long
        room[:length] = part[:length]
        coefficients.append(room)
        at += room.size
        return [length - 1, at - room.size]

    curve_rows: list[float] = []
    for first, following in itertools.pairwise(curve.kinks):
        for piece in pieces[first:following]:
            entries = put(piece.parts[0], _length(piece.parts[0]))
            curve_rows += [piece.scale, piece.offset, *entries, first, following]
    # A function has one length on all pieces: the processor predicts loops of constant length.
    lengths = [max(map(_length, parts)) for parts in zip(*(row.parts for row in rows), strict=True)]
    family_rows: list[float] = []
    for row in rows:
        family_rows += [row.scale, row.offset]
        for power, part, length in zip(row.powers, row.parts, lengths, strict=True):
            family_rows += [power, *put(part, length)]
    numbers = [len(pieces), len(rows), *places, *starts, *curve_rows, *family_starts, *family_rows]
    return np.concatenate([np.array(numbers, dtype=np.float64), *coefficients])


def _length(part: Array) -> int:
    """Count the coefficients up to the last that is not zero, at least one."""
    return 1 + int(np.flatnonzero(part).max(initial=0))
