"""The constants of law fem for metals that harden and are stronger at rate, fitted to impacts."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw.laws import fem
from contactlaw.physical import rate as rates
from validation.fem import cases, fit, store
from validation.fem.cases import Case

Array = NDArray[np.float64]

FIT = "metals", "metals_alike", "bodies"  # the sets of the fit
_STEP = 0.05  # relative, of the differences of a fit


class Constants(NamedTuple):
    """Constants that are fitted to the impacts of `FIT`."""

    strain: float  # representative strain over sqrt(d/R) ...
    both: float  # ... less by this share where both bodies flow alike, ...
    by_exponent: float  # ... larger with the exponent n, by this slope of the logarithm, ...
    by_ratio: float  # ... and with this power of E*/sigma
    rate: float  # representative rate over (V0/R)(V_Y/V0)^0.3


def shipped() -> Constants:
    """Constants of the law."""
    strain, _, both, by_exponent, by_ratio = fem.fitted()["strain"]
    return Constants(strain, both, by_exponent, by_ratio, fem.fitted()["rate"])


def at_rate(pair: cl.Pair, case: Case, share: float = rates.SHARE) -> cl.Pair:
    """Pair without rate, as strong as an impact makes it, with another representative rate."""
    if rates.leading(pair) is None:
        return pair
    size = np.array(case.radius * rates.SHARE / share)  # rates go with share/radius
    return rates.strengthened(pair, rates.factors(pair, np.array(case.speed), size).item())


def errors(name: str, constants: Constants) -> Array:
    """Errors in COR of the law with other constants; below 0.3 over 0.3, 0 where it is flagged.

    Spheres much stiffer than the plate count: their flag was set after the fit.
    """
    late = fem.fitted()["strain"][1]
    found = {**fem.fitted(), "strain": [constants.strain, late, *constants[1:-1]]}
    return errors_by(name, found, constants.rate)


def errors_by(name: str, found: dict[str, Any], rate: float = rates.SHARE) -> Array:
    """Errors in COR of the law with other numbers, and another representative rate, as in `errors`."""
    measured, off = store.read(name).data["restitution"], []
    for case, cor in zip(cases.stored(name), measured.tolist(), strict=True):
        pair = at_rate(fit.pair_of(dataclasses.asdict(case)), case, rate)
        law = fem.law_of(fit.numbers_of(pair), found)
        hit = cl.ImpactModel(pair, law).solve(case.speed, case.radius, case.thickness)
        flagged = hit.flags & cl.Validity.ACCURACY & ~cl.Validity.UNTRIED_STRENGTH
        off.append(0.0 if flagged else (float(hit.restitution) - cor) / max(cor, 0.3))
    return np.array(off)


def step(constants: Constants) -> Constants:
    """Step of the fit from some constants, by Gauss and Newton; zeros at the optimum."""
    here = np.concatenate([errors(name, constants) for name in FIT])
    slopes = []
    for n, value in enumerate(constants):
        moved = constants._replace(**{Constants._fields[n]: (1.0 + _STEP) * value})
        there = np.concatenate([errors(name, moved) for name in FIT])
        slopes.append((there - here) / (_STEP * value))
    return Constants(*np.linalg.lstsq(np.stack(slopes, axis=1), -here, rcond=None)[0].tolist())
