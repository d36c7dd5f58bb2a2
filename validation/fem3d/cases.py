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
from dataclasses import dataclass
from datetime import date
from typing import Any

import contactlaw as cl
from contactlaw._version import VERSION
from contactlaw.physical.oblique import ObliqueRebound
from validation.fem import store
from validation.fem3d import impact
from validation.fem3d.impact import oblique_impact

RADIUS = 1e-3  # [m]
KINDS = "elastic", "sphere", "plate"  # which body flows
SETS = "looked_at", "kept_out", "kept_out_2", "kept_out_3"  # ``validation/data/README.md`` says how they were drawn
_MODULUS = 1e11  # E* [Pa]
_DENSITY = 5000.0  # [kg/m3]
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


def listed(name: str, of: Callable[..., Any] = Case) -> list[Any]:
    """Read the impacts of a set: `Case`, or what `of` makes of their numbers."""
    with (_FOLDER / f"fem3d_{name}.csv").open() as file:
        rows = list(csv.DictReader(file))
    words = {"kind", "sphere", "plate"}
    return [of(**{key: text if key in words else float(text) for key, text in row.items()}) for row in rows]


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
    """Read the outcomes of the impacts of a set that this solver has computed."""
    done = {}
    path = _FOLDER / f"fem3d_{name}.jsonl"
    for line in path.read_text().splitlines() if path.exists() else ():
        entry = json.loads(line)
        if entry["solver_version"] == impact.VERSION:
            done[of(**entry["case"])] = entry["outcome"]
    return done


def compute(
    name: str, of: Callable[..., Any], solve: Callable[[Any], dict[str, Any]]
) -> Iterator[tuple[Any, dict[str, Any]]]:
    """Compute what is missing of a set, and store each impact as soon as it is done."""
    done = results(name, of)
    for case in listed(name, of):
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
