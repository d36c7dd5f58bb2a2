"""How fast the beads come, what is left of it, and at which angle.

The angle is that between the bead's path and the wall's normal: at 0° it comes straight on.
"""

import numpy as np
from matplotlib.figure import Figure

from contactlaw import style
from contactlaw._arrays import Array, Rows
from contactlaw.reporting.run import Run

_BINS = 12, 40  # fewest and most


def draw(run: Run) -> Figure:
    """Draw histograms of speed, COR and angle, with their medians."""
    rows, title = run.impacts, "No contact was an impact"
    if rows.size:
        low, high = np.quantile(rows["restitution"], [0.05, 0.95])
        title = f"Nine in ten impacts have a COR of {low:.2f} to {high:.2f}"
        title = f"The impacts have a COR of {low:.2f}" if high - low < 0.005 else title
    figure = style.figure(style.COLUMN, 8.0, title, f"{run.subject}; {rows.size} impact{'s' * (rows.size != 1)}")
    bins = int(np.clip(2.0 * rows.size**0.5, *_BINS)) + 1
    columns = {
        "normal speed of approach [m/s]": (rows["approach_speed"], 0.0, None),
        "coefficient of restitution": (rows["restitution"], None, 1.0),
        "angle of impact [°]": (angle(rows), 0.0, 90.0),
    }
    for axes, (label, (values, least, most)) in zip(figure.subplots(3, 1), columns.items(), strict=True):
        axes.set(xlabel=label, ylabel="impacts")
        if rows.size:
            low, high = np.quantile(values, [0.002, 0.998])
            edges = np.sort(np.linspace(low if least is None else least, most or high, bins))
            axes.hist(values.clip(edges[0], edges[-1]), list(edges), color=style.MUTED, edgecolor="white")
            axes.yaxis.get_major_locator().set_params(integer=True)
            middle = float(np.median(values))
            axes.axvline(middle, color=style.INK, linestyle="--", label=f"median {middle:.3g}")
            axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97))
    axes.set_xticks(range(0, 91, 15))
    return figure


def angle(rows: Rows) -> Array:
    """Angle of each impact from the wall's normal [degrees]."""
    return np.asarray(np.degrees(np.arctan2(rows["sliding_speed"], rows["approach_speed"])))
