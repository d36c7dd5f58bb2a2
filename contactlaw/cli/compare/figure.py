"""The figure of a comparison: the model's band over speed or thickness, and measured CORs."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from contactlaw import style
from contactlaw._arrays import Array
from contactlaw._readable import in_unit
from contactlaw.cli.parts import bands, plots
from contactlaw.comparison import Comparison
from contactlaw.model import ImpactModel
from contactlaw.physical.pair import Pair

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_UNITS = {"speed": "m/s", "radius": "m", "thickness": "m"}
_SAMPLES = 80  # points of a curve
_WIDER = 1.5  # ratio of a curve's ends to the extreme values of the data
_ALIKE = 0.1  # ln of speeds and sizes that share a curve
_CURVES = 6  # drawn of more; all points are


def save(
    found: Comparison, pair: Pair, law: str, errors: dict[str, float], about: str, path: str | os.PathLike[str]
) -> None:
    """Draw a comparison into a file: over speed, or over thickness if there are as many."""
    data, model = found.data, ImpactModel(pair, law)
    sizes = {name: np.asarray(getattr(data, name)) for name in _UNITS}
    steps = {name: np.round(np.log(size) / _ALIKE) for name, size in sizes.items()}
    counts = {name: np.unique(step[np.isfinite(step)]).size for name, step in steps.items()}
    along = "thickness" if counts["thickness"] >= max(counts["speed"], 2) else "speed"
    rest = [name for name in sizes if name != along]
    _, of = np.unique([steps[name] for name in rest], axis=1, return_inverse=True)
    of, inside = of.ravel(), sizes[along][np.isfinite(sizes[along])]
    many = of.max() + 1
    measured, error = np.asarray(data.restitution), np.asarray(data.restitution_error)
    label, scale = ("impact speed [m/s]", 1.0) if along == "speed" else ("plate thickness [mm]", 1e3)
    x = np.geomspace(inside.min() / _WIDER, inside.max() * _WIDER, _SAMPLES)
    with style.applied():
        edge = "; a half-space stands at the right end" if inside.size < len(data) else ""
        title = f"Measured COR beside the model: chi-squared {found.chi_squared:.3g} of {len(data)}"
        made = style.figure(9.0, 6.0, title, f"{about}; nothing is fitted; band: {bands.in_caption(found.band)}{edge}")
        axes = made.subplots()
        for n in range(many):
            colour = plots.colour_of(n, many) if many > 1 else style.BLUE
            if n in np.linspace(0, many - 1, min(many, _CURVES)).round():
                here = {one: float(sizes[one][of == n].mean()) for one in rest}
                name = ", ".join(f"{one} {in_unit(value, _UNITS[one], 3)}" for one, value in here.items())
                curve(axes, scale * x, model, here | {along: x}, errors, colour, name)
            at, face = scale * np.minimum(sizes[along][of == n], x[-1]), colour if many > 1 else style.ORANGE
            points(axes, at, measured[of == n], error[of == n], face, "_" if n else "measured")
        axes.set(xlabel=label, ylabel="coefficient of restitution [-]", xscale="log")
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
