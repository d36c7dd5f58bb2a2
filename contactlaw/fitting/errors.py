"""Standard errors of fitted parameters: from the scatter of the data, and from the model's errors.

All covariances are of logarithms. The model's error is no scatter: it is the same for equal
impacts, and alike for similar ones. Compared with finite elements (the paper's matrix, 64 impacts)
errors of law fem in COR are alike at speeds that differ by less than a factor 1.6 (correlation
0.9), hardly at a factor 2 (0.3) and not beyond; those in contact time are alike at any thickness.
One correlation length for all, a factor e in speed and in R/H, is our choice.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array, Mask, Places
from contactlaw.answers.law_errors import law_errors
from contactlaw.fitting.measurements import NORMAL
from contactlaw.fitting.predictions import Predictor, per_slide
from contactlaw.physical.rebound import Rebound

# Rms error of the sliding speed after an impact, over friction times speed, against finite elements
# in three dimensions (`python -m validation.fem3d`). The tangential motion is that of any law.
SLIDING_ERROR = 0.061
_LENGTH = 1.0  # correlation length of the model's errors in ln(speed) and ln(R/H)
_CELLS = 600  # largest number of cells, whose correlations are a matrix
_NEAREST = 1e-3  # width of a cell in ln(speed) and ln(R/H), doubled until there are few enough
_RIDGE = 1e-8  # added to the information: a parameter that nothing determines has an error of 1e4


class Errors(NamedTuple):
    """Covariances of the logarithms of all parameters, from the two sources."""

    statistical: Array
    model: Array

    @property
    def total(self) -> Array:
        """Covariance of both."""
        return np.asarray(self.statistical + self.model)

    def widened(self, factors: Array) -> Errors:
        """Multiply the statistical error of each parameter by a factor."""
        return Errors(self.statistical * np.outer(factors, factors), self.model)


class ModelCovariance(NamedTuple):
    """Covariance of the model's errors of all values.

    A cell holds values of one kind at one place, by ln(speed) and ln(R/H), which share an error.
    With n values in c cells this takes memory and time of n + c^2, where the matrix takes n^2, or
    800 MB for 10,000 rebounds. If there are more places than cells, places are rounded, by 1e-3 or
    more: standard errors change by 0.3 % with one plate, by 5 % with as many plates as rebounds.
    """

    # rms of the model's error of each value, in its units; of opposite signs for two oblique kinds
    # where one error makes one of them too large and the other too small
    size: Array
    cell: Places  # cell of each value
    correlation: Array  # (c, c) correlation of cells

    def propagated(self, gain: Array) -> Array:
        """Covariance of what follows from the values by a gain (p, n)."""
        gathered = self._gathered((gain * self.size).T)
        return np.asarray(gathered.T @ self.correlation @ gathered)

    def squares(self, off: Array, error: Array) -> float:
        """Sum of squares of deviations, weighted by the covariance of data and model.

        By Woodbury's identity: C = diag(error^2) + U correlation U^T, with the sizes in U.
        """
        scaled = self.size / error
        own = float(((off / error) ** 2).sum())
        weight = self._gathered((scaled**2)[:, None])[:, 0]
        pull = self._gathered((scaled * off / error)[:, None])[:, 0]
        inner = np.eye(weight.size) + self.correlation * weight
        return own - float(pull @ np.linalg.solve(inner, self.correlation @ pull))

    def _gathered(self, columns: Array) -> Array:
        """Sum over the values of each cell."""
        found = np.zeros((len(self.correlation), columns.shape[1]))
        np.add.at(found, self.cell, columns)
        return found


class Linear(NamedTuple):
    """The fit near its minimum, where values are linear in the logarithms of the parameters."""

    slopes: Array  # (m, p) of the values, over their standard errors
    covariance: Array  # (p, p) of the parameters, by the errors of data and priors

    @classmethod
    def of(cls, predictor: Predictor, slopes: Array, error: Array) -> Linear:
        """Linear fit with these slopes (m, p) and standard errors (m,) of the values."""
        scaled = slopes / error[:, None]
        held = np.diag([one.prior**-2.0 + _RIDGE for one in predictor.parameters])
        return cls(scaled, np.asarray(np.linalg.inv(scaled.T @ scaled + held)))

    def covariances(self, error: Array, model: ModelCovariance | None) -> Errors:
        """Propagate errors of the values, the priors and the model; None: its errors are not known."""
        gain = self.covariance @ (self.slopes / error[:, None]).T
        from_model = np.zeros_like(self.covariance) if model is None else model.propagated(gain)
        return Errors(self.covariance, from_model)

    def freedoms(self, found: Sequence[tuple[Mask, float]]) -> Array:
        """Degrees of freedom of each parameter's variance, by Welch and Satterthwaite.

        Each kind of values adds a part to the variance, as uncertain as the scatter of that kind,
        which was found from few or many values; the parts of priors and given errors are known. A
        thickness that rests on five contact times is known no better for thirty peak forces beside
        them. `found` has masks (m,) of values whose errors were found together, and from how many
        degrees of freedom.
        """
        parts = (self.covariance @ self.slopes.T) ** 2
        doubt = np.zeros(len(self.covariance))
        for these, freedom in found:
            doubt += parts[:, these].sum(axis=1) ** 2 / freedom
        with np.errstate(divide="ignore"):
            return np.asarray(np.diag(self.covariance) ** 2 / doubt)

    def leverages(self) -> Array:
        """Leverage of each value: how many parameters it determines.

        The sum over all values is one for each free parameter, and a share of one for each prior.
        """
        return np.asarray(np.einsum("ij,jk,ik->i", self.slopes, self.covariance, self.slopes))


def model_covariance(predictor: Predictor, values: Array, hit: Rebound) -> ModelCovariance | None:
    """Covariance of the model's errors of all values; None for a law whose errors are not known."""
    at = predictor.setting(values)
    rms = law_errors(predictor.law, at.pair, hit, at.radius / at.thickness)
    if rms is None:
        return None
    kind, row = predictor.values.kind, predictor.values.row
    if at.friction is not None:
        slide = SLIDING_ERROR * at.friction * np.asarray(predictor.data.speed)
        rms = np.vstack([rms, *(slide * change for change in per_slide(at).values())])
    speed = np.log(np.asarray(predictor.data.speed))[row]
    slenderness = np.log(np.maximum(at.radius / at.thickness, 1e-3))[row]  # half-space: R/H = 0
    # all oblique kinds follow from one number, and share its error
    cell, (kinds, *places) = _cells(np.minimum(kind, len(NORMAL)), speed, slenderness)
    apart = np.hypot(*(place[:, None] - place for place in places))
    correlation = np.exp(-apart / _LENGTH) * (kinds[:, None] == kinds)
    return ModelCovariance(rms[kind, row], cell, correlation)


def _cells(kind: Places, *places: Array) -> tuple[Places, Array]:
    """Find each value's cell, by number, and the kind and mean place of each cell.

    Values share a cell if they are at one place or, if there are more than `_CELLS` places, near
    to each other.
    """
    exact = np.array([kind, *places])
    rounded, width = exact, _NEAREST
    while True:
        _, cell = np.unique(rounded, axis=1, return_inverse=True)
        cell = cell.reshape(-1)
        count = int(cell.max()) + 1
        if count <= _CELLS:
            many = np.bincount(cell)
            return cell, np.array([np.bincount(cell, of) / many for of in exact])
        rounded = np.vstack([kind, np.floor(exact[1:] / width)])
        width *= 2.0


def student(freedom: Array) -> Array:
    """Factors that widen errors which were themselves estimated from few data.

    With it 68.3 % of the true values lie within the error, as with a known standard error.

    Examples
    --------
    >>> student(np.array([2.0, 1e9])).round(2)
    array([1.32, 1.  ])
    """
    from scipy.special import stdtrit

    within = 0.5 * (1.0 + math.erf(1.0 / math.sqrt(2.0)))
    return np.asarray(stdtrit(freedom, within))
