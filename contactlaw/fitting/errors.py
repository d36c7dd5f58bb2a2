"""Errors of parameters, and of the model: how large they are, and how alike at similar impacts.

The model's error is no scatter: it is the same for equal impacts, and alike for similar ones.
Compared with finite elements (the paper's matrix, 64 impacts) errors of law fem in COR are alike at
speeds that differ by less than a factor 1.6 (correlation 0.9), hardly at a factor 2 (0.3) and not
beyond; those in contact time are alike at any thickness. One correlation length for all, a factor e
in speed and in R/H, is our choice.
"""

import math

import numpy as np

from contactlaw._arrays import Array, Places
from contactlaw.answers.law_errors import law_errors
from contactlaw.fitting.measurements import NORMAL
from contactlaw.fitting.predictions import Predictor, per_slide
from contactlaw.physical.rebound import Rebound

# Rms error of the sliding speed after an impact, over friction times speed, against finite elements
# in three dimensions (`python -m validation.fem3d`). The tangential motion is that of any law.
SLIDING_ERROR = 0.061
_THICK = 1e-3  # R/H that stands for that of a half-space
_UNLIKE = 100.0  # distance of two kinds of values, whose errors are not correlated
_CELLS = 400  # most places; impacts are rounded to them if there are more
_WIDTHS = (1e-9, *1e-3 * 2.0 ** np.arange(14))  # width of a place in ln(speed) and ln(R/H)
_RIDGE = 1e-8  # added to the information: a parameter that nothing determines has an error of 1e4


def correlated(speed: Array, slenderness: Array, kind: Places | int = 0) -> Array:
    """Split standard errors of 1 of n values into c independent ones (n, c), by speed and R/H.

    The sum of their products is the correlation exp(-distance) of two values of one kind, and 0 for
    two kinds. With more than 400 different impacts places are rounded, by 1e-3 or more: standard
    errors change by 0.3 % with one plate, by 5 % with as many plates as impacts.
    """
    logs = np.log(speed), np.log(np.maximum(slenderness, _THICK))
    places = np.array([_UNLIKE * kind + 0.0 * speed, *logs])
    for width in _WIDTHS:
        cells, cell = np.unique(np.round(places / width), axis=1, return_inverse=True)
        if cells.shape[1] <= _CELLS:
            break
    apart = width * np.sqrt(((cells[:, :, None] - cells[:, None]) ** 2).sum(axis=0))
    factor = np.linalg.cholesky(np.exp(-apart) + 1e-10 * np.eye(len(apart)))
    return np.asarray(factor[cell.ravel()])


def chi_squared(off: Array, error: Array, shared: Array) -> float:
    """Sum of squares of deviations (n,) over their own errors (n,) and errors that they share (n, c).

    Each column is a standard error that moves all values together. It is the least sum of squares,
    whatever these errors are, with what they are themselves.

    Examples
    --------
    >>> round(chi_squared(np.array([3.0, 3.0]), np.ones(2), np.array([[1.0], [1.0]])), 9)
    6.0
    """
    rows = np.vstack([shared / error[:, None], np.eye(shared.shape[1])])
    basis = np.linalg.qr(rows)[0]
    left = np.pad(off / error, (0, shared.shape[1]))
    left = left - basis @ (basis.T @ left)
    return float(left @ left)


def model_errors(predictor: Predictor, x: Array, hit: Rebound) -> Array:
    """Errors of the model as independent ones of all values (m, c); 0 if they are not known."""
    at = predictor.setting(x)
    slenderness, speed = at.radius / at.thickness, np.asarray(predictor.data.speed)
    rms = law_errors(predictor.law, at.pair, hit, slenderness)
    if rms is None:
        return np.zeros((predictor.values.value.size, 1))
    kind, row = predictor.values.kind, predictor.values.row
    if at.friction is not None:
        slide = SLIDING_ERROR * at.friction * speed
        rms = np.vstack([rms, *(slide * change for change in per_slide(at).values())])
    # all oblique kinds follow from one number, and share its error
    alike = correlated(speed[row], slenderness[row], np.minimum(kind, len(NORMAL)))
    return np.asarray(rms[kind, row][:, None] * alike)


def covariance_of(slopes: Array) -> Array:
    """Covariance of parameters by the slopes of values over their errors, and of the priors' deviations."""
    return np.asarray(np.linalg.inv(slopes.T @ slopes + _RIDGE * np.eye(slopes.shape[1])))


def student(freedom: float) -> float:
    """Factor that widens errors which follow from a scatter of so many degrees of freedom.

    With it 68.3 % of the true values lie within the error, as with a known standard error.

    Examples
    --------
    >>> round(student(2.0), 2), round(student(math.inf), 6)
    (1.32, 1.0)
    """
    from scipy.special import stdtrit

    return float(stdtrit(freedom, 0.5 * math.erfc(-math.sqrt(0.5))))
