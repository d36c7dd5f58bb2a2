"""Impacts of polymers with losses: those of the fit, and those kept out.

Bead, plate and both in turn are of a polymer. It has the moduli, density and strength of the
catalogue, and a random loss factor, frequency and effect of rate.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw.laws import fem
from validation.fem import fit, journal, metals, store
from validation.fem.cases import Case, material
from validation.fem.impact import expect

Array = NDArray[np.float64]

SEEDS = {"polymers": 20261202, "polymers_kept_out": 20261203}
NUMBERS = {"polymers": (16, 4), "polymers_kept_out": (24, 0)}  # and elastic ones on thick plates
_POLYMERS = ("pmma", "nylon-66", "polycarbonate", "ptfe", "hdpe")
_OTHERS = ("bearing-steel-52100", "glass")  # they do not yield
_LOSSES = 0.02, 0.4  # tan delta
_FREQUENCIES = 2e3, 5e4  # [Hz] at which the losses were measured, drawn by the logarithm
_RATES = 0.02, 0.06  # C of the flow stress, per e-fold of a rate in 1/s
_SPEEDS, _RADII = (0.5, 8.0), (0.5e-3, 4e-3)  # [m/s], [m], by the logarithm, as R/H is
_SLENDERNESS, _THICK = ((0.1, 0.5), (0.5, 1.5)), 0.1  # R/H
_WIDEST = 0.3  # radius of the contact over that of the sphere
_SHALLOWEST = 2.0  # speed over the yield speed, where a body may flow
_SLOWEST = 0.2  # COR without any loss but the plate's waves; below, a lossy sphere may stay


def draw(name: str) -> list[Case]:
    """List the impacts of one of `SEEDS`."""
    generator = np.random.default_rng(SEEDS[name])
    drawn, thick = NUMBERS[name]
    meshes = 2 if "kept_out" in name else 1
    listed: list[Case] = []
    while len(listed) < drawn + thick:
        case = _case(generator, len(listed), thick=len(listed) >= drawn, meshes=meshes)
        if _fits(case):
            listed.append(case)
    return listed


def compute(name: str, processes: int) -> None:
    """Compute the impacts of one of `SEEDS`."""
    listed = draw(name)
    about = f"{len(listed)} impacts of polymers with a constant loss factor, seed {SEEDS[name]}"
    journal.impacts(name, about, listed, processes)


def errors(name: str, pressure: float) -> Array:
    """Errors in COR with another strength of bodies with losses; below 0.3 over 0.3."""
    data = store.read(name).data
    found = {**fem.fitted(), "pressure": pressure}
    off = np.zeros(data["speed"].size)
    for n, case in enumerate(draw(name)):
        pair = fit.pair_of(dataclasses.asdict(case))
        pair = metals.at_rate(pair, case)
        law = fem.law_of(fit.numbers_of(pair), found)
        hit = cl.ImpactModel(pair, law).solve(case.speed, case.radius, case.thickness)
        measured = float(data["restitution"][n])
        off[n] = (float(hit.restitution) - measured) / max(measured, 0.3)
    return off


def _case(generator: np.random.Generator, n: int, *, thick: bool, meshes: int) -> Case:
    """Draw the n-th impact: bead, plate or both a polymer; elastic or not; thick plate or thin."""
    sphere_is, plate_is = ((True, False), (False, True), (True, True))[n % 3]
    flows = n // 3 % 2 == 1 and not thick
    radius, slenderness = _log(generator, _RADII), _log(generator, _SLENDERNESS[n // 6 % 2])
    sphere, plate = (
        _polymer(generator, flows=flows) if polymer else str(generator.choice(_OTHERS))
        for polymer in (sphere_is, plate_is)
    )
    return Case(
        _log(generator, _SPEEDS),
        float(f"{radius / (_THICK if thick else slenderness):.4g}"),
        radius,
        sphere,
        plate,
        yields=flows and sphere_is,
        plate_yields=flows and plate_is,
        meshes=meshes,
    )


def _polymer(generator: np.random.Generator, *, flows: bool) -> str:
    base, rate = str(generator.choice(_POLYMERS)), generator.uniform(*_RATES)
    loss, frequency = generator.uniform(*_LOSSES), _log(generator, _FREQUENCIES)
    strength = material(base).require_yield_strength("fem")
    flow = f", flow {strength:.4g} 0 1 {rate:.3f} 1" if flows else ""
    return f"{base}{flow}, loss {loss:.3f} {frequency:.4g}"


def _log(generator: np.random.Generator, limits: tuple[float, float]) -> float:
    return float(f"{math.exp(generator.uniform(*np.log(limits))):.4g}")


def _fits(case: Case) -> bool:
    """Whether a contact is no wider than elements bear, a body flows that may, and the bead leaves.

    All is estimated without losses.
    """
    pair, sizes = case.pair, (case.speed, case.radius, case.thickness)
    may_flow = case.yields or case.plate_yields
    found = expect(pair, *sizes, case.yields, case.plate_yields)
    elastic = cl.ImpactModel(pair, law="hertz", outside="solve").lookup(*sizes)
    return (
        found.contact < _WIDEST * case.radius
        and float(elastic.restitution) > _SLOWEST
        and not (may_flow and case.speed < _SHALLOWEST * metals.ideal(case).yield_speed)
    )
