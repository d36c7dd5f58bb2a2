"""Pages of runs, and their parts; a page needs no other file and no network.

``page.html`` is the frame of such a page, and ``parts.html`` has tables, limits and figures.
"""

import base64
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import NamedTuple

from contactlaw._template import template as template  # also for the demo


class Figure(NamedTuple):
    """A figure within a page: its image as text, and its caption."""

    name: str
    image: str
    caption: str
    more: str


def shown(module: Callable[[str], ModuleType], pictures: Mapping[str, bytes]) -> list[Figure]:
    """Prepare figures for a page, with the docstrings of their modules for captions."""
    found = []
    for name, picture in pictures.items():
        caption, _, more = str(module(name).__doc__).strip().partition("\n\n")
        image = f"data:image/png;base64,{base64.b64encode(picture).decode()}"
        texts = (" ".join(text.split()) for text in (caption, more))
        found.append(Figure(name, image, *texts))
    return found


def made(created: str, versions: Mapping[str, str]) -> str:
    """Say when a run was made, and by which versions."""
    programs = ", ".join(f"{name} {text}" for name, text in sorted(versions.items()))
    return f"{created}; {programs}"
