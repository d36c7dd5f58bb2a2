"""The summary that a run prints."""

from __future__ import annotations

import math

from dem_demo.measure import PlateRow, bead_on_bead, flag_counts, plate_rows
from dem_demo.reader import Run
from dem_demo.recorder import CONSTANT

_HEAD = (
    "                         speed        COR                  energy of the impacts\n"
    "   plate     impacts      mean       mean    range         kept    wave  plastic"
)


def summary(run: Run) -> str:
    """Write the summary of a run.

    Parameters
    ----------
    run : Run
        The run, as read from its file.

    Returns
    -------
    str
        Title, one line per plate, beads on beads, and limits of the model that were exceeded.
        Speeds are normal speeds [m/s]; energy shares are weighted by energy.
    """
    lines = [_title(run), "", _HEAD]
    lines += [_plate_line(row) for row in plate_rows(run)]
    lines += ["", _bead_line(run), _limits_line(run)]
    return "\n".join(lines)


def label(thickness: float) -> str:
    """Name a plate by its thickness [m].

    Examples
    --------
    >>> label(0.5e-3), label(float("inf"))
    ('0.5 mm', 'half-space')
    """
    return "half-space" if thickness == math.inf else f"{thickness * 1e3:.4g} mm"


def _title(run: Run) -> str:
    scene, radius = run.scene, run.scene.beads.radius * 1e3
    law = f"COR {run.constant_cor:g} everywhere" if run.law == CONSTANT else f"law {run.law}"
    return (
        f"{radius.size} beads of {scene.sphere_material.name}, radius {radius.min():.2f} to "
        f"{radius.max():.2f} mm, on {scene.plate_material.name}\n"
        f"{scene.duration:g} s in {run.engine}, {law}, seed {scene.seed}"
    )


def _plate_line(row: PlateRow) -> str:
    head = f"{label(row.thickness):>10} {row.impacts:9d}"
    if not row.impacts:
        return head
    cor = f"{row.restitution:.3f}   {row.lowest:.3f} - {row.highest:.3f}"
    shares = "".join(
        "       -" if math.isnan(share) else f"{share:8.1%}"
        for share in (row.kept, row.wave, row.plastic)
    )
    return f"{head} {row.speed:6.2f} m/s      {cor}  {shares}"


def _bead_line(run: Run) -> str:
    if run.bead_on_bead is not None:
        return f"Bead on bead: {run.bead_on_bead}"
    rows = bead_on_bead(run)
    if not rows.size:
        return "Bead on bead: no impacts"
    speed, cor = rows["approach_speed"], rows["restitution"]
    return (
        f"Bead on bead: {rows.size} impacts, {speed.mean():.2f} m/s on average, "
        f"COR {cor.min():.3f} - {cor.max():.3f}"
    )


def _limits_line(run: Run) -> str:
    counts = flag_counts(run)
    if not counts:
        return "Limits of the model: all impacts on plates are inside"
    found = ", ".join(f"{number} {name}" for name, number in counts.items())
    return f"Limits of the model: impacts outside: {found} (see contactlaw.Validity)"
