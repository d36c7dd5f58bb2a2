"""What a force law is: formulas on one side, the array that kernels read on the other.

`Law.of` turns formulas, plain numpy functions between kinks, into piecewise polynomials that hold
them to 1e-13. A formula is expanded in Chebyshev polynomials on pieces that are halved until the
last terms vanish; a `numpy.polynomial.Polynomial` is taken as it is.
"""

from __future__ import annotations

import functools
import hashlib
import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.polynomial import Polynomial, chebyshev
from numpy.typing import NDArray

from contactlaw.equation import force as _force
from contactlaw.equation.force import Curve

Array = NDArray[np.float64]
Formula = Callable[[Array], Array]

END = 1e5  # [d_Y]; beyond, a law goes on by its tangent, see `Law.of`
HERTZ = Polynomial([0.0, 0.0, 0.0, 1.0])  # F = q^3
_FUNCTIONS = _force.FUNCTIONS
_TERMS = 18  # Chebyshev terms of a piece
_WIDEST = 1.7  # ratio of the ends of a piece at first
_VANISHED = 2e-14  # a term, relatively to the least value on its piece
_ROUNDING = 1e-13  # of its size, by which a value may fall below zero
_CORNER = 1e-4  # relative jump of a slope; differences err by 1e-8 of it
_MOST_PIECES = 400  # of one branch; a formula that needs more is not smooth
_NODES = np.cos(math.pi * (np.arange(_TERMS) + 0.5) / _TERMS)
# values at the nodes -> coefficients of Chebyshev polynomials -> of powers
_TO_CHEBYSHEV = chebyshev.chebvander(_NODES, _TERMS - 1) * 2.0 / _TERMS
_TO_CHEBYSHEV[:, 0] *= 0.5
_TO_POWERS = np.array(
    [np.pad(chebyshev.cheb2poly(e), (0, _TERMS))[:_TERMS] for e in np.eye(_TERMS)]
)


@dataclass(frozen=True)
class Loading:
    """A branch of the loading curve, smooth from its start to that of the next one.

    Parameters
    ----------
    start : float
        Compression at which it begins [d_Y]; 0 for the first.
    force : callable or Polynomial
        Force [F_Y]: a function of arrays of the compression [d_Y], or a polynomial in the *root*
        compression, whose first branch is Hertz's `HERTZ`, q^3.
    """

    start: float
    force: Formula | Polynomial


@dataclass(frozen=True)
class Unloading:
    """A branch of the family of unloading curves, smooth from its start to that of the next one.

    Parameters
    ----------
    start : float
        Largest compression at which it begins [d_Y]. Below the first branch the contact is elastic.
    residual : callable
        Compression left after unloading from dm, over (dm - 1)^order [d_Y].
    exponent : callable or float, optional
        n in F = Fm ((d - dr)/(dm - dr))^n; 1.5 is Hertz's.
    loss : callable, optional
        Loading work less unloading work over (dm - 1)^loss_order [F_Y d_Y], where the difference
        of the two would lose its digits.
    order, loss_order : float, optional
        How residual and loss begin at dm = 1; 2 for most laws. With 0 no factor is taken out, and
        the law follows them to 1e-13 of dm and of the loading work.
    cap : tuple of callable, optional
        Compressions, lower and upper, between which the way back is the loading curve, which is
        lower there than the unloading curve; the upper one is None if that is so from dm on.
    """

    start: float
    residual: Formula
    exponent: Formula | float = 1.5
    loss: Formula | None = None
    order: float = 0.0
    loss_order: float = 0.0
    cap: tuple[Formula, Formula | None] | None = None


