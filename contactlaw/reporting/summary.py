"""The numbers of a run in words: two tables, for the text and the page."""

import numpy as np

from contactlaw._readable import relative, rounded, scale_of
from contactlaw.reporting.limits import exceeded, limits_lines
from contactlaw.reporting.run import CAUSES, Run, WallRow, by_cause

Table = list[tuple[str, ...]]

ENERGY = (
    "Energy that contacts took from the beads, by where it went: into bending waves of the wall, "
    "lost at the contact, into micro-slip and vibration (other), to friction. All contacts count."
)
CONSTANT = (
    "The constant is the one COR with which these impacts take the same energy in all. With it, "
    "95 of 100 beads rebound to a height within the next column of their own; with the plain mean "
    "of the CORs the wall takes too much or too little energy by the last one. Another COR causes "
    "other impacts: where beads bounce again and again, repeat with its record."
)


def counts(run: Run) -> str:
    """Say in one line how many impacts there are, on how many walls, and of what."""
    walls, count = len(np.unique(run.rows[["plate", "thickness"]])), run.impacts.size
    names, beads = run.impacts.dtype.names or (), float(count)
    if "parcel" in names:
        beads = float((np.maximum(run.impacts["parcel"], 1.0) ** 3).sum())
    stand = f", which stand for {beads:.6g} of true beads" if beads != count else ""
    return f"{count} impact{'s' * (count != 1)} on {walls} wall{'s' * (walls != 1)}{stand}, {run.subject}"


def text(run: Run) -> str:
    """Write the summary for a text file."""
    lines = [counts(run), *([run.left_out] if run.left_out else [])]
    for table, note in ((impacts(run), CONSTANT), (energies(run), ENERGY)):
        widths = [max(map(len, column)) for column in zip(*table, strict=True)]
        lines += ["", *("  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in table)]
        lines += ["", note]
    return "\n".join([*lines, "", *limits_lines(exceeded(run.impacts["flags"]))])


def impacts(run: Run) -> Table:
    """Impacts, their speeds and CORs, and one constant for each wall."""
    head = ("wall", "impacts", "speed", "COR", "nine in ten", "constant", "rebound", "mean: energy")
    return [head, *(_impacts(wall) for wall in run.walls)]


def _impacts(wall: WallRow) -> tuple[str, ...]:
    best, rows = wall.best, wall.impacts
    if best is None:
        return (wall.name, "0", *["-"] * 6)
    low, middle, high = np.quantile(rows["restitution"], [0.05, 0.5, 0.95])
    return (
        wall.name,
        f"{rows.size}",
        f"{np.median(rows['approach_speed']):.3g} m/s",
        f"{middle:.3f}",
        f"{low:.3f}-{high:.3f}",
        f"{best.restitution:.4f}",
        relative(best.rebound_error),
        relative(best.mean_energy_error, "+z.1%"),
    )


def energies(run: Run) -> Table:
    """Energy that each wall and each cause took, and the sums, in the unit that suits the whole."""
    found: Table = [("wall", "contacts", *CAUSES, "in all", "share")]
    whole = by_cause(run.rows).sum() or 1.0
    unit, scale = scale_of(whole, "J")
    for name, rows in (*((wall.name, wall.rows) for wall in run.walls), ("all walls", run.rows)):
        parts = by_cause(rows)
        sizes = (rounded(part / scale, 3) for part in (*parts, parts.sum()))
        shown = (f"{size} {unit.replace('u', 'µ')}" for size in sizes)
        found.append((name, f"{rows.size}", *shown, f"{parts.sum() / whole:z.1%}"))
    return found
