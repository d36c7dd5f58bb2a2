"""The figure of a comparison: the model's band over speed or thickness, and measured CORs."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from contactlaw import style
from contactlaw._arrays import Array
from contactlaw._readable import in_unit
from contactlaw.cli.parts import plots
from contactlaw.comparison import Comparison
from contactlaw.model import ImpactModel
from contactlaw.physical.pair import Pair

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SAMPLES = 80  # points of a curve
_WIDER = 1.5  # ratio of a curve's ends to the extreme values of the data


def save(
    found: Comparison, pair: Pair, law: str, errors: dict[str, float], about: str, path: str | os.PathLike[str]
) -> None:
    """Draw a comparison into a file: over thickness if there are several, otherwise over speed."""
    data, model = found.data, ImpactModel(pair, law)
    sizes = {name: np.asarray(getattr(data, name)) for name in ("speed", "radius", "thickness")}
    thickness = sizes["thickness"]
    along = "thickness" if np.unique(thickness[np.isfinite(thickness)]).size > 1 else "speed"
    rest = [name for name in sizes if name != along]
    units, scale = {"speed": "m/s", "radius": "m", "thickness": "m"}, 1e3 if along == "thickness" else 1.0
    groups = np.unique(np.column_stack([sizes[name] for name in rest]), axis=0)
    with style.applied():
        title = f"Measured COR beside the model: chi-squared {found.chi_squared:.2g} of {len(data)}"
        made = style.figure(9.0, 6.0, title, f"{about}; the band is of 68 %, nothing is fitted")
        axes = made.subplots()
        inside = sizes[along][np.isfinite(sizes[along])]
        x = np.geomspace(inside.min() / _WIDER, inside.max() * _WIDER, _SAMPLES)
        for n, group in enumerate(groups.tolist()):
            here = dict(zip(rest, group, strict=True)) | {along: x}
            colour = plots.colour_of(n, len(groups)) if len(groups) > 1 else style.BLUE
            name = ", ".join(f"{one} {in_unit(value, units[one])}" for one, value in zip(rest, group, strict=True))
            curve(axes, scale * x, model, here, errors, colour, name)
            rows = np.all([sizes[one] == value for one, value in zip(rest, group, strict=True)], axis=0)
            measured, error = (np.asarray(one)[rows] for one in (data.restitution, data.restitution_error))
            points(axes, scale * sizes[along][rows], measured, error, colour if len(groups) > 1 else style.ORANGE)
        unit = "m/s" if along == "speed" else "mm"
        axes.set(xlabel=f"{'impact speed' if along == 'speed' else 'plate thickness'} [{unit}]", xscale="log")
        axes.set_ylabel("coefficient of restitution [-]")
        style.decades(axes.xaxis, (1.0, 2.0, 5.0))
        axes.legend(loc="best")
        plots.save(made, path)


def curve(
    axes: Axes,
    x: Array,
    model: ImpactModel,
    impact: dict[str, Any],
    errors: dict[str, float],
    colour: Any,
    label: str = "model",
) -> None:
    """Draw the COR of a model over x, with its band where that is known."""
    cor = np.asarray(model.solve(**impact).restitution)
    band = model.uncertainty(**impact, **errors).restitution
    low, high = (np.where(np.isfinite(end), end, cor) for end in (band.low, band.high))
    axes.fill_between(x, low, high, color=colour, alpha=0.25, linewidth=0.0)
    axes.plot(x, cor, color=colour, linewidth=2.4, label=label)


def points(axes: Axes, x: Array, value: Array, error: Array, colour: Any, label: str = "measured") -> None:
    """Draw measured CORs with their standard errors."""
    look = {"fmt": "o", "color": style.INK, "markersize": 8, "markerfacecolor": colour, "capsize": 5}
    axes.errorbar(x, value, error, label=label, **look)
