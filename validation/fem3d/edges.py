"""Normal impacts near a free edge of a plate, straight or the rim of a hole, without friction.

Each is computed on the same kind of mesh without the edge too, because what the edge changes is
what a model must predict. Two are repeated on finer elements.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import contactlaw as cl
from validation.fem3d.impact import oblique_impact

NAME = "edges"


@dataclass(frozen=True)
class Case:
    """One impact; lengths in metres."""

    sphere: str  # a material of the catalogue, of which only elasticity and density count
    plate: str
    kind: str  # of `cases.KINDS`: which body flows
    strength: float  # of that body [Pa]; 0: none flows
    radius: float  # of the sphere
    thickness: float
    speed: float  # [m/s]
    distance: float  # from the first contact to the edge; 0: there is no edge nearby
    hole: float  # radius of the hole whose rim is the edge; 0: the edge is straight
    across: float  # elements in the expected radius of the contact

    @property
    def pair(self) -> cl.Pair:
        """Materials; only that of the body that flows has a strength."""
        made = []
        for body, name in (("sphere", self.sphere), ("plate", self.plate)):
            of, strength = cl.material(name), self.strength if self.kind == body else None
            elasticity = of.youngs_modulus, of.poissons_ratio, of.density
            made.append(cl.Material(name, *elasticity, yield_strength=strength))
        return cl.Pair(*made)


def solve(case: Case) -> dict[str, Any]:
    """Compute an impact."""
    hit = oblique_impact(
        case.pair,
        case.speed,
        0.0,
        case.radius,
        case.thickness,
        0.0,
        yields=case.kind == "sphere",
        plate_yields=case.kind == "plate",
        across=int(case.across),
        distance=case.distance or math.inf,
        hole=case.hole or math.inf,
    )
    return {key: value for key, value in vars(hit).items() if key != "history"}