@dataclass(frozen=True, eq=False)
class Law:
    """A normal force law, as data: see `contactlaw.equation.force` for the array's layout.

    Two laws are equal if their data and the coefficient of their yield compression are.

    Parameters
    ----------
    name : str
        What users call it, with its numbers in brackets.
    source : str
        Where the formulas come from.
    yield_coefficient : float or None
        c in d_Y = c pi^2 sigma_Y^2 R* / E*^2; None for a law that never yields.
    loading_kinks : tuple of float
        Compressions [d_Y], rising, at which the loading curve changes its formula.
    outcome_kinks : tuple of float
        All largest compressions [d_Y], rising, at which an impact's outcome is not smooth; the
        first is 1, that of yield. None for a law that never yields.
    data : ndarray of float64
        The law itself.
    yield_strains : tuple of float, optional
        Least and largest sigma_Y/E of a sphere for which finite elements favour the law once it has
        yielded well.
    from_pair : tuple of str, optional
        Names of the numbers, beside d_Y, that the pair of materials has given it.
    """

    name: str
    source: str
    yield_coefficient: float | None
    loading_kinks: tuple[float, ...]
    outcome_kinks: tuple[float, ...]
    data: Array
    yield_strains: tuple[float, float] = (0.0, math.inf)
    from_pair: tuple[str, ...] = ()

    @staticmethod
    def of(
        *,
        name: str,
        source: str,
        yield_coefficient: float | None,
        loading: Sequence[Loading],
        unloading: Sequence[Unloading] = (),
        yield_strains: tuple[float, float] = (0.0, math.inf),
    ) -> Law:
        """Make a law from its formulas.

        Parameters
        ----------
        name, source, yield_coefficient, yield_strains
            As of `Law`.
        loading : sequence of Loading
            Branches of the loading curve. They have to meet, and to rise.
        unloading : sequence of Unloading, optional
            Branches of the unloading curves. Without any the law is elastic.

        Returns
        -------
        Law
            It follows the formulas to 1e-12, relatively, up to a compression of 1e5 d_Y. Beyond,
            the force goes on along its tangent over the compression, the residual compression keeps
            its share of the largest one, and the exponent its value.

        Raises
        ------
        ValueError
            If a formula gives what is no positive finite number, is not smooth between its kinks,
            branches do not meet, a loop would gain energy, or the law does not follow Hertz's curve
            up to yield; the message says where.

        Examples
        --------
        A sphere whose pressure is cut off at yield, and which comes back as Hertz's:

        >>> import contactlaw as cl
        >>> from contactlaw.laws import HERTZ, Law, Loading, Unloading
        >>> law = Law.of(
        ...     name="cut off",
        ...     source="an example",
        ...     yield_coefficient=0.68,
        ...     loading=[Loading(0.0, HERTZ), Loading(1.0, lambda d: 1.5 * d - 0.5)],
        ...     unloading=[Unloading(1.0, residual=lambda dm: (dm - 1.0) ** 2 / dm)],
        ... )
        >>> round(law.loading(2.0), 4), round(law.residual(3.0), 4)
        (5.5, 1.3333)
        """
        _check_yield(name, yield_coefficient, loading, unloading)
        curve = _LoadingCurve(name, loading, bool(unloading))
        rows = [row for branch in _ends(unloading) for row in _unloading_rows(name, curve, *branch)]
        _check_joints(name, curve, unloading)
        if rows:
            rows.append(_beyond(curve, rows[-1]))
        return Law(
            name=name,
            source=source,
            yield_coefficient=yield_coefficient,
            loading_kinks=curve.kinks,
            outcome_kinks=tuple(
                sorted({*curve.kinks, *(float(branch.start) for branch in unloading)})
            ),
            data=_packed(curve, rows, any(branch.cap for branch in unloading)),
            yield_strains=yield_strains,
        )

    @property
    def family(self) -> str:
        """Name without the numbers."""
        return self.name.partition("(")[0]

    @property
    def yields(self) -> bool:
        """Whether there is a compression from which the sphere yields."""
        return bool(self.outcome_kinks)

    @property
    def capped(self) -> bool:
        """Whether the way back is in part the loading curve, see `Unloading`."""
        return bool(self.data[_force.CAPPED])

    @functools.cached_property
    def key(self) -> str:
        """Hash of the data: what tables are kept by."""
        return hashlib.sha256(self.data.tobytes()).hexdigest()[:16]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Law):
            return NotImplemented
        return (self.key, self.yield_coefficient) == (other.key, other.yield_coefficient)

    def __hash__(self) -> int:
        return hash((self.key, self.yield_coefficient))

    def follows(self, other: Law) -> bool:
        """Whether another law is this one, but for rounding; without a kernel to compile."""
        mine, theirs = self._samples(), other._samples()
        return len(mine) == len(theirs) and bool(np.allclose(mine, theirs, rtol=1e-11, atol=1e-14))

    def _samples(self) -> list[float]:
        """Numbers that tell laws apart."""
        values = [*self.loading_kinks, *self.outcome_kinks]
        for d in (*self.outcome_kinks, *np.geomspace(0.5, 1e4, 25).tolist()):
            values += [_sample(self.data, math.sqrt(d), family=False)[0]]
            values += _sample(self.data, d, family=True)
        return values

    def has_corner(self, kink: float) -> bool:
        """Whether the slope of the loading curve jumps at one of its kinks."""
        q, h = math.sqrt(kink), 1e-4
        force = [_sample(self.data, q + n * h, family=False)[0] for n in (-2, -1, 0, 1, 2)]
        before = 3.0 * force[2] - 4.0 * force[1] + force[0]
        after = -3.0 * force[2] + 4.0 * force[3] - force[4]
        return abs(after - before) > _CORNER * before

    def loading(self, q: float) -> float:
        """Force [F_Y] at the compression q^2 [d_Y] while it grows."""
        return _force.loading(self.data, q)

    def residual(self, dm: float) -> float:
        """Compression [d_Y] left after unloading from the largest one, dm."""
        return _force.residual(self.data, dm)

    def unloading_curve(self, dm: float) -> Curve:
        """Find the unloading curve from dm."""
        return _force.unloading(self.data, dm)

    def unloading(self, q: float, curve: Curve) -> float:
        """Force [F_Y] at d = residual(dm) + q^2 below dm; reloading follows the same curve."""
        return _force.unloading_force(self.data, curve, q)

    def dissipation(self, dm: float) -> float:
        """Subtract unloading work from loading work [F_Y d_Y], of a contact that reached dm."""
        return _force.loss(self.data, dm)


