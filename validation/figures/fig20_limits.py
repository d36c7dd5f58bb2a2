"""Fig. 20: beyond the limits of the model: thinner plates, faster impacts, near edges.

At R/H = 2.5 the model is up to 7.4 % too high up to 7 V_Y0, 19 % at 14 V_Y0. An edge changes the
COR by less than 0.2 % if it is farther away than `contactlaw.edge_distance`. At two thirds of that
distance a wave of the contact's own frequency comes back only when the contact ends, but the COR
is already 2.3 % off: waves of higher frequency are faster.
"""

from __future__ import annotations

import numpy as np

import contactlaw as cl
from contactlaw.style import BLUE, INK, MUTED
from validation import figures
from validation.accuracy import compare
from validation.fem import store
from validation.figures import chart
from validation.figures.chart import RESTITUTION, SPEED, Axis, Panel
from validation.paper.setting import PAIR, RADIUS, largest, model

PART = figures.FINITE_ELEMENTS

_MARKERS = "os^D"


def draw() -> chart.Drawn:
    """Draw the error over speed, and the COR over the distance of the edge."""
    figure, (left, right) = chart.sheet(
        (13.0, 5.6),
        "Beyond the limits the model errs slowly; an edge too near matters at once",
        "gamma-alumina on glass; left: error of the modified Zener model in COR by radius over "
        "thickness, R/H; right: plate of finite radius, R/H = 1.5, at the yield speed",
        Panel(SPEED, Axis("error of the COR  [%]")),
        Panel(Axis("distance of the edge over cl.edge_distance"), RESTITUTION),
    )
    case = compare.comparison("limits")
    off = case.model["restitution"] / case.fem["restitution"] - 1.0
    values = sorted(set(case.slenderness.round(3)))
    for one, colour, marker in zip(values, chart.shades(len(values)), _MARKERS, strict=True):
        rows = np.isclose(case.slenderness, one, atol=1e-3)
        v, error = case.speed_ratio[rows], 100.0 * off[rows]
        left.plot(v, error, f"{marker}-", color=colour, label=f"R/H = {one:g}")
    left.axvline(7.0, color=MUTED, linestyle=":")
    chart.note(left, 7.2, 19.0, "the paper's fastest", MUTED, va="top")
    left.axhline(0.0, color=INK, linewidth=1)
    left.legend(loc="upper left")
    edge = store.read("edge").data
    free = model().lookup(edge["speed"][0], RADIUS, edge["thickness"][0])
    ratio = edge["width"] / cl.edge_distance(PAIR.plate, edge["thickness"][0], free.contact_time)
    right.plot(ratio, edge["restitution"], "o-", color=BLUE, label="finite elements")
    right.axhline(float(free.restitution), color=INK, linestyle="--", label="model, no edge")
    right.axvline(1.0, color=MUTED, linestyle=":")
    chart.note(right, 1.03, 0.667, "cl.edge_distance", MUTED)
    right.legend(loc="lower right")
    change = np.abs(edge["restitution"] / edge["restitution"][-1] - 1.0)
    thin, fast = case.slenderness > 2.0, case.speed_ratio > 7.1
    return figure, {
        "largest error at R/H = 2.5 up to 7 V_Y0": largest(off[thin & ~fast]),
        "largest error at R/H = 2.5 up to 14 V_Y0": largest(off[thin]),
        "largest error at 10 and 14 V_Y0, R/H up to 1.8": largest(off[~thin & fast]),
        "change of the COR by an edge from edge_distance on": change[ratio > 0.99].max(),
        "change at two thirds of it": change[np.isclose(ratio, 2 / 3, atol=0.01)][0],
    }
