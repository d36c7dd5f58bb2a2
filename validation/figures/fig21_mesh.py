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

from validation import figures
from validation.fem import compare, store
from validation.figures import _style
from validation.paper import RADIUS, model

PART = figures.FINITE_ELEMENTS

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
        6.0,
        "The finite elements converge, and tend to Hertz for small contacts",
        "left: gamma-alumina at 26 m/s on glass, difference from the finest mesh; right: elastic, "
        "frictionless, 9 mm block, difference from Hertz",
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
            named = label if line == "-" else None
            left.loglog(size, 100.0 * off, line, marker="o", color=colour, label=named)
    left.loglog(
        [0.01, 0.04], [0.1, 0.4], color=_style.PALE, linewidth=5, label="first order", zorder=1
    )
    _style.key(left, "plate of 0.5 mm", "-", 1.5)
    _style.key(left, "plate of 1 mm", "--", 1.5)
    left.set_xticks([0.01, 0.02, 0.04], ["0.01 R", "0.02 R", "0.04 R"])
    left.set_yticks([0.01, 0.1, 1.0], ["0.01", "0.1", "1"])
    left.minorticks_off()
    left.set(xlabel="smallest element", ylabel="difference from 0.005 R  [%]")
    hertz = data["check"] == "hertz"
    elastic = model("hertz").lookup(data["speed"][hertz], RADIUS, math.inf)
    width = np.sqrt(np.asarray(elastic.peak_compression) / RADIUS)
    for name, label, line, colour in (
        ("peak_force", "peak force", "o-", _style.BLUE),
        ("contact_time", "contact time", "s-", _style.ORANGE),
        ("peak_compression", "peak compression", ".--", _style.GREEN),
    ):
        off = data[name][hertz] / getattr(elastic, name) - 1.0
        right.plot(width, 100.0 * off, line, color=colour, label=label, markersize=8)
    right.axhline(0.0, color=_style.INK, linewidth=1)
    right.set_xlim(0.0)
    right.set_xlabel("radius of the contact over that of the sphere")
    right.set_ylabel("difference from Hertz  [%]")
    for axes in (left, right):  # below the axes, where no line is
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=3)
    estimated = compare.discretisation()
    numbers = {}
    for name, (_, label) in _FIELDS.items():
        numbers[f"{label}: elements of 0.01 R over 0.005 R, difference"] = worst[name]
        numbers[f"{label}: estimated error of 0.01 R"] = float(estimated[name].max())
    return figure, numbers
