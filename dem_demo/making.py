"""Files made of a record, one after the other; what fails does not keep the rest from being made.

They come in the order of what each is worth where a disk has no room for all.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

from dem_demo.gallery import Picture
from dem_demo.signals import Interrupted

Pictures = Mapping[str, Picture]
Content = Callable[[Pictures], bytes]


def make_all(
    folder: Path,
    figures: Sequence[str],
    draw: Callable[[str], Picture],
    first: Mapping[str, Content],
    last: Mapping[str, Content],
) -> dict[str, BaseException]:
    """Draw figures, and write what is made of them, the figures, and the rest.

    Parameters
    ----------
    folder : Path
        Existing folder for the files.
    figures : sequence of str
        Names of the figures.
    draw : callable
        Makes one by its name.
    first, last : mapping of callable
        What a file holds, by its name; written before and after the figures. It is given the
        figures that could be drawn.

    Returns
    -------
    dict
        What went wrong, by the name of the file that is missing. An interrupt ends all.
    """
    pictures: dict[str, Picture] = {}

    def keep(name: str) -> None:
        pictures[name] = draw(name)

    def write(name: str, content: Content) -> None:
        try:
            (folder / name).write_bytes(content(pictures))
        except BaseException:
            (folder / name).unlink(missing_ok=True)
            raise

    steps = [
        *((f"{name}.png", partial(keep, name)) for name in figures),
        *((name, partial(write, name, content)) for name, content in first.items()),
        *((f"{n}.png", partial(write, f"{n}.png", partial(_wide, n))) for n in figures),
        *((name, partial(write, name, content)) for name, content in last.items()),
    ]
    failed: dict[str, BaseException] = {}
    for n, (name, step) in enumerate(steps):
        try:
            if name not in failed:
                step()
        except Exception as error:
            failed[name] = error
        except Interrupted as error:
            return {**failed, **dict.fromkeys((name for name, _ in steps[n:]), error)}
    return failed


def _wide(name: str, pictures: Pictures) -> bytes:
    return pictures[name].wide
