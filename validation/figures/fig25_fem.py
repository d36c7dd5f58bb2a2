"""Fig. 25: law fem, which was fitted to finite elements, against impacts by finite elements.

Left, its COR over that of finite elements, by the body that yields; crosses are law myc, which has
no answer where the sphere has no yield strength. Right, the errors of law fem in COR, above for
impacts of the paper's kind, to which it was fitted too, below for everyday impacts that were drawn
before the fit and kept out of it. The target is that 95 % of the impacts lie in the band, and that
those outside of it carry a flag of accuracy, which an open mark shows.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes

from contactlaw import style
from contactlaw.style import BLUE, GREEN, INK, MUTED, PALE, SKY, VERMILION
from validation import figures
from validation.accuracy import acceptance
from validation.accuracy.acceptance import Member, Row
from validation.figures import chart
from validation.figures.chart import Axis, Panel

PART = figures.PRACTICE

_LOOK = {  # by the body that yields: marker, colour and words
    "none": ("D", SKY, "neither yields"),
    "sphere": ("o", BLUE, "the sphere yields"),
    "plate": ("s", VERMILION, "the plate yields"),
    "both": ("^", GREEN, "both yield"),
}
_TITLES = {
    "paper": "impacts of the paper's kind",
    "kept out": "everyday impacts, kept out of the fit",
}
_FEM = Axis("COR by finite elements").between(0.0, 1.005)
_WIDEST = 5.0  # [%]; a larger error is drawn here, with its value


def draw() -> chart.Drawn:
    """Draw COR over COR, and the errors of both rows."""
    rows = acceptance.rows(_TITLES)
    others = {name: acceptance.members(row.target, "myc") for name, row in rows.items()}
    figure = style.figure(
        14.0,
        7.4,
        "Law fem has the COR of finite elements, whichever body yields",
        "left: the coefficient of restitution (COR) of each impact, coloured: law fem, crosses: "
        "law myc, in which the sphere alone yields; right: errors of law fem, band: their bound",
    )
    panels = figure.subplot_mosaic(
        [["cor", "paper"], ["cor", "kept out"]], width_ratios=(1.0, 1.15)
    )
    Panel(_FEM, _FEM._replace(label="COR by law")).set_up(panels["cor"])
    _parity(panels["cor"], rows, others)
    for name, row in rows.items():
        _errors(panels[name], _TITLES[name], row)
    panels["paper"].set_xlabel("")
    panels["paper"].tick_params(labelbottom=False)
    return figure, _numbers(rows, others)


def _parity(axes: Axes, rows: dict[str, Row], others: dict[str, tuple[Member, ...]]) -> None:
    axes.plot([0.0, 1.0], [0.0, 1.0], color=INK, linewidth=1)
    every = [one for listed in others.values() for one in listed]
    axes.plot(
        [one.fem for one in every], [one.law for one in every], "x", color=MUTED,
        markersize=6, alpha=0.7, label="law myc", zorder=1,
    )  # fmt: skip
    for row in rows.values():
        _marks(axes, row, lambda one: one.law, 8.0)
    chart.key(axes, "open: with a flag", "o", markerfacecolor="white", color=BLUE)
    named = dict(zip(*axes.get_legend_handles_labels()[::-1], strict=True))
    axes.legend(named.values(), named.keys(), loc="upper left", fontsize=12)


def _marks(axes: Axes, row: Row, value: Callable[[Member], float], size: float) -> None:
    """Mark impacts by the body that yields; those that carry a flag of accuracy are open."""
    for yielding, (marker, colour, words) in _LOOK.items():
        for flagged in (False, True):
            some = [
                one for one in row.members if (one.yielding, one.flagged) == (yielding, flagged)
            ]
            if not some:  # an empty mark takes room in the layout
                continue
            axes.plot(
                [one.fem for one in some], [value(one) for one in some], marker, color=colour,
                markersize=size, markerfacecolor="white" if flagged else colour,
                markeredgecolor=colour if flagged else "white", markeredgewidth=0.8,
                label=None if flagged else words, clip_on=False, zorder=2,
            )  # fmt: skip


def _errors(axes: Axes, title: str, row: Row) -> None:
    """Draw errors of law fem in COR, and their bound as a band."""
    bound = 100.0 * row.target.bounds.restitution
    right = sum(abs(one.errors.restitution) <= 0.01 * bound for one in row.members)
    title = f"{title}: {right} of {len(row.members)} within {bound:g} %"
    Panel(_FEM, Axis("error of the COR  [%]").between(-5.6, 5.6), title).set_up(axes)
    axes.axhspan(-bound, bound, color=PALE, alpha=0.6, linewidth=0)
    axes.axhline(0.0, color=INK, linewidth=1)

    def error(one: Member) -> float:
        return float(np.clip(100.0 * one.errors.restitution, -_WIDEST, _WIDEST))

    _marks(axes, row, error, 7.0)
    far = [one for one in row.members if abs(100.0 * one.errors.restitution) > _WIDEST]
    for n, one in enumerate(sorted(far, key=lambda one: one.fem)):
        percent = 100.0 * one.errors.restitution
        lift = 9 + 12 * (n % 2)  # apart from its neighbours
        axes.annotate(
            f"{percent:+.1f}", (one.fem, error(one)), (0, -lift if percent > 0.0 else lift),
            textcoords="offset points", ha="center", va="center_baseline", fontsize=10,
        )  # fmt: skip


def _numbers(rows: dict[str, Row], others: dict[str, tuple[Member, ...]]) -> dict[str, float]:
    numbers: dict[str, float] = {}
    for name, row in rows.items():
        numbers[f"{name}: impacts"] = len(row.members)
        numbers[f"{name}: with a flag of accuracy"] = len(row.members) - len(row.counted)
        numbers[f"{name}: beyond a bound without one"] = len(row.silent)
        for field, share, largest in zip(
            acceptance.Errors._fields, row.shares, row.largest, strict=True
        ):
            words = field.replace("_", " ")
            numbers[f"{name}: share within, {words}"] = share
            numbers[f"{name}: largest error, {words}"] = largest
        numbers[f"{name}: rms error, restitution"] = row.rms
        listed = others[name]
        errors = np.array([one.errors.restitution for one in listed])
        numbers[f"{name}: answered by myc"] = len(listed)
        numbers[f"{name}: rms error of myc, restitution"] = float(np.sqrt(np.mean(errors**2)))
    return numbers
