"""Where the energy of the beads came from and went, over time.

Upper line: what they had at the start, what gravity and the deck have added since.
"""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from contactlaw import style
from dem_demo.sieve.figures._labels import panels, source
from dem_demo.sieve.measure import account
from dem_demo.sieve.record import Runs

_PARTS = (
    ("moving", "kinetic energy of the beads", style.PALE),
    ("wave", "bending wave in the sheet", style.BLUE),
    ("plastic", "lost at the contact", style.ORANGE),
    ("vibration", "micro-slip and vibration at the contact", style.VERMILION),
    ("others", "bead on bead, sliding friction", style.GREEN),
)


def draw(runs: Runs) -> Figure:
    """Draw stacked shares over time, under the law and with a constant COR."""
    figure = style.figure(
        12.0,
        style.pick(6.0, 8.4),
        "A vibrating deck feeds energy in, and the sheet takes it away",
        f"{source(runs)}; energies of all beads since the start",
    )
    shown = panels(figure, runs)
    for axes, run in shown:
        energy = account(run)
        parts = [getattr(energy, field) * 1e3 for field, _, _ in _PARTS]
        used = [n for n, part in enumerate(parts) if np.abs(part).max(initial=0.0) > 0.0]
        axes.stackplot(
            run.time * 1e3, [parts[n] for n in used], labels=[_PARTS[n][1] for n in used],
            colors=[_PARTS[n][2] for n in used], linewidth=0,
        )  # fmt: skip
        whole = (energy.start + energy.gravity + energy.deck) * 1e3
        axes.plot(run.time * 1e3, whole, color=style.INK, linewidth=2.0, label="all of it")
        without = (energy.start + energy.gravity) * 1e3
        axes.plot(
            run.time * 1e3, without, color=style.INK, linewidth=1.5, linestyle=":",
            label="without the work of the deck",
        )  # fmt: skip
        axes.set_xlim(0.0, run.time[-1] * 1e3 or 1.0)
        axes.set(xlabel="time [ms]", ylabel="energy [mJ]")
        axes.label_outer()
    handles: dict[str, Artist] = {}
    for axes, _ in shown:
        handles |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    figure.legend(
        handles.values(), list(handles), loc="outside lower center", ncols=style.pick(3, 1)
    )
    return figure
