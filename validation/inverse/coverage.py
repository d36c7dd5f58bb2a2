"""Share of fits whose true value lies within the stated standard error: 68 % if that is right.

Configurations are random: beads and plates of the catalogue, half with other strengths, R 0.3 to 3
mm, R/H 0.15 to 1.8, 8 to 30 speeds below, across or above yield, one to three kinds of values with
errors of 0.3 to 3 %, which the fit is given or has to estimate. The data are those of the model,
with scatter. In half of the sets a model error is added, drawn from its stated covariance, and the
total standard error is judged; in the others the statistical one.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

import contactlaw as cl
from contactlaw.fitting.errors import model_errors
from contactlaw.fitting.measurements import KINDS, NORMAL
from contactlaw.fitting.predictions import Predictor
from contactlaw.fitting.unknowns import UNKNOWNS, parameters
from contactlaw.physical.law import law_of
from validation.fem.census import LISTED
from validation.inverse.model import rebounds, true

Array = NDArray[np.float64]

QUESTIONS = (
    *((name,) for name in UNKNOWNS if name != "friction" and "loss" not in name),
    ("yield_strength", "thickness"),
    ("radius", "thickness", "plate_yield_strength"),
)
REGIMES = {"below": (0.02, 0.7), "across": (0.2, 8.0), "above": (3.0, 60.0)}  # V0/V_Y0
_LEAST = 0.05  # smallest COR of a measurement
_SWIFTEST = 40.0  # [m/s]


class Configuration(NamedTuple):
    """A measurement: the true inputs, and which values are measured at which errors."""

    pair: cl.Pair
    radius: float
    thickness: float
    speed: Array
    kinds: tuple[str, ...]
    noise: tuple[float, ...]  # relative errors of the kinds
    stated: bool  # the fit is given these errors
    regime: str


class Outcome(NamedTuple):
    """Fit of one unknown of a set: its error `off` and the stated `error`, both relative."""

    name: str
    regime: str
    model_errs: bool
    off: float
    error: float

    @property
    def within(self) -> bool:
        """Whether the true value lies within the standard error."""
        return abs(self.off) <= self.error


def draw(random: np.random.Generator, question: tuple[str, ...], law: str) -> Configuration:
    """Draw a configuration whose data depend on the unknowns of a question."""
    while True:
        sphere, plate = (cl.material(str(random.choice(LISTED))) for _ in range(2))
        pair = cl.Pair(*(_of_other_strength(random, body) for body in (sphere, plate)))
        strengths = [body.yield_strength or math.inf for body in (pair.sphere, pair.plate)]
        regime = str(random.choice(list(REGIMES)))
        if "yield_strength" in question and not strengths[0] < 0.8 * strengths[1]:
            continue
        if "plate_yield_strength" in question and not strengths[1] < 0.8 * strengths[0]:
            continue
        if regime == "below" and any(name.endswith("yield_strength") for name in question):
            continue
        if law != "fem" and pair.sphere.yield_strength is None:
            continue
        at_yield = pair.yield_speed if min(strengths) < math.inf else 10.0
        slowest, fastest = (min(ratio * at_yield, _SWIFTEST) for ratio in REGIMES[regime])
        if fastest < 2.0 * slowest:
            continue
        radius = 1e-3 * math.exp(random.uniform(math.log(0.3), math.log(3.0)))
        thickness = radius / math.exp(random.uniform(math.log(0.15), math.log(1.8)))
        count = int(random.integers(8, 31))
        speed = np.exp(np.sort(random.uniform(math.log(slowest), math.log(fastest), count)))
        least = 2 if len(question) > 1 else 1
        kinds = tuple(random.permutation(list(NORMAL))[: random.integers(least, 4)].tolist())
        noise = tuple(np.exp(random.uniform(math.log(0.003), math.log(0.03), len(kinds))).tolist())
        one = Configuration(pair, radius, thickness, speed, kinds, noise, bool(random.integers(2)), regime)
        if np.min(rebounds(one, law).restitution) > _LEAST:
            return one


def _of_other_strength(random: np.random.Generator, body: cl.Material) -> cl.Material:
    if body.yield_strength is None or random.integers(2):
        return body
    factor = math.exp(random.uniform(math.log(0.4), math.log(2.5)))
    return dataclasses.replace(body, yield_strength=factor * body.yield_strength)


def measured(
    random: np.random.Generator, one: Configuration, question: tuple[str, ...], law: str, errs: bool
) -> dict[str, Array | float]:
    """Draw the data of a configuration, without the unknowns."""
    hit = rebounds(one, law)
    data: dict[str, Array | float] = {"speed": one.speed}
    data |= {name: getattr(one, name) for name in ("radius", "thickness") if name not in question}
    exact = {kind: np.asarray(getattr(hit, kind)) for kind in one.kinds}
    shift = _model_error(random, one, exact, law) if errs else {}
    for kind, noise in zip(one.kinds, one.noise, strict=True):
        scatter = noise * exact[kind] * random.standard_normal(one.speed.size)
        values = exact[kind] + scatter + shift.get(kind, 0.0)
        data[kind] = np.clip(values, 1e-3, 1.19) if kind == "restitution" else values
        if one.stated:
            data[f"{kind}_error"] = noise * exact[kind]
    return data


def _model_error(
    random: np.random.Generator, one: Configuration, exact: dict[str, Array], law: str
) -> dict[str, Array]:
    data = cl.Measurements(speed=one.speed, radius=one.radius, thickness=one.thickness, **exact)
    varied = parameters(one.pair, data, ["density"], {})
    predictor = Predictor(one.pair, law_of(one.pair, law), data, varied)
    x = np.log([one.pair.sphere.density])
    shared = model_errors(predictor, x, predictor.impacts(predictor.setting(x)))
    drawn = shared @ random.standard_normal(shared.shape[1])
    names = list(KINDS)
    return {name: drawn[predictor.values.kind == names.index(name)] for name in exact}


def outcomes(question: tuple[str, ...], sets: int, seed: int, law: str = "fem") -> Iterator[list[Outcome]]:
    """Fit synthetic data sets; the outcomes of each, none where the fit is refused."""
    random = np.random.default_rng([seed, QUESTIONS.index(question)])
    for n in range(sets):
        one = draw(random, question, law)
        errs = bool(n % 2) and law == "fem"  # flagged errors of the other laws are too large
        data = measured(random, one, question, law, errs)
        try:
            found = cl.fit(one.pair, data, question, law)
        except cl.UnidentifiedError:
            yield []
            continue
        stated = found.errors if errs else found.statistical_errors
        yield [
            Outcome(name, one.regime, errs, found.values[name] / true(one, name) - 1.0, stated[name] / true(one, name))
            for name in question
        ]


class Tally(NamedTuple):
    """Counts for one unknown of a question."""

    question: tuple[str, ...]
    name: str
    answered: int
    refused: int
    within: dict[str, float]  # share, by regime, by the error that is judged, and of all
    median_error: float


def tally(question: tuple[str, ...], sets: int, seed: int, law: str = "fem") -> list[Tally]:
    """Count until `sets` data sets are answered."""
    found: list[list[Outcome]] = []
    refused = 0
    for one in outcomes(question, 20 * sets, seed, law):
        refused += not one
        if one:
            found.append(one)
        if len(found) == sets:
            break
    rows = []
    for n, name in enumerate(question):
        of = [one[n] for one in found]
        parts = {
            "all": of,
            "data": [one for one in of if not one.model_errs],
            "data and model": [one for one in of if one.model_errs],
            **{regime: [one for one in of if one.regime == regime] for regime in REGIMES},
        }
        within = {part: float(np.mean([one.within for one in ones])) for part, ones in parts.items() if ones}
        error = float(np.median([one.error for one in of]))
        rows.append(Tally(question, name, len(of), refused, within, error))
    return rows


def _tally(task: tuple[tuple[str, ...], int, int, str]) -> list[Tally]:
    return tally(*task)


def report(sets: int = 1000, seed: int = 1) -> str:
    """Count for every question, as text; takes half an hour on two cores.

    The law is fem; there are as many processes as cores.
    """
    lines = [f"share of {sets} true values within the stated standard error, seed {seed} [%]"]
    parts = ("all", "data", "data and model", *REGIMES)
    lines.append(f"{'':56s} {' '.join(f'{part:>8s}' for part in parts)}  refused, median error [%]")
    tasks = [(question, sets, seed, "fem") for question in QUESTIONS]
    with ProcessPoolExecutor() as pool:
        for rows in tqdm(pool.map(_tally, tasks), "coverage", len(tasks), disable=None, leave=False):
            for row in rows:
                shares = (f"{100.0 * row.within.get(part, math.nan):8.1f}" for part in parts)
                title = row.name if len(row.question) == 1 else f"{row.name} ({len(row.question)})"
                lines.append(f"{title:56s} {' '.join(shares)}  {row.refused}, {100.0 * row.median_error:.2g}")
    return "\n".join(lines)
