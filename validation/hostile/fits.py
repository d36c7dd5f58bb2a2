"""Fits of two unknowns to exact data: within two standard errors, or with alternatives, or refused.

A case is a bead and a plate of the catalogue, R 0.1 to 5 mm, R/H 0.1 to 1.8, 6 to 16 speeds, exact
values of one to three kinds with a stated error of 1 %, and any two of the ten unknowns. Bodies
have losses if a loss factor is unknown.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw.fitting.measurements import NORMAL
from contactlaw.fitting.unknowns import UNKNOWNS
from validation.inverse.model import rebounds, true

Array = NDArray[np.float64]

FULL = 500

_ERROR = 0.01  # stated relative error of the values
_LEAST_COR = 0.05  # smallest COR of a measurement
_LOSSES = 0.02, 0.4  # tan delta
_LARGEST = 2.0  # error of an answer that is allowed, in standard errors


class Case(NamedTuple):
    """A measurement, and its two unknowns."""

    pair: cl.Pair
    radius: float
    thickness: float
    speed: Array
    kinds: tuple[str, ...]
    unknown: tuple[str, ...]

    def data(self) -> dict[str, Array | float]:
        """Compute the rebounds, and leave out the unknowns."""
        hit = rebounds(self, "fem")
        found: dict[str, Array | float] = {"speed": self.speed}
        sizes = {"radius": self.radius, "thickness": self.thickness}
        found |= {name: size for name, size in sizes.items() if name not in self.unknown}
        for kind in self.kinds:
            found[kind] = np.asarray(getattr(hit, kind))
            found[f"{kind}_error"] = _ERROR * found[kind]
        return found

    def words(self) -> str:
        """Describe the case with all its inputs."""
        speeds = ", ".join(f"{v:.4g}" for v in self.speed.tolist())
        return (
            f"{self.pair.sphere.name} on {self.pair.plate.name}, R {self.radius:.9g} m, "
            f"H {self.thickness:.9g} m, {' and '.join(self.kinds)} at {speeds} m/s, unknown "
            f"{' and '.join(self.unknown)}"
        )


def draw(random: np.random.Generator) -> Case:
    """Draw a measurement with two unknowns that its bodies have, at speeds of up to 30 m/s."""
    questions = list(itertools.combinations((name for name in UNKNOWNS if name != "friction"), 2))
    names = list(cl.materials())
    while True:
        pair = cl.Pair(*(str(random.choice(names)) for _ in range(2)))
        unknown = questions[int(random.integers(len(questions)))]
        pair = cl.Pair(
            *(
                dataclasses.replace(body, loss_factor=(random.uniform(*_LOSSES), 1e4))
                if f"{prefix}loss_factor" in unknown
                else body
                for prefix, body in (("", pair.sphere), ("plate_", pair.plate))
            )
        )
        bodies = {"yield_strength": pair.sphere, "plate_yield_strength": pair.plate}
        if any(bodies[name].yield_strength is None for name in unknown if name in bodies):
            continue
        radius = 1e-3 * math.exp(random.uniform(math.log(0.1), math.log(5.0)))
        thickness = radius / math.exp(random.uniform(math.log(0.1), math.log(1.8)))
        slowest = math.exp(random.uniform(math.log(0.05), math.log(5.0)))
        fastest = slowest * random.uniform(3.0, 30.0)
        speed = np.geomspace(slowest, min(fastest, 30.0), int(random.integers(6, 17)))
        kinds = tuple(random.permutation(list(NORMAL))[: random.integers(1, 4)].tolist())
        case = Case(pair, radius, thickness, speed, kinds, unknown)
        if np.min(rebounds(case, "fem").restitution) > _LEAST_COR:
            return case


def faults(count: int, seed: int = 0) -> Iterator[str]:
    """Fit random cases; yield those whose answer is wrong and has no alternatives."""
    random = np.random.default_rng(seed)
    for _ in range(count):
        fault = fault_of(draw(random))
        if fault:
            yield fault


def fault_of(case: Case) -> str:
    """Describe what is wrong with the fit of a case; empty if nothing is."""
    try:
        found = cl.fit(case.pair, case.data(), case.unknown)
    except cl.UnidentifiedError:
        return ""
    off = {
        name: (found.values[name] - true(case, name)) / found.errors[name] for name in case.unknown
    }
    if found.alternatives or max(map(abs, off.values())) <= _LARGEST:
        return ""
    answers = "; ".join(
        f"{name} {found.values[name]:.6g} +- {found.errors[name]:.3g}, true {true(case, name):.6g}"
        for name in case.unknown
    )
    return f"{case.words()}: {answers}"
