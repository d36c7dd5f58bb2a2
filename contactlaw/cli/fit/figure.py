"""The figure of a fit: measured values of one quantity, and the fitted curves with their bands."""

from typing import Any

import numpy as np

from contactlaw.cli.fit.printed import values_in_words
from contactlaw.cli.parts.figure import AXES, Figure
from contactlaw.cli.parts.measured import Measured, figure_of
from contactlaw.fitting import Fit
from contactlaw.fitting.measurements import KINDS


def figure(found: Fit, about: str) -> Figure:
    """Figure of the quantity with the most values."""
    counts = {kind: rows.size for kind, rows in found.rows.items()}
    kind = max(counts, key=counts.__getitem__)
    data, rows, shift = found.data, found.rows[kind], KINDS[kind].shift
    normal, sliding = np.asarray(data.speed), np.asarray(data.sliding_speed if data.is_oblique else 0.0)
    sizes = {"speed": np.hypot(normal, sliding), "radius": found.radius, "thickness": found.thickness}
    if data.is_oblique:
        sizes["angle"] = np.degrees(np.arctan2(sliding, normal))

    def predicted(impact: dict[str, Any]) -> dict[str, Any]:
        angle = np.radians(impact.pop("angle", 0.0))
        speed = impact.pop("speed")
        along = {"sliding_speed": speed * np.sin(angle)} if data.is_oblique else {}
        hit, errors = found.curve(speed * np.cos(angle), **impact, **along)
        value = np.asarray(getattr(hit, kind)) + shift
        ends = {"low": value - errors[kind], "high": value + errors[kind]}
        return {"y": value, **ends, "flags": np.asarray(hit.flags)}

    error: Any = getattr(data, f"{kind}_error")
    measured = Measured(
        kind,
        {name: size[rows] for name, size in sizes.items()},
        np.asarray(getattr(data, kind))[rows] + shift,
        None if error is None else error[rows],
        found.flags[rows],
    )
    remarks = ["Band: one standard error of the fit"]
    if others := [f"{AXES[name].label} ({n} value{'s' * (n != 1)})" for name, n in counts.items() if name != kind]:
        remarks.append(f"Measured, but not drawn: {', '.join(others)}")
    title = ", ".join(values_in_words(found)).replace("+-", "±")
    return figure_of(measured, predicted, title[0].upper() + title[1:], about, *remarks)
