"""Where the deck takes energy from the beads: where it wears, rings and warms.

Colours show the energy per area that impacts dissipate, in bending waves and at the contact,
without sliding friction, averaged over a neighbourhood.
"""

from __future__ import annotations

from matplotlib.figure import Figure

from contactlaw import style
from contactlaw.reporting.charts import density_bar, density_scale, sheet
from contactlaw.reporting.surface import EnergyMap, energy_map
from dem_demo.kit.drawing import MM, panels, source
from dem_demo.kit.run import Run, Runs
from dem_demo.sieve.scene import Sieve


def draw(runs: Runs[Sieve]) -> Figure:
    """Draw the deck seen from above, under the law and with a constant COR."""
    maps = [_map(run) for run in runs]
    scale = density_scale([found.density for found in maps])
    figure = style.figure(
        style.COLUMN, 9.4, _title(maps, runs[1].name), f"{source(runs)}; dissipated in {runs[0].time[-1] * 1e3:.0f} ms"
    )
    shown = panels(figure, runs)
    for (axes, run), found in zip(shown, maps, strict=True):
        deck = run.scene.deck
        drawn = sheet(axes, found.corners[:, :, :2] * MM, found.density, scale)
        axes.set(xlim=(0.0, deck.length * MM), ylim=(0.0, deck.width * MM), xlabel="x [mm]", ylabel="y [mm]")
        axes.label_outer()
    density_bar(figure, drawn, [axes for axes, _ in shown])
    return figure


def _map(run: Run[Sieve]) -> EnergyMap:
    assert run.record.surface is not None  # the adapter knows the mesh
    return energy_map(run.record.surface, run.dissipated)


def _title(maps: list[EnergyMap], other: str) -> str:
    law, constant = (float(found.energy.sum()) for found in maps)
    if not min(law, constant) > 0.0:
        return "Where the deck dissipates energy"
    if law > constant:
        return f"The deck dissipates {law / constant:.1f} times as much energy as with one {other}"
    return f"With one {other}, the deck dissipates {constant / law:.1f} times as much energy"
