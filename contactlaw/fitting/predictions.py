"""Predictions of the model for rebounds with trial values, and their derivatives.

Every trial is integrated, with the law for its bodies: a table for each would take 0.7 s.
Parameters are varied by their logarithms, `x`.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array, Mask, Places
from contactlaw.answers import oblique
from contactlaw.answers.backend import UnsolvedError
from contactlaw.answers.derivatives import FINE, solver
from contactlaw.answers.solver import Solver
from contactlaw.equation.tangential import POINT
from contactlaw.fitting.measurements import KINDS, Measurements
from contactlaw.fitting.unknowns import Parameter, Setting, bounds, setting
from contactlaw.laws import Law
from contactlaw.physical.arguments import check
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.law import law_for_pair
from contactlaw.physical.oblique import ObliqueRebound
from contactlaw.physical.pair import Pair
from contactlaw.physical.rate import REACH, rates
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.strengths import Fineness

# Laws of pairs with a rate of strain in the search of basins, where the COR is within 1e-3 of the
# model's, and in the scan before, within 5e-2.
COARSE = Fineness(1e-6, 4.0, 0.04, REACH, 5e-3)
ROUGH = Fineness(1e-5, 4.0, 0.12, REACH, 5e-3)
_STEP = 1e-4  # step of a logarithm; differences err by half of it times the second derivative


class Values(NamedTuple):
    """Measured values of all kinds, one after the other.

    Attributes
    ----------
    kind, row
        Number of the kind in `KINDS`, and of the rebound.
    value
        As measured, in SI units, with the shift of its kind.
    error
        Standard errors; NaN where they have to be found.
    """

    kind: Places
    row: Places
    value: Array
    error: Array

    def by_kind(self) -> dict[str, Mask]:
        """Which values are of each kind that was measured."""
        return {name: self.kind == n for n, name in enumerate(KINDS) if n in self.kind}


@dataclass(frozen=True, eq=False)
class Predictor:
    """The model as a function of the logarithms `x` of some parameters."""

    pair: Pair
    law: Law
    data: Measurements
    parameters: list[Parameter]
    fineness: Fineness = FINE

    @functools.cached_property
    def values(self) -> Values:
        """What was measured."""
        parts = []
        for n, (name, kind) in enumerate(KINDS.items()):
            measured: Any = getattr(self.data, name)
            if measured is not None:
                rows = np.flatnonzero(np.isfinite(measured))
                errors: Any = getattr(self.data, f"{name}_error")
                known = np.full(rows.size, np.nan) if errors is None else errors[rows]
                parts.append((np.full(rows.size, n), rows, measured[rows] + kind.shift, known))
        return Values(*map(np.concatenate, zip(*parts, strict=True)))

    @functools.cached_property
    def limits(self) -> Array:
        """Logarithms of the least and the largest value of each parameter (2, p)."""
        return np.log([bounds(one, self.pair, self.data) for one in self.parameters]).T

    @functools.cached_property
    def centres(self) -> Array:
        """Logarithms of the values of parameters with a prior; 0 of the others."""
        return np.log([1.0 if one.is_free else one.centre for one in self.parameters])

    def setting(self, x: Array) -> Setting:
        """Bodies and sizes with these values."""
        return setting(self.pair, self.data, self.parameters, np.exp(x))

    def impacts(self, at: Setting) -> Rebound:
        """Everything about rebounds but the flags, which are those of slow ones."""
        return _integrated(solver(at.pair, self.law, rates(at.speed, at.radius), self.fineness), at)

    def predicted(self, *trials: Array) -> Array:
        """Predict the measured values (k, m) at k trials that differ only in sizes, not in materials.

        They are NaN where the model has no answer, as for impossible bodies or plates far too thin.
        """
        try:
            settings = [self.setting(x) for x in trials]
            sizes: Any = zip(*(one[1:] for one in settings), strict=True)
            joined: Any = (None if size[0] is None else np.concatenate(size) for size in sizes)
            together = Setting(settings[0].pair, *joined)
            columns = columns_of(self.impacts(together), together)
        except (UnsolvedError, ValueError):
            if len(trials) == 1:
                return np.full((1, self.values.value.size), np.nan)
            return np.concatenate([self.predicted(x) for x in trials])
        return np.asarray(columns.reshape(len(KINDS), len(trials), -1)[self.values.kind, :, self.values.row].T)

    def derivatives(self, x: Array, here: Array, moved: Places | None = None) -> Array:
        """Differentiate the values with respect to x; a column for each parameter that is moved."""
        columns = np.zeros((here.size, x.size))
        for n in range(x.size) if moved is None else moved:
            step = -_STEP if x[n] + _STEP > self.limits[1, n] else _STEP
            columns[:, n] = (self.predicted(x + step * (np.arange(x.size) == n))[0] - here) / step
        return columns


def impacts(at: Setting, law: Law) -> Rebound:
    """Integrate rebounds of any bodies that `ImpactModel` takes, without a table."""
    return _integrated(Solver(SphereOnPlate(at.pair, law_for_pair(at.pair, law))), at)


def _integrated(backend: Solver, at: Setting) -> Rebound:
    check(speed=at.speed, radius=at.radius, thickness=at.thickness)
    given = Impacts(at.speed, at.radius, at.thickness, at.speed.shape)
    if at.friction is None or at.sliding_speed is None:
        return backend.rebounds(given)
    return oblique.answer(backend, given, at.friction, at.sliding_speed)


def columns_of(hit: Rebound, at: Setting) -> Array:
    """Values of all kinds, a row for each, with the shift of the kind; NaN: there is none."""
    found = np.full((len(KINDS), at.radius.size), np.nan)
    for row, (name, kind) in zip(found, KINDS.items(), strict=True):
        if name == "spin" and isinstance(hit, ObliqueRebound):
            row[:] = per_slide(at)[name] * (at.sliding_speed - np.asarray(hit.sliding_speed))
        elif hasattr(hit, name):
            row[:] = getattr(hit, name) + kind.shift
    return found


def per_slide(at: Setting) -> dict[str, Array]:
    """Change of each oblique kind by a change of the sliding speed [1/(m/s), ..., 1/m]."""
    with np.errstate(divide="ignore"):
        one = 1.0 / np.asarray(at.sliding_speed)
    return {
        "tangential_restitution": -one / POINT,
        "rotational_restitution": one,
        "spin": (1.0 - 1.0 / POINT) / at.radius,
    }
