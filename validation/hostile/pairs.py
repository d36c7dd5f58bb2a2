"""Random pairs of materials: continuous, in range, and flagged outside of the finite elements.

Moduli are drawn over six decades, Poisson's ratios to 0.49, strengths of E*/5 to E*/1e7 or none;
either body is the weaker, or the strengths are equal, also but for 2e-4. Of each case, the model
can be made; the COR of a few impacts has no jump across equal strengths, nor along any input; waves
take less energy on a thicker plate; every number is finite and the energies sum to one; a strength
outside of the finite elements is flagged; and, in a tenth of the cases, a lookup agrees with
integration.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw import Validity
from contactlaw.laws.fem import RATIOS
from contactlaw.physical.law import law_of

Array = NDArray[np.float64]

FULL = 2000
_LOOKED_UP = 10  # one table is built in so many cases
_NEAR = 1e-4  # relative step of an input
_RADIUS = 1e-3  # [m]
_ENERGIES = 1e-7  # tolerance of their sum: 1e-10 in each of some hundred steps
_RATIO = (5.0, 1e7)  # E*/sigma_Y of the weaker body
# A change of COR beyond this, over twice that of the steps beside it, is a jump.
_KINK = 3e-6


def faults(count: int, seed: int) -> Iterator[str]:
    """Try random pairs; yield a sentence for each fault, with the pair."""
    generator = np.random.default_rng(seed)
    for n in range(count):
        pair, speed, thickness = draw(generator)
        where = (
            f"{_words(pair.sphere)} on {_words(pair.plate)}, V {speed.tolist()} m/s, "
            f"H {thickness:.17g} m"
        )
        try:
            found = [
                *answers(pair, speed, thickness),
                *steps(pair, speed, thickness),
                *thicker(pair, speed),
            ]
            if n % _LOOKED_UP == 0:
                found += lookups(pair, speed, thickness)
        except (ValueError, RuntimeError, ArithmeticError) as error:
            found = [f"{type(error).__name__}: {error}"]
        yield from (f"{fault}: {where}" for fault in found)


def draw(generator: np.random.Generator) -> tuple[cl.Pair, Array, float]:
    """Draw a pair, speeds from well below yield up, and a thickness."""
    modulus = np.exp(generator.uniform(math.log(1e6), math.log(1e12), 2))
    if generator.random() < 0.5:  # within a factor of ten, so that both bodies deform
        modulus[1] = min(modulus[0] * math.exp(generator.uniform(-2.3, 2.3)), 1e12)
    nu = generator.uniform(0.0, 0.49, 2)
    effective = 1.0 / np.sum((1.0 - nu**2) / modulus)
    # Waves are no faster than 20 km/s.
    least = np.maximum(modulus / 4e8, 500.0)
    density = least * np.exp(generator.uniform(0.0, np.log(2e4 / 500.0), 2))
    weakest = float(effective) / math.exp(generator.uniform(*np.log(_RATIO)))
    weakest = max(weakest, 1.1e-12 * float(modulus.max()))  # a weaker solid is refused
    other = weakest * math.exp(generator.uniform(0.0, 3.0))
    kinds: tuple[tuple[float | None, float | None], ...] = (
        (None, None),
        (weakest, None),
        (weakest, weakest),
        (weakest, other),
        (weakest * (1.0 - _NEAR), weakest * (1.0 + _NEAR)),
    )
    strengths = kinds[generator.integers(len(kinds))]
    if generator.random() < 0.5:
        strengths = strengths[::-1]
    bodies = [
        cl.Material(
            name, float(e), float(n), float(rho),
            yield_strength=None if s is None or s >= 0.99 * e else float(s),
        )
        for name, e, n, rho, s in zip(("a", "b"), modulus, nu, density, strengths, strict=True)
    ]  # fmt: skip
    pair = cl.Pair(*bodies)
    # kinetic energy equal to the work of Hertz's contact at yield, or at a tenth of the radius
    deep = min(_share(pair), 0.1)
    slow = math.sqrt(0.8 * pair.effective_modulus * deep**2.5 / math.pi / pair.sphere.density)
    speed = slow * np.exp(generator.uniform(np.log(0.3), np.log(300.0), 3))
    fastest = 0.1 * math.sqrt(pair.effective_modulus / pair.sphere.density)
    thickness = _RADIUS * math.exp(generator.uniform(np.log(0.5), np.log(30.0)))
    return pair, np.minimum(speed, fastest), thickness


def _share(pair: cl.Pair) -> float:
    law = law_of(pair, "fem")
    return law.scale if law.yields and law.scale is not None else math.inf


def solve(pair: cl.Pair, speed: Array, thickness: Array | float) -> cl.Rebound:
    """Integrate impacts of beads of a millimetre."""
    return cl.ImpactModel(pair).solve(speed, _RADIUS, thickness)


def answers(pair: cl.Pair, speed: Array, thickness: float) -> Iterator[str]:
    """Check that numbers are finite, energies sum to one, and untried strengths are flagged."""
    for h in (thickness, math.inf):
        hit = solve(pair, speed, h)
        for field in dataclasses.fields(hit):
            if not np.isfinite(getattr(hit, field.name)).all():
                yield f"{field.name} is {getattr(hit, field.name)}"
        e = np.asarray(hit.restitution)
        parts = (hit.plastic_fraction, hit.wave_fraction, hit.other_fraction)
        whole = e**2 + sum(np.asarray(part) for part in parts)
        if not ((e >= 0.0) & (e <= 1.0)).all():
            yield f"COR {e}"
        if not np.abs(whole - 1.0).max() <= _ENERGIES:
            yield f"energies sum to {whole}"
        if min(float(np.min(part)) for part in parts) < -_ENERGIES:
            yield f"a loss is negative: {parts}"
        # In finite elements the stronger body yields too, up to 1/0.36 times the lower strength.
        strengths = [s for s in (pair.sphere.yield_strength, pair.plate.yield_strength) if s]
        flowing = [s for s in strengths if s < min(strengths) / 0.36]
        ratios = [pair.effective_modulus / s for s in flowing]
        yields = np.asarray(hit.plastic_fraction) > 0.0
        untried = (np.asarray(hit.flags) & Validity.UNTRIED_STRENGTH) != 0
        known = all(RATIOS[0] <= ratio <= RATIOS[1] for ratio in ratios)
        stiffness = pair.sphere.plane_modulus / pair.plate.plane_modulus
        known &= len(flowing) < 2 or 1.0 / 12.0 <= stiffness <= 12.0
        if (untried != (yields & (not known))).any():
            yield f"flags {hit.flags} with E*/sigma_Y {ratios}"


def steps(pair: cl.Pair, speed: Array, thickness: float) -> Iterator[str]:
    """Check that no small step of an input moves the COR far more than its neighbours do."""
    for name, moved in inputs(pair):
        cor = np.array([np.asarray(solve(one, speed, thickness).restitution) for one in moved])
        first = np.abs(np.diff(cor, axis=0))
        jump = first[1] - 2.0 * np.maximum(first[0], first[2])
        if jump.max() > _KINK:
            yield f"COR jumps by {jump.max():.2g} with the {name}"


def inputs(pair: cl.Pair) -> Iterator[tuple[str, list[cl.Pair]]]:
    """Yield four pairs along each input, and four across equal strengths."""
    at = _NEAR * np.array([-1.5, -0.5, 0.5, 1.5])
    for body, field in itertools.product(
        ("sphere", "plate"), ("youngs_modulus", "poissons_ratio", "yield_strength")
    ):
        value = getattr(getattr(pair, body), field)
        if value is not None and not (field == "poissons_ratio" and not 1e-3 < value < 0.489):
            yield f"{field} of the {body}", [_with(pair, body, field, value * (1 + d)) for d in at]
    strengths = [body.yield_strength for body in (pair.sphere, pair.plate)]
    if None not in strengths:
        equal = min(s for s in strengths if s is not None)
        yield "ratio of the strengths", [
            _with(
                _with(pair, "sphere", "yield_strength", equal * (1 + d)),
                "plate", "yield_strength", equal * (1 - d),
            )
            for d in at
        ]  # fmt: skip


def _with(pair: cl.Pair, body: str, field: str, value: float) -> cl.Pair:
    changed: dict[str, Any] = {field: value}
    if body == "sphere":
        return cl.Pair(dataclasses.replace(pair.sphere, **changed), pair.plate)
    return cl.Pair(pair.sphere, dataclasses.replace(pair.plate, **changed))


def thicker(pair: cl.Pair, speed: Array) -> Iterator[str]:
    """Check that lambda and, where nothing yields, the loss to waves fall with the thickness.

    The COR rises, except by friction: with less lost to waves a contact is deeper, and slips more.
    """
    thickness = _RADIUS * np.geomspace(0.3, 100.0, 60)
    elastic = cl.Pair(
        *(dataclasses.replace(body, yield_strength=None) for body in (pair.sphere, pair.plate))
    )
    hit = solve(elastic, speed[:1], thickness)
    lam, waves = np.asarray(hit.inelasticity), np.asarray(hit.wave_fraction)
    if (np.diff(lam) > 1e-9 * lam[1:]).any():
        yield f"lambda rises with the thickness, by {np.diff(lam).max():.2g}"
    if (np.diff(waves) > _ENERGIES).any():
        yield f"waves take more with the thickness, by {np.diff(waves).max():.2g}"
    e, other = np.asarray(hit.restitution), np.asarray(hit.other_fraction)
    if (np.diff(e**2) < -np.abs(np.diff(other)) - _ENERGIES).any():
        yield f"COR falls with the thickness, by {-np.diff(e).min():.2g}"


def lookups(pair: cl.Pair, speed: Array, thickness: float) -> Iterator[str]:
    """Check the COR by the table of a pair against integration.

    Its warning is ignored: it may concern another field, as the contact time at a small COR.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        model = cl.ImpactModel(pair, outside="solve")
        looked = model.lookup(speed, _RADIUS, thickness).restitution
    exact = model.solve(speed, _RADIUS, thickness).restitution
    off = float(np.abs(np.asarray(looked) - np.asarray(exact)).max())
    if not off <= 1e-5:
        yield f"lookup differs from solve by {off:.2g}"


def _words(body: cl.Material) -> str:
    values = (body.youngs_modulus, body.poissons_ratio, body.density, body.yield_strength)
    return "(" + ", ".join("None" if one is None else f"{one:.17g}" for one in values) + ")"
