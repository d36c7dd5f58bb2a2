"""Figures that the command line draws; matplotlib is loaded when one is asked for."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from contactlaw.physical.history import ForceHistory

_BLUE, _VERMILION, _MUTED = "#0072B2", "#D55E00", "#6E6E6E"  # Okabe and Ito 2008
_SETTINGS: dict[Any, Any] = {
    "font.size": 12,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#EBEBEB",
    "legend.frameon": False,
    "savefig.dpi": 150,
}


def save_history(contact: ForceHistory, title: str, path: str | os.PathLike[str]) -> None:
    """Draw one contact into a file: force over time, and over compression.

    Parameters
    ----------
    contact : ForceHistory
        Of one impact.
    title : str
        What it is.
    path : path-like
        PNG, SVG or PDF, by its suffix.

    Raises
    ------
    ImportError
        Without matplotlib; the message says how to install it.
    ValueError
        If the suffix names no format.
    """
    try:
        import matplotlib as mpl
        from matplotlib.figure import Figure
    except ImportError as error:
        raise ImportError("a plot needs matplotlib: pip install contactlaw[demo]") from error
    with mpl.rc_context(_SETTINGS):
        figure = Figure(figsize=(10.0, 4.6), layout="constrained")
        figure.suptitle(title, x=0.012, ha="left", fontsize=13, fontweight="bold")
        left, right = figure.subplots(1, 2, sharey=True)
        top = int(np.argmax(contact.force))
        parts = ((slice(top + 1), _BLUE, "loading"), (slice(top, None), _VERMILION, "unloading"))
        for part, colour, name in parts:
            left.plot(contact.time[part] * 1e6, contact.force[part], color=colour, linewidth=2.2)
            right.plot(
                contact.compression[part] * 1e6, contact.force[part], color=colour, linewidth=2.2,
                label=name,
            )  # fmt: skip
        left.set(xlabel="time since touch [µs]", ylabel="contact force [N]", ylim=(0.0, None))
        left.set_xlim(0.0, 1.02 * contact.time[-1] * 1e6)
        plate = left.twinx()
        plate.plot(
            contact.time * 1e6, contact.plate_displacement * 1e6, color=_MUTED, linestyle="--"
        )
        plate.set_ylabel("displacement of the plate [µm] (dashed)", color=_MUTED)
        plate.set_ylim(0.0, None)
        plate.grid(visible=False)
        plate.spines["right"].set_visible(True)
        right.set(xlabel="compression [µm]", xlim=(0.0, None))
        right.legend(loc="upper left")
        figure.savefig(path)
