"""What is made of a recorded rain: summary, page, figures and film."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from dem_demo import figures
from dem_demo.film import gif
from dem_demo.page import page
from dem_demo.place import FILM, PAGE, SUMMARY
from dem_demo.reader import Run
from dem_demo.report import summary
from dem_demo.signals import Interrupted


def make(run: Run, folder: Path) -> dict[str, BaseException]:
    """Write what can be written; what fails does not keep the rest from being made.

    Parameters
    ----------
    run : Run
        The run, as read from its file.
    folder : Path
        Existing folder for the files.

    Returns
    -------
    dict
        What went wrong, by the name of the file that is missing. An interrupt ends all.
    """
    pictures: dict[str, figures.Picture] = {}

    def draw(name: str) -> None:
        pictures[name] = figures.draw(name, run)

    def wide(name: str) -> bytes:
        return pictures[name].wide

    def write(name: str, content: Callable[[], bytes]) -> None:
        try:
            (folder / name).write_bytes(content())
        except BaseException:
            (folder / name).unlink(missing_ok=True)
            raise

    drawn = figures.names()
    steps = [
        *((f"{name}.png", partial(draw, name)) for name in drawn),
        # in the order of what each is worth where there is no room for all
        (SUMMARY, partial(write, SUMMARY, lambda: f"{summary(run)}\n".encode())),
        (PAGE, partial(write, PAGE, lambda: page(run, pictures).encode())),
        *((f"{n}.png", partial(write, f"{n}.png", partial(wide, n))) for n in drawn),
        (FILM, partial(write, FILM, lambda: gif(run))),
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
