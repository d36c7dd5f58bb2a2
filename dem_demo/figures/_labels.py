"""What the figures of a run have in common: words for the run, a column for each plate."""

from __future__ import annotations

from matplotlib.axes import Axes

from dem_demo.reader import Run
from dem_demo.recorder import CONSTANT


def source(run: Run) -> str:
    """Say in a few words what ran."""
    scene = run.scene
    law = f"COR {run.constant_cor:g} everywhere" if run.law == CONSTANT else "contactlaw"
    return f"{scene.sphere_material.name} on {scene.plate_material.name}, {run.engine}, {law}"


def thickness_axis(axes: Axes, labels: list[str]) -> None:
    """Give every plate a column, with its thickness below."""
    axes.set_xticks(range(len(labels)), labels)
    axes.set_xlim(-0.55, len(labels) - 0.45)
    axes.set_xlabel("plate thickness")
    axes.grid(visible=False, axis="x")
