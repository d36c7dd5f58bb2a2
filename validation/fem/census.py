"""Everyday impacts: what people pour, on what, how fast; and those that no fit may see.

Every metal, ceramic and glass of the catalogue falls on every other, as a bead of 1 mm radius, at
0.5 to 10 m/s onto plates of 0.6 to 10 mm.
"""

from __future__ import annotations

import csv
import itertools
from pathlib import Path

import numpy as np

import contactlaw as cl
from validation.fem import cases, journal
from validation.fem.cases import Case

RADIUS = 1e-3  # [m]
SPEED = (0.5, 10.0)  # [m/s], drawn by its logarithm
THICKNESS = (0.6e-3, 10e-3)  # [m], likewise
DRAWN = Path(__file__).with_name("kept_out.csv")
SEED, COUNT = 20261122, 80  # of the impacts that are kept out


def pairs() -> list[tuple[str, str]]:
    """Sphere and plate of every everyday pair."""
    listed = [name for name in cl.materials() if cl.material(name).kind != "polymer"]
    return list(itertools.permutations(listed, 2))


def draw(seed: int, count: int) -> list[Case]:
    """Impacts of random everyday pairs; a body yields that has a yield strength."""
    generator = np.random.default_rng(seed)
    known = pairs()
    listed = []
    for _ in range(count):
        sphere, plate = known[generator.integers(len(known))]
        speed, thickness = (
            float(f"{np.exp(generator.uniform(*np.log(limits))):.4g}")
            for limits in (SPEED, THICKNESS)
        )
        listed.append(_case(sphere, plate, speed, thickness))
    return listed


def _case(sphere: str, plate: str, speed: float, thickness: float) -> Case:
    return Case(
        speed, thickness, RADIUS, sphere, plate,
        yields=cl.material(sphere).yield_strength is not None,
        plate_yields=cl.material(plate).yield_strength is not None,
    )  # fmt: skip


def kept_out() -> list[Case]:
    """Read the impacts that the law is judged by: drawn before it was fitted, never fitted to."""
    with DRAWN.open() as file:
        rows = list(csv.DictReader(file))
    return [
        _case(row["sphere"], row["plate"], float(row["speed_m_s"]), float(row["thickness_m"]))
        for row in rows
    ]


def study(processes: int) -> None:
    """Compute the impacts that are kept out."""
    rows = journal.complete("kept_out", cases.solve, kept_out(), processes)
    data = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    cases.save("kept_out", f"{len(rows)} everyday impacts that no fit has seen", data)
    journal.forget("kept_out")
