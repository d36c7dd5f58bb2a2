"""Fig. 21: the finite elements converge with the mesh, and tend to Hertz for small contacts.

Elements of 0.01 R, the paper's, leave an estimated error of 0.16 % in COR, 0.21 % in peak force,
0.30 % in contact time and 0.61 % in the largest plastic strain: what the last three meshes leave if
they go on converging, at first order at best, and halving the plate's mesh away from the contact; a
quarter is added. Peak force and strain of one plate, and the contact time, oscillate. A finite
contact is stiffer than Hertz's half-spaces, in proportion to its width: that is physics, not the
mesh.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from validation.fem import compare, store
from validation.figures import _style
from validation.paper import RADIUS, model

_FIELDS = {
    "restitution": (_style.VERMILION, "COR"),
    "peak_force": (_style.BLUE, "peak force"),
    "contact_time": (_style.ORANGE, "contact time"),
    "plastic_strain": (_style.PURPLE, "largest plastic strain"),
}


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw the differences from the finest mesh and from Hertz."""
    data = store.read("verification").data
    figure = _style.figure(
        12.0,
        5.4,
        "The finite elements converge, and tend to Hertz for small contacts",
        "left: gamma-alumina at 26 m/s on 0.5 mm (full) and 1 mm (dashed) of glass, difference "
        "from the finest mesh; right: elastic, frictionless, 9 mm block, difference from Hertz",
    )
    left, right = figure.subplots(1, 2)
    worst = dict.fromkeys(_FIELDS, 0.0)
    for thickness, line in ((0.5e-3, "-"), (1e-3, "--")):
        rows = (data["check"] == "mesh") & (data["thickness"] == thickness)
        size = data["size"][rows][:-1]
        for name, (colour, label) in _FIELDS.items():
            value = data[name][rows]
            off = np.maximum(np.abs(value[:-1] / value[-1] - 1.0), 1e-5)
            worst[name] = max(worst[name], float(off[-1]))
            left.loglog(
                size, off, line, marker="o", color=colour, label=label if line == "-" else None
            )
    left.loglog([0.01, 0.04], [0.001, 0.004], color=_style.MUTED, linewidth=1)
    left.text(0.0245, 0.0029, "first order", color=_style.MUTED, fontsize=10.5)
    left.set_xticks([0.01, 0.02, 0.04], ["0.01 R", "0.02 R", "0.04 R"])
    left.minorticks_off()
    left.set(xlabel="smallest element", ylabel="difference from elements of 0.005 R")
    left.legend()
    hertz = data["check"] == "hertz"
    elastic = model("hertz").lookup(data["speed"][hertz], RADIUS, math.inf)
    width = np.sqrt(np.asarray(elastic.peak_compression) / RADIUS)
    for name, label, colour in (
        ("peak_force", "peak force", _style.BLUE),
        ("contact_time", "contact time", _style.ORANGE),
        ("peak_compression", "peak compression", _style.GREEN),
    ):
        off = data[name][hertz] / getattr(elastic, name) - 1.0
        right.plot(width, off, "o-", color=colour, label=label)
    right.axhline(0.0, color=_style.INK, linewidth=1)
    right.set_xlim(0.0)
    right.set_xlabel("radius of the contact over that of the sphere")
    right.set_ylabel("difference from Hertz")
    right.legend()
    for axes in (left, right):
        axes.yaxis.set_major_formatter(PercentFormatter(1.0))
    estimated = compare.discretisation()
    numbers = {}
    for name, (_, label) in _FIELDS.items():
        numbers[f"{label}: elements of 0.01 R over 0.005 R, difference"] = worst[name]
        numbers[f"{label}: estimated error of 0.01 R"] = float(estimated[name].max())
    return figure, numbers
