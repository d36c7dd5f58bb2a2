"""Fits of one to three unknowns to 50 measured rebounds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

import contactlaw as cl
from contactlaw import laws
from contactlaw.fitting.predictions import impacts
from contactlaw.fitting.unknowns import Setting
from contactlaw.laws import fem, jackson_green, kogut_etsion
from contactlaw.physical.law import law_of
from validation.bench.row import Row, seconds

Array = NDArray[np.float64]
Data = dict[str, Array | float]

POINTS = 50
_NOISE = 0.01
_QUESTIONS = (("thickness",), ("yield_strength",), ("yield_strength", "thickness"))
_STEEL = (
    ("thickness",), ("plate_yield_strength",), ("plate_yield_strength", "thickness"),
    ("plate_yield_strength", "youngs_modulus", "thickness"),
)  # fmt: skip


def rows() -> Iterator[Row]:
    """Measure fits in a warm process, without the laws that earlier fits cached."""
    steel = cl.Pair("bearing-steel-52100", "aluminium-6061-t6")
    paper = cl.Pair("gamma-alumina", "glass")
    data = measured(steel, "fem", ("thickness",))
    by_hand = seconds(lambda: with_a_table(steel, data), 3)
    ours = timed(steel, "fem", ("thickness",))
    yield Row("fit, fem, thickness", ours, "s", 0.3, "scipy on ImpactModel", by_hand / ours,
              note="which has its table already, and finds no standard errors")  # fmt: skip
    for question in _STEEL[1:]:
        yield Row(f"fit, fem, {', '.join(question)}", timed(steel, "fem", question), "s", 0.3)
    metals = cl.Pair("copper-ofhc-annealed", "aluminium-6061-t6")
    both = ("yield_strength", "plate_yield_strength")
    yield Row("fit, fem, two strengths at rates", timed(metals, "fem", both), "s", 3.0)
    for law in laws.names():
        for question in _QUESTIONS[: 1 if law == "hertz" else None]:
            if law != "fem":
                took = timed(paper, law, question)
                yield Row(f"fit, {law}, {', '.join(question)}", took, "s", 0.3)


def timed(pair: cl.Pair, law: str, question: tuple[str, ...]) -> float:
    """Time of a fit that finds no law in the cache [s]."""
    data = measured(pair, law, question)

    def once() -> None:
        for family in (fem, jackson_green, kogut_etsion):
            family.law.cache_clear()
        cl.fit(pair, data, question, law)

    return seconds(once, 5)


def measured(pair: cl.Pair, law: str, question: tuple[str, ...]) -> Data:
    """Draw noisy rebounds of a bead of 1 mm radius from a plate of 1 mm."""
    random = np.random.default_rng(1)
    speed = np.geomspace(0.1, 8.0, POINTS) * (1.0 if law == "fem" else 4.0)
    size = np.full(POINTS, 1e-3)
    hit = impacts(Setting(pair, size, size), law_of(pair, law), speed)
    data: Data = {"speed": speed}
    data |= {name: 1e-3 for name in ("radius", "thickness") if name not in question}
    for kind in ("restitution", "contact_time", "peak_force")[: len(question)]:
        exact = np.asarray(getattr(hit, kind))
        data[kind] = exact * (1.0 + _NOISE * random.standard_normal(POINTS))
        data[f"{kind}_error"] = _NOISE * exact
    return data


def with_a_table(pair: cl.Pair, data: Data) -> object:
    """Find a thickness as one would by hand: scipy's least squares on COR from the table."""
    model = cl.ImpactModel(pair)

    def residuals(x: Array) -> Array:
        cor = model.restitution(data["speed"], data["radius"], float(np.exp(x[0])))
        return np.asarray((cor - data["restitution"]) / data["restitution_error"])

    return least_squares(residuals, [np.log(1.5e-3)])  # a start at 3e-3 leaves the table
