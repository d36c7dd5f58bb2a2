"""The law that a user chose for a pair, with the numbers that it takes from the materials."""

import dataclasses

from contactlaw import laws
from contactlaw._errors import ArgumentError
from contactlaw.laws import Law
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair


def law_of(pair: Pair, law: str | Law) -> Law:
    """Resolve the law that a user gave, with the numbers that it takes from the pair.

    Raises
    ------
    ValueError
        If there is no such law, or the sphere has no yield strength where the law needs one.
    TypeError
        If `law` is neither a name nor a Law.
    """
    if isinstance(law, Law):
        found = laws.own(law)
    elif not isinstance(law, str):
        raise TypeError(f"law: expected the name of a law or a contactlaw.laws.Law, got {law!r}")
    else:
        for body in pair.bodies:
            if body.poissons_ratio < 0.0 and "poissons_ratio" in laws.parameters(law):
                raise ArgumentError(
                    "law",
                    law,
                    f"it is made for Poisson's ratios from 0 to 0.5, {body.name!r} has "
                    f'{body.poissons_ratio:g}: take law="myc", or "hertz" for bodies that do not yield',
                )
        found = laws.law(law, **pair_numbers(pair, law))
    if found.from_pair and isinstance(law, Law) and law_of(pair, found.family) != found:
        found = dataclasses.replace(found, from_pair=())  # of another pair: numbers held fixed
    if found.yields and found.scale is None:
        pair.sphere.require_yield_strength(found.name)
    return found


def law_for_pair(pair: Pair, law: Law) -> Law:
    """Law for another pair: it gets that pair's numbers, unrounded, if it takes any."""
    if not law.from_pair:
        return law
    return dataclasses.replace(laws.exact(law.family, **pair_numbers(pair, law.family)), from_pair=law.from_pair)


def pair_numbers(pair: Pair, law: str) -> dict[str, float]:
    """Numbers that laws take from a pair."""
    numbers = {
        "poissons_ratio": pair.sphere.poissons_ratio,
        "plate_poissons_ratio": pair.plate.poissons_ratio,
        "sphere_ratio": _modulus_ratio(pair, pair.sphere),
        "plate_ratio": _modulus_ratio(pair, pair.plate),
        "modulus_share": pair.effective_modulus / pair.plate.plane_modulus,
    }
    for role, body in (("sphere", pair.sphere), ("plate", pair.plate)):
        if body.flow is not None and body.flow.hardening:
            numbers[f"{role}_hardening"] = body.flow.hardening / body.flow.strength
            numbers[f"{role}_exponent"] = body.flow.exponent
    if pair.frequency:
        numbers["loss_factor"] = pair.loss_factor
    if "modulus_ratio" in laws.parameters(law):
        numbers["modulus_ratio"] = pair.effective_modulus / pair.sphere.require_yield_strength(law)
    return numbers


def _modulus_ratio(pair: Pair, body: Material) -> float:
    """E*/sigma_Y of a body; 0 for one that does not yield."""
    return 0.0 if body.strength is None else pair.effective_modulus / body.strength
