"""Fig. 20: beyond the limits: thinner plates, faster impacts, edges that are near.

At R/H = 2.5 the model is up to 7.4 % too high up to 7 V_Y0, 19 % at 14 V_Y0. An edge changes the
COR by less than 0.2 % from `contactlaw.edge_distance` on; at two thirds of it, where the wave of
the contact's own frequency would just not be back, it is already 2.3 % off: faster waves run ahead.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import contactlaw as cl
from validation import figures
from validation.fem import compare, store
from validation.figures import _style
from validation.paper import PAIR, RADIUS, model

PART = figures.FINITE_ELEMENTS

_MARKERS = "os^D"


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw the error over speed, and the COR over the distance of the edge."""
    case = compare.comparison("limits")
    edge = store.read("edge").data
    figure = _style.figure(
        13.0,
        5.6,
        "Beyond the limits the model errs slowly; an edge too near matters at once",
        "gamma-alumina on glass; left: error of the modified Zener model in COR by radius over "
        "thickness, R/H; right: plate of finite radius, R/H = 1.5, at the yield speed",
    )
    left, right = figure.subplots(1, 2)
    values = sorted(set(case.slenderness.round(3)))
    off = 100.0 * (case.model["restitution"] / case.fem["restitution"] - 1.0)
    for slenderness, colour, marker in zip(
        values, _style.shades(len(values)), _MARKERS, strict=True
    ):
        rows = np.isclose(case.slenderness, slenderness, atol=1e-3)
        left.plot(
            case.speed_ratio[rows], off[rows], f"{marker}-", color=colour,
            label=f"R/H = {slenderness:g}",
        )  # fmt: skip
    left.axvline(7.0, color=_style.MUTED, linestyle=":")
    left.text(7.2, 19.0, "the paper's fastest", color=_style.MUTED, va="top", fontsize=10.5)
    left.axhline(0.0, color=_style.INK, linewidth=1)
    left.set(xlabel=_style.SPEED, ylabel="error of the COR  [%]")
    left.legend(loc="upper left")
    free = model().lookup(edge["speed"][0], RADIUS, edge["thickness"][0])
    ratio = edge["width"] / cl.edge_distance(PAIR.plate, edge["thickness"][0], free.contact_time)
    right.plot(ratio, edge["restitution"], "o-", color=_style.BLUE, label="finite elements")
    right.axhline(float(free.restitution), color=_style.INK, linestyle="--", label="model, no edge")
    right.axvline(1.0, color=_style.MUTED, linestyle=":")
    right.text(1.03, 0.667, "cl.edge_distance", color=_style.MUTED, fontsize=10.5)
    right.set(xlabel="distance of the edge over cl.edge_distance")
    right.set_ylabel(_style.RESTITUTION)
    right.legend(loc="lower right")
    far = edge["restitution"][-1]
    change = np.abs(edge["restitution"] / far - 1.0)
    thin = case.slenderness > 2.0
    slow = thin & (case.speed_ratio < 7.1)
    return figure, {
        "largest error at R/H = 2.5 up to 7 V_Y0": float(np.abs(off[slow]).max() / 100.0),
        "largest error at R/H = 2.5 up to 14 V_Y0": float(np.abs(off[thin]).max() / 100.0),
        "largest error at 10 and 14 V_Y0, R/H up to 1.8": float(
            np.abs(off[~thin & (case.speed_ratio > 7.1)]).max() / 100.0
        ),
        "change of the COR by an edge from edge_distance on": float(change[ratio > 0.99].max()),
        "change at two thirds of it": float(change[np.isclose(ratio, 2 / 3, atol=0.01)][0]),
    }
