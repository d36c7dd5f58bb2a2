"""What a fit can find: numbers of the two materials, and the sizes of bead and plate."""

import dataclasses
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.answers.derivatives import Number, with_numbers
from contactlaw.equation.corrections import CONTACT_TIME
from contactlaw.fitting.measurements import NORMAL, OBLIQUE, Measurements
from contactlaw.laws import Law
from contactlaw.physical.arguments import number
from contactlaw.physical.flow import CONSTRAINT
from contactlaw.physical.pair import Pair
from contactlaw.physical.scaling import unit_time

_MOST = 3  # unknowns at once


class Unknown(NamedTuple):
    """A number that a fit may find."""

    title: str
    unit: str
    body: str  # "sphere", "plate", or "" for a size
    field: str  # name in the body's Material, or in Measurements
    least: float  # in SI units
    largest: float


# Bounds are those of rubber and diamond, aerogels and osmium; `bounds` has those of strengths.
_MATERIAL = {
    "yield_strength": ("yield strength", "Pa", 0.0, math.inf),
    "youngs_modulus": ("Young's modulus", "Pa", 1e5, 2e12),
    "density": ("density", "kg/m3", 1.0, 3e4),
    "loss_factor": ("loss factor", "", 1e-4, 1.0),
}
UNKNOWNS = {
    prefix + field: Unknown(f"{title} of the {name}", unit, body, field, least, largest)
    for body, prefix, name in (("sphere", "", "bead"), ("plate", "plate_", "plate"))
    for field, (title, unit, least, largest) in _MATERIAL.items()
}
UNKNOWNS["thickness"] = Unknown("thickness of the plate", "m", "", "thickness", 1e-7, 10.0)
UNKNOWNS["radius"] = Unknown("radius of the bead", "m", "", "radius", 1e-7, 1.0)
UNKNOWNS["friction"] = Unknown("coefficient of friction", "", "", "friction", 1e-3, 5.0)
# Perhaps the unknown is the strength of one body, and the other body yields.
OTHER_STRENGTH = {"yield_strength": "plate_yield_strength", "plate_yield_strength": "yield_strength"}
# E*/sigma_Y of glassy metals and of the softest lead; law fem is made for 11 to 2000.
_RATIOS = (12.0, 1e4)
_USUAL_LOSS = 0.05  # tan delta with which a search begins if none is given
_SIZES = ("radius", "thickness", "friction")
SLENDERNESS = (0.03, 6.0)  # R/H between which sizes are sought; a thinner plate gives no rebound to measure
_RADII = np.array([1e-5, 0.05])  # [m] between which a radius is sought if no thickness is known
_SEARCH_FACTOR = 5.0  # factor by which moduli and densities may differ from the values given


@dataclass(frozen=True)
class Parameter:
    """A parameter of a fit, which varies its logarithm."""

    name: str
    centre: float  # value given; NaN: none
    prior: float  # standard error of the logarithm; inf: none
    is_unknown: bool  # whether it is an unknown; else a given value with a prior

    @property
    def unknown(self) -> Unknown:
        """Its entry in `UNKNOWNS`."""
        return UNKNOWNS[self.name]

    @property
    def is_free(self) -> bool:
        """Whether it is an unknown without a prior."""
        return self.prior == math.inf

    @property
    def is_strength(self) -> bool:
        """Whether it is a yield strength."""
        return self.unknown.field == "yield_strength"

    def changes(self, law: Law) -> bool:
        """Whether the law changes with it."""
        fields = "yield_strength", "youngs_modulus", "loss_factor"
        return bool(law.from_pair) and self.unknown.field in fields


class Setting(NamedTuple):
    """Bodies and sizes of all rebounds, with all numbers in place."""

    pair: Pair
    speed: Array
    radius: Array
    thickness: Array
    friction: Array | None = None  # None: nothing that was measured depends on it
    sliding_speed: Array | None = None


def parameters(pair: Pair, data: Measurements, unknown: Sequence[str], priors: Mapping[str, float]) -> list[Parameter]:
    """List the parameters: the unknowns first, then given values with priors.

    Raises
    ------
    ValueError
        A name that is not in `UNKNOWNS`, none or more than three unknowns, a size that is neither
        given nor unknown, or both; a prior that is not positive, or of something without a value.
    """
    for argument, names in (("unknown", unknown), ("priors", priors)):
        for name in names:
            if name not in UNKNOWNS:
                raise ArgumentError(argument, name, f"must be of {', '.join(UNKNOWNS)}")
    if not 1 <= len(unknown) <= _MOST or len(set(unknown)) < len(unknown):
        raise ArgumentError("unknown", unknown, f"must be one to {_MOST} different names")
    if "friction" in [*unknown, *priors] and not data.is_oblique:
        kinds = f"{', '.join(NORMAL)} do not depend on friction: measure one of {', '.join(OBLIQUE)}"
        raise ArgumentError("unknown", None, f"{kinds} at an angle")
    for size in _SIZES if data.is_oblique else _SIZES[:2]:
        _check_size(size, getattr(data, size), size in unknown, size in priors)
    found = []
    for name in dict.fromkeys([*unknown, *priors]):
        centre = _centre(pair, data, UNKNOWNS[name])
        prior = _prior(name, centre, priors[name]) if name in priors else math.inf
        found.append(Parameter(name, centre, prior, name in unknown))
    return found


