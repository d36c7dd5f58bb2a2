"""Fig. 12: what one per cent more of an input does to the COR, against speed.

On thin plates thickness and radius matter most: where the radius is 1.8 times the thickness, one
per cent of either is worth 0.9 per cent of COR at twice the yield speed. On thick ones it is the
yield strength, with 0.5 at 5 yield speeds and a radius of 0.3 times the thickness. Lines are
derivatives of the table, dots difference quotients of the solver.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from contactlaw.style import BLUE, GREEN, INK, ORANGE, VERMILION
from validation import figures
from validation.figures import chart
from validation.figures.chart import SPEED, Axis
from validation.paper import setting
from validation.paper.setting import FASTEST, RADIUS, largest, model

PART = figures.PRACTICE

_RATIOS = (0.3, 0.9, 1.8)
_LINES = {
    "speed": (INK, "-"),
    "radius": (BLUE, "-"),
    "thickness": (BLUE, "--"),
    "sphere_density": (GREEN, "-"),
    "plate_density": (GREEN, "--"),
    "sphere_modulus": (ORANGE, "-"),
    "plate_modulus": (ORANGE, "--"),
    "yield_strength": (VERMILION, "-"),
}


def draw() -> chart.Drawn:
    """Draw one panel per thickness with a line per input."""
    figure, panels = chart.by_thickness(
        (13.0, 5.8),
        "Which input has to be known well? Thickness, where the plate is thin",
        "what one per cent more of an input does to the COR; gamma-alumina on glass",
        _RATIOS,
        SPEED.between(0, FASTEST),
        Axis("change of the COR  [% per %]"),
    )
    v, at = np.linspace(0.1, FASTEST, 300), np.linspace(0.5, 6.7, 9)
    worst = 0.0
    for ratio, axes in panels:
        moved = model().sensitivity(v * setting.SPEED, RADIUS, RADIUS / ratio)
        for field in dataclasses.fields(moved):
            colour, line = _LINES[field.name]
            label = field.name.replace("_", " ")
            axes.plot(v, getattr(moved, field.name), line, color=colour, label=label)
        dots = _quotient(at, ratio)
        axes.plot(at, dots, "o", color=INK, markersize=5)
        table = model().sensitivity(at * setting.SPEED, RADIUS, RADIUS / ratio).speed
        worst = max(worst, largest(dots - table))
    first = figure.axes[0]
    chart.key(first, "speed, by the solver", "o", markersize=5)
    figure.legend(*first.get_legend_handles_labels(), loc="outside lower center", ncols=5)
    thin = model().sensitivity(2.0 * setting.SPEED, RADIUS, RADIUS / 1.8)
    thick = model().sensitivity(5.0 * setting.SPEED, RADIUS, RADIUS / 0.3)
    return figure, {
        "thickness, R/H = 1.8, 2 yield speeds": thin.thickness,
        "radius, R/H = 1.8, 2 yield speeds": thin.radius,
        "yield strength, R/H = 0.3, 5 yield speeds": thick.yield_strength,
        "speed, R/H = 0.3, 5 yield speeds": thick.speed,
        "largest difference to the solver, speed": worst,
    }


def _quotient(v: np.ndarray, ratio: float) -> np.ndarray:
    """Central difference of ln e with respect to ln V0, by integration."""
    step = 1e-4
    up, down = (
        model().solve(v * setting.SPEED * np.exp(h), RADIUS, RADIUS / ratio, rtol=1e-13).restitution
        for h in (step, -step)
    )
    return np.log(up / down) / (2.0 * step)
