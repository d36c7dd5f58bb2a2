"""Pages of runs, and their parts; a page needs no other file and no network.

``page.html`` is the frame of such a page, and ``parts.html`` has tables, limits and figures.
"""

import base64
import datetime
from collections.abc import Mapping
from types import ModuleType
from typing import NamedTuple

from contactlaw._template import template as template  # also for the demo


class Figure(NamedTuple):
    """A figure within a page: its image as text, and its caption."""

    name: str
    image: str
    caption: str
    more: str


def shown(modules: Mapping[str, ModuleType], pictures: Mapping[str, bytes]) -> list[Figure]:
    """Prepare figures for a page, with the docstrings of their modules for captions."""
    figures = []
    for name, picture in pictures.items():
        texts = (" ".join(text.split()) for text in str(modules[name].__doc__).partition("\n\n")[::2])
        image = f"data:image/png;base64,{base64.b64encode(picture).decode()}"
        figures.append(Figure(name, image, *texts))
    return figures


def made(versions: Mapping[str, str]) -> str:
    """Say when a page was made, and by which versions."""
    now = datetime.datetime.now(datetime.UTC)
    programs = ", ".join(f"{name} {version}" for name, version in sorted(versions.items()))
    return f"Made on {now:%Y-%m-%d at %H:%M} UTC by {programs}"
