"""Fig. 21: the finite elements converge with the mesh, and tend to Hertz for small contacts.

Elements of 0.01 R, the paper's, leave an estimated error of 0.16 % in COR, 0.21 % in peak force,
0.30 % in contact time and 0.61 % in the largest plastic strain: what the last three meshes leave by
extrapolation, at first order at best, and the effect of halving the plate's mesh away from the
contact, both with a quarter added. Peak force and strain of one plate, and the contact time,
oscillate. A finite contact is stiffer than Hertz's half-spaces, in proportion to its width: that is
physics, not the mesh.
"""

from __future__ import annotations

import math

import numpy as np

from contactlaw.style import BLUE, GREEN, INK, ORANGE, PALE, PURPLE, VERMILION
from validation import figures
from validation.accuracy import compare
from validation.fem import store
from validation.figures import chart
from validation.figures.chart import Axis, Panel
from validation.paper.setting import RADIUS, model

PART = figures.FINITE_ELEMENTS

_FIELDS = {
    "restitution": (VERMILION, "COR"),
    "peak_force": (BLUE, "peak force"),
    "contact_time": (ORANGE, "contact time"),
    "plastic_strain": (PURPLE, "largest plastic strain"),
}


def draw() -> chart.Drawn:
    """Draw the differences from the finest mesh and from Hertz."""
    data = store.read("verification").data
    difference = Axis("difference from 0.005 R  [%]").log(0.01, 0.1, 1.0)
    contact = Axis("radius of the contact over that of the sphere").between(0.0, 0.12)
    figure, (left, right) = chart.sheet(
        (12.0, 6.0),
        "The finite elements converge, and tend to Hertz for small contacts",
        "left: gamma-alumina at 26 m/s on glass, difference from the finest mesh; right: elastic, "
        "frictionless, 9 mm block, difference from Hertz",
        Panel(Axis("smallest element").log(0.01, 0.02, 0.04, unit=" R"), difference),
        Panel(contact, Axis("difference from Hertz  [%]")),
    )
    worst = dict.fromkeys(_FIELDS, 0.0)
    for thickness, line in ((0.5e-3, "-"), (1e-3, "--")):
        rows = (data["check"] == "mesh") & (data["thickness"] == thickness)
        size = data["size"][rows][:-1]
        for name, (colour, label) in _FIELDS.items():
            value = data[name][rows]
            off = np.maximum(np.abs(value[:-1] / value[-1] - 1.0), 1e-5)
            worst[name] = max(worst[name], off[-1])
            named = label if line == "-" else None
            left.plot(size, 100.0 * off, f"o{line}", color=colour, label=named)
    left.plot([0.01, 0.04], [0.1, 0.4], color=PALE, linewidth=5, label="first order", zorder=1)
    chart.key(left, "plate of 0.5 mm", "-")
    chart.key(left, "plate of 1 mm", "--")
    hertz = data["check"] == "hertz"
    elastic = model("hertz").lookup(data["speed"][hertz], RADIUS, math.inf)
    width = np.sqrt(np.asarray(elastic.peak_compression) / RADIUS)
    for name, label, line, colour in (
        ("peak_force", "peak force", "o-", BLUE),
        ("contact_time", "contact time", "s-", ORANGE),
        ("peak_compression", "peak compression", ".--", GREEN),
    ):
        off = data[name][hertz] / getattr(elastic, name) - 1.0
        right.plot(width, 100.0 * off, line, color=colour, label=label, markersize=8)
    right.axhline(0.0, color=INK, linewidth=1)
    for axes in (left, right):  # below the axes, where no line is
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3)
    estimated = compare.discretisation()
    numbers = {}
    for name, (_, label) in _FIELDS.items():
        numbers[f"{label}: elements of 0.01 R over 0.005 R, difference"] = worst[name]
        numbers[f"{label}: estimated error of 0.01 R"] = estimated[name].max()
    return figure, numbers
