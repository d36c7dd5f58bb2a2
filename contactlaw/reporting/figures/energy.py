"""What each wall takes from the beads, and where the energy goes.

A thin wall's bending wave carries energy away for good; on a thick wall the losses at the contact
prevail.
"""

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw._arrays import Array
from contactlaw._readable import drawn, scale_of
from contactlaw.reporting.run import CAUSES, Run, by_cause, shares

_ROW, _PANEL = 0.42, 0.9  # [inches] height of a wall, and of what is around the walls of a panel
_LEAST = 2e-3  # [longest bar], the least part that can be seen
_WIDE = 7.0  # [%], the width of a number with room around it


def draw(run: Run) -> Figure:
    """Draw a bar for each wall, the first one on top: energies taken, and shares of what came."""
    walls, causes = run.walls, by_cause(run.rows)
    most = CAUSES[int(causes.argmax())]
    unit, scale = scale_of(max(float(by_cause(wall.rows).sum()) for wall in walls), "J")
    energies = np.array([[0.0, *by_cause(wall.rows) / scale] for wall in walls])
    parts = np.array([100.0 * np.array(shares(wall.impacts, causes[-1] > 0.0)) for wall in walls])
    figure = style.figure(
        style.COLUMN,
        2.2 + 2.0 * (_PANEL + _ROW * len(walls)),
        f"{100.0 * causes.max() / (causes.sum() or 1.0):.0f} % of what the walls take: {style.ENERGIES[most][0]}",
        run.subject,
    )
    upper, lower = figure.subplots(2, 1)
    _stack(upper, energies)
    for n, total in enumerate(energies.sum(axis=1)):
        upper.annotate(drawn(total * scale, "J", 3), (total, n), (4, 0), textcoords="offset points", va="center")
    upper.set_xlim(0.0, 1.25 * energies.sum(axis=1).max() or 1.0)  # room for the sums
    upper.set(xlabel=f"energy taken by all contacts [{unit.replace('u', 'µ')}]")
    _stack(lower, parts, _WIDE)
    lower.set(xlabel="share of the energy that impacts bring [%]", xlim=(0.0, 100.0))
    named: dict[str, Artist] = {}
    for axes in (lower, upper):
        axes.set_yticks(range(len(walls)), [wall.name.replace(", ", ",\n") for wall in walls], fontsize=11)
        axes.set_ylim(len(walls) - 0.5, -0.5)
        axes.grid(visible=False, axis="y")
        named |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    figure.legend(named.values(), list(named), loc="outside lower center", ncols=2)
    return figure


def _stack(axes: Axes, parts: Array, wide: float = np.inf) -> None:
    """Stack parts (walls, energies) from left to right, with the numbers of those from `wide` on."""
    for n, (name, colour) in enumerate(list(style.ENERGIES.values())[: parts.shape[1]]):
        part = parts[:, n]
        if part.max() > _LEAST * parts.sum(axis=1).max():
            bars = axes.barh(range(len(part)), part, 0.7, parts[:, :n].sum(axis=1), color=colour, edgecolor="white")
            bars.set_label(name)
            ink = "white" if colour == style.BLUE else style.INK
            axes.bar_label(bars, [f"{x:.0f}" if x >= wide else "" for x in part], label_type="center", color=ink)
