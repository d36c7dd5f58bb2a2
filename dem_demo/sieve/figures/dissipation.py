"""Where the deck takes energy from the beads: where it wears, rings and warms.

Colours show the energy per area that impacts dissipate, in bending waves and at the contact,
without sliding friction, averaged over a neighbourhood.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw.reporting.charts import sheet
from contactlaw.reporting.surface import energy_map
from dem_demo.kit.run import Runs
from dem_demo.sieve.figures._panels import MM, panels
from dem_demo.sieve.scene import Sieve


def draw(runs: Runs[Sieve]) -> Figure:
    """Draw the deck seen from above, under the law and with a constant COR."""
    scene, lost = runs[0].scene, [float(run.dissipated.sum()) for run in runs]
    title = "Where the deck dissipates energy"
    if len(runs) > 1 and min(lost) > 0.0:
        title = f"The deck dissipates {lost[0] / lost[1]:.1f} times as much energy as with one {runs[1].name}"
    about = f"{scene.subject}; dissipated in {runs[0].time[-1] * 1e3:.0f} ms"
    figure = style.figure(style.COLUMN, 9.4, title, about)
    maps = [energy_map(run.record.surface, run.dissipated) for run in runs if run.record.surface]
    scale: Any = Normalize(0.0, max(float(np.quantile(found.density, 0.999)) for found in maps) or 1.0)
    shown = panels(figure, runs)
    for (axes, _), found in zip(shown, maps, strict=True):
        drawn = sheet(axes, found.corners[:, :, :2] * MM, found.density, scale)
        axes.set(xlim=(0.0, scene.deck.length * MM), ylim=(0.0, scene.deck.width * MM), xlabel="x [mm]")
        axes.set_ylabel("y [mm]")
        axes.label_outer()
    bar = figure.colorbar(drawn, ax=[axes for axes, _ in shown], location="bottom", fraction=0.03, pad=0.02, aspect=40)
    bar.set_label("energy dissipated per area [J/m²]")
    return figure
