"""A panel for each run, one above the other."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dem_demo.kit.run import Run, Runs
from dem_demo.sieve.scene import Sieve

MM = 1e3


def panels(figure: Figure, runs: Runs[Sieve]) -> list[tuple[Axes, Run[Sieve]]]:
    """Make panels with the same axes, titled with the names of the runs."""
    grid = figure.subplots(len(runs), 1, sharex=True, sharey=True, squeeze=False)
    shown = list(zip(grid.flat, runs, strict=True))
    for axes, run in shown:
        axes.set_title(f"{'constant' if run.making.constant_cor else 'contactlaw,'} {run.name}")
    return shown
