"""GIFs of a scene, for slides."""

from __future__ import annotations

import io

from PIL import Image

_COLOURS = 96  # beads of all colours, and what their edges mix with them


def encoded(frames: list[Image.Image], rate: float) -> bytes:
    """Make a GIF that repeats itself of frames, so many per second [1/s]."""
    palette = frames[len(frames) // 2].quantize(_COLOURS)  # one for all, or the picture flickers
    reduced = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    file = io.BytesIO()
    reduced[0].save(
        file, "GIF", save_all=True, append_images=reduced[1:], duration=round(1e3 / rate), loop=0,
    )  # fmt: skip
    return file.getvalue()
