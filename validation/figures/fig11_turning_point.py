"""Fig. 11: error map of the turning-point form, the project's own closed form of the COR.

Within 0.6 % of the solver for lambda_Y up to 0.3 and v up to 10; exact on the half-space (bottom
edge). Up to the speed at which loading becomes linear, 4.2 V_Y0 and more, only the fits of two
one-dimensional functions err (0.05 %); beyond it, the equal loading work that the form assumes.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure

from contactlaw import laws, turning_point
from validation.figures import _style
from validation.paper import ETA, restitution


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw the relative error, with the axes of the paper's pair on the right."""
    figure = _style.figure(
        10.0,
        6.2,
        "The turning-point form: within 0.6 % everywhere",
        "relative error of the COR against the solver; any pair of materials (R/H on the right: "
        "gamma-alumina on glass)",
    )
    axes = figure.subplots()
    v, lam_y = np.linspace(0.05, 10.0, 100), np.linspace(0.0, 0.3, 61)
    myc = laws.law("myc")
    exact = np.array([[restitution(x, lam, myc) for x in v] for lam in lam_y])
    error = turning_point.restitution(v, lam_y[:, None]) / exact - 1.0
    levels = np.arange(-0.6, 0.61, 0.1)
    filled = axes.contourf(v, lam_y, 100 * error, levels=levels, cmap="PuOr", extend="both")
    figure.colorbar(filled, ax=axes, label="error of the COR  [%]", pad=0.12)
    axes.axhline(ETA * 1.8**2, color=_style.INK, linestyle=":", linewidth=1.2)
    other = axes.secondary_yaxis(
        "right",
        functions=(
            lambda lam: np.sqrt(np.maximum(lam, 0.0) / ETA),
            lambda ratio: ETA * np.square(ratio),
        ),
    )
    other.set_ylabel("R / H")
    other.set_yticks([0.5, 1.0, 1.4, 1.8])
    axes.set(xlabel="impact speed  V$_0$ / V$_{Y0}$", ylabel=r"inelasticity at yield  $\lambda_Y$")
    axes.grid(visible=False)
    slow = v <= 3.0
    return figure, {
        "largest error": float(np.abs(error).max()),
        "root mean square error": math.sqrt(float((error**2).mean())),
        "largest error up to 3 V_Y0": float(np.abs(error[:, slow]).max()),
    }
