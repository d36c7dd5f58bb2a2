"""What each wall takes from the beads, and where the energy goes.

Left: energy that all contacts took. Right: shares of what the impacts brought. A thin wall's
bending wave carries energy away for good; on a thick one plastic flow at the contact takes it.
"""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw.report.charts import PARTS, bar, wall_axis
from contactlaw.report.run import CAUSES, Run, shares, taken
from contactlaw.report.summary import joules, unit_of


def draw(run: Run) -> Figure:
    """Draw two panels with a bar for each wall."""
    walls = run.walls
    figure = style.figure(
        12.0, style.pick(6.0, 9.6), _title(run),
        f"{run.subject}; left: energy that all contacts took, right: shares of the energy that "
        "the impacts brought",
    )  # fmt: skip
    left, right = figure.subplots(*style.pick((1, 2), (2, 1)))
    names = [_wrapped(wall.name, len(walls)) for wall in walls]
    parts = np.array([[np.nansum(wall.rows[f"{cause}_energy"]) for cause in CAUSES]
                      for wall in walls])  # fmt: skip
    unit, scale = unit_of(float(parts.sum(axis=1).max()))
    for n, (wall, part) in enumerate(zip(walls, parts, strict=True)):
        for m, (_, colour) in enumerate(PARTS[1:]):
            left.bar(n, part[m] / scale, 0.6, part[:m].sum() / scale, color=colour,
                     edgecolor="white", linewidth=0.6)  # fmt: skip
        left.annotate(joules(part.sum()), (n, part.sum() / scale), (0, 3), ha="center",
                      textcoords="offset points", fontsize=11 if len(walls) < 7 else 8)  # fmt: skip
        if wall.impacts.size:
            found = shares(wall.impacts, wall.impacts["mass"], run.friction)
            bar(right, n, 0.6, list(zip(PARTS, found, strict=True)))
    for axes in (left, right):
        wall_axis(axes, names, "wall")
        if len(walls) < 3:  # or a single bar would be as wide as its panel
            axes.set_xlim(0.5 * len(walls) - 2.0, 0.5 * len(walls) + 1.0)
    left.set_ylabel(f"energy taken [{unit}]")
    left.margins(y=0.1)
    right.set_ylabel("share of the impacts' energy [%]")
    right.set_ylim(0.0, 104.0)
    handles = dict(zip(*reversed(right.get_legend_handles_labels()), strict=True))
    figure.legend(handles.values(), list(handles), loc="outside lower center",
                  ncols=style.pick(len(handles), 2))  # fmt: skip
    return figure


def _wrapped(name: str, walls: int) -> str:
    """Break a name into lines, if columns are wide enough to have it below them."""
    return "\n".join(textwrap.wrap(name, max(10, 52 // walls))) if walls < 7 else name


def _title(run: Run) -> str:
    rows, whole = run.rows, float(taken(run.rows).sum())
    parts = [float(np.nansum(rows[f"{cause}_energy"])) for cause in CAUSES]
    if not whole > 0.0:
        return "What the walls take from the beads"
    most = int(np.argmax(parts))
    return f"{100.0 * parts[most] / whole:.0f} % of what the walls take goes to {_WORDS[most]}"


_WORDS = "bending waves", "plastic flow at the contact", "micro-slip and vibration", "friction"
