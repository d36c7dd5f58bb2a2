"""Facts and texts of the drum for its summary and its page."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlaw.reporting.limits import label
from dem_demo.drum import figures
from dem_demo.drum.scene import Drum
from dem_demo.kit.beads import Floats
from dem_demo.kit.runs import Run
from dem_demo.kit.tale import Facts, Tale

_SEAM = 1.05  # [bead's radius]; nearer to a seam, a bead touches shell and end at once


def on_faces(run: Run[Drum]) -> NDArray[np.bool_]:
    """Mask of impacts in which a bead touched one wall, not a seam of shell and end.

    At a seam both walls contribute to the rebound, and neither contact has a COR of its own.
    """
    return np.asarray(_away(run) > _SEAM * run.scene.radius[run.collisions["bead"]])


def _away(run: Run[Drum]) -> Floats:
    """Distance of each impact from the nearest seam [m]."""
    rows, scene = run.collisions, run.scene
    on_shell = np.minimum(rows["y"], scene.length - rows["y"])
    on_end = scene.drum - np.hypot(rows["x"], rows["z"])
    return np.asarray(np.where(rows["plate"] == 0, on_shell, on_end))


def _title(run: Run[Drum]) -> tuple[str, str]:
    scene, radius = run.scene, run.scene.radius * 1e3
    return (
        f"{radius.size} beads of {scene.sphere_material.name}, radius {radius.min():.2f} to "
        f"{radius.max():.2f} mm, in a drum of {label(scene.thickness)} "
        f"{scene.plate_material.name}, {2e3 * scene.drum:g} mm wide and {1e3 * scene.length:g} mm "
        "long",
        f"{scene.duration * scene.turns:.3g} revolutions at {scene.turns:g} per second",
    )


def _facts(run: Run[Drum]) -> Facts:
    rows, lost = run.collisions, run.dissipated
    shell = float(lost[rows["plate"] == 0].sum() / lost.sum()) if lost.sum() else 0.0
    height = 1e3 * (run.scene.drum + run.position[..., 2].astype(float).mean(axis=1))
    return [
        ("share of the shell in what is dissipated", f"{shell:.0%}"),
        ("mean height of the beads at the end", f"{height[-1]:.1f} mm"),
    ]


TALE = Tale(
    wall="drum",
    flat=("on one wall, not at a seam", on_faces),
    own=_facts,
    title=_title,
    figures=figures,
    page={
        "heading": "Beads in a turning drum",
        "lede": "Shell and ends of the drum are sheet metal. Under the law the rebound of each "
        "impact follows from speed, bead and plate, as does where its energy goes. For comparison, "
        "the same beads with one coefficient of restitution (COR) for all impacts.",
        "alt": "The drum, seen along its axis",
        "others": "",
    },
)
