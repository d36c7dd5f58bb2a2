"""Where the walls take energy from the beads: where they wear, ring and warm."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw._arrays import Array, Integers
from contactlaw._readable import drawn
from contactlaw.reporting.charts import DENSITY, density_bar, density_scale, sheet
from contactlaw.reporting.run import Run, taken
from contactlaw.reporting.surface import EnergyMap

_FLAT = 1e-6  # extent over the largest one; walls with less are drawn as a plan
_VIEWS = {"seen from above": (1.0, -1.6, 1.0), "seen from below, behind": (-1.0, 1.6, -1.0)}
_DULL = 0.65  # brightness of a surface that is seen edge-on
_NOTHING = 1e-4  # share of the largest energy per area; less is drawn as no energy, in grey
_POINTS = 20_000  # most contacts that are drawn
_WIDE, _HIGH = 5.0, (0.3, 6.0)  # [inches] width of a drawing, and its least and largest height


def draw(run: Run) -> Figure:
    """Draw the walls in the colours of their energies, or the contact points alone."""
    if run.map is None:
        return _points(run)
    corners, shades = 1e3 * run.map.corners, colours(run.map)
    size = np.ptp(corners, axis=(0, 1))
    thin = size <= _FLAT * size.max()
    shown = np.argsort(thin, kind="stable")[:2]  # the axes of a plan
    drawings = [(corners[:, :, shown], shades)] if thin.any() else [_seen(corners, shades, v) for v in _VIEWS.values()]
    grey = "; grey: no contact near" if (shades == to_rgb(style.PALE)).all(axis=1).any() else ""
    figure, panels = _panels(run, [np.ptp(flat, axis=(0, 1)) for flat, _ in drawings], 0.7, grey)
    scale = density_scale([run.map.density])
    for axes, (flat, painted), name in zip(panels, drawings, _VIEWS, strict=False):
        sheet(axes, flat, run.map.density, scale).set(array=None, facecolors=painted)
        axes.autoscale_view()
        axes.set_anchor("N")
        if thin.any():
            _label(axes, shown)
        else:
            axes.set_title(f"{name}; {size.max():.3g} mm is the longest side")
            axes.axis("off")
    density_bar(figure, ScalarMappable(scale, DENSITY), panels)
    return figure


def _panels(run: Run, sizes: list[Array], below: float, more: str) -> tuple[Figure, list[Axes]]:
    """Make a figure with room for drawings of some sizes, and `below` inches for their legend."""
    time = float(np.ptp(run.rows["time"]))
    within = f" in {drawn(time, 's', 3)}" if time > 0.0 else ""
    high = max(float(np.clip(_WIDE * size[1] / size[0], *_HIGH)) for size in sizes)
    title, about = "Where the walls take energy from the beads", f"{run.subject}; all contacts{within}{more}"
    figure = style.figure(style.COLUMN, 1.0 + below + len(sizes) * (0.5 + high), title, about)
    return figure, list(figure.subplots(len(sizes), 1, squeeze=False)[:, 0])


def _label(axes: Axes, shown: Integers) -> None:
    axes.set(xlabel=f"{'xyz'[shown[0]]} [mm]", ylabel=f"{'xyz'[shown[1]]} [mm]", aspect="equal")


def _seen(corners: Array, shades: Array, direction: tuple[float, float, float]) -> tuple[Array, Array]:
    """Project triangles as seen from far away in a direction, the nearest one last; darken their colours."""
    towards = np.array(direction) / np.linalg.norm(direction)
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    plane = np.stack((right, np.cross(towards, right)), axis=1)
    order = np.argsort(corners.mean(axis=1) @ towards)
    corners = corners[order]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = np.abs(normal @ towards) / np.linalg.norm(normal, axis=1)
    return corners @ plane, shades[order] * (_DULL + (1.0 - _DULL) * facing)[:, None]


def _points(run: Run) -> Figure:
    """Draw contact points as seen along the axis in which they spread the least."""
    energy, places = taken(run.rows), 1e3 * run.on_walls.points
    spread = np.ptp(places, axis=0)
    shown = np.delete(np.arange(3), 2 - int(np.argmin(spread[::-1])))
    # points on one flat wall, or a single one, need some room beside them
    size = np.maximum(spread[shown], 0.12 * spread.max() or 1.0)
    figure, (axes,) = _panels(run, [size], 0.5, "")
    largest = np.argsort(-energy)[:_POINTS]
    most = float(f"{float(np.quantile(energy, 0.98)) or 1.0:.0e}")
    look: dict[str, Any] = {"color": style.VERMILION, "alpha": 0.4, "linewidths": 0}
    area = 200.0 * (energy[largest] / most).clip(0.01, 4.0)
    x, y = places[largest][:, shown].T
    axes.scatter(x, y, s=area, rasterized=True, **look)
    for part in (1.0, 0.1, 0.01):
        axes.scatter([], [], s=200.0 * part, label=drawn(part * most, "J", 3), **look)
    low, high = (0.5 * (places.min(axis=0) + places.max(axis=0)))[shown] + 0.55 * np.outer((-1.0, 1.0), size)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    axes.locator_params(axis="y", nbins=6 if size[1] > 0.3 * size[0] else 3)
    _label(axes, shown)
    figure.legend(title="energy that a contact took", loc="outside lower center", ncols=3)
    return figure


def colours(found: EnergyMap) -> Array:
    """Colours of the map's triangles as red, green and blue from 0 to 1, shape (k, 3)."""
    mapped = ScalarMappable(density_scale([found.density]), DENSITY).to_rgba(found.density)
    shades = np.asarray(mapped)[:, :3]
    shades[found.density < _NOTHING * found.density.max()] = to_rgb(style.PALE)
    return shades
