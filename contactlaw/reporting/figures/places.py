"""Where the walls take energy from the beads: where they wear, ring and warm.

Colours show the energy per area, averaged over a neighbourhood, of all causes; grey: none near.
Without the walls' mesh, each contact is a point whose area is the energy that it took.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw._arrays import Array
from contactlaw._readable import drawn
from contactlaw.reporting.charts import DENSITY, density_bar, density_scale, sheet
from contactlaw.reporting.run import Run, taken
from contactlaw.reporting.surface import EnergyMap

_TITLE = "Where the walls take energy from the beads"
_FLAT = 1e-6  # extent over the largest one; walls with less are drawn as a plan
_VIEWS = {"seen from above": (1.0, -1.6, 1.0), "seen from below, behind": (-1.0, 1.6, -1.0)}
_DULL = 0.65  # brightness of a surface that is seen edge-on
_NOTHING = 1e-4  # share of the largest energy per area; less is drawn as no energy, in grey
_POINTS = 20_000  # most contacts that are drawn


def draw(run: Run) -> Figure:
    """Draw the walls in the colours of their energies, or the contact points alone."""
    time = float(np.ptp(run.rows["time"]))
    within = f" in {drawn(time, 's', 3)}" if time > 0.0 else ""
    if run.map is None:
        return _points(run, within)
    found = run.map
    size = np.ptp(found.corners, axis=(0, 1))
    thin = np.flatnonzero(size <= _FLAT * size.max())
    views = 1 if thin.size else len(_VIEWS)
    figure = style.figure(
        12.0, 6.6 if thin.size else 5.8, _TITLE, f"{run.subject}; energy of all contacts per area{within}"
    )
    panels = np.atleast_1d(figure.subplots(1, views))
    if thin.size:
        x, y = (n for n in range(3) if n != thin[0])
        _paint(panels[0], found.corners[:, :, [x, y]], found, colours(found))
        panels[0].set(xlabel=f"{'xyz'[x]} [mm]", ylabel=f"{'xyz'[y]} [mm]")
    else:
        for axes, (name, towards) in zip(panels, _VIEWS.items(), strict=True):
            _view(axes, found, np.array(towards) / np.linalg.norm(towards))
            axes.set_title(f"{name}; {1e3 * size.max():.3g} mm is the longest side")
    scale = density_scale([found.density])
    density_bar(figure, ScalarMappable(scale, DENSITY), list(panels))
    return figure


def _paint(axes: Axes, corners: Array, found: EnergyMap, shades: Array) -> None:
    drawn = sheet(axes, 1e3 * corners, found.density, density_scale([found.density]))
    drawn.set(array=None, facecolors=shades)
    axes.autoscale_view()


def _view(axes: Axes, found: EnergyMap, towards: Array) -> None:
    """Draw walls in space as one at the end of `towards` sees them from far away."""
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    plane = np.stack((right, np.cross(towards, right)), axis=1)
    order = np.argsort(found.corners.mean(axis=1) @ towards)  # what is near hides what is far
    corners = found.corners[order]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = np.abs(normal @ towards) / np.linalg.norm(normal, axis=1)
    shades = colours(found)[order] * (_DULL + (1.0 - _DULL) * facing)[:, None]
    _paint(axes, corners @ plane, found, shades)
    axes.axis("off")


def _points(run: Run, within: str) -> Figure:
    """Draw contact points as seen along the axis in which they spread the least."""
    energy, places = taken(run.rows), 1e3 * run.on_walls.points
    spread = np.ptp(places, axis=0)
    x, y = (n for n in range(3) if n != 2 - int(np.argmin(spread[::-1])))
    # points on one flat wall, or a single one, need some room beside them
    wide, high = np.maximum(spread[[x, y]], 0.12 * spread.max() or 1.0)
    height = float(np.clip(11.0 * high / wide, 1.2, 6.0))
    figure = style.figure(12.0, 1.9 + height, _TITLE, f"{run.subject}; contacts{within}")
    axes = figure.add_subplot()
    few = np.argsort(-energy)[:_POINTS]
    most = float(f"{float(np.quantile(energy, 0.98)) or 1.0:.0e}")
    look: dict[str, Any] = {"color": style.VERMILION, "alpha": 0.4, "linewidths": 0}
    size = 200.0 * (energy[few] / most).clip(0.01, 4.0)
    axes.scatter(places[few, x], places[few, y], s=size, rasterized=True, **look)
    for part in (1.0, 0.1, 0.01):
        axes.scatter([], [], s=200.0 * part, label=drawn(part * most, "J", 3), **look)
    middle = 0.5 * (places.min(axis=0) + places.max(axis=0))
    for n, size, limit in ((x, wide, axes.set_xlim), (y, high, axes.set_ylim)):
        limit(middle[n] - 0.55 * size, middle[n] + 0.55 * size)
    axes.locator_params(axis="y", nbins=6 if high > 0.3 * wide else 3)
    axes.set(xlabel=f"{'xyz'[x]} [mm]", ylabel=f"{'xyz'[y]} [mm]", aspect="equal")
    figure.legend(title="taken by a contact", loc="outside lower center", ncols=3)
    return figure


def colours(found: EnergyMap) -> Array:
    """Colours of the map's triangles as red, green and blue from 0 to 1, shape (k, 3)."""
    mapped = ScalarMappable(density_scale([found.density]), DENSITY).to_rgba(found.density)
    shades = np.asarray(mapped)[:, :3]
    shades[found.density < _NOTHING * found.density.max()] = to_rgb(style.PALE)
    return shades
