"""What the walls bear over time: the force of the beads on them, and what drives the walls."""

from __future__ import annotations

from matplotlib.figure import Figure

from contactlaw import style
from dem_demo.kit.drawing import source
from dem_demo.kit.run import B, Runs
from dem_demo.kit.scene import GRAVITY


def draw(runs: Runs[B]) -> Figure:
    """Draw force and drive of all walls, under the law and with a constant COR."""
    scene, frame = runs[0].scene, 1e3 / runs[0].scene.FRAME_RATE
    force = "force", "weights", 2, -1.0 / (GRAVITY * scene.mass.sum())
    most = (force[3] * runs[0].borne[:, :, 2].sum(axis=1)).max()
    title = f"Landing beads press on the {scene.WALL} with up to {most:.1f} times their weight"
    figure = style.figure(style.COLUMN, 6.6, title, f"{source(runs)}; all walls, means over {frame:g} ms")
    panels = figure.subplots(2, 1, sharex=True)
    for axes, (name, unit, column, factor) in zip(panels, (force, scene.DRIVE), strict=True):
        for run, line, colour in zip(runs, ("-", "--"), (style.BLUE, style.VERMILION), strict=False):
            borne = factor * run.borne[1:, :, column].sum(axis=1)
            axes.plot(1e3 * run.time[1:] - 0.5 * frame, borne, line, color=colour, label=run.name)
        axes.set(ylabel=f"{name} [{unit}]", xlim=(0.0, 1e3 * run.time[-1]))
    panels[0].axhline(1.0, color=style.INK, linestyle=":", label="weight of the beads")
    panels[0].set_ylim(bottom=0.0)
    panels[1].set_xlabel("time [ms]")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure
