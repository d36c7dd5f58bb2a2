"""Two bodies whose materials and law are known, and the numbers of their impacts."""

import functools
from dataclasses import dataclass
from typing import Any

import numpy as np

from contactlaw._arrays import Array, Integers
from contactlaw._errors import ArgumentError
from contactlaw.equation.numbers import HEAVIEST, LIGHTEST, Impact, Numbers, PairConstants, mass_fits, solid_mass
from contactlaw.laws import Law
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.pair import Pair
from contactlaw.physical.plates import check_contact
from contactlaw.physical.scaling import constants_of, numbers_of, on_wall, without_plate
from contactlaw.physical.strengths import by_strength
from contactlaw.physical.validity import Limits, limits, limits_by_strength, mass_flags


@dataclass(frozen=True, eq=False)
class SphereOnPlate:
    """A pair of materials and its law, with the constants that follow from them."""

    pair: Pair
    law: Law

    @functools.cached_property
    def limits(self) -> Limits:
        """Limits of the model."""
        return limits(self.pair, self.law)

    @functools.cached_property
    def constants(self) -> PairConstants:
        """Constants from which the dimensionless numbers of impacts follow."""
        return constants_of(self.pair, self.law)

    @functools.cached_property
    def data(self) -> Array:
        """The law at any strength, as kernels read it."""
        return by_strength(self.pair, self.law)

    @functools.cached_property
    def limits_by_strength(self) -> Array:
        """Limits of the model at some strengths, as kernels read them."""
        return limits_by_strength(self.pair, self.law)

    def given(self, speed: Any, radius: Any, thickness: Any, *more: Any, memory: bool = False, **named: Any) -> Impacts:
        """Impacts that a user gave, see `Impacts.on_plates`; masses are checked, too.

        `memory` says whether the caller integrates impacts on plates from which something comes
        back; others refuse curved walls and foundations.
        """
        check_contact(thickness, self.pair.given[1])
        impacts = Impacts.on_plates(speed, radius, thickness, *more, **named)
        if impacts.mass is not None:
            share = impacts.mass / self.solid_mass(impacts.radius)
            for n in np.flatnonzero(~mass_fits(share))[:1].tolist():
                raise _refused(impacts.mass[n], share[n], n if share.size > 1 else None)
        return impacts if impacts.wall is None else on_wall(self.pair.plate, impacts, memory)

    def impact(self, impacts: Impacts) -> Impact:
        """Impacts as kernels take them."""
        share, radius = np.ones_like(impacts.speed), impacts.radius
        if impacts.bending is not None:
            radius = radius * impacts.bending
        if impacts.mass is not None or impacts.bending is not None:
            share = self.mass(impacts) / self.solid_mass(radius)
        return Impact(impacts.speed, radius, impacts.thickness, share)

    def solid_mass(self, radius: Array) -> Array:
        """Mass of a solid sphere [kg]."""
        return np.asarray(solid_mass(self.constants, radius))

    def mass(self, impacts: Impacts) -> Array:
        """Mass that answers at the contact of each impact [kg]."""
        return self.solid_mass(impacts.radius) if impacts.mass is None else impacts.mass

    def numbers(self, impact: Impact) -> Numbers:
        """Dimensionless numbers and units of impacts."""
        return numbers_of(self.constants, self.data, impact)

    def mass_flags(self, impacts: Impacts) -> Integers:
        """Limits that masses exceed."""
        return np.asarray(mass_flags(self.mass(impacts) / self.solid_mass(impacts.radius)))


def _refused(mass: float, share: float, n: int | None) -> ArgumentError:
    remedy = (
        "a hollow sphere so light is a thin shell, which bends under the contact"
        if share < LIGHTEST
        else "is it in grams? It is the mass that answers at the contact"
    )
    limits = f"must be {LIGHTEST:g} to {HEAVIEST:g} of it: {remedy}"
    reason = f"{share:.4g} of a solid sphere's {mass / share:.4g} kg; {limits}"
    return ArgumentError("mass", mass, reason, n)


class TwoSpheres(SphereOnPlate):
    """Materials of two spheres, from which no wave carries energy off, and their law."""

    @functools.cached_property
    def constants(self) -> PairConstants:
        """Constants from which the dimensionless numbers of impacts follow."""
        return without_plate(constants_of(self.pair, self.law))

    def mass_flags(self, impacts: Impacts) -> Integers:
        """None: the mass is that of both."""
        return np.zeros(impacts.speed.size, dtype=np.int64)
