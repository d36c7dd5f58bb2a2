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
from dem_demo.kit.run import Run, Runs
from dem_demo.rain import paths
from dem_demo.rain.scene import Shower

# Beads are drawn this many times as large, to be visible, and with friction to show that they turn.
_MAGNIFIED, _TURNING_MAGNIFIED = 3.0, 5.0
_PLATES_MAGNIFIED = 4.0  # plates are drawn this many times as thick, to look different
_TURNING = 20.0  # spins, of a thousand turns a second, are drawn this many times slower than paths
_HAND = 1.6  # [drawn radius], length of the hand that turns with a bead
_EXPOSURE = 2e-3  # [s]; a streak is the path of a bead in this time
_HALF_SPACE = 3e-3  # [m], drawn depth of a plate of infinite thickness
_SIDES, _BELOW = 0.01, 0.016  # [m] beside and below the plates
_ABOVE = 1.08  # top of the picture over the height of the nozzles
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
        "turning": f"{_TURNING:g}" if run.scene.friction else "",
        "marked": " They are ringed in the animation, and faint in the figure of the COR.",
    }


def _data(run: Run[Shower]) -> dict[str, object]:
    """Collect what the player draws, in metres and seconds."""
    made = paths.pieces(run)
    fields = [*_FIELDS, *(("angle", "spin") if run.scene.friction else ())]
    columns = [run.scene.radius[made["bead"]], *(made[name] for name in fields)]
    # From the 2 % quantile of the COR, at most 0.9, to 1.
    low = max(0.0, min(0.9, float(np.quantile(run.impacts["restitution"], 0.02)))) if run.impacts.size else 0.9
    depth = [_PLATES_MAGNIFIED * min(thickness, _HALF_SPACE) for thickness in run.scene.plates]
    bottom = min(run.scene.floor, -max(depth) - _BELOW)
    top = _ABOVE * float(run.scene.position[:, 1].max())
    map_ = colormaps["viridis"]
    return {
        "fields": ["radius", *fields],
        "pieces": base64.b64encode(np.column_stack(columns).astype("<f4").tobytes()).decode(),
        "window": (-_SIDES, float(run.scene.ends.max()) + _SIDES, bottom, top),
        "duration": float(run.time[-1]),
        "magnified": _TURNING_MAGNIFIED if run.scene.friction else _MAGNIFIED,
        "exposure": _EXPOSURE,
        "turning": _TURNING,
        "hand": _HAND,
        "plates": [
            {"x0": left, "x1": right, "y": 0.0, "depth": deep, "label": label(thickness)}
            for (left, right), deep, thickness in zip(run.scene.ends.tolist(), depth, run.scene.plates, strict=True)
        ],
        "range": [low, 1.0],
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
