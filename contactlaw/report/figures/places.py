"""Where the walls take energy from the beads: where they wear, ring and warm.

Colours show the energy per area, averaged over a neighbourhood, of all causes; grey: none near.
Without the walls' mesh, each contact is a point whose area is the energy that it took.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, to_rgb
from matplotlib.figure import Figure
from numpy.typing import NDArray

from contactlaw import style
from contactlaw.report.charts import DENSITY, density_bar, density_scale, sheet
from contactlaw.report.run import Run, taken
from contactlaw.report.summary import joules
from contactlaw.report.surface import EnergyMap

Floats = NDArray[np.float64]

_FLAT = 1e-6  # extent over the largest one; walls with less are drawn as a plan
_VIEWS = {"seen from above": (1.0, -1.6, 1.0), "seen from below, behind": (-1.0, 1.6, -1.0)}
_DULL = 0.65  # brightness of a surface that is seen edge-on
_NOTHING = 1e-4  # share of the largest energy per area; less is drawn as no energy, in grey
_POINTS = 20_000  # most contacts that are drawn


def draw(run: Run) -> Figure:
    """Draw the walls in the colours of their energies, or the contact points alone."""
    if run.map is None:
        return _points(run)
    low, high = (run.map.corners.min(axis=(0, 1)), run.map.corners.max(axis=(0, 1)))
    thin = np.flatnonzero(high - low <= _FLAT * (high - low).max())
    views = 1 if thin.size else len(_VIEWS)
    figure = style.figure(
        12.0, style.pick(6.6 if thin.size else 5.8, 5.8 * views),
        "Where the walls take energy from the beads",
        f"{run.subject}; energy of all contacts per area, in {_time(run)}",
    )  # fmt: skip
    panels = np.atleast_1d(figure.subplots(*style.pick((1, views), (views, 1))))
    scale = density_scale([run.map.density])
    if thin.size:
        _plan(panels[0], run.map, int(thin[0]), scale)
    else:
        for axes, (name, towards) in zip(panels, _VIEWS.items(), strict=True):
            _view(axes, run.map, np.array(towards), scale)
            axes.set_title(name)
    density_bar(figure, ScalarMappable(scale, DENSITY), list(panels))
    return figure


def _time(run: Run) -> str:
    return f"{float(np.ptp(run.rows['time'])) * 1e3:.3g} ms"


def _plan(axes: Axes, found: EnergyMap, across: int, scale: LogNorm) -> None:
    """Draw walls that are all in one plane, seen along the axis `across`."""
    x, y = (n for n in range(3) if n != across)
    drawn = sheet(axes, found.corners[:, :, [x, y]] * 1e3, found.density, scale)
    drawn.set(array=None, facecolors=colours(found))
    axes.autoscale_view()
    axes.set(xlabel=f"{'xyz'[x]} [mm]", ylabel=f"{'xyz'[y]} [mm]")


def _view(axes: Axes, found: EnergyMap, towards: Floats, scale: LogNorm) -> None:
    """Draw walls in space as one at the end of `towards` sees them from far away."""
    towards = towards / np.linalg.norm(towards)
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    plane = np.stack((right, np.cross(towards, right)), axis=1)
    order = np.argsort(found.corners.mean(axis=1) @ towards)  # what is near hides what is far
    corners = found.corners[order]
    drawn = sheet(axes, corners @ plane * 1e3, found.density[order], scale)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = np.abs(normal @ towards) / np.linalg.norm(normal, axis=1)
    shades = colours(found)[order] * (_DULL + (1.0 - _DULL) * facing)[:, None]
    drawn.set(array=None, facecolors=shades)
    axes.autoscale_view()
    axes.axis("off")
    _ruler(axes)


def _ruler(axes: Axes) -> None:
    """Draw a line of a round length below the walls."""
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    power = 10.0 ** np.floor(np.log10(0.4 * (right - left)))
    length = max(n * power for n in (1.0, 2.0, 5.0) if n * power <= 0.4 * (right - left))
    y = bottom - 0.04 * (top - bottom)
    axes.plot([left, left + length], [y, y], color=style.INK, linewidth=3.0)
    axes.annotate(f"{length:g} mm", (left + 0.5 * length, y), (0, -4), va="top", ha="center",
                  textcoords="offset points")  # fmt: skip
    axes.set_ylim(bottom - 0.12 * (top - bottom), top)


def _points(run: Run) -> Figure:
    """Draw contact points as seen along the axis in which they spread the least."""
    rows, energy = run.rows, taken(run.rows)
    places = np.column_stack([rows[name] for name in "xyz"]) * 1e3
    spread = np.ptp(places, axis=0)
    x, y = (n for n in range(3) if n != 2 - int(np.argmin(spread[::-1])))
    wide, high = np.maximum(spread[[x, y]], 0.02 * spread.max())
    figure = style.figure(
        12.0, 1.9 + float(np.clip(style.pick(11.0, 5.2) * high / wide, 1.2, 6.0)),
        "Where the walls take energy from the beads",
        f"{run.subject}; contacts in {_time(run)}",
    )  # fmt: skip
    axes = figure.add_subplot()
    few = np.argsort(-energy)[:_POINTS]
    most = float(np.quantile(energy, 0.98)) or 1.0
    most = float(f"{most:.0e}")
    look: dict[str, Any] = {"color": style.VERMILION, "alpha": 0.4, "linewidths": 0}
    size = 200.0 * (energy[few] / most).clip(0.01, 4.0)
    axes.scatter(places[few, x], places[few, y], s=size, rasterized=True, **look)
    for part in (1.0, 0.1, 0.01):
        axes.scatter([], [], s=200.0 * part, label=joules(part * most), **look)
    axes.set(xlabel=f"{'xyz'[x]} [mm]", ylabel=f"{'xyz'[y]} [mm]")
    axes.set_aspect("equal")
    figure.legend(title="taken by a contact", loc="outside lower center", ncols=3)
    return figure


def colours(found: EnergyMap) -> Floats:
    """Colours of the map's triangles as red, green and blue from 0 to 1, shape (k, 3)."""
    scale = density_scale([found.density])
    mapped = np.asarray(ScalarMappable(scale, DENSITY).to_rgba(found.density))[:, :3]
    mapped[found.density < _NOTHING * found.density.max()] = to_rgb(style.PALE)
    return mapped
