"""Answers with other inputs, as sensitivities, ranges and fits need them: each is integrated."""

import dataclasses
import functools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from contactlaw._arrays import Array
from contactlaw.answers.solver import Solver
from contactlaw.laws import Law
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.law import law_for_pair
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.physical.rate import REACH, flow_with_rate, per_rate, scaled
from contactlaw.physical.strengths import Fineness, by_strength, without_curves
from contactlaw.physical.validity import alone

Number = tuple[str, str]  # body, "sphere" or "plate", and field of its Material, or "flow_stress"

# The COR of a pair with a rate of strain is within 1e-6 of that with laws of any strength.
FINE = Fineness(5, 1e-8, 3.0, 0.15, REACH, 1e-4)
_MARGIN = 1.001  # of the rate beyond that of the impacts


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


def solver(pair: Pair, law: Law, rates: Array, rtol: float, fineness: Fineness = FINE) -> Solver:
    """Solver of a pair, with its own numbers in the law, for impacts at `contactlaw.physical.rate.rates`.

    Answers are right but for the flags of pairs with a rate of strain.
    """
    if not flow_with_rate(pair, law):
        return Solver(_Varied(pair, law_for_pair(pair, law), fineness), rtol)
    scale = per_rate(pair)
    low, high = scale * rates.min(initial=REACH).item() / _MARGIN, scale * rates.max(initial=0.0).item() * _MARGIN
    fineness = fineness._replace(slowest=low, fastest=high)
    return Solver(_Varied(pair, without_curves(pair, law), fineness), rtol)
