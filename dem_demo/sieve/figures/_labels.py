"""What the figures of a sieve have in common: words for the run, and one panel for each."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contactlaw import style
from dem_demo.report import label
from dem_demo.sieve.record import Run, Runs
from dem_demo.sieve.report import progress

MM = 1e3


def source(runs: Runs) -> str:
    """Say in a few words what ran."""
    scene = runs.law.scene
    part = f", partial: {progress(runs)}" if runs.reason else ""
    return (
        f"{scene.radius.size} beads of {scene.sphere_material.name} on "
        f"{scene.plate_material.name}, {label(scene.thickness)}{part}"
    )


def panels(figure: Figure, runs: Runs, *, stacked: bool = False) -> list[tuple[Axes, Run]]:
    """Make a panel for each run, with a common scale and its name."""
    n = len(runs.every)
    shape = (n, 1) if stacked else (style.pick(1, n), style.pick(n, 1))
    grid = figure.subplots(*shape, sharex=True, sharey=True, squeeze=False)
    found = list(zip(grid.flat, runs.every, strict=True))
    for axes, run in found:
        axes.set_title(name(run), fontweight="bold", loc="left")
    return found


def name(run: Run) -> str:
    """Name what ruled a run's impacts, for a title."""
    return f"contactlaw, {run.name}" if run.constant_cor is None else f"constant {run.name}"
