"""What the figures of scenes share: subtitles, a panel for each run, the scale of the colours."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dem_demo.kit.run import B, Run, Runs, S

MM = 1e3


def source(runs: Runs[S]) -> str:
    """Subtitle: beads and walls."""
    scene = runs[0].scene
    return f"{scene.radius.size} beads of {scene.sphere_material.name} on {scene.sheet}"


def panels(
    figure: Figure, runs: Runs[B], *, stacked: bool = False, projection: str | None = None
) -> list[tuple[Axes, Run[B]]]:
    """Make a panel for each run, titled with the name of the run; all have the same scale."""
    shape = (len(runs), 1) if stacked else (1, len(runs))
    kind = {"projection": projection}
    grid = figure.subplots(*shape, sharex=True, sharey=True, squeeze=False, subplot_kw=kind)
    found = list(zip(grid.flat, runs, strict=True))
    for axes, run in found:
        kind_of_run = "contactlaw," if run.making.constant_cor is None else "constant"
        axes.set_title(f"{kind_of_run} {run.name}")
    return found


def restitution_range(run: Run[Any]) -> tuple[float, float]:
    """Range of the colour scale: from the 2 % quantile of the COR, at most 0.9, to 1."""
    found = run.impacts["restitution"]
    low = float(np.quantile(found, 0.02)) if found.size else 0.9
    return max(0.0, min(low, 0.9)), 1.0
