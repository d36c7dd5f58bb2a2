"""The summary of a sieve: the law, and beside it a constant COR."""

from __future__ import annotations

import numpy as np

from dem_demo.measure import Limit, exceeded
from dem_demo.report import label, limits_lines
from dem_demo.sieve.measure import account, kept, near_edge, on_faces, passed
from dem_demo.sieve.record import Run, Runs

_WIDTH = 42


def summary(runs: Runs) -> str:
    """Write the summary.

    Parameters
    ----------
    runs : Runs
        As read from their files.

    Returns
    -------
    str
        Title, one line per number with a column for each run, and limits of the model that were
        exceeded under the law.
    """
    columns = [dict(facts(run)) for run in runs.every]
    lines = [*title(runs), ""]
    lines += [
        "".join([f"{name:{_WIDTH}}", *(f"{column[name]:>18}" for column in columns)])
        for name in columns[0]
    ]
    lines += ["", "Friction and bead on bead are the engine's own, not recorded impact by impact"]
    lines += limits_lines(limits(runs.law))
    if runs.reason:
        lines += ["", f"Partial, {progress(runs)}: {runs.reason}"]
    return "\n".join(lines)


def title(runs: Runs) -> tuple[str, str]:
    """Say in two lines what fell on what, and what computed it."""
    scene, deck = runs.law.scene, runs.law.scene.deck
    small, large = scene.radius.min() * 1e3, scene.radius.max() * 1e3
    return (
        f"{scene.radius.size} beads of {scene.sphere_material.name}, radius {small:g} and "
        f"{large:g} mm, on a deck of {label(scene.thickness)} {scene.plate_material.name}, "
        f"{deck.length * 1e3:.0f} x {deck.width * 1e3:.0f} mm, openings of {label(deck.opening)}, "
        f"{len(runs.law.triangles)} triangles",
        f"{scene.duration * scene.frequency:.3g} periods of {scene.frequency:g} Hz, amplitude "
        f"{label(scene.amplitude)}, friction {scene.friction:g}, in {runs.law.engine} on "
        f"{runs.law.ranks} {'rank' if runs.law.ranks == 1 else 'ranks'}, seed {scene.seed}",
    )


def facts(run: Run) -> list[tuple[str, str]]:
    """Name what was measured, and what it was."""
    rows, scene, flat = run.collisions, run.scene, on_faces(run)
    energy = account(run)
    deck = float(run.dissipated.sum())
    found = [("", run.name), ("impacts on the deck", f"{rows.size}")]
    if flat.any():
        low, middle, high = np.quantile(rows["restitution"][flat], [0.05, 0.5, 0.95])
        found += [
            ("  on its flat, not at a rim or a wall", f"{flat.sum()}"),
            ("  mean approach speed there", f"{rows['approach_speed'][flat].mean():.3f} m/s"),
            ("  median COR there", f"{middle:.3f}"),
            ("  COR of nine in ten of them", f"{low:.3f} - {high:.3f}"),
            ("  one COR that dissipates as much", f"{kept(run):.3f}"),
        ]
    above = run.position[-1, :, 2] > -scene.amplitude
    height = float(run.position[-1, above, 2].mean()) * 1e3 if above.any() else 0.0
    return [
        *found,
        ("dissipated at the deck", _millijoules(deck)),
        ("  bending wave in the sheet", _millijoules(energy.wave[-1])),
        ("  lost at the contact", _millijoules(energy.plastic[-1])),
        ("work of the deck on the beads", _millijoules(energy.deck[-1])),
        ("beads on beads, sliding friction", _millijoules(energy.others[-1])),
        ("kinetic energy at the start", _millijoules(energy.start[-1])),
        ("kinetic energy at the end", _millijoules(energy.moving[-1])),
        ("mean height of beads on the deck", f"{height:.1f} mm"),
        ("undersize beads that have passed", f"{passed(run)[-1]:.1%}"),
        ("simulated", f"{run.time[-1] * 1e3:.0f} ms"),
        ("computed in", f"{run.elapsed[-1]:.0f} s"),
    ]


def _millijoules(energy: float) -> str:
    return f"{energy * 1e3:.1f} mJ"


def limits(run: Run) -> list[Limit]:
    """List the limits of the model that impacts exceed."""
    return exceeded(run.collisions["flags"], near_edge(run))


def progress(runs: Runs) -> str:
    """Say how far a partial sieve has come."""
    last = runs.every[-1]
    reached = last.time[-1] if last.time.size else 0.0
    return f"{reached:.4g} of {last.scene.duration:g} s under the {last.name}"