def with_guesses(pair: Pair, data: Measurements, parameters: Iterable[Parameter]) -> Pair:
    """Give bodies strengths and loss factors that are unknown, these at the frequency of the impacts.

    Raises
    ------
    ValueError
        If that frequency is not known, because the radius is unknown, too.
    """
    for one in parameters:
        role = one.unknown.body
        if not (math.isnan(one.centre) and role):
            continue
        if one.is_strength:
            guess = math.sqrt(math.prod(bounds(one, pair, data)))
            pair = with_numbers(pair.bodies, {(role, "yield_strength"): guess})
            continue
        if data.radius is None:
            remedy = f"give their radius, or Material(..., loss_factor=(a guess, frequency)) of the {role}"
            raise ArgumentError("unknown", one.name, f"needs the frequency of the impacts: {remedy}")
        time = CONTACT_TIME * unit_time(pair) * np.median(np.asarray(data.radius) / np.asarray(data.speed) ** 0.2)
        body = dataclasses.replace(getattr(pair, role), loss_factor=(_USUAL_LOSS, 0.5 / time))
        pair = Pair(**{"sphere": pair.sphere, "plate": pair.plate, role: body})
    return pair


def _check_size(name: str, values: Array | None, unknown: bool, prior: bool) -> None:
    if values is None and not unknown:
        unit = UNKNOWNS[name].unit or "-"
        reason = f"has to be given [{unit}], for each rebound or one for all, or to be unknown"
    elif values is not None and unknown and not prior:
        reason = "is unknown and given: leave it out of the data, or give its error as a prior"
    else:
        return
    raise ArgumentError(name, None, reason)


def _centre(pair: Pair, data: Measurements, unknown: Unknown) -> float:
    """Value given for an unknown, the median of a size; NaN: none."""
    value = getattr(getattr(pair, unknown.body) if unknown.body else data, unknown.field)
    value = value[0] if isinstance(value, tuple) else value
    return float(np.median(value)) if value is not None and np.isfinite(value).all() else math.nan


def _prior(name: str, centre: float, error: float) -> float:
    size = number(name, error)
    if math.isnan(centre):
        raise ArgumentError("priors", None, f"{name} has no value that {error!r} could be the error of")
    if not 0.0 < size < centre:
        reason = f"the standard error of {name} must be positive and below it, {centre:.6g}; left out, it is unknown"
        raise ArgumentError("priors", error, reason)
    return size / centre


def bounds(parameter: Parameter, pair: Pair, data: Measurements) -> tuple[float, float]:
    """Least and largest value of a parameter in a fit."""
    unknown = parameter.unknown
    low, high = unknown.least, unknown.largest
    if parameter.is_strength:
        low, high = (pair.effective_modulus / ratio for ratio in reversed(_RATIOS))
        body = getattr(pair, unknown.body)
        if isinstance(body.hardening, float):  # hardening follows from the hardness
            high = min(high, body.hardness / CONSTRAINT)  # no metal softens
    elif unknown.body and unknown.field != "loss_factor":
        low = max(low, parameter.centre / _SEARCH_FACTOR)
        high = min(high, parameter.centre * _SEARCH_FACTOR)
    elif parameter.is_free and unknown.field in _SIZES[:2]:
        least, most = SLENDERNESS
        if unknown.field == "thickness":
            radius = _RADII if data.radius is None else data.radius
            return float(np.min(radius) / most), float(np.max(radius) / least)
        thickness = np.append([], [] if data.thickness is None else data.thickness)
        thickness = thickness[np.isfinite(thickness)]
        low, high = (least * thickness.min(), most * thickness.max()) if thickness.size else _RADII.tolist()
    return low, high


def setting(pair: Pair, data: Measurements, parameters: list[Parameter], values: Array) -> Setting:
    """Put the values of parameters into bodies and sizes."""
    # copies: for read-only arrays kernels would be compiled once more
    names = "speed", "radius", "thickness", *(("friction", "sliding_speed") if data.is_oblique else ())
    sizes: Any = {name: None if getattr(data, name) is None else np.array(getattr(data, name)) for name in names}
    numbers: dict[Number, float] = {}
    for one, value in zip(parameters, values.tolist(), strict=True):
        if one.unknown.body:
            numbers[one.unknown.body, one.unknown.field] = value
        else:
            size = sizes[one.name]
            sizes[one.name] = np.full(len(data), value) if size is None else size * (value / one.centre)
    return Setting(with_numbers(pair.bodies, numbers), **sizes)
