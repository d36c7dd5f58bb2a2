"""Where the energy of the impacts went, per plate.

A thin plate's bending wave carries energy away for good; a thick plate hardly bends, and what is
lost on it goes into plastic flow where the bead touches.
"""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw.reporting.charts import PARTS, bar, wall_axis
from contactlaw.reporting.limits import label
from dem_demo.rain.figures._labels import source
from dem_demo.rain.measure import plate_shares
from dem_demo.rain.record import Run


def draw(run: Run) -> Figure:
    """Draw a stacked bar per plate."""
    energy = "normal kinetic energy"
    if run.scene.friction:
        energy = "kinetic energy at the contact, normal and sliding,"
    figure = style.figure(
        10.5,
        6.2,
        "Where the energy of the impacts went",
        f"{source(run)}; shares of the {energy} of all impacts on each plate",
    )
    axes = figure.add_subplot()
    for n in range(len(run.scene.plates)):
        found = plate_shares(run, n)
        if found is not None:
            bar(axes, n, 0.6, list(zip(PARTS, found, strict=True)))
    wall_axis(axes, [label(plate.thickness) for plate in run.scene.plates])
    axes.set_ylabel("share of the impact energy [%]")
    axes.set_ylim(0.0, 104.0)
    axes.set_yticks(range(0, 101, 20))
    _legend(axes)
    return figure


def _legend(axes: Axes) -> None:
    """One entry per part, above the bars."""
    handles, names = axes.get_legend_handles_labels()
    unique = dict(zip(names, handles, strict=True))
    columns = len(unique) if len(unique) < 5 else 3
    if unique:
        axes.legend(
            unique.values(),
            unique.keys(),
            loc="lower center",
            bbox_to_anchor=(0.5, 1.0),
            ncols=columns,
            columnspacing=1.4,
            handlelength=1.2,
        )
