"""What changes when a number of a pair or of its impacts changes: sensitivities, ranges, fits.

Impacts are integrated with the number changed, because a table has an error of its own. Differences
of a logarithm divided by the step are elasticities; over a standard error they are ranges.
"""

import dataclasses
import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from contactlaw._arrays import Array
from contactlaw.answers.solver import Solver
from contactlaw.laws import Law
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.law import law_for_pair
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.physical.rate import REACH, flow_with_rate, per_rate, rates, scaled
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.strengths import Fineness, by_strength, without_curves
from contactlaw.physical.validity import alone

Number = tuple[str, str]
"""A body, ``"sphere"`` or ``"plate"``, and a field of its Material or ``"flow_stress"``; or ``"impact"`` and a size."""

# The COR of a pair with a rate of strain is within 1e-6 of that with laws of any strength.
FINE = Fineness(1e-8, 3.0, 0.02, REACH, 1e-4)
# Step of central differences of a logarithm. They err by 2e-9 times the third derivative, which is
# up to 3e4 next to a corner, and by 2e-9 from the solver, whose errors are alike at the two ends.
STEP = 1e-4
_MARGIN = 1.001  # of the rate beyond that of the impacts
_LARGEST = {"poissons_ratio": 0.5, "rate": 0.5, "loss_factor": 1.0}  # a material refuses more


class Variants:
    """Answers of a pair some of whose numbers are multiplied by factors; each law is made once.

    Answers are right but for the flags of pairs with a rate of strain.
    """

    def __init__(self, pair: Pair, law: Law) -> None:
        self.pair, self.law = pair, law
        self._solver = functools.cache(self._made)

    def answers(self, impacts: Impacts, factors: Mapping[Number, float]) -> Rebound:
        """Integrate impacts with these numbers multiplied by factors, as flat arrays."""
        sizes = {name: x * getattr(impacts, name) for (role, name), x in factors.items() if role == "impact"}
        moved = dataclasses.replace(impacts, shape=impacts.speed.shape, **sizes)
        # two decades of rates or more, so that other impacts often find the same law
        decades = 0.5 * np.log10(rates(moved.speed, moved.radius))
        ends = 2.0 * math.floor(decades.min(initial=4.0)), 2.0 * math.ceil(decades.max(initial=0.0))
        numbers = frozenset(item for item in factors.items() if item[0][0] != "impact")
        return self._solver(numbers, *ends).rebounds(moved)

    def _made(self, factors: frozenset[tuple[Number, float]], *decades: float) -> Solver:
        values = {
            (role, name): min(x * self._value(role, name), _LARGEST.get(name, math.inf)) for (role, name), x in factors
        }
        return solver(with_numbers(self.pair.given, values), self.law, 10.0 ** np.array(decades))

    def _value(self, role: str, name: str) -> float:
        body = self.pair.given[role == "plate"]
        value = getattr(body, name, 1.0)
        if name == "hardening" and body.flow is not None:  # also where it is from a hardness
            value = body.flow.hardening
        return float(value[0] if isinstance(value, tuple) else value)


def with_number(body: Material, name: str, value: float) -> Material:
    """Body with another value of one number, which has no error any more.

    Of `rate` and `loss_factor` it is the first number, of `hardening` B [Pa], also where that
    follows from a hardness; `flow_stress` is the factor of the whole.
    """
    if name == "flow_stress":
        return scaled(body, value)
    known = getattr(body, name)
    new: dict[str, Any] = {name: (value, *known[1:]) if isinstance(known, tuple) else value}
    if name == "hardening" and body.flow is not None:
        new |= {name: (value, body.flow.exponent), "yield_strength": body.flow.strength}
    errors = {of: error for of, error in body.uncertainty.items() if of != name}
    is_minimum = body.specified_minimum and name != "yield_strength"
    return dataclasses.replace(body, **new, uncertainty=errors, specified_minimum=is_minimum)


def with_numbers(bodies: tuple[Material, Material], numbers: Mapping[Number, float]) -> Pair:
    """Pair of sphere and plate with other numbers."""
    known = dict(zip(("sphere", "plate"), bodies, strict=True))
    for (role, name), value in numbers.items():
        known[role] = with_number(known[role], name, value)
    return Pair(**known)


@dataclass(frozen=True, eq=False)
class _Varied(SphereOnPlate):
    """Bodies whose law is made for some strengths only, with the flags of slow impacts."""

    fineness: Fineness

    @functools.cached_property
    def data(self) -> Array:
        return by_strength(self.pair, self.law, self.fineness)

    @functools.cached_property
    def limits_by_strength(self) -> Array:
        return alone(self.limits)


def solver(pair: Pair, law: Law, rates: Array, fineness: Fineness = FINE) -> Solver:
    """Solver of a pair, with its own numbers in the law, for impacts at `contactlaw.physical.rate.rates`.

    Answers are right but for the flags of pairs with a rate of strain.
    """
    if not flow_with_rate(pair, law):
        return Solver(_Varied(pair, law_for_pair(pair, law), fineness))
    low, high = rates.min(initial=REACH) / _MARGIN, rates.max(initial=0.0) * _MARGIN
    fineness = fineness._replace(slowest=per_rate(pair) * low, fastest=per_rate(pair) * high)
    return Solver(_Varied(pair, without_curves(pair, law), fineness))
