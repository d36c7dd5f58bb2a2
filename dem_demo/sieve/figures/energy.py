"""Where the energy of the beads came from and went, over time.

Upper line: energy at the start, plus what gravity and the moving deck have added since.
"""

from __future__ import annotations

from matplotlib.artist import Artist
from matplotlib.figure import Figure

from contactlaw import style
from dem_demo.kit.run import Runs
from dem_demo.sieve.figures._panels import panels
from dem_demo.sieve.scene import Sieve

_LEAST = 2e-3  # [largest part], the least part that can be seen
_FIELDS = "moving", "wave", "plastic", "vibration", "friction", "others"  # of the account, as in `style.ENERGIES`


def draw(runs: Runs[Sieve]) -> Figure:
    """Draw where the energy is over time, stacked, under the law and with a constant COR."""
    figure = style.figure(
        style.COLUMN,
        8.6,
        "A moving deck feeds energy in, and impacts take it away",
        f"{runs[0].scene.subject}; energies of all beads since the start",
    )
    handles: dict[str, Artist] = {}
    for axes, run in panels(figure, runs):
        found, time = run.account, run.time * 1e3
        looks = zip(_FIELDS, style.ENERGIES.values(), strict=True)
        shown = [(1e3 * getattr(found, field), *look) for field, look in looks]
        least = _LEAST * max(part.max() for part, *_ in shown)
        parts, labels, colours = zip(*(one for one in shown if one[0].max() > least), strict=True)
        axes.stackplot(time, parts, labels=labels, colors=colours, linewidth=0)
        without = (found.start + found.gravity) * 1e3
        axes.plot(time, without + found.walls * 1e3, color=style.INK, linewidth=2.0, label="total")
        axes.plot(time, without, color=style.INK, linestyle=":", label="without the work of the deck")
        axes.set_xlim(0.0, time[-1])
        axes.set(xlabel="time [ms]", ylabel="energy [mJ]")
        axes.label_outer()
        handles |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    figure.legend(handles.values(), list(handles), loc="outside lower center", ncols=2)
    return figure
