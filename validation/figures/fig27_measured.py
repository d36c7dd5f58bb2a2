"""Fig. 27: the normal COR, measured by Kharaz, Gorham and Salman (2001) and by the model.

Beads of alumina, 5 mm in diameter, come straight onto a thick anvil of glass at 3.9 m/s and keep
98 % of their speed; by the model, 98.5 %. The difference, 0.005, is what rounding may have taken
from the published number, and a little more than a standard error of the model (0.004: that of the
law beside finite elements, and the effect of moduli and densities). Nothing is fitted. Such beads
stay elastic, so this tests the energy that goes into waves, not plastic flow. The source calls the
anvil thick and gives no number: as the right panel shows, 2 cm or more agrees with the
measurement, and 1 cm does not. We could read no other measurement with its conditions, and none
over plate thickness.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw.style import BLUE, INK, ORANGE, SKY
from validation import figures
from validation.accuracy import measured
from validation.accuracy.measured import Source
from validation.figures import chart
from validation.figures.chart import Axis, Panel

PART = figures.PRACTICE

_SPEED = Axis("impact speed  [m/s]").between(0.5, 10.0).log(0.5, 1, 2, 5, 10)
_THICKNESS = Axis("thickness of the anvil  [mm]").between(5.0, 100.0).log(5, 10, 20, 50, 100)


def draw() -> chart.Drawn:
    """Draw the COR of each source over speed and over thickness."""
    sources = measured.sources()
    figure, every = chart.sheet(
        (12.0, 5.4 * len(sources)),
        "A measured rebound: 0.98, and 0.985 by the model",
        "bands and bars are the errors of model and reading; nothing is fitted",
        *(panel for source in sources for panel in _panels(source)),
        rows=len(sources),
    )
    numbers: dict[str, float] = {}
    for source, left, right in zip(sources, every[::2], every[1::2], strict=True):
        model, one = cl.ImpactModel(source.pair), source.rebounds[0]
        speed, thickness = np.geomspace(0.5, 10.0, 60), np.geomspace(5e-3, 0.1, 120)
        _model(left, speed, model, speed, one.radius, one.thickness)
        _model(right, 1e3 * thickness, model, one.speed, one.radius, thickness)
        for rebound in source.rebounds:
            left.errorbar(
                rebound.speed, rebound.restitution, rebound.reading_error, fmt="o", color=INK,
                markersize=8, markerfacecolor=ORANGE, capsize=5, label="measured",
            )  # fmt: skip
        least, most = (one.restitution + sign * one.reading_error for sign in (-1.0, 1.0))
        right.axhspan(
            least, most, color=ORANGE, alpha=0.5, linewidth=0.0, label="measured, thickness unknown"
        )
        for axes in (left, right):
            axes.legend(loc="lower right")
        band = model.uncertainty(one.speed, one.radius, one.thickness).restitution
        found = float(model.restitution(one.speed, one.radius, one.thickness))
        curve = np.asarray(model.restitution(one.speed, one.radius, thickness))
        numbers |= {
            f"{source.title}: COR": found,
            f"{source.title}: COR, standard error": float(band.high - band.low) / 2.0,
            f"{source.title}: COR, model minus measured": found - one.restitution,
            f"{source.title}: least thickness within the reading error, mm": 1e3
            * float(np.interp(least, curve, thickness)),
        }
    return figure, numbers


def _panels(source: Source) -> tuple[Panel, Panel]:
    one = source.rebounds[0]
    cor = chart.RESTITUTION.between(one.restitution - 0.08, 1.0)
    return Panel(_SPEED, cor, source.title), Panel(_THICKNESS, cor, f"at {one.speed:g} m/s")


def _model(axes: Axes, x: NDArray[np.float64], model: cl.ImpactModel, *impact: Any) -> None:
    band = model.uncertainty(*impact).restitution
    axes.fill_between(x, band.low, band.high, color=SKY, alpha=0.35, linewidth=0.0)
    axes.plot(x, model.restitution(*impact), color=BLUE, linewidth=2.4, label="model")
