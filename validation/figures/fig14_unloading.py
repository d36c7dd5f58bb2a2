"""Fig. 14: unloading from 30 d_Y, and the share of the loading work that comes back.

That share is the square of the COR on a half-space. MYC and Stronge come nearest to the finite
elements, but give back too little: 0.58 for 0.64 from 5 d_Y, 0.39 for 0.42 from 10: the difference
is plastic work, of which the model has too much. Etsion's unloading gives back too much, 0.70 to
0.73 from 5 d_Y. At 30 d_Y, where the flattened sphere flows, every law gives back too much. An
elastic hemisphere is 47 % above Hertz there: its contact is no longer small.
"""

from __future__ import annotations

import numpy as np

from contactlaw.laws import Law
from contactlaw.style import INK
from validation import figures
from validation.accuracy import compare
from validation.figures import chart
from validation.figures.chart import COMPRESSION, FORCE, Axis, Panel
from validation.paper.setting import all_laws, force, unloading

PART = figures.FINITE_ELEMENTS

_DEEPEST = 30.0  # d_Y
_DEPTHS = ("2", "5", "10", "30")


def draw() -> chart.Drawn:
    """Draw the deep indentation with all laws, and the returned work against depth."""
    deepest = Axis("largest compression  d$_m$ / d$_Y$").log(1, 2, 5, 10, 30)
    figure, (left, right) = chart.sheet(
        (13.0, 6.4),
        "No law unloads quite as finite elements do; MYC and Stronge come nearest",
        "gamma-alumina hemisphere pressed slowly into glass and drawn back; compression and force "
        "in units of the yield of MYC",
        Panel(COMPRESSION.between(0, _DEEPEST), FORCE.between(0, 95)),
        Panel(deepest, Axis("work of unloading over work of loading").between(0, 1.02)),
        width_ratios=(1.25, 1.0),
    )
    numbers = {}
    grid, depth = np.linspace(0.0, _DEEPEST, 400), np.geomspace(0.8, _DEEPEST, 60)
    for name, law in all_laws().items():
        chart.of_law(left, name, grid, force(law, grid))
        if law.yield_coefficient is None:
            continue
        chart.of_law(left, name, *unloading(law, _DEEPEST), named=False)
        chart.of_law(right, name, depth, [_returned(law, one) for one in depth])
        title = chart.law(name)[-1]
        numbers[f"returned from 5 d_Y, {title}"] = _returned(law, 5.0)
        numbers[f"returned from 30 d_Y, {title}"] = _returned(law, 30.0)
    for name in _DEPTHS:
        curve = compare.indentation(name)
        share = numbers[f"returned from {name} d_Y, finite elements"] = compare.returned(*curve)
        right.plot(float(name), share, "o", color=INK, markersize=9)
        if name in ("10", "30"):
            label = "finite elements" if name == "30" else None
            left.plot(*_points(curve, 9), "o", color=INK, markersize=4, label=label)
    compression, load, top = compare.indentation("30_elastic")
    numbers["elastic finite elements over Hertz at 30 d_Y"] = load[top] / compression[top] ** 1.5
    left.plot(
        compression[:top:8], load[:top:8], "o", color=INK, markersize=4, markerfacecolor="white",
        label="finite elements, elastic",
    )  # fmt: skip
    curve = compare.indentation("calculix")
    square: chart.Look = {"color": INK, "markerfacecolor": "none"}
    left.plot(*_points(curve, 4), "s", markersize=7, label="CalculiX", **square)
    right.plot(10.0, compare.returned(*curve), "s", markersize=13, **square)
    chart.key(left, "thin: unloading", "-", linewidth=1.2)
    left.legend(loc="upper left")
    return figure, numbers


def _points(curve: tuple[np.ndarray, np.ndarray, int], step: int) -> tuple[np.ndarray, np.ndarray]:
    compression, load, _ = curve
    touching = load > 0.005 * load.max()
    return compression[touching][::step], load[touching][::step]


def _returned(law: Law, largest: float) -> float:
    d = np.linspace(0.0, largest, 400)
    spent = np.trapezoid(force(law, d), d)
    back, load = unloading(law, largest)
    return float(np.trapezoid(load, back) / spent)
