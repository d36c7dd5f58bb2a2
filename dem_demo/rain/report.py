"""The summary that a run prints."""

from __future__ import annotations

from contactlaw.reporting import run as of_any_run
from contactlaw.reporting import summary as tables
from dem_demo.rain.measure import balance, bead_on_bead
from dem_demo.rain.record import Run


def summary(run: Run) -> str:
    """Write the summary of a run: title, beads on beads, and what happened on each plate."""
    lines = [*title(run), "", _bead_line(run)]
    lines += [_balance_line(run)] if run.scene.friction else []
    return "\n".join([*lines, "", tables.text(of_any_run.Run(run.record))])


def title(run: Run) -> tuple[str, str]:
    """Title in two lines: beads and plates; duration, engine, law and seed."""
    scene, radius = run.scene, run.scene.beads.radius * 1e3
    law = f"law {run.law}" + (f", friction {scene.friction:g}" if scene.friction else "")
    return (
        f"{radius.size} beads of {scene.sphere_material.name}, radius {radius.min():.2f} to "
        f"{radius.max():.2f} mm, on {scene.plate_material.name}",
        f"{scene.duration:g} s in pymunk, {law}, seed {scene.seed}",
    )


def _bead_line(run: Run) -> str:
    rows = bead_on_bead(run)
    if not rows.size:
        return "Bead on bead: no impacts"
    speed, cor = rows["approach_speed"], rows["restitution"]
    return (
        f"Bead on bead: {rows.size} impacts, {speed.mean():.2f} m/s on average, COR {cor.min():.3f} - {cor.max():.3f}"
    )


def _balance_line(run: Run) -> str:
    """Say where the energy of all beads went, translation and rotation."""
    found = balance(run)
    if not found.given:
        return "Energy of all beads: none has been thrown yet"
    names = "moving", "spinning", "wave", "plastic", "other", "friction"
    parts = [f"{name} {getattr(found, name) / found.given:z.1%}" for name in names]
    parts += [f"bead on bead {found.beads / found.given:z.1%}"]
    parts += [f"unaccounted {found.rest / found.given:z.2%}"]
    given = f"Energy of all beads, by throw and fall: {found.given * 1e3:.3g} mJ, of which"
    return f"{given}\n  {', '.join(parts)}"
