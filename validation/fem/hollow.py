"""Spheres that are not solid: hollow ones, and ones of a core and a shell.

The model knows such a sphere by its mass alone, mu times that of a solid one of the shell's
material. Its error is what the inside does beyond that: a thin shell bends, and a sphere with a
core vibrates otherwise than the solid spheres that the law `fem` was fitted to.
"""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import NamedTuple

import contactlaw as cl
from validation.fem import fit, journal, store
from validation.fem.cases import Case
from validation.fem.impact import with_mass
from validation.fem.mesh import SOLID, Core

NAME = "hollow"
RADIUS = 1e-3  # [m]
SHELLS = 0.7, 0.5, 0.4, 0.3, 0.25, 0.2, 0.15, 0.1  # thickness [R]
# A light and a dense core as stiff as the shell; a foam; ones as stiff as carbides, or as lead
CORES = (
    Core(0.7, 0.3, 1.0),
    Core(0.7, 3.0, 1.0),
    Core(0.8, 0.2, 0.02),
    Core(0.7, 0.4, 3.0),
    Core(0.7, 2.0, 3.0),
    Core(0.7, 1.4, 0.1),
    Core(0.8, 5.0, 1.0),
)
_USUAL = SOLID, Core(0.5), Core(0.6), Core(0.7), Core(0.75), CORES[1]
_ALL = "bearing-steel-52100", "glass"  # plates of the series with more spheres than these
# sphere, plate, speed [m/s], whether the sphere flows, and the plate; R/H
SERIES = (
    ("soda-lime-glass", "bearing-steel-52100", 3.0, False, False, (0.1, 1.0)),
    ("stainless-steel-304", "glass", 3.0, True, False, (0.1, 1.0)),
    ("aluminium-6061-t6", "alumina", 1.0, True, False, (0.1,)),
    ("soda-lime-glass", "aluminium-6061-t6", 5.0, False, True, (0.1,)),
)


def listed() -> list[Case]:
    """List the impacts: those of `SERIES`, and one of them again on elements half as large."""
    cases = [
        Case(speed, RADIUS / slenderness, RADIUS, sphere, plate, yields=yields, plate_yields=plate_yields, core=core)
        for sphere, plate, speed, yields, plate_yields, slendernesses in SERIES
        for slenderness in slendernesses
        for core in (SOLID, *(Core(1.0 - share) for share in SHELLS), *CORES)
        if core in _USUAL or plate in _ALL
    ]
    finer = next(one for one in cases if one.yields and one.core == Core(0.7))
    return [*cases, replace(finer, size=0.0034, far=0.5)]


def compute(processes: int) -> None:
    """Compute the impacts."""
    about = "hollow and layered spheres; core: its radius [R], density and modulus over the shell's"
    journal.impacts(NAME, about, listed(), processes)


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
    for n, case in enumerate(listed()):
        pair = with_mass(fit.pair_of(asdict(case)), case.core)
        hit = cl.ImpactModel(pair).solve(case.speed, case.radius, case.thickness)
        errors = (float(getattr(hit, k)) / data[k][n] - 1.0 for k in Compared._fields[-3:])
        found = data["restitution"][n], float(hit.restitution), float(hit.other_fraction)
        rows.append(Compared(case, *found, *errors))
    return rows
