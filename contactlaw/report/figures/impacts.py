"""How fast the beads come, what is left of it, and at which angle.

Of the impacts alone. The angle is that from the wall's normal: 0° is straight on. The dashed lines
are medians.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from contactlaw import style
from contactlaw.report.run import OTHERS, Run

Column = Callable[[NDArray[np.void]], NDArray[np.float64]]

_BINS = 12, 40  # fewest and most
_COLOURS = style.BLUE, style.ORANGE, style.GREEN, style.PURPLE, style.SKY
_WIDE = 50.0  # largest over smallest speed from which on the axis is logarithmic


def draw(run: Run) -> Figure:
    """Draw histograms of speed, COR and angle, stacked by wall."""
    rows = run.impacts
    figure = style.figure(
        13.0, style.pick(4.9, 11.0), _title(run),
        f"{run.subject}; {rows.size} impacts{'; ' * bool(run.left_out)}{run.left_out}",
    )  # fmt: skip
    walls, bins = _stacked(run), int(np.clip(2.0 * rows.size**0.5, *_BINS)) + 1
    panels = figure.subplots(*style.pick((1, 3), (3, 1)))
    speed = rows["approach_speed"]
    low, high = (float(speed.min()), float(speed.max())) if speed.size else (0.5, 1.0)
    if high > _WIDE * low > 0.0:
        panels[0].set_xscale("log")
        panels[0].xaxis.set_major_formatter("{x:g}")
        edges = np.geomspace(low, high, bins)
    else:
        edges = np.linspace(0.0, 1.001 * high, bins)
    cor = rows["restitution"]
    least = float(np.quantile(cor, 0.002)) if cor.size else 0.0
    most = max(1.0, float(np.quantile(cor, 0.998))) if cor.size else 1.0
    _histogram(panels[0], walls, edges, _speed, "normal speed of approach [m/s]")
    _histogram(panels[1], walls, np.linspace(max(0.0, least - 0.02), most, bins), _cor,
               "coefficient of restitution")  # fmt: skip
    _histogram(panels[2], walls, np.linspace(0.0, 90.0, bins), angle, "angle of impact [°]")
    panels[2].set_xticks(range(0, 91, 15))
    panels[0].set_ylabel("impacts")
    if len(walls) > 1:
        figure.legend(
            *panels[0].get_legend_handles_labels(), loc="outside lower center",
            ncols=style.pick(len(walls), 2),
        )  # fmt: skip
    return figure


def _title(run: Run) -> str:
    cor = run.impacts["restitution"]
    if not cor.size:
        return "No contact with a wall is an impact"
    low, high = np.quantile(cor, [0.05, 0.95])
    return f"Nine in ten impacts have a COR between {low:.2f} and {high:.2f}"


def _stacked(run: Run) -> list[tuple[str, NDArray[np.void]]]:
    """Impacts by wall; walls beyond the number of colours are one."""
    most = len(_COLOURS)
    order = sorted(range(len(run.walls)), key=lambda n: -run.walls[n].impacts.size)
    own = sorted(order if len(order) <= most else order[: most - 1])
    found = [(run.walls[n].name, run.walls[n].impacts) for n in own]
    rest = [run.walls[n].impacts for n in order[len(own) :]]
    return [*found, (OTHERS, np.concatenate(rest))] if rest else found


def _histogram(axes: Axes, walls: list[tuple[str, NDArray[np.void]]], edges: NDArray[np.float64],
               column: Column, label: str) -> None:  # fmt: skip
    values = [column(rows).clip(edges[0], edges[-1]) for _, rows in walls]
    axes.hist(values, list(edges), stacked=True, label=[name for name, _ in walls],
              color=_COLOURS[: len(walls)], edgecolor="white", linewidth=0.3)  # fmt: skip
    whole = np.concatenate(values)
    if whole.size:
        middle = float(np.median(whole))
        axes.axvline(middle, color=style.INK, linestyle="--", linewidth=1.4)
        axes.annotate(f"median {middle:.3g}", (middle, 1.01), ha="center", va="bottom",
                      xycoords=("data", "axes fraction"), fontsize=11)  # fmt: skip
    axes.set_xlabel(label)


def _speed(rows: NDArray[np.void]) -> NDArray[np.float64]:
    return np.asarray(rows["approach_speed"])


def _cor(rows: NDArray[np.void]) -> NDArray[np.float64]:
    return np.asarray(rows["restitution"])


def angle(rows: NDArray[np.void]) -> NDArray[np.float64]:
    """Angle of each impact from the wall's normal [degrees]."""
    return np.asarray(np.degrees(np.arctan2(rows["sliding_speed"], rows["approach_speed"])))
