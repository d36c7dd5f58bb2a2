"""Where the energy of the beads came from and went, over time.

Upper line: energy at the start, plus what gravity and the moving walls have added since.
"""

from __future__ import annotations

from matplotlib.artist import Artist
from matplotlib.figure import Figure

from contactlaw import style
from dem_demo.kit.drawing import panels, source
from dem_demo.kit.run import B, Runs

_PARTS = (
    ("moving", "kinetic energy of the beads", style.PALE),
    ("wave", "bending wave in the plate", style.BLUE),
    ("plastic", "lost at the contact", style.ORANGE),
    ("vibration", "micro-slip and vibration at the contact", style.VERMILION),
    ("friction", "friction on the walls", style.SKY),
    ("others", "bead on bead", style.GREEN),
)


def draw(runs: Runs[B]) -> Figure:
    """Draw where the energy is over time, stacked, under the law and with a constant COR."""
    wall = runs[0].scene.WALL
    figure = style.figure(
        12.0,
        6.0,
        f"A moving {wall} feeds energy in, and impacts take it away",
        f"{source(runs)}; energies of all beads since the start",
    )
    handles: dict[str, Artist] = {}
    for axes, run in panels(figure, runs):
        found, time = run.account, run.time * 1e3
        used = [(getattr(found, field) * 1e3, *look) for field, *look in _PARTS if getattr(found, field).any()]
        parts, labels, colours = zip(*used, strict=True)
        axes.stackplot(time, parts, labels=labels, colors=colours, linewidth=0)
        without = (found.start + found.gravity) * 1e3
        axes.plot(time, without + found.walls * 1e3, color=style.INK, linewidth=2.0, label="total")
        label = f"without the work of the {wall}"
        axes.plot(time, without, color=style.INK, linewidth=1.5, linestyle=":", label=label)
        axes.set_xlim(0.0, time[-1])
        axes.set(xlabel="time [ms]", ylabel="energy [mJ]")
        axes.label_outer()
        handles |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    figure.legend(handles.values(), list(handles), loc="outside lower center", ncols=3)
    return figure
