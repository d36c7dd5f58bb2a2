"""Where the energy of the impacts went, per plate.

A thin plate's bending wave carries energy away for good; a thick plate hardly bends, and what is
lost on it goes into plastic flow where the bead touches.
"""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contactlaw import style
from dem_demo.kit.report import label
from dem_demo.rain.figures._labels import source, thickness_axis
from dem_demo.rain.measure import model_shares, plate_rows
from dem_demo.rain.record import Run

_PARTS = _KEPT, *_ = (
    ("kept by the bead", style.PALE),
    ("bending wave in the plate", style.BLUE),
    ("plastic flow at the contact", style.ORANGE),
    ("micro-slip and vibration", style.GREEN),
    ("friction along the plate", style.SKY),
)
_LOST = ("lost, nobody knows where", style.MUTED)
_ROOM = 4.5  # [%], the height of a number; smaller shares have theirs beside the bar
_READABLE = {style.BLUE: style.BLUE, style.ORANGE: "#9A6700", style.GREEN: "#00694D",
             style.SKY: "#1F6E9C", style.PALE: style.INK, style.MUTED: style.INK}  # fmt: skip


def draw(run: Run) -> Figure:
    """Draw a stacked bar per plate; for the baseline, beside the model's answer for its impacts."""
    constant = run.baseline
    energy = "normal kinetic energy"
    if run.scene.friction:
        energy = "kinetic energy at the contact, normal and sliding,"
    figure = style.figure(
        10.5,
        6.2,
        "A constant COR takes the same share from every impact"
        if constant
        else "Where the energy of the impacts went",
        f"{source(run)}; shares of the {energy} of all impacts on each plate"
        + ("; left: the run, right: contactlaw for the same impacts" if constant else ""),
    )
    axes = figure.add_subplot()
    for n, row in enumerate(plate_rows(run)):
        if not row.impacts:
            continue
        if constant:
            kept = row.shares.kept
            _bar(axes, n - 0.25, 0.3, [(_KEPT, kept), (_LOST, 1.0 - kept)])
            _bar(axes, n + 0.15, 0.3, list(zip(_PARTS, model_shares(run, n), strict=True)))
        else:
            _bar(axes, n, style.pick(0.6, 0.5), list(zip(_PARTS, row.shares, strict=True)))
    thickness_axis(axes, [label(plate.thickness) for plate in run.scene.plates])
    axes.set_ylabel("share of the impact energy [%]")
    axes.set_ylim(0.0, 104.0)
    axes.set_yticks(range(0, 101, 20))
    _legend(axes)
    return figure


def _bar(axes: Axes, x: float, width: float, parts: list[tuple[tuple[str, str], float]]) -> None:
    """Stack the shares, each with its number; those of small shares are beside the bar."""
    bottom = beside = 0.0
    for (name, colour), share in parts:
        height = 100.0 * share
        if height < 0.05:
            continue
        axes.bar(x, height, width, bottom, color=colour, label=name, edgecolor="white")
        middle = bottom + 0.5 * height
        text = f"{height:.0f}" if height >= 9.5 else f"{height:.1f}"
        if height >= _ROOM:
            ink = "white" if colour in (style.BLUE, style.MUTED, style.GREEN) else style.INK
            axes.text(x, middle, text, ha="center", va="center", color=ink, fontsize=11)
        else:
            beside = max(middle, beside + _ROOM)
            axes.text(
                x + 0.5 * width, beside, f" {text}", va="center", color=_READABLE[colour],
                fontsize=11, fontweight="bold",
            )  # fmt: skip
        bottom += height


def _legend(axes: Axes) -> None:
    """One entry per part, above the bars."""
    handles, names = axes.get_legend_handles_labels()
    unique = dict(zip(names, handles, strict=True))
    columns = len(unique) if len(unique) < 5 else 3
    if unique:
        axes.legend(
            unique.values(), unique.keys(), loc="lower center", bbox_to_anchor=(0.5, 1.0),
            ncols=style.pick(columns, 2), columnspacing=1.4, handlelength=1.2,
        )  # fmt: skip
