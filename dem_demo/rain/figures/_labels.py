"""Helpers for the figures of a run: subtitle, a column per plate, rings around impacts."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from numpy.typing import NDArray

from contactlaw import style
from dem_demo.kit.beads import Floats
from dem_demo.rain.record import Run


def source(run: Run) -> str:
    """Subtitle: materials, engine and law."""
    scene = run.scene
    law = f"law {run.law}" + (f", friction {scene.friction:g}" if scene.friction else "")
    return f"{scene.sphere_material.name} on {scene.plate_material.name}, pymunk, {law}"


def ring(axes: Axes, x: Floats, y: Floats, far: NDArray[np.bool_]) -> None:
    """Mark the points of impacts that are outside a limit of the model."""
    axes.scatter(x[far], y[far], s=46, facecolors="none", edgecolors=style.VERMILION, linewidths=1.1)


def ringed(far: NDArray[np.bool_]) -> str:
    """Legend of the rings; empty if there are none."""
    return "; ringed: outside a limit of the model" if far.any() else ""


def radius_colours(run: Run) -> ScalarMappable:
    """Colours of beads by their radius in mm."""
    radius = run.scene.beads.radius * 1e3
    top = max(radius.max(), radius.min() + 1e-6)
    return ScalarMappable(Normalize(radius.min(), top), "cividis")
