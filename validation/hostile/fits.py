"""Fits of two unknowns to exact data: within two standard errors, or with alternatives, or refused.

A case is a bead and a plate of the catalogue, R 0.1 to 5 mm, R/H 0.1 to 1.8, 6 to 16 speeds, exact
values of one to three kinds with a stated error of 1 %, and any two of the ten unknowns. Bodies
have losses if a loss factor is unknown.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw.fitting.measurements import NORMAL
from contactlaw.fitting.unknowns import UNKNOWNS
from validation.hostile import log, simplest
from validation.inverse.model import rebounds, true

Array = NDArray[np.float64]

FULL = 500

_ERROR = 0.01  # stated relative error of the values
_LEAST_COR = 0.05  # smallest COR of a measurement
_LOSSES = 0.02, 0.4  # tan delta
_QUESTIONS = list(itertools.combinations([name for name in UNKNOWNS if name != "friction"], 2))
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


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """Draw a measurement with two unknowns that its bodies have, at speeds of up to 30 m/s."""
    unknown = draw(st.sampled_from(_QUESTIONS))
    bodies = []
    for prefix in ("", "plate_"):
        lossy, yielding = f"{prefix}loss_factor" in unknown, f"{prefix}yield_strength" in unknown
        body = cl.material(draw(st.sampled_from(sorted(cl.materials()))))
        assume(not yielding or body.yield_strength is not None)
        loss = (draw(st.floats(*_LOSSES)), 1e4)
        bodies.append(dataclasses.replace(body, loss_factor=loss) if lossy else body)
    radius, slowest = draw(log(0.1e-3, 5e-3)), draw(log(0.05, 5.0))
    fastest = min(slowest * draw(st.floats(3.0, 30.0)), 30.0)
    case = Case(
        cl.Pair(*bodies),
        radius,
        radius / draw(log(0.1, 1.8)),
        np.geomspace(slowest, fastest, draw(st.integers(6, 16))),
        tuple(draw(st.lists(st.sampled_from(list(NORMAL)), min_size=1, max_size=3, unique=True))),
        unknown,
    )
    assume(np.min(rebounds(case, "fem").restitution) > _LEAST_COR)
    return case


def faults(count: int, seed: int = 0) -> Iterator[str]:
    """Fit random cases; yield the simplest whose answer is wrong and has no alternatives."""
    return simplest(cases(), check, count, seed)


def check(case: Case) -> Iterator[str]:
    """Describe what is wrong with the fit of a case."""
    try:
        found = cl.fit(case.pair, case.data(), case.unknown)
    except cl.UnidentifiedError:
        return
    off = {name: (found.values[name] - true(case, name)) / found.errors[name] for name in case.unknown}
    if not found.alternatives and max(map(abs, off.values())) > _LARGEST:
        yield f"{case}: {found.values} +- {found.errors}, off by {off} errors"
