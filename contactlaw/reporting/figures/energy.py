"""What each wall takes from the beads, and where the energy goes.

Left: energy that all contacts took. Right: shares of what the impacts brought. A thin wall's
bending wave carries energy away for good; on a thick one plastic flow at the contact takes it.
"""

from __future__ import annotations

import textwrap

from matplotlib.figure import Figure

from contactlaw import style
from contactlaw._readable import drawn, scale_of
from contactlaw.reporting.charts import PARTS, bar, wall_axis
from contactlaw.reporting.run import Run, by_cause, shares


def draw(run: Run) -> Figure:
    """Draw two panels with a bar for each wall."""
    walls, causes = run.walls, by_cause(run.rows)
    most = int(causes.argmax())
    share = 100.0 * causes[most] / (causes.sum() or 1.0)
    figure = style.figure(
        12.0, style.pick(6.0, 9.6), f"{share:.0f} % of what the walls take: {PARTS[most + 1][0]}",
        f"{run.subject}; left: energy that all contacts took, right: shares of the energy that "
        "the impacts brought",
    )  # fmt: skip
    left, right = figure.subplots(*style.pick((1, 2), (2, 1)))
    unit, scale = scale_of(max(float(by_cause(wall.rows).sum()) for wall in walls), "J")
    for n, wall in enumerate(walls):
        part = by_cause(wall.rows)
        for m, (_, colour) in enumerate(PARTS[1:]):
            left.bar(n, part[m] / scale, 0.6, part[:m].sum() / scale, color=colour,
                     edgecolor="white", linewidth=0.6)  # fmt: skip
        left.annotate(drawn(part.sum(), "J", 3), (n, part.sum() / scale), (0, 3), ha="center",
                      textcoords="offset points", fontsize=11 if len(walls) < 7 else 8)  # fmt: skip
        if wall.impacts.size:
            found = shares(wall.impacts, wall.impacts["mass"], by_cause(run.rows)[-1] > 0.0)
            bar(right, n, 0.6, list(zip(PARTS, found, strict=True)), len(walls) < 7)
    names = [wall.name for wall in walls]
    if len(walls) < 7:  # columns are wide enough to have their names below them
        names = ["\n".join(textwrap.wrap(name, max(10, 52 // len(walls)))) for name in names]
    for axes, what in (
        (left, f"energy taken [{unit.replace('u', 'µ')}]"),
        (right, "share of impacts' energy [%]"),
    ):
        wall_axis(axes, names, "wall")
        if len(walls) > 6:
            axes.tick_params(axis="x", rotation=60)
        axes.set_ylabel(what)
        if len(walls) < 3:  # or a single bar would be as wide as its panel
            axes.set_xlim(0.5 * len(walls) - 2.0, 0.5 * len(walls) + 1.0)
    left.margins(y=0.1)
    right.set_ylim(0.0, 104.0)
    handles = dict(zip(*reversed(right.get_legend_handles_labels()), strict=True))
    figure.legend(handles.values(), list(handles), loc="outside lower center",
                  ncols=style.pick(4 if len(handles) < 5 else 3, 2))  # fmt: skip
    return figure
