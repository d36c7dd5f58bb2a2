"""What each wall takes from the beads, and where the energy goes.

Left: energy that all contacts took. Right: shares of what the impacts brought. A thin wall's
bending wave carries energy away for good; on a thick one plastic flow at the contact takes it.
"""

from matplotlib.figure import Figure

from contactlaw import style
from contactlaw._readable import drawn, scale_of
from contactlaw.reporting.charts import PARTS, across
from contactlaw.reporting.run import Run, by_cause, shares


def draw(run: Run) -> Figure:
    """Draw two panels with a bar for each wall, the first one on top."""
    walls, causes = run.walls, by_cause(run.rows)
    most, rubs = int(causes.argmax()), causes[-1] > 0.0
    share = 100.0 * causes[most] / (causes.sum() or 1.0)
    height = 2.6 + 0.5 * max(len(walls), 3)
    figure = style.figure(
        12.0,
        height,
        f"{share:.0f} % of what the walls take: {PARTS[most + 1][0]}",
        f"{run.subject}; left: energy that all contacts took, right: shares of the energy that the impacts brought",
    )
    left, right = figure.subplots(1, 2, sharey=True)
    unit, scale = scale_of(max(float(by_cause(wall.rows).sum()) for wall in walls), "J")
    for n, wall in enumerate(walls):
        part = by_cause(wall.rows)
        for m, (_, colour) in enumerate(PARTS[1:]):
            left.barh(n, part[m] / scale, 0.7, part[:m].sum() / scale, color=colour, edgecolor="white", linewidth=0.6)
        left.annotate(
            drawn(part.sum(), "J", 3),
            (part.sum() / scale, n),
            (4, 0),
            va="center",
            textcoords="offset points",
            fontsize=11,
        )
        if wall.impacts.size:
            found = shares(wall.impacts, wall.impacts["mass"], rubs)
            across(right, n, list(zip(PARTS, found, strict=True)))
    left.set_yticks(range(len(walls)), [wall.name for wall in walls])
    left.set_ylim(max(len(walls), 3) - 0.5, -0.5)
    left.set_xlabel(f"energy taken [{unit.replace('u', 'µ')}]")
    left.set_xlim(0.0, 1.2 * left.dataLim.x1 or 1.0)  # room for the sums
    right.set(xlabel="share of impacts' energy [%]", xlim=(0.0, 100.0))
    for axes in (left, right):
        axes.grid(visible=False, axis="y")
    handles = dict(zip(*reversed(right.get_legend_handles_labels()), strict=True))
    figure.legend(handles.values(), list(handles), loc="outside lower center", ncols=4 if len(handles) < 5 else 3)
    return figure
