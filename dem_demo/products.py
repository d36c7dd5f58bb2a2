"""What is made of a recorded rain: summary, page, figures and film."""

from __future__ import annotations

from pathlib import Path

from dem_demo import figures
from dem_demo.film import gif
from dem_demo.making import make_all
from dem_demo.page import page
from dem_demo.place import PAGE, SUMMARY, Kind
from dem_demo.reader import Run
from dem_demo.recorder import FORMAT, RECORD
from dem_demo.report import summary

FILM = "rain.gif"


def kind() -> Kind:
    """Name what a rain leaves in its folder."""
    pictures = (f"{name}.png" for name in figures.names())
    return Kind("rain", RECORD, FORMAT, frozenset({RECORD, SUMMARY, PAGE, FILM, *pictures}))


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
    return make_all(
        folder,
        figures.names(),
        lambda name: figures.draw(name, run),
        {
            SUMMARY: lambda _: f"{summary(run)}\n".encode(),
            PAGE: lambda pictures: page(run, pictures).encode(),
        },
        {FILM: lambda _: gif(run)},
    )
