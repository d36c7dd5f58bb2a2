"""Fig. 28: how the edge of a plate changes the COR of impacts near it.

A plate gives way more near a free edge, and less where it is held, so that a bead loses more or
less. Near a hole the same plate gives way less than at a straight edge, because waves run round the
hole. The points are finite elements in time of thin plates, which share no code with the model.
Beyond `edge_distance` none of this matters. In the grey band, nearer than the plate is thick, the
answers are flagged.
"""

from __future__ import annotations

import csv
import math

import numpy as np

import contactlaw as cl
from contactlaw.equation.edge import Edge
from contactlaw.physical.scaling import wave_path
from contactlaw.style import BLUE, GREEN, INK, MUTED, PALE, VERMILION
from validation import figures
from validation.accuracy.edges import FILE
from validation.figures import chart
from validation.figures.chart import RESTITUTION, Axis, Panel

PART = figures.PRACTICE

RADIUS, THICKNESS, SPEED = 1.2973e-3, 1e-3, 2.0  # [m, m, m/s]: lambda is 0.3
_DISTANCE = Axis("distance from the edge  [mm]").between(0.0, 10.3)
# colour, and place of its name
_KINDS: tuple[tuple[Edge, str, tuple[float, float]], ...] = (
    ("free", VERMILION, (1.45, 0.33)),
    ("supported", GREEN, (1.08, 0.665)),
    ("clamped", BLUE, (2.75, 0.85)),
)
# radius [mm], name and its place
_HOLES = (
    (1.0, "hole, 1 mm", (0.28, 0.578)),
    (3.0, "3 mm", (0.28, 0.476)),
    (10.0, "10 mm", (0.15, 0.338)),
)
_LEAST = 0.3  # distance from a hole [mm]; nearer ones are of no use


def elements(kind: Edge) -> np.ndarray:
    """Distances [sqrt(b T_H)] and CORs of the finite elements, for lambda 0.3, shape (2, n)."""
    with FILE.open(encoding="utf-8") as file:
        rows = [
            (float(row["distance"]), float(row["restitution"]))
            for row in csv.DictReader(file)
            if row["edge"] == kind and row["law"] == "hertz" and row["inelasticity"] == "0.3"
            and row["poissons_ratio"] == ("0.2" if kind == "free" else "0.3")
        ]  # fmt: skip
    return np.array(rows).T


def draw() -> chart.Drawn:
    """Draw the COR over the distance, for each kind of edge and for holes."""
    figure, (axes,) = chart.sheet(
        (11.0, 6.4),
        "Near a free edge a bead loses more to the plate, near a held one next to nothing",
        "elastic bead of glass, 2.6 mm in diameter, on 1 mm of glass at 2 m/s; "
        "lines: model, thin ones at the rims of holes; circles: independent finite elements",
        Panel(_DISTANCE, RESTITUTION.between(0.0, 1.03)),
    )
    model = cl.ImpactModel(cl.Pair("glass", "glass"), law="hertz")
    impact = SPEED, RADIUS, THICKNESS
    endless = model.solve(*impact)
    cor, path = float(endless.restitution), wave_path(model.pair.plate)
    reach = 1e3 * float(cl.edge_distance(model.pair.plate, THICKNESS, endless.contact_time))
    unit = 1e3 * math.sqrt(path * THICKNESS * _hertz_time(model.pair))
    s = np.linspace(0.02, 10.3, 515)
    numbers, off, change = {"COR far from edges": cor}, [], []
    axes.axvspan(0.0, 1e3 * THICKNESS, color=PALE, alpha=0.5, linewidth=0)
    axes.axhline(cor, color=INK, linestyle="--", linewidth=1.2)
    axes.axvline(reach, color=MUTED, linestyle=":")
    for radius, name, place in _HOLES:
        at = s[s >= _LEAST]
        near = model.solve(*impact, edge_distance=1e-3 * at, hole_radius=1e-3 * radius).restitution
        axes.plot(at, near, color=VERMILION, linewidth=1.2)
        chart.note(axes, *place, name, VERMILION, va="center")
        numbers[f"COR 2 mm from a hole of {radius:g} mm"] = np.interp(2.0, at, near)
    for kind, colour, place in _KINDS:
        near = np.asarray(model.solve(*impact, edge=kind, edge_distance=1e-3 * s).restitution)
        at, found = elements(kind)
        here = model.solve(*impact, edge=kind, edge_distance=1e-3 * unit * at).restitution
        axes.plot(s, near, color=colour, linewidth=2.6)
        axes.plot(
            unit * at, found, "o", color=colour, markersize=8, markerfacecolor="white",
            markeredgewidth=1.8,
        )  # fmt: skip
        axes.text(*place, kind, color=colour, fontsize=14, fontweight="bold", ha="left")
        numbers[f"COR 2 mm from a {kind} edge"] = np.interp(2.0, s, near)
        off.append(np.abs(here - found).max())
        change.append(np.abs(near[s > reach] / cor - 1.0).max())
    numbers["largest difference from the finite elements"] = max(off)
    numbers["largest change of the COR from edge_distance on"] = max(change)
    chart.note(axes, 0.5, 0.66, "flagged:\nnearer than\nthe plate\nis thick", MUTED, ha="center")
    chart.note(axes, reach - 0.1, 0.04, "cl.edge_distance", MUTED, ha="right")
    chart.note(axes, 7.0, cor - 0.05, f"far from edges: {cor:.2f}")
    return figure, numbers


def _hertz_time(pair: cl.Pair) -> float:
    """T_H, in which the finite elements count [s]."""
    mass = 4.0 / 3.0 * math.pi * RADIUS**3 * pair.sphere.density
    stiffness = 4.0 / 3.0 * pair.effective_modulus * math.sqrt(RADIUS)
    return float((mass / (stiffness * math.sqrt(SPEED))) ** 0.4)
