"""GIFs of a scene, for slides."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from contactlaw import style

_COLOURS = 96  # beads of all colours, and their blended edges

# Shows a time [s], and the artists that it moves.
Moving = tuple[Callable[[float], None], Sequence[Artist]]


def film(size: tuple[float, float], lay_out: Callable[[Figure], Moving], times: Sequence[float], rate: float) -> bytes:
    """Make an endless GIF of a size [inches], with a frame for each time, at a rate [1/s]."""
    with style.applied():
        figure = Figure(figsize=size, dpi=100, layout="constrained")
        canvas: Any = FigureCanvasAgg(figure)  # its methods are untyped
        show, moving = lay_out(figure)
        for artist in moving:
            artist.set_animated(True)  # what does not move is drawn once
        canvas.draw()
        still = canvas.copy_from_bbox(figure.bbox)
        frames = []
        for time in times:
            canvas.restore_region(still)
            show(time)
            for artist in moving:
                figure.draw_artist(artist)
            frames.append(Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB"))
    palette = frames[len(frames) // 2].quantize(_COLOURS)  # one palette, or it flickers
    reduced = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    file = io.BytesIO()
    reduced[0].save(file, "GIF", save_all=True, append_images=reduced[1:], duration=round(1e3 / rate), loop=0)
    return file.getvalue()
