"""Fig. 26: oblique impacts, measured by Kharaz, Gorham and Salman (2001) and by the model.

Beads of alumina, 5 mm in diameter, come without spin at 3.9 m/s onto a thick anvil of glass. At
steep angles of incidence they stick for most of the contact; the elastic contact, stretched
sideways, throws them back while they turn. From about 28 degrees on they slide all the time, and
friction takes what Coulomb's law says. Two others have read the points off the paper's figures,
and they agree within 1 %. The coefficient of friction, 0.092, is the paper's, and nothing is
fitted. The paper may have got it from the points that slide: those below 28 degrees test the
model.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw.style import BLUE, INK
from validation import figures
from validation.accuracy.measured import FOLDER
from validation.figures import chart
from validation.figures.chart import Axis, Panel

PART = figures.PRACTICE

RADIUS, SPEED, FRICTION = 2.5e-3, 3.9, 0.092  # [m, m/s, -]
SLIDING = 28.0  # [deg] angle of incidence from which the bead slides all the time

_ANGLE = Axis("angle of incidence from the normal  [°]").between(0.0, 90.0)
_ALONG = Axis("tangential restitution of the centre  v$_t$' / v$_t$").between(0.5, 1.0)
_COLUMNS = {"tangential restitution": "tangential_restitution", "spin": "spin_rad_per_s"}
_SPIN = Axis("spin after the impact  [rad/s]").between(0.0, 700.0)


def impacts(angle: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Tangential restitution and spin [rad/s] of the model at angles of incidence [deg]."""
    model = cl.ImpactModel(cl.Pair("alumina", "glass"))
    normal, along = SPEED * np.cos(np.radians(angle)), SPEED * np.sin(np.radians(angle))
    hit = model.oblique(normal, along, RADIUS, math.inf, FRICTION, method="solve")
    restitution = np.asarray(hit.tangential_restitution)
    return restitution, 2.5 * along * (1.0 - restitution) / RADIUS


def measured(column: str) -> NDArray[np.float64]:
    """Angles [deg], measured values and who read them, shape (3, n)."""
    with (FOLDER / "kharaz-2001.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    names = "angle_deg", column, "source"
    return np.array([[float(r[name]) for name in names] for r in rows if r[column]]).T


def points() -> Iterator[tuple[str, int, float, float, float]]:
    """Quantity, who read it, angle [deg], measured and modelled value of each point."""
    for n, (name, column) in enumerate(_COLUMNS.items()):
        at, value, source = measured(column)
        for row in zip(source.astype(int), at, value, impacts(at)[n], strict=True):
            yield name, *row


def draw() -> chart.Drawn:
    """Draw both quantities over the angle."""
    figure, every = chart.sheet(
        (12.0, 5.4),
        "A bead that comes at an angle: sticking at first, sliding beyond",
        "alumina on glass, R = 2.5 mm, 3.9 m/s, friction 0.092, no spin before; nothing is fitted",
        Panel(_ANGLE, _ALONG),
        Panel(_ANGLE, _SPIN),
    )
    numbers = {}
    angle = np.linspace(0.5, 89.5, 179)
    for n, (name, axes, curve) in enumerate(zip(_COLUMNS, every, impacts(angle), strict=True)):
        at, value, _ = measured(_COLUMNS[name])
        axes.plot(angle, curve, color=BLUE, linewidth=2.4, label="model")
        axes.plot(at, value, "o", color=INK, markersize=6, markerfacecolor="none", label="measured")
        off = impacts(at)[n] / value - 1.0
        slides = at > SLIDING
        for motion, part in (("sticking", ~slides), ("sliding", slides)):
            numbers[f"{name}, {motion}: largest error"] = off[part][np.abs(off[part]).argmax()]
        axes.axvline(SLIDING, color=INK, linewidth=1.0, linestyle=":")
    chart.note(every[0], SLIDING + 1.5, 0.52, "slides all the time")
    every[0].legend(loc="lower right")
    return figure, numbers
