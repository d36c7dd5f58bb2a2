"""The numbers of a run in words: two tables, for the text and the page."""

import textwrap

import numpy as np

from contactlaw._readable import relative, rounded, scale_of
from contactlaw.reporting.limits import exceeded
from contactlaw.reporting.run import CAUSES, Run, WallRow, by_cause
from contactlaw.spectrum import EDGES

Table = list[tuple[str, ...]]

ENERGY = (
    "This is the energy that the walls took from the beads, by where it went: into bending waves of the wall, "
    "into losses at the contact (plastic), into micro-slip and vibration (other), and into friction. All "
    "contacts count, also those that are no free impacts."
)
CONSTANT = (
    "Nine in ten impacts have a COR in the range of that column. "
    "If each of these impacts had the constant COR, the walls would take the same energy in all, and for "
    "95 % of the beads the rebound height would be wrong by less than the last column. Another COR causes "
    "other impacts: where beads bounce again and again, simulate with the constant, and take the constant "
    "of that run."
)
WAVES = (
    "This is the mean power that bending waves carry into each wall, from the first contact to the last, with the "
    "third octave that has the most of it, and the frequencies that nine tenths of it lie between. The last column "
    "is the share of the waves' energy that is not in the power, because the force is not known: that of contacts "
    "that are no free impacts, or that are next to an edge or on a curved wall."
)
NO_WAVES = "The power that bending waves carry into the walls is not known by frequency: "
OUTSIDE = "These impacts are outside a limit of the model; their numbers deserve less trust."
INSIDE = "No impact on a wall is flagged as outside a limit of the model."
UNCHECKED = "Shared plates are not checked: the record lacks materials."
_WIDTH = 80  # of the text


def counts(run: Run) -> str:
    """Say in one line how many impacts there are, on how many walls, and of what."""
    walls, count = len(np.unique(run.rows[["plate", "thickness"]])), run.impacts.size
    beads = float(count)
    if "parcel" in (run.impacts.dtype.names or ()):
        beads = float((np.maximum(run.impacts["parcel"], 1.0) ** 3).sum())
    stand = f", which stand for {beads:.6g} of single beads" if beads != count else ""
    return f"{count} impact{'s' * (count != 1)} on {walls} wall{'s' * (walls != 1)}{stand}, {run.subject}"


def text(run: Run) -> str:
    """Write the summary for a text file."""
    outside = exceeded(run.impacts["flags"])
    lines = [*_wrapped(counts(run)), *_wrapped(run.left_out), ""]
    lines += [*_columns(impacts(run)), "", *_wrapped(CONSTANT), ""]
    lines += [*_columns(energies(run)), "", *_wrapped(ENERGY), ""]
    table = waves(run)
    lines += [*_columns(table), "", *_wrapped(WAVES)] if table else _wrapped(NO_WAVES + run.waves[1])
    lines += ["", *[UNCHECKED] * (not run.record.bodies), OUTSIDE if outside else INSIDE]
    return "\n".join(lines + [line for one in outside.items() for line in _wrapped("  {}: {}".format(*one))])


def _wrapped(paragraph: str) -> list[str]:
    return textwrap.wrap(paragraph, _WIDTH, subsequent_indent="  " * paragraph.startswith(" "))


def _columns(table: Table) -> list[str]:
    """Lines of a table whose heads have a line for each word."""
    words = [name.split() for name in table[0]]
    deep = max(map(len, words))
    rows = [*zip(*([""] * (deep - len(one)) + one for one in words), strict=True), *table[1:]]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]).rstrip() for row in rows]


def impacts(run: Run) -> Table:
    """Impacts, their speeds and CORs, and one constant for each wall."""
    head = ("wall", "impacts", "median speed [m/s]", "median COR", "nine in ten", "constant COR", "height error")
    return [head, *(_impacts(wall) for wall in run.walls)]


def _impacts(wall: WallRow) -> tuple[str, ...]:
    best, rows = wall.best, wall.impacts
    if best is None:
        return (wall.name, "0", *["-"] * 5)
    low, middle, high = np.quantile(rows["restitution"], [0.05, 0.5, 0.95])
    return (
        wall.name,
        f"{rows.size}",
        f"{np.median(rows['approach_speed']):.3g}",
        f"{middle:.3f}",
        f"{low:.2f}-{high:.2f}",
        f"{best.restitution:.4f}",
        relative(best.rebound_error),
    )


def energies(run: Run) -> Table:
    """Energy that each wall and each cause took, and the sums, in the unit that suits the whole."""
    whole = by_cause(run.rows).sum() or 1.0
    unit, scale = scale_of(whole, "J")
    table: Table = [("wall", *(f"{name} [{unit.replace('u', 'µ')}]" for name in (*CAUSES, "all")), "share")]
    for name, rows in (*((wall.name, wall.rows) for wall in run.walls), ("all walls", run.rows)):
        parts = by_cause(rows)
        sizes = (rounded(part / scale, 3) for part in (*parts, parts.sum()))
        table.append((name, *sizes, f"{parts.sum() / whole:z.1%}"))
    return table


def waves(run: Run) -> Table:
    """Power that bending waves carry into each wall, and its frequencies; no rows if it is not known."""
    spectrum, _ = run.waves
    if spectrum is None:
        return []
    table: Table = [("wall", "power [mW]", "most at [kHz]", "nine tenths [kHz]", "left out")]
    for n, wall in enumerate(run.walls):
        below = spectrum.power[n].cumsum()
        cells = "0", "-", "-"
        if below[-1] > 0.0:
            low, high = np.interp([0.05, 0.95], below[:-1] / below[-1], 1e-3 * EDGES[1:-1])
            most = 1e-3 * spectrum.frequency[spectrum.power[n].argmax()]
            cells = rounded(1e3 * below[-1], 3), f"{most:.3g}", f"{low:.3g}-{high:.3g}"
        table.append((wall.name, *cells, f"{spectrum.left_out[n]:.1%}"))
    return table
