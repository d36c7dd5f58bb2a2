"""index.html: the results of a rain on one page, which needs no other file and no network.

``page.html`` and ``player.js``, the animation, which draws with ``drawing.js`` of
`contactlaw.export`, stand in the frame of `contactlaw.reporting.page`.
"""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Mapping

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_hex
from numpy.typing import NDArray

from contactlaw.reporting import page as common
from contactlaw.reporting import run as of_any_run
from contactlaw.reporting import summary as tables
from contactlaw.reporting.limits import exceeded, label
from dem_demo.rain import figures, paths
from dem_demo.rain.figures import _rain
from dem_demo.rain.measure import near_edge, one_for_all, restitution_range
from dem_demo.rain.record import Run
from dem_demo.rain.report import title

_LEDE = (
    "How a bead rebounds from a plate depends on the plate's thickness, on the bead and on its "
    "speed. Particle simulations mostly take one number for all of it, the coefficient of "
    "restitution (COR): rebound speed over impact speed. Here every collision has its own COR."
)
_SAMPLES = 96  # points of the force curve of a contact
_FIELDS = ("start", "end", "x", "y", "u", "v", "fall", "restitution", "other_v", "outside")


def page(run: Run, pictures: Mapping[str, bytes], film: bytes) -> str:
    """Write the page of a run, as HTML; the film is for slides, and not on it."""
    known = of_any_run.Run(run.record)
    return common.template(__package__, "page.html").render(
        title="Beads rain on plates: what contactlaw gives a particle simulation",
        heading="Beads rain on plates",
        lede=_LEDE,
        facts=title(run),
        data=json.dumps(_data(run), separators=(",", ":"), allow_nan=False),
        sample=_sample(run),
        cor=f"{one_for_all(run):.2f}" if run.on_plates.size else "",
        turning=f"{_rain.TURNING:g}" if run.scene.friction else "",
        impacts=tables.impacts(known),
        constant=tables.CONSTANT,
        energies=tables.energies(known),
        energy=tables.ENERGY,
        limits=exceeded(run.on_plates["flags"]),
        figures=common.shown(figures.module, pictures),
        command=run.record.made["command"],
        law=run.law,
        source=run.model.force_law.source,
        made=run.made,
    )


def _sample(run: Run) -> str:
    every, shown = run.scene.beads.radius.size, paths.drawn(run).size
    return f" {shown} of the {every} beads are shown." if shown < every else ""


def _data(run: Run) -> dict[str, object]:
    """Collect what the player draws, in metres and seconds."""
    made = paths.pieces(run)
    fields = [*_FIELDS, *(("angle", "spin") if run.scene.friction else ())]
    columns = [run.scene.beads.radius[made["bead"]], *(made[name] for name in fields)]
    low, high = restitution_range(run)
    map_ = colormaps["viridis"]
    return {
        "fields": ["radius", *fields],
        "pieces": base64.b64encode(np.column_stack(columns).astype("<f4").tobytes()).decode(),
        "window": _rain.window(run.scene),
        "duration": float(run.time[-1]) if run.time.size else 0.0,
        "magnified": _rain.magnified(run),
        "exposure": _rain.EXPOSURE,
        "turning": _rain.TURNING,
        "hand": _rain.HAND,
        "plates": [
            {
                "x0": plate.x0,
                "x1": plate.x1,
                "y": plate.y,
                "depth": _rain.drawn_depth(plate.thickness),
                "label": label(plate.thickness),
            }
            for plate in run.scene.plates
        ],
        "range": [low, high],
        "colours": [to_hex(map_(x)) for x in np.linspace(0.0, 1.0, 33)],
        "hits": [hit for n in range(len(run.scene.plates)) if (hit := _hardest(run, n))],
    }


def _hardest(run: Run, plate: int) -> dict[str, object] | None:
    """Describe the hardest contact on a plate, and how its bending wave spreads."""
    rows = run.on_plates
    # The page says that no wave comes back during the contact, so it is one far from edges.
    here = np.flatnonzero((rows["plate"] == plate) & ~near_edge(run))
    if not here.size:
        return None
    n = here[np.argmax(rows["peak_force"][here])]
    row, thickness = rows[n], run.scene.plates[plate].thickness
    radius, speed = float(run.scene.beads.radius[row["bead"]]), float(row["approach_speed"])
    contact = run.model.force_history(speed, radius, thickness, samples=_SAMPLES)
    material = run.scene.plate_material
    # Kirchhoff's plate: waves spread by sqrt(D/(rho H)), D/(rho H) = E H^2/(12 rho (1 - nu^2)).
    stiffness = material.youngs_modulus / (12.0 * material.density)
    spread = math.sqrt(stiffness / (1.0 - material.poissons_ratio**2)) * min(thickness, 1.0)
    return {
        "label": label(thickness),
        "thickness": min(thickness, 1.0),
        "speed": speed,
        "radius": radius,
        "duration": float(contact.time[-1]),
        "force": _rounded(contact.force),
        "compression": _rounded(contact.compression),
        "displacement": _rounded(contact.plate_displacement),
        "spread": spread,
        "model": float(row["restitution"]),
        "constant": one_for_all(run),
    }


def _rounded(values: NDArray[np.float64]) -> list[float]:
    return [float(f"{value:.4g}") for value in values]