def _sample(data: Array, x: float, *, family: bool) -> list[float]:
    """Polynomials of a law's data at one place, of its loading curve or its unloading family."""
    starts_at, rows_at, count, length = (
        (_force.FAMILY_STARTS, _force.FAMILY, _force.UNLOADINGS, _force.UNLOADING_ROW)
        if family
        else (_force.STARTS, _force.CURVE, _force.PIECES, _force.PIECE)
    )
    starts = data[int(data[starts_at]) :][: int(data[count])]
    k = int(np.searchsorted(starts, x, side="right")) - 1
    if k < 0:
        return []
    row = data[int(data[rows_at]) + k * length :][:length]
    t = row[_force.SCALE] * x - row[_force.OFFSET]
    entries = (
        row[_force.OFFSET + 1 :].reshape(-1, 3)[:, 1:]
        if family
        else row[[_force.DEGREE, _force.AT]][None]
    )
    return [float(_horner(data[int(at) : int(at + degree) + 1], t)) for degree, at in entries]


@dataclass(frozen=True, eq=False)
class _Piece:
    """Polynomials over one piece of a line, in t = scale x - offset."""

    start: float
    scale: float
    offset: float
    parts: list[Array]


@dataclass(frozen=True)
class _Part:
    """A function to be expanded, what it is, and the size of what it was computed from."""

    what: str
    function: Formula
    size: Formula | None = None


def _expand(name: str, parts: Sequence[_Part | float], low: float, high: float) -> list[_Piece]:
    """Polynomials for some functions on [low, high], all on the same pieces; numbers stay exact."""
    count = max(1, math.ceil(math.log(high / low) / math.log(_WIDEST)))
    edges = np.geomspace(low, high, count + 1)
    edges[[0, -1]] = low, high
    todo, done = list(itertools.pairwise(edges.tolist())), []
    while todo:
        left, right = np.array(todo).T
        middle, half = 0.5 * (left + right), 0.5 * (right - left)
        at = middle[:, None] + half[:, None] * _NODES
        found = [_powers(name, part, at) for part in parts]
        smooth = np.all([converged for _, converged in found], axis=0)
        for n in np.flatnonzero(smooth):
            powers = [np.trim_zeros(rows[n], "b") for rows, _ in found]
            coefficients = [row if row.size else np.zeros(1) for row in powers]
            done.append(_Piece(left[n], 1.0 / half[n], middle[n] / half[n], coefficients))
        todo = [
            ends for n in np.flatnonzero(~smooth)
            for ends in ((left[n], middle[n]), (middle[n], right[n]))
        ]  # fmt: skip
        if len(todo) + len(done) > _MOST_PIECES:
            raise ValueError(
                f"law: {name!r} is not smooth near {todo[0][0]:.6g} d_Y; give each kink a branch "
                "that begins there"
            )
    return sorted(done, key=lambda piece: piece.start)


