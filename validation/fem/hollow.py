"""Spheres that are not solid: hollow ones, and ones of a core and a shell.

The model knows such a sphere by its mass alone, mu times that of a solid one of the shell's
material. Its error is what the inside does beyond that: a thin shell bends, and a sphere with a
core vibrates otherwise than the solid spheres that the law `fem` was fitted to.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import NamedTuple

import contactlaw as cl
from validation.fem import cases, fit, store
from validation.fem.cases import Case
from validation.fem.impact import with_mass

NAME = "hollow"
RADIUS = 1e-3  # [m]


class Compared(NamedTuple):
    """One impact: finite elements beside the law `fem`; errors are relative to finite elements."""

    case: Case
    fem: float  # COR
    law: float  # COR
    other: float  # share of the energy that the law leaves in vibration and friction
    restitution: float
    contact_time: float
    peak_force: float


def compared() -> list[Compared]:
    """Compare the stored impacts with the model, which knows the sphere's mass alone."""
    data, rows = store.read(NAME).data, []
    for n, case in enumerate(cases.stored(NAME)):
        pair = with_mass(fit.pair_of(asdict(case)), case.core)
        hit = cl.ImpactModel(pair).solve(case.speed, case.radius, case.thickness)
        errors = (float(getattr(hit, k)) / data[k][n] - 1.0 for k in Compared._fields[-3:])
        found = data["restitution"][n], float(hit.restitution), float(hit.other_fraction)
        rows.append(Compared(case, *found, *errors))
    return rows
