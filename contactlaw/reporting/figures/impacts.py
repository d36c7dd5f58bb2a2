"""How fast the beads come, what is left of it, and at which angle.

Of the impacts alone. The angle is that from the wall's normal: 0° is straight on.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw._arrays import Array, Rows
from contactlaw.reporting.run import OTHERS, Run

_BINS = 12, 40  # fewest and most
_COLOURS = style.BLUE, style.ORANGE, style.GREEN, style.PURPLE, style.SKY


def draw(run: Run) -> Figure:
    """Draw histograms of speed, COR and angle, stacked by wall, with their medians."""
    rows = run.impacts
    title = "How fast the beads come"
    if rows.size:
        low, high = np.quantile(rows["restitution"], [0.05, 0.95])
        title = f"Nine in ten impacts have a COR of {low:.2f} to {high:.2f}"
        title = f"The impacts have a COR of {low:.2f}" if high - low < 0.005 else title
    figure = style.figure(
        13.0,
        4.9,
        title,
        f"{run.subject}; {rows.size} impact{'s' * (rows.size != 1)}{'; ' * bool(run.left_out)}{run.left_out}",
    )
    walls = _stacked(run)
    bins = int(np.clip(2.0 * rows.size**0.5, *_BINS)) + 1
    columns: dict[str, tuple[Callable[[Any], Any], float | None, float | None]] = {
        "normal speed of approach [m/s]": (lambda hits: hits["approach_speed"], 0.0, None),
        "coefficient of restitution": (lambda hits: hits["restitution"], None, 1.0),
        "angle of impact [°]": (angle, 0.0, 90.0),
    }
    panels = figure.subplots(1, 3)
    for axes, (label, (column, least, most)) in zip(panels, columns.items(), strict=True):
        values = [column(hits) for _, hits in walls]
        whole = np.concatenate(values)
        ends = np.quantile(whole, [0.002, 0.998]) if whole.size else (0.0, 1.0)
        edges = np.sort(np.linspace(ends[0] if least is None else least, most or ends[1], bins))
        axes.hist(
            [one.clip(edges[0], edges[-1]) for one in values],
            list(edges),
            stacked=True,
            label=[name for name, _ in walls],
            color=_COLOURS[: len(walls)],
            edgecolor="white",
            linewidth=0.3,
        )
        axes.set(xlabel=label, ylabel="impacts")
        axes.yaxis.get_major_locator().set_params(integer=True)
        if whole.size:
            middle = float(np.median(whole))
            axes.axvline(middle, color=style.INK, linestyle="--", linewidth=1.4)
            axes.annotate(
                f"median {middle:.3g}",
                (middle, 1.01),
                ha="center",
                va="bottom",
                xycoords=("data", "axes fraction"),
                fontsize=11,
            )
    panels[2].set_xticks(range(0, 91, 15))
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=len(walls))
    return figure


def _stacked(run: Run) -> list[tuple[str, Rows]]:
    """Impacts by wall; walls beyond the number of colours are one."""
    most = len(_COLOURS)
    rank = [(wall.name == OTHERS, -wall.impacts.size) for wall in run.walls]  # the rest is last
    order = sorted(range(len(run.walls)), key=rank.__getitem__)
    own = sorted(order if len(order) <= most else order[: most - 1])
    found = [(run.walls[n].name, run.walls[n].impacts) for n in own]
    rest = [run.walls[n].impacts for n in order[len(own) :]]
    found += [(OTHERS, np.concatenate(rest))] if rest else []
    return found or [("no impact yet", run.impacts)]


def angle(rows: Rows) -> Array:
    """Angle of each impact from the wall's normal [degrees]."""
    return np.asarray(np.degrees(np.arctan2(rows["sliding_speed"], rows["approach_speed"])))
