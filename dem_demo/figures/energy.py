"""Where the energy of the impacts went, per plate."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dem_demo import style
from dem_demo.figures._labels import source, thickness_axis
from dem_demo.measure import model_shares, plate_rows
from dem_demo.reader import Run
from dem_demo.recorder import CONSTANT
from dem_demo.report import label

_KEPT, _WAVE, _PLASTIC, _LOST = (
    ("kept by the bead", style.PALE),
    ("bending wave in the plate", style.BLUE),
    ("plastic flow at the contact", style.ORANGE),
    ("lost, nobody knows where", style.MUTED),
)


def draw(run: Run) -> Figure:
    """Draw a stacked bar per plate; beside the baseline, what the model says of its impacts."""
    constant = run.law == CONSTANT
    figure = style.figure(
        10.5,
        6.2,
        "A constant COR takes the same share from every impact"
        if constant
        else "Where the energy of the impacts went",
        f"{source(run)}; shares of the normal kinetic energy of all impacts on each plate"
        + ("; left: the run, right: contactlaw for the same impacts" if constant else ""),
    )
    axes = figure.add_subplot()
    for n, row in enumerate(plate_rows(run)):
        if not row.impacts:
            continue
        if constant:
            _bar(axes, n - 0.2, 0.36, [(_KEPT, row.kept), (_LOST, 1.0 - row.kept)])
            kept, wave, plastic = model_shares(run, n)
            _bar(axes, n + 0.2, 0.36, [(_KEPT, kept), (_WAVE, wave), (_PLASTIC, plastic)])
        else:
            parts = [(_KEPT, row.kept), (_WAVE, row.wave), (_PLASTIC, row.plastic)]
            _bar(axes, n, 0.66, parts)
    thickness_axis(axes, [label(plate.thickness) for plate in run.scene.plates])
    axes.set_ylabel("share of the impact energy [%]")
    axes.set_ylim(0.0, 100.0)
    _legend(figure, axes)
    return figure


def _bar(axes: Axes, x: float, width: float, parts: list[tuple[tuple[str, str], float]]) -> None:
    bottom = 0.0
    for (name, colour), share in parts:
        height = 100.0 * share
        axes.bar(x, height, width, bottom, color=colour, label=name, edgecolor="white")
        if height >= 2.5:  # smaller parts have no room for a number
            dark = colour in (style.BLUE, style.MUTED)
            axes.text(
                x, bottom + 0.5 * height, f"{height:.0f}", ha="center", va="center",
                color="white" if dark else style.INK, fontsize=11,
            )  # fmt: skip
        bottom += height


def _legend(figure: Figure, axes: Axes) -> None:
    """One entry per part, above the bars."""
    handles, names = axes.get_legend_handles_labels()
    unique = dict(zip(names, handles, strict=True))
    if unique:
        axes.legend(
            unique.values(), unique.keys(), loc="lower center", bbox_to_anchor=(0.5, 1.0),
            ncols=len(unique), columnspacing=1.4, handlelength=1.2,
        )  # fmt: skip
