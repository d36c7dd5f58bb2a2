"""The figure of a fit: measured values of one quantity, and the fitted curves with their bands."""

from typing import Any

import numpy as np

from contactlaw._arrays import Array
from contactlaw.cli.fit.printed import impacts_of, values_in_words
from contactlaw.cli.parts.figure import Figure
from contactlaw.cli.parts.measured import figure_of
from contactlaw.fitting import Fit
from contactlaw.fitting.measurements import KINDS


def figure(found: Fit, about: str) -> Figure:
    """Figure of the quantity with the most values."""
    kind = max(found.rows, key=lambda name: found.rows[name].size)
    rows, shift = found.rows[kind], KINDS[kind].shift

    def predicted(impact: dict[str, Any]) -> tuple[Any, Array, Array, Array]:
        speed, angle = impact["speed"], np.radians(impact.get("angle", 0.0))
        along = {"sliding_speed": speed * np.sin(angle)} if "angle" in impact else {}
        hit, errors = found.curve(speed * np.cos(angle), impact["radius"], impact["thickness"], **along)
        value = np.asarray(getattr(hit, kind)) + shift
        return hit, value, value - errors[kind], value + errors[kind]

    sizes = {name: size[rows] for name, size in impacts_of(found).items()}
    error: Any = getattr(found.data, f"{kind}_error")
    values = np.asarray(getattr(found.data, kind))[rows] + shift, None if error is None else error[rows]
    title = f"Fit: {', '.join(values_in_words(found))}".replace("+-", "±")
    return figure_of(
        kind, sizes, *values, found.flags[rows], predicted, title, about, "Band: one standard error of the fit"
    )
