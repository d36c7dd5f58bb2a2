"""Fits of one to three unknowns to 50 measured rebounds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw import laws
from contactlaw.fitting.predictions import impacts
from contactlaw.fitting.unknowns import Setting
from contactlaw.laws import fem, jackson_green, kogut_etsion
from contactlaw.physical.law import law_of
from validation.bench.row import Row, seconds

Data = dict[str, NDArray[np.float64] | float]

POINTS = 50
STEEL = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
_NOISE = 0.01
_ONE, _TWO = ("thickness",), ("yield_strength", "thickness")
_QUESTIONS = (  # pair, law, unknowns, target [s]
    (STEEL, "fem", _ONE, 0.3),
    (STEEL, "fem", ("plate_yield_strength",), 0.3),
    (STEEL, "fem", ("plate_yield_strength", "thickness"), 0.3),
    (STEEL, "fem", ("plate_yield_strength", "youngs_modulus", "thickness"), 0.3),
    (cl.Pair("copper-ofhc-annealed", "aluminium-6061-t6"), "fem", ("yield_strength", "plate_yield_strength"), 3.0),
    *(
        (cl.Pair("gamma-alumina", "glass"), law, unknown, 0.3)
        for law in laws.names()
        if law != "fem"
        for unknown in (_ONE, ("yield_strength",), _TWO)[: 1 if law == "hertz" else None]
    ),
)


def rows() -> Iterator[Row]:
    """Measure fits in a warm process, without the laws that earlier fits cached."""
    for pair, law, unknown, target in _QUESTIONS:
        data = measured(pair, law, unknown)

        def once() -> None:
            for family in (fem, jackson_green, kogut_etsion):
                family.law.cache_clear()
            cl.fit(pair, data, unknown, law)  # noqa: B023  # called in this turn of the loop

        yield Row(f"fit, {law}, {', '.join(unknown)}", seconds(once, 5), "s", target)


def measured(pair: cl.Pair, law: str, unknown: tuple[str, ...]) -> Data:
    """Draw noisy rebounds of a bead of 1 mm radius from a plate of 1 mm."""
    random = np.random.default_rng(1)
    speed = np.geomspace(0.1, 8.0, POINTS) * (1.0 if law == "fem" else 4.0)
    size = np.full(POINTS, 1e-3)
    hit = impacts(Setting(pair, speed, size, size), law_of(pair, law))
    data: Data = {"speed": speed}
    data |= {name: 1e-3 for name in ("radius", "thickness") if name not in unknown}
    for kind in ("restitution", "contact_time", "peak_force")[: len(unknown)]:
        exact = np.asarray(getattr(hit, kind))
        data[kind] = exact * (1.0 + _NOISE * random.standard_normal(POINTS))
        data[f"{kind}_error"] = _NOISE * exact
    return data
