"""The figure of a comparison: the model's band over speed or thickness, and measured CORs."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from contactlaw._arrays import Array
from contactlaw.cli.parts import bands
from contactlaw.cli.parts.figure import Figure
from contactlaw.cli.parts.measured import figure_of
from contactlaw.comparison import Comparison
from contactlaw.model import ImpactModel


def figure(found: Comparison, model: ImpactModel, errors: Mapping[str, float], about: str) -> Figure:
    """Figure of a comparison with a model; the errors are those of speed and sizes."""
    data = found.data
    sizes = {name: np.asarray(getattr(data, name)) for name in ("speed", "thickness", "radius")}
    values = np.asarray(data.restitution), np.asarray(data.restitution_error), found.flags
    title = f"Measured COR beside the model: chi-squared {found.chi_squared:.3g} for {len(data)} rebounds"
    band = f"Band: {bands.meaning(found.band, model.pair)}"
    return figure_of(
        "restitution",
        sizes,
        *values,
        lambda impact: curve(model, impact, errors),
        title,
        about,
        "Nothing is fitted",
        band,
    )


def curve(
    model: ImpactModel, impact: Mapping[str, Any], errors: Mapping[str, float]
) -> tuple[Any, Array, Array, Array]:
    """Predict some impacts: what the model says, their COR, and the ends of its band."""
    hit = model.solve(**impact)
    cor, band = np.asarray(hit.restitution), model.uncertainty(**impact, **errors).restitution
    low, high = (np.where(np.isfinite(end), end, cor) for end in (band.low, band.high))
    return hit, cor, low, high
