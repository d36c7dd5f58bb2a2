"""Fig. 14: unloading from 30 d_Y, and the share of the loading work that comes back.

Beyond yield a law is judged by its unloading too: the share that comes back is the square of the
COR on a half-space. MYC and finite elements agree within 0.03 up to 10 d_Y; Thornton's law gives
back too little from the start. At 30 d_Y all but Thornton's give back too much.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from validation.fem import compare
from validation.figures import _style
from validation.paper import all_laws, force, unloading

_DEEPEST = 30.0  # d_Y
_DEPTHS = ("2", "5", "10", "30")


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw the deep indentation with all laws, and the returned work against depth."""
    figure = _style.figure(
        13.0,
        6.4,
        "Down to 10 yield compressions MYC gives back what finite elements do",
        "gamma-alumina hemisphere pressed slowly into glass and drawn back; compression and force "
        "in units of the yield of MYC; dots: finite elements, squares: CalculiX",
    )
    left, right = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    numbers = {}
    grid, depth = np.linspace(0.0, _DEEPEST, 400), np.geomspace(0.8, _DEEPEST, 60)
    for law in all_laws():
        name = law.name.partition("(")[0]
        colour, line = _style.LAWS[name]
        left.plot(
            grid, force(law, grid), line, color=colour, linewidth=2, label=_style.TITLES[name]
        )
        if law.yield_coefficient is None:
            continue
        left.plot(*unloading(law, _DEEPEST), line, color=colour, linewidth=1.2)
        share = np.array([_returned(law, one) for one in depth])
        right.plot(depth, share, line, color=colour, linewidth=2)
        numbers[f"returned from 5 d_Y, {_style.TITLES[name]}"] = _returned(law, 5.0)
        numbers[f"returned from 30 d_Y, {_style.TITLES[name]}"] = _returned(law, 30.0)
    for name in _DEPTHS:
        way, load, top = compare.indentation(name)
        here = slice(None, None, 12)
        left.plot(
            way[here], load[here], "o", color=_style.INK, markersize=3.5,
            label="finite elements" if name == "30" else None,
        )  # fmt: skip
        numbers[f"returned from {name} d_Y, finite elements"] = compare.returned(way, load, top)
        right.plot(
            float(name), compare.returned(way, load, top), "o", color=_style.INK, markersize=9
        )
    way, load, top = compare.indentation("calculix")
    right.plot(
        way[top], compare.returned(way, load, top), "s", color=_style.INK, markersize=13,
        markerfacecolor="none",
    )  # fmt: skip
    left.plot(way[::6], load[::6], "s", color=_style.INK, markersize=6, markerfacecolor="none")
    left.set(xlim=(0, _DEEPEST), ylim=(0, 95), xlabel="compression  d / d$_Y$")
    left.set_ylabel("force  F / F$_Y$")
    left.legend(loc="upper left")
    right.set_xscale("log")
    right.set_xticks([1, 2, 5, 10, 30], ["1", "2", "5", "10", "30"])
    right.minorticks_off()
    right.set(xlabel="largest compression  d$_m$ / d$_Y$", ylim=(0, 1.02))
    right.set_ylabel("work of unloading over work of loading")
    return figure, numbers


def _returned(law, largest: float) -> float:
    d = np.linspace(0.0, largest, 400)
    spent = np.trapezoid(force(law, d), d)
    back, load = unloading(law, largest)
    return float(np.trapezoid(load, back) / spent)
