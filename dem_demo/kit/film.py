"""GIFs of a scene, for slides."""

from __future__ import annotations

import io

from PIL import Image

_COLOURS = 96  # beads of all colours, and their blended edges


def encoded(frames: list[Image.Image], rate: float) -> bytes:
    """Make an endless GIF of frames at a rate [1/s]."""
    palette = frames[len(frames) // 2].quantize(_COLOURS)  # one palette, or it flickers
    reduced = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    file = io.BytesIO()
    reduced[0].save(file, "GIF", save_all=True, append_images=reduced[1:], duration=round(1e3 / rate), loop=0)
    return file.getvalue()
