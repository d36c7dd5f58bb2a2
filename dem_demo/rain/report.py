"""The summary that a run prints."""

from __future__ import annotations

import math

from contactlaw.reporting.limits import label, limits_lines
from dem_demo.rain.measure import PlateRow, balance, bead_on_bead, limits, plate_rows
from dem_demo.rain.record import Run

_HEAD = (
    "                         speed        COR                  energy of the impacts"
    "             {gap}outside\n"
    "   plate     impacts      mean       mean    range         kept    wave  plastic   other"
    "{name}   limits"
)
_FRICTION = "  friction"


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
    more = _FRICTION if run.scene.friction else ""
    lines = [*title(run), "", _HEAD.format(gap=" " * len(more), name=more)]
    lines += [_plate_line(row, len(more)) for row in plate_rows(run)]
    lines += ["", _bead_line(run)]
    lines += [_balance_line(run)] if run.scene.friction else []
    lines += limits_lines(limits(run))
    lines += [run.left_out] if run.left_out else []
    if run.reason:
        lines += ["", f"Partial, {progress(run)}: {run.reason}"]
    return "\n".join(lines)


def progress(run: Run) -> str:
    """Say how far a partial rain has come."""
    reached = max([*run.time[-1:].tolist(), *run.collisions["time"][-1:].tolist()], default=0.0)
    return f"{reached:.4g} of {run.scene.duration:g} s"


def title(run: Run) -> tuple[str, str]:
    """Title in two lines: beads and plates; duration, engine, law and seed."""
    scene, radius = run.scene, run.scene.beads.radius * 1e3
    law = f"law {run.law}"
    if run.baseline:
        law = f"COR {run.constant_cor:g} everywhere, limits by {law}"
    elif scene.friction:
        law = f"{law}, friction {scene.friction:g}"
    return (
        f"{radius.size} beads of {scene.sphere_material.name}, radius {radius.min():.2f} to "
        f"{radius.max():.2f} mm, on {scene.plate_material.name}",
        f"{scene.duration:g} s in {run.engine}, {law}, seed {scene.seed}",
    )


def _plate_line(row: PlateRow, width: int) -> str:
    head = f"{label(row.thickness):>10} {row.impacts:9d}"
    if not row.impacts:
        return head
    cor = f"{row.restitution:.3f}   {row.lowest:.3f} - {row.highest:.3f}"
    *shown, friction = row.shares
    shares = "".join("       -" if math.isnan(s) else f"{s:z8.1%}" for s in shown)
    shares += f"{friction:z{width}.1%}" if width else ""
    return f"{head} {row.speed:6.2f} m/s      {cor}  {shares} {row.outside:8d}"


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


def _balance_line(run: Run) -> str:
    """Say where the energy of all beads went, translation and rotation."""
    found = balance(run)
    if not found.given:
        return "Energy of all beads: none has been thrown yet"
    names = "moving", "spinning", "wave", "plastic", "other", "friction"
    parts = [f"{name} {getattr(found, name) / found.given:z.1%}" for name in names]
    rest, beads = found.rest / found.given, found.beads / found.given
    if run.bead_on_bead is None:
        parts += [f"bead on bead {beads:z.1%}", f"unaccounted {rest:z.2%}"]
    else:
        parts += [f"bead on bead and unaccounted {rest:z.1%}"]
    given = f"Energy of all beads, by throw and fall: {found.given * 1e3:.3g} mJ, of which"
    return f"{given}\n  {', '.join(parts)}"
