"""Fig. 12: what one per cent more of an input does to the COR, against speed.

On thin plates thickness and radius rule: where the radius is 1.8 times the thickness, one per cent
of either is worth 0.9 per cent of COR at twice the yield speed. On thick ones it is the yield
strength, with 0.5 at 5 yield speeds and a radius of 0.3 times the thickness. Lines are derivatives
of the table, dots difference quotients of the solver.
"""

from __future__ import annotations

import dataclasses

import numpy as np
from matplotlib.figure import Figure

from validation import figures
from validation.figures import _style
from validation.paper import FASTEST, RADIUS, SPEED, model

PART = figures.PRACTICE

_RATIOS = (0.3, 0.9, 1.8)
_LINES = {
    "speed": (_style.INK, "-"),
    "radius": (_style.BLUE, "-"),
    "thickness": (_style.BLUE, "--"),
    "sphere_density": (_style.GREEN, "-"),
    "plate_density": (_style.GREEN, "--"),
    "sphere_modulus": (_style.ORANGE, "-"),
    "plate_modulus": (_style.ORANGE, "--"),
    "yield_strength": (_style.VERMILION, "-"),
}


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw one panel per thickness with a line per input."""
    figure = _style.figure(
        13.0,
        5.8,
        "Which input has to be known well? Thickness, where the plate is thin",
        "what one per cent more of an input does to the COR; gamma-alumina on glass; "
        f"{_style.RATIO}",
    )
    panels = figure.subplots(1, len(_RATIOS), sharey=True)
    v = np.linspace(0.1, FASTEST, 300)
    worst = 0.0
    for axes, ratio in zip(panels, _RATIOS, strict=True):
        moved = model().sensitivity(v * SPEED, RADIUS, RADIUS / ratio)
        for field in dataclasses.fields(moved):
            colour, line = _LINES[field.name]
            label = field.name.replace("_", " ")
            axes.plot(v, getattr(moved, field.name), line, color=colour, label=label, linewidth=2)
        at = np.linspace(0.5, 6.7, 9)
        dots = _quotient(at, ratio)
        axes.plot(at, dots, "o", color=_style.INK, markersize=5)
        table = np.asarray(model().sensitivity(at * SPEED, RADIUS, RADIUS / ratio).speed)
        worst = max(worst, float(np.abs(dots - table).max()))
        axes.set(title=f"R/H = {ratio:g}", xlim=(0, FASTEST))
    panels[1].set_xlabel(_style.SPEED)
    panels[0].set_ylabel("change of the COR  [% per %]")
    _style.key(panels[0], "speed, by the solver", "o", markersize=5)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    thin = model().sensitivity(2.0 * SPEED, RADIUS, RADIUS / 1.8)
    thick = model().sensitivity(5.0 * SPEED, RADIUS, RADIUS / 0.3)
    return figure, {
        "thickness, R/H = 1.8, 2 yield speeds": float(thin.thickness),
        "radius, R/H = 1.8, 2 yield speeds": float(thin.radius),
        "yield strength, R/H = 0.3, 5 yield speeds": float(thick.yield_strength),
        "speed, R/H = 0.3, 5 yield speeds": float(thick.speed),
        "largest difference to the solver, speed": worst,
    }


def _quotient(v: np.ndarray, ratio: float) -> np.ndarray:
    """Central difference of ln e with respect to ln V0, by integration."""
    step = 1e-4
    up, down = (
        model().solve(v * SPEED * np.exp(h), RADIUS, RADIUS / ratio, rtol=1e-13).restitution
        for h in (step, -step)
    )
    return np.log(up / down) / (2.0 * step)
