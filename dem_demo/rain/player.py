"""What player.js and the page of a rain have beside other pages: flights, and hits in slow motion."""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_hex
from numpy.typing import NDArray

from contactlaw import edge_distance
from contactlaw.reporting.limits import label
from dem_demo.kit.drawing import restitution_range
from dem_demo.kit.run import Run, Runs
from dem_demo.rain import paths, picture
from dem_demo.rain.scene import Shower

_SAMPLES = 96  # points of the force curve of a contact
_FIELDS = ("start", "end", "x", "y", "u", "v", "fall", "restitution", "other_v", "outside")


def data(runs: Runs[Shower]) -> Mapping[str, Any]:
    """Collect what the template needs beside what all scenes have."""
    run = runs[0]
    every, shown = run.scene.radius.size, paths.drawn(run).size
    return {
        "data": json.dumps(_data(run), separators=(",", ":"), allow_nan=False),
        "sample": f" {shown} of the {every} beads are shown." if shown < every else "",
        "cor": f"{run.mean_cor:.2f}" if run.impacts.size else "",
        "turning": f"{picture.TURNING:g}" if run.scene.friction else "",
        "marked": " They are ringed in the animation and in the figures.",
    }


def _data(run: Run[Shower]) -> dict[str, object]:
    """Collect what the player draws, in metres and seconds."""
    made = paths.pieces(run)
    fields = [*_FIELDS, *(("angle", "spin") if run.scene.friction else ())]
    columns = [run.scene.radius[made["bead"]], *(made[name] for name in fields)]
    low, high = restitution_range(run)
    map_ = colormaps["viridis"]
    return {
        "fields": ["radius", *fields],
        "pieces": base64.b64encode(np.column_stack(columns).astype("<f4").tobytes()).decode(),
        "window": picture.window(run.scene),
        "duration": float(run.time[-1]),
        "magnified": picture.magnified(run),
        "exposure": picture.EXPOSURE,
        "turning": picture.TURNING,
        "hand": picture.HAND,
        "plates": [
            {"x0": left, "x1": right, "y": 0.0, "depth": picture.drawn_depth(thickness), "label": label(thickness)}
            for (left, right), thickness in zip(run.scene.ends.tolist(), run.scene.plates, strict=True)
        ],
        "range": [low, high],
        "colours": [to_hex(map_(x)) for x in np.linspace(0.0, 1.0, 33)],
        "hits": [hit for n in range(len(run.scene.plates)) if (hit := _hardest(run, n))],
    }


def _hardest(run: Run[Shower], plate: int) -> dict[str, object] | None:
    """Describe the hardest contact on a plate, and how its bending wave spreads."""
    thickness, material = run.scene.plates[plate], run.scene.plate_material
    rows = run.impacts[run.impacts["plate"] == plate]
    # The page says that no wave comes back during the contact, so it is one far from edges.
    if thickness < math.inf and rows.size:
        # The distance grows with the square root of contact time: one call serves all impacts.
        unit = edge_distance(material, thickness, 1.0)
        rows = rows[run.scene.from_edge(rows) >= unit * np.sqrt(rows["contact_time"])]
    if not rows.size:
        return None
    row = rows[np.argmax(rows["peak_force"])]
    radius, speed = float(row["radius"]), float(row["approach_speed"])
    contact = run.model.force_history(speed, radius, thickness, samples=_SAMPLES)
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
        "constant": run.mean_cor,
    }


def _rounded(values: NDArray[np.float64]) -> list[float]:
    return [float(f"{value:.4g}") for value in values]