def _powers(name: str, part: _Part | float, at: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Coefficients of powers of t for rows of values, and which rows have converged."""
    if isinstance(part, float):
        return np.full((len(at), 1), part), np.ones(len(at), dtype=bool)
    values = _values(name, part.what, part.function, at)
    size = np.abs(values) if part.size is None else part.size(at)
    wrong = ~(np.isfinite(values) & (values >= -_ROUNDING * size))
    if wrong.any():
        n = int(np.argmax(wrong))
        _refuse(name, part.what, values.flat[n], at.flat[n])
    level = values[:, :1]  # without it the sums round by what the values vary, not by their size
    terms = (values - level) @ _TO_CHEBYSHEV
    terms[:, :1] += level
    small = np.abs(terms) <= _VANISHED * size.min(axis=1, keepdims=True)
    kept = np.cumsum(~small[:, ::-1], axis=1)[:, ::-1] > 0  # up to the last that counts
    return (terms * kept) @ _TO_POWERS, small[:, -2:].all(axis=1)


def _refuse(name: str, what: str, value: float, at: float) -> NoReturn:
    gain = "; a loop would gain energy" if what == "loss" and value < 0.0 else ""
    raise ValueError(
        f"law: the {what} of {name!r} is {value:.6g} at {at:.6g} d_Y and has to be finite and not "
        f"negative{gain}"
    )


def _values(name: str, what: str, function: Formula, at: Array) -> Array:
    """Values of a user's formula."""
    with np.errstate(all="ignore"):
        try:
            return np.broadcast_to(np.asarray(function(at), dtype=np.float64), at.shape)
        except (TypeError, ValueError) as error:
            raise ValueError(
                f"law: the {what} of {name!r} has to take an array, as numpy's functions do, and "
                f"give one number for each of its; it says: {error}"
            ) from error


class _LoadingCurve:
    """The loading curve in pieces, with force and work at any compressions."""

    def __init__(self, name: str, branches: Sequence[Loading], yields: bool) -> None:
        if not branches or branches[0].start != 0.0 or branches[0].force != HERTZ:
            raise ValueError(
                f"law: the first branch of {name!r} has to begin at 0 with a polynomial, HERTZ"
            )
        self.kinks = tuple(float(branch.start) for branch in branches[1:])
        self.pieces: list[_Piece] = []
        self.first: list[int] = []  # piece at the last kink, of each piece
        ends = _ends(branches)
        for branch, end in ends:
            first = len(self.pieces)
            force = branch.force
            if isinstance(force, Polynomial):
                coefficients = np.asarray(force.coef, dtype=np.float64)
                self.pieces.append(_Piece(math.sqrt(branch.start), 1.0, 0.0, [coefficients]))
            else:
                _check_rise(name, force, branch.start, end, 200)
                part = _Part("loading force", _over_root(force))
                self.pieces += _expand(name, [part], math.sqrt(branch.start), math.sqrt(end))
            self.first += [first] * (len(self.pieces) - first)
        self._tabulate()
        if yields:
            self._go_on()
        for kink in self.kinks:
            before, after = self.force(np.array([kink * (1.0 - 1e-12), kink]))
            if not abs(after - before) <= 1e-9 * before:
                raise ValueError(
                    f"law: the loading branches of {name!r} do not meet at {kink:.9g} d_Y: "
                    f"{before:.9g} and {after:.9g} F_Y"
                )
        _check_rise(name, self.force, 1e-3, END, 2000)

    def _go_on(self) -> None:
        """Add the tangent over the compression at `END`, in powers of q."""
        end = np.array([END, END * (1.0 + 1e-6)])
        force, work = self.force(end), self.work(end)
        piece = self.pieces[-1]
        t = piece.scale * math.sqrt(END) - piece.offset
        slope = 0.5 * piece.scale * Polynomial(piece.parts[0]).deriv()(t) / math.sqrt(END)
        self.tangent = float(force[0]), float(slope), float(work[0])
        if piece.scale == 1.0 and piece.parts[0].size <= 3 and piece.parts[0][1] == 0.0:
            return  # it is its own tangent
        constant = float(force[0] - slope * END)
        tail = np.array([constant, 0.0, float(slope)])
        self.pieces.append(_Piece(math.sqrt(END), 1.0, 0.0, [tail]))
        self.first.append(self.first[-1])
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
            work[0] = done - _horner(work, piece.scale * piece.start - piece.offset)
            self._work[n, : work.size] = work
            if n + 1 < len(pieces):
                done = float(_horner(work, piece.scale * pieces[n + 1].start - piece.offset))

    def force(self, d: Array) -> Array:
        """Force at compressions."""
        return self._at(d, self._force)

    def work(self, d: Array) -> Array:
        """Integral of the force up to compressions."""
        return self._at(d, self._work)

    def _at(self, d: Array, coefficients: Array) -> Array:
        q = np.sqrt(d)
        k = np.searchsorted(self._starts, q, side="right") - 1
        return _horner(coefficients.T[:, k], self._scale[k] * q - self._offset[k])


def _horner(coefficients: Array, t: Array | float) -> Array:
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
        raise ValueError(f"law: the loading force of {name!r} does not rise at {at:.6g} d_Y")


def _check_yield(
    name: str, coefficient: float | None, loading: Sequence[Loading], unloading: Sequence[Unloading]
) -> None:
    """Refuse a law that would not begin to differ from Hertz's at yield."""
    starts = [branch.start for branch in loading[1:]]
    if any(start < 1.0 for start in starts) or (unloading and unloading[0].start != 1.0):
        raise ValueError(
            f"law: {name!r} has to follow Hertz's curve up to yield, 1 d_Y: no branch of loading "
            "but the first may begin before, and the first of unloading begins there"
        )
    if not (starts or unloading):
        right, needed = coefficient is None, "None: it never yields"
    else:
        right = coefficient is not None and 0.0 < coefficient < math.inf
        needed = "a positive number: the law yields"
    if not right:
        raise ValueError(f"law: yield_coefficient of {name!r} must be {needed}, got {coefficient}")


def _check_joints(name: str, curve: _LoadingCurve, branches: Sequence[Unloading]) -> None:
    """Refuse unloading curves that change at once, or begin with a jump: so would outcomes."""
    before = (0.0, 0.0)
    for branch, end in _ends(branches):
        dm = np.array([branch.start * (1.0 + 1e-9), end * (1.0 - 1e-9)])
        left, lost = (np.asarray(f(dm)) for f in _residual_and_loss(curve, branch))
        for what, value, last, scale in (
            ("residual compression", left, before[0], branch.start),
            ("loss", lost, before[1], float(curve.work(dm)[0])),
        ):
            if not abs(value[0] - last) <= 1e-6 * scale:
                raise ValueError(
                    f"law: the {what} of {name!r} jumps at {branch.start:.9g} d_Y, from {last:.6g} "
                    f"to {value[0]:.6g}"
                )
        before = float(left[1]), float(lost[1])


def _over_root(force: Formula) -> Formula:
    """Take the root compression."""
    return lambda q: force(q * q)


def _ends(branches: Sequence[Any]) -> list[tuple[Any, float]]:
    """Branches with the compressions at which they end; those have to rise."""
    starts = [branch.start for branch in branches]
    if any(not low < high for low, high in itertools.pairwise([*starts, END])):
        raise ValueError(f"law: branches have to begin one after the other, below {END:g} d_Y")
    return list(zip(branches, [*starts[1:], END], strict=True)) if starts else []


@dataclass(frozen=True, eq=False)
class _Row:
    """A piece of the unloading family: functions in the order of `equation.force`."""

    piece: _Piece
    powers: tuple[float, ...]


def _residual_and_loss(curve: _LoadingCurve, branch: Unloading) -> tuple[Formula, Formula]:
    """Residual compression and loss themselves."""
    exponent, given = branch.exponent, branch.loss

    def residual(dm: Array) -> Array:
        return branch.residual(dm) * (dm - 1.0) ** branch.order

    def difference(dm: Array) -> Array:
        n = exponent(dm) if callable(exponent) else exponent
        return curve.work(dm) - curve.force(dm) * (dm - residual(dm)) / (n + 1.0)

    if given is None:
        return residual, difference
    return residual, lambda dm: given(dm) * (dm - 1.0) ** branch.loss_order


def _unloading_rows(name: str, curve: _LoadingCurve, branch: Unloading, end: float) -> list[_Row]:
    exponent = branch.exponent
    residual, loss = _residual_and_loss(curve, branch)
    some = np.geomspace(branch.start * (1.0 + 1e-9), end, 200)
    deep = _values(name, "residual compression", residual, some) >= some
    if deep.any():
        raise ValueError(
            f"law: the residual compression of {name!r} is not below the largest one at "
            f"{some[int(np.argmax(deep))]:.6g} d_Y"
        )

    # what a residual and a loss have to keep their digits of: the span dm - dr where that is
    # smaller, and the loss itself; rounding allows for shares of 0.05
    def smaller(dm: Array) -> Array:
        return branch.residual(dm) * np.clip(1.0 - residual(dm) / dm, 0.05, 1.0)

    def lost(dm: Array) -> Array:
        work = curve.work(dm)
        return np.clip(loss(dm), 0.05 * work, 0.2 * work)

    parts: list[_Part | float] = [
        _Part("residual compression", branch.residual, smaller if branch.order else np.positive)
    ]
    parts.append(
        _Part("exponent", lambda dm: 2.0 * exponent(dm)) if callable(exponent) else 2.0 * exponent
    )
    if branch.loss is None:
        parts.append(_Part("loss", loss, lost))
    else:
        parts.append(_Part("loss", branch.loss))
    low, high = branch.cap or (None, None)
    parts.append(0.0 if low is None else _Part("cap", low, np.positive))
    if high is None:
        parts.append(0.0 if low is None else math.inf)
    else:
        parts.append(_Part("cap", high, np.positive))
    powers = (branch.order, 0.0, branch.loss_order, 0.0, 0.0)
    # the loss has kinks where the loading curve has them
    inner = [kink for kink in curve.kinks if branch.start < kink < end]
    return [
        _Row(piece, powers)
        for ends in itertools.pairwise([branch.start, *inner, end])
        for piece in _expand(name, parts, *ends)
    ]


def _beyond(curve: _LoadingCurve, last: _Row) -> _Row:
    """Row from `END` on: residual in proportion to dm, exponent kept, loss from the works."""
    piece = last.piece
    values = [_horner(part, piece.scale * END - piece.offset) for part in piece.parts]
    share = float(values[_force.RESIDUAL]) * (END - 1.0) ** last.powers[_force.RESIDUAL] / END
    exponent = float(values[_force.EXPONENT])
    force, slope, work = curve.tangent
    at_zero = force - slope * END
    up = np.array([work - at_zero * END - 0.5 * slope * END**2, at_zero, 0.5 * slope])
    down = np.array([0.0, at_zero, slope]) * (2.0 * (1.0 - share) / (exponent + 2.0))
    parts = [np.array([0.0, share]), np.array([exponent]), up - down, np.zeros(1), np.zeros(1)]
    return _Row(_Piece(END, 1.0, 0.0, parts), (0.0,) * len(parts))


def _packed(curve: _LoadingCurve, rows: Sequence[_Row], capped: bool) -> Array:
    """Put all of it into one array, see `contactlaw.equation.force`."""
    pieces = curve.pieces
    starts = [*(piece.start for piece in pieces), math.inf]
    family_starts = [*(row.piece.start for row in rows), math.inf]
    starts_at = _force.HEADER
    curve_at = starts_at + len(starts)
    family_starts_at = curve_at + len(pieces) * _force.PIECE
    family_at = family_starts_at + len(family_starts)
    at = family_at + len(rows) * _force.UNLOADING_ROW
    header = [len(pieces), len(rows), starts_at, curve_at, family_starts_at, family_at, capped]
    coefficients: list[Array] = []

    def put(part: Array) -> list[float]:
        nonlocal at
        coefficients.append(np.pad(part, (0, -part.size % 4)))
        at += coefficients[-1].size
        return [part.size - 1, at - coefficients[-1].size]

    curve_rows: list[float] = []
    for piece, first in zip(pieces, curve.first, strict=True):
        following = next((k for k in curve.first if k > first), len(pieces))
        curve_rows += [piece.scale, piece.offset, *put(piece.parts[0]), first, following]
    # one length for all pieces of a function: a loop of constant length is predicted
    terms = [max((row.piece.parts[n].size for row in rows), default=0) for n in range(_FUNCTIONS)]
    family_rows: list[float] = []
    for row in rows:
        family_rows += [row.piece.scale, row.piece.offset]
        for power, part, length in zip(row.powers, row.piece.parts, terms, strict=True):
            family_rows += [power, *put(np.pad(part, (0, length - part.size)))]
    numbers = [*header, *starts, *curve_rows, *family_starts, *family_rows]
    return np.concatenate([np.array(numbers, dtype=np.float64), *coefficients])


def bisect(above: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Place, or places, between which a condition that holds at `low` ends."""
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    for _ in range(60):
        middle = 0.5 * (low + high)
        holds = above(middle)
        low, high = np.where(holds, middle, low), np.where(holds, high, middle)
    return low
