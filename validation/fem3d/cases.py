"""Oblique impacts to be computed: looked at while models are made, or kept out to judge them.

Each is an elastic impact, or one in which the sphere or the plate flows. Both bodies have the same
density and Poisson's ratio. By similarity only ratios count, so the sphere has a radius of 1 mm and
the pair E* = 100 GPa.
"""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, fields
from datetime import date
from typing import Any

import numpy as np

import contactlaw as cl
from contactlaw._version import VERSION
from contactlaw.physical.oblique import ObliqueRebound
from validation.fem import store
from validation.fem3d import impact
from validation.fem3d.impact import oblique_impact

RADIUS = 1e-3  # [m]
KINDS = "elastic", "sphere", "plate"  # which body flows
SEEDS = dict(looked_at=20261201, kept_out=20261202, kept_out_2=20261203, kept_out_3=20261204)
COUNT = 12
_MODULUS = 1e11  # E* [Pa]
_DENSITY = 5000.0  # [kg/m3]
_COMPRESSION = 0.005, 0.012  # of the elastic impact on a half-space [R], drawn by its logarithm
_STRENGTH = 40.0, 120.0  # E*/sigma_Y, likewise
_FRICTION = 0.1, 0.4
_PSI = 0.3, 8.0  # likewise by its logarithm
_THICKEST = 0.3  # R/H below which the plate stands for a half-space
_STEEPEST = 1.4  # largest R/H
_FOLDER = store.FOLDER


@dataclass(frozen=True)
class Case:
    """One oblique impact.

    `kind` is one of `KINDS`; `share` is E1'/(E1' + E2') of the sphere; `ratio` is E*/sigma_Y of
    the body that flows; `slimness` is R/H, 0 for a half-space; `psi` is v_s/(mu V0).
    """

    kind: str
    share: float
    poissons_ratio: float
    ratio: float
    speed: float  # [m/s]
    slimness: float
    friction: float
    psi: float

    @property
    def pair(self) -> cl.Pair:
        """Materials; only that of the body that flows has a strength."""
        moduli = _MODULUS / (1.0 - self.share), _MODULUS / self.share
        return cl.Pair(
            *(
                cl.Material(
                    name,
                    modulus * (1.0 - self.poissons_ratio**2),
                    self.poissons_ratio,
                    _DENSITY,
                    yield_strength=self.strength if self.kind == name else None,
                )
                for name, modulus in zip(("sphere", "plate"), moduli, strict=True)
            )
        )

    @property
    def strength(self) -> float:
        """Strength of the body that flows [Pa]; inf: none does."""
        return math.inf if self.kind == "elastic" else _MODULUS / self.ratio

    @property
    def thickness(self) -> float:
        """Thickness of the plate [m]."""
        return RADIUS / self.slimness if self.slimness else math.inf

    @property
    def sliding_speed(self) -> float:
        """Speed of the contact point along the plate [m/s]."""
        return self.psi * self.friction * self.speed


def draw(seed: int) -> list[Case]:
    """Draw random impacts, as many of each kind."""
    generator = np.random.default_rng(seed)

    def by_logarithm(limits: tuple[float, float]) -> float:
        return float(np.exp(generator.uniform(*np.log(limits))))

    listed = []
    for n in range(COUNT):
        compression = by_logarithm(_COMPRESSION)
        # m V0^2/2 = (8/15) E* sqrt(R) d^(5/2)
        speed = math.sqrt(0.8 / math.pi * _MODULUS / _DENSITY * compression**2.5)
        slimness = float(generator.uniform(0.0, _STEEPEST))
        drawn = (
            generator.uniform(0.3, 0.7),
            generator.uniform(0.2, 0.35),
            by_logarithm(_STRENGTH),
            speed,
            slimness if slimness > _THICKEST else 0.0,
            generator.uniform(*_FRICTION),
            by_logarithm(_PSI),
        )
        listed.append(Case(KINDS[n % len(KINDS)], *(float(f"{value:.3g}") for value in drawn)))
    return listed


def drawn(name: str) -> list[Case]:
    """Read the impacts of one of `SEEDS`."""
    with (_FOLDER / f"fem3d_{name}.csv").open() as file:
        rows = list(csv.DictReader(file))
    kinds = {field.name: float for field in fields(Case) if field.name != "kind"}
    return [Case(row["kind"], **{key: of(row[key]) for key, of in kinds.items()}) for row in rows]


def write(name: str) -> None:
    """Write the impacts of one of `SEEDS`, before any of them is computed."""
    with (_FOLDER / f"fem3d_{name}.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, [field.name for field in fields(Case)], lineterminator="\n")
        writer.writeheader()
        writer.writerows(asdict(case) for case in draw(SEEDS[name]))


def solve(case: Case) -> dict[str, Any]:
    """Compute an impact, and its normal incidence on the same mesh."""
    given = case.pair, case.speed, RADIUS, case.thickness, case.friction
    flows = {"yields": case.kind == "sphere", "plate_yields": case.kind == "plate"}
    hit, normal = (
        oblique_impact(given[0], given[1], along, *given[2:], **flows) for along in (case.sliding_speed, 0.0)
    )
    outcome = {key: value for key, value in vars(hit).items() if key != "history"}
    return {
        **outcome,
        "psi_after": hit.sliding_speed / (case.friction * case.speed),
        "normal_restitution": normal.restitution,
    }


def model(case: Case) -> ObliqueRebound:
    """Answer of the model, integrated."""
    return cl.ImpactModel(case.pair).oblique(
        case.speed, case.sliding_speed, RADIUS, case.thickness, case.friction, method="solve"
    )


def results(name: str, of: Callable[..., Any] = Case) -> dict[Any, dict[str, Any]]:
    """Read the outcomes of the impacts of one of `SEEDS` that this solver has computed."""
    done = {}
    path = _FOLDER / f"fem3d_{name}.jsonl"
    for line in path.read_text().splitlines() if path.exists() else ():
        entry = json.loads(line)
        if entry["solver_version"] == impact.VERSION:
            done[of(**entry["case"])] = entry["outcome"]
    return done


def compute(name: str) -> Iterator[tuple[Case, dict[str, Any]]]:
    """Compute what is missing of one of `SEEDS`; each impact is kept as soon as it is done."""
    return kept(name, drawn(name), solve)


def kept(name: str, listed: list[Any], solve: Callable[[Any], dict[str, Any]]) -> Iterator[tuple[Any, dict[str, Any]]]:
    """Compute what is missing of these impacts, and store each as soon as it is done."""
    done = results(name, type(listed[0]))
    for case in listed:
        if case not in done:
            done[case] = solve(case)
            line = {
                "case": vars(case),
                "outcome": done[case],
                "command": f"python -m validation.fem3d {name}",
                "across": vars(case).get("across", impact.ACROSS),
                "solver_version": impact.VERSION,
                "contactlaw_version": VERSION,
                "date": date.today().isoformat(),
            }
            with (_FOLDER / f"fem3d_{name}.jsonl").open("a") as file:
                file.write(json.dumps(line) + "\n")
        yield case, done[case]
