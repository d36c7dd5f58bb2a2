"""sieve.gif: the bed under the law, and with a constant COR, in slow motion, for slides."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from contactlaw import style
from dem_demo.film import encoded
from dem_demo.sieve.figures._bed import Bed, restitution_range, window
from dem_demo.sieve.figures._labels import panels
from dem_demo.sieve.record import Runs

_RATE = 8.0  # frames per second [1/s]
_WIDTH, _ROOM = 9.0, 0.75  # inches, and beside the beds in height


def gif(runs: Runs) -> bytes:
    """Film all frames that both runs have.

    Parameters
    ----------
    runs : Runs
        As read from their files.

    Returns
    -------
    bytes
        A GIF that repeats itself.
    """
    frames = min(run.time.size for run in runs.every)
    with style.applied():
        left, right, bottom, top = window(runs.law)
        height = _ROOM + 0.85 * _WIDTH * (top - bottom) / (right - left)
        figure = Figure(figsize=(_WIDTH, height * len(runs.every)), dpi=100, layout="constrained")
        canvas: Any = FigureCanvasAgg(figure)  # its methods are untyped
        shown = panels(figure, runs, stacked=True)
        range_ = restitution_range(runs.law)
        beds = [Bed(axes, run, range_) for axes, run in shown]
        bar = figure.colorbar(beds[0].beads, ax=[axes for axes, _ in shown], fraction=0.03)
        bar.set_label("COR of the last impact")
        clock = figure.text(0.01, 0.01, "", ha="left", va="bottom", color=style.MUTED)
        images = []
        for frame in range(frames):
            clock.set_text(f"{runs.law.time[frame] * 1e3:.0f} ms")
            for bed in beds:
                bed.show(frame)
            canvas.draw()
            images.append(Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB"))
    return encoded(images, _RATE)
