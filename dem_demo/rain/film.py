"""rain.gif: the busiest part of the rain in slow motion, for slides."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

from contactlaw import style
from dem_demo.kit.film import encoded
from dem_demo.rain import paths
from dem_demo.rain.figures._rain import TURNING, Picture, instants
from dem_demo.rain.record import Run
from dem_demo.rain.report import title

SLOWER = 20  # times slower than the rain
_FRAMES, _RATE = 100, 20.0  # frames of the film, and frames per second [1/s]
_SIZE = 7.2, 4.3  # [inches]


def gif(run: Run) -> bytes:
    """Film the busiest time of a run."""
    made = paths.pieces(run)
    with style.applied():
        figure = Figure(figsize=_SIZE, dpi=100, layout="constrained")
        canvas: Any = FigureCanvasAgg(figure)  # its methods are untyped
        axes = figure.add_subplot()
        hands = f"\nhands: spin, {SLOWER * TURNING:g} times slower" if run.scene.friction else ""
        beads, *_, plates = title(run)[0].split(", ")
        axes.set_title(f"{beads} {plates}, {SLOWER} times slower{hands}")
        picture = Picture(axes, run, made)
        bar = figure.colorbar(picture.circles, ax=axes, pad=0.01, fraction=0.03)
        bar.set_label("COR of the last impact (grey: none yet)")
        canvas.draw()
        still = canvas.copy_from_bbox(figure.bbox)
        frames = []
        for time in _times(run, made):
            canvas.restore_region(still)
            picture.show(time)
            for collection in picture.moving:
                axes.draw_artist(collection)
            frames.append(Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB"))
    return encoded(frames, _RATE)


def _times(run: Run, made: NDArray[np.void]) -> list[float]:
    """Choose the times [s] of the frames: around the busiest instant."""
    times, counts = instants(run, made)
    length = _FRAMES / (_RATE * SLOWER)
    end = float(times[-1]) if times.size else 0.0
    within = np.ones(max(1, round(length * run.scene.frame_rate)))
    middle = float(times[np.argmax(np.convolve(counts, within, "same"))]) if times.size else 0.0
    begin = min(max(0.0, middle - 0.5 * length), max(0.0, end - length))
    shown = np.linspace(begin, min(begin + length, end), _FRAMES, endpoint=False)
    return [float(time) for time in shown]
