"""The values that come nearest to the data: a scan, then least squares by scipy."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw.evaluation import UnsolvedError
from contactlaw.fitting.measurements import KINDS, Measurements
from contactlaw.fitting.predictions import Predictor, Values
from contactlaw.fitting.unknowns import Parameter, bounds

Array = NDArray[np.float64]

_ROWS = 6  # rebounds of a kind that a scan looks at, from the slowest to the fastest
GUESSED = 0.02  # relative error of values whose own is not known, until it is found
_CONVERGED = 1e-7  # of the sum of squares: 3e-4 of a standard error, and less
_NEAR = 0.02  # of a logarithm: as near as that, derivatives that need another law are kept
# Trial values, in units of: the strength from which on nothing yields, what is given, R or H.
_STRENGTHS = (1.2, 0.95, 0.8, 0.63, 0.48, 0.35, 0.24, 0.15, 0.09, 0.04)
_FEW_STRENGTHS = (1.2, 0.7, 0.3, 0.1)  # where there are other unknowns
_MODULI, _FEW_MODULI = (0.4, 0.63, 1.0, 1.6, 2.5), (0.6, 1.0, 1.6)
_DENSITIES = (0.6, 1.0, 1.6)
_SLENDERNESS, _FEW_SLENDERNESS = np.geomspace(0.03, 4.0, 16), np.geomspace(0.05, 3.0, 9)  # R/H
_RADII = np.geomspace(1e-5, 0.05, 12)  # [m]
_THINNEST = 6.0  # R/H; beyond, the model answers slowly and wrongly
_RADII = np.geomspace(1e-5, 0.05, 16)


def optimizer() -> Any:
    """scipy.optimize, which is an extra of its own.

    Raises
    ------
    ImportError
        Without scipy; the message says how to install it.
    """
    try:
        import scipy.optimize
    except ImportError as error:
        raise ImportError("a fit needs scipy: pip install 'contactlaw[fit]'") from error
    return scipy.optimize


def limits(predictor: Predictor) -> tuple[Array, Array]:
    """Least and largest values."""
    low, high = np.array([bounds(one, predictor.pair) for one in predictor.moved]).T
    return low, high


def scan(predictor: Predictor) -> list[Array]:
    """Find values from which to go on: the nearest to the data of a grid.

    Where nothing yields, strengths do not matter: if that is the nearest, the nearest with yield is
    given, too.
    """
    rows = _some(predictor.values, np.asarray(predictor.data.speed))
    few = replace(predictor, data=_part(predictor.data, rows), values=predictor.values.part(rows))
    error = few.values.error
    error = np.where(np.isnan(error), GUESSED * few.values.value, error)
    low, high = limits(few)
    onset = _onset(few)
    trials = []
    for point in itertools.product(*_axes(few, onset)):
        at = np.clip(np.array(point), low, high)
        if few.slenderness(at) <= _THINNEST:
            off = (few.at(at) - few.values.value) / error
            trials.append((float(off @ off), at))
    trials.sort(key=lambda trial: trial[0])
    yields = [_yields(few.moved, at, onset) for _, at in trials]
    best = [trials[0][1]]
    if not yields[0] and any(yields):
        best.append(trials[yields.index(True)][1])
    return best


def _yields(moved: list[Parameter], at: Array, onset: dict[str, float]) -> bool:
    """Whether a point lies below the strengths from which on nothing yields."""
    strengths = [(value, onset[one.name]) for one, value in zip(moved, at, strict=True)
                 if one.name in onset]  # fmt: skip
    return not strengths or any(value < least for value, least in strengths)


def _some(values: Values, speed: Array) -> NDArray[np.intp]:
    """Rebounds of each kind, evenly over the speeds."""
    chosen: set[int] = set()
    for kind in np.unique(values.kind):
        rows = values.row[values.kind == kind]
        rows = rows[np.argsort(speed[rows], kind="stable")]
        at = np.unique(np.linspace(0, rows.size - 1, min(_ROWS, rows.size)).round().astype(int))
        chosen.update(rows[at].tolist())
    return np.array(sorted(chosen))


def _part(data: Measurements, rows: NDArray[np.intp]) -> Measurements:
    names = [*KINDS, *(f"{name}_error" for name in KINDS), "speed", "radius", "thickness"]
    given = {name: getattr(data, name) for name in names}
    return Measurements(**{name: v[rows] for name, v in given.items() if v is not None})


def _middle(one: Parameter, predictor: Predictor) -> float:
    """Value of a parameter where it is not scanned itself, by what else is known."""
    if not math.isnan(one.centre):
        return one.centre
    if one.is_strength:
        return 1e-2 * float(getattr(predictor.pair, one.unknown.body).youngs_modulus)
    other = predictor.data.radius if one.name == "thickness" else predictor.data.thickness
    if other is None or not np.isfinite(other).any():
        return 1e-3
    return float(np.median(np.asarray(other)[np.isfinite(other)]))


def _onset(predictor: Predictor) -> dict[str, float]:
    """Strength of each body whose own is unknown, from which on it does not yield, nearly."""
    middle = np.array([_middle(one, predictor) for one in predictor.moved])
    found = {}
    for n, one in enumerate(predictor.moved):
        if one.is_strength and one.wanted and one.prior is None:
            trial = middle.copy()
            trial[n] = 1e-2 * getattr(predictor.pair, one.unknown.body).youngs_modulus
            chi = np.max(predictor.impacts(trial).overload)
            # d_Y goes with the square of the strength
            found[one.name] = float(trial[n] * math.sqrt(chi)) if chi > 0.0 else math.inf
    return found


def _axes(predictor: Predictor, onset: dict[str, float]) -> list[list[float]]:
    """Trial values of each parameter."""
    scanned = [one for one in predictor.moved if one.wanted and one.prior is None]
    few = len(scanned) > 1
    axes = []
    for one in predictor.moved:
        middle, factors = _middle(one, predictor), np.ones(1)
        if one not in scanned:
            pass
        elif one.is_strength:
            middle = min(onset[one.name], 1e3 * middle)
            factors = np.array(_FEW_STRENGTHS if few else _STRENGTHS)
        elif one.unknown.field == "youngs_modulus":
            factors = np.array((1.0,) if len(scanned) > 2 else _FEW_MODULI if few else _MODULI)
        elif one.unknown.field == "density":
            factors = np.array(_DENSITIES)
        elif one.name == "thickness":
            factors = 1.0 / (_FEW_SLENDERNESS if few else _SLENDERNESS)
        elif predictor.data.thickness is not None and np.isfinite(predictor.data.thickness).any():
            factors = _FEW_SLENDERNESS if few else _SLENDERNESS
        else:
            middle, factors = 1.0, _RADII
        axes.append((middle * factors).tolist())
    return axes


class Descent:
    """Least squares, by scipy; what it has computed serves the next one, with other errors."""

    def __init__(self, predictor: Predictor) -> None:
        self.predictor = predictor
        moved = predictor.moved
        self._low, self._high = np.log(np.array(limits(predictor)))
        self._held = [n for n, one in enumerate(moved) if one.prior is not None]
        self._centres = np.log([moved[n].centre for n in self._held])
        self._widths = np.array([moved[n].prior for n in self._held], dtype=np.float64)
        self._last: tuple[Array, Array] | None = None
        self._steepest: tuple[Array, Array] | None = None

    def predicted(self, x: Array) -> Array:
        """Fitted values, by the logarithms of the parameters."""
        if self._last is None or not np.array_equal(self._last[0], x):
            self._last = x.copy(), self.predictor.at(np.exp(x))
        return self._last[1]

    def slopes(self, x: Array) -> Array:
        """Differentiate the fitted values."""
        here = self.predicted(x)
        if self._steepest and float(np.abs(x - self._steepest[0]).max()) < _NEAR:
            return self.predictor.derivatives(np.exp(x), here, self._steepest[1])
        self._steepest = x.copy(), self.predictor.derivatives(np.exp(x), here)
        return self._steepest[1]

    def __call__(self, start: Array, error: Array) -> tuple[Array, float]:
        """Go down from a start: values, and the sum of squares with that of the priors."""
        pull = np.zeros((len(self._held), start.size))
        pull[np.arange(len(self._held)), self._held] = 1.0 / self._widths

        def residuals(x: Array) -> Array:
            try:
                off = (self.predicted(x) - self.predictor.values.value) / error
            except (UnsolvedError, ValueError):  # too thin, too strong: a shorter step is taken
                off = np.full_like(error, np.inf)
            return np.concatenate([off, (x[self._held] - self._centres) / self._widths])

        def slopes(x: Array) -> Array:
            return np.vstack([self.slopes(x) / error[:, None], pull])

        margin = 1e-6 * (self._high - self._low)
        found = optimizer().least_squares(
            residuals,
            np.clip(np.log(start), self._low + margin, self._high - margin),
            slopes,
            bounds=(self._low, self._high),
            x_scale="jac",
            ftol=_CONVERGED,
            xtol=1e-9,
            gtol=1e-10,
            max_nfev=60,
        )
        return np.exp(found.x), float(2.0 * found.cost)
