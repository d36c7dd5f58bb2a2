"""What is made of a recorded sieve: summary, page, figures and film."""

from __future__ import annotations

import functools
from pathlib import Path

from dem_demo.making import make_all
from dem_demo.place import PAGE, SUMMARY, Kind
from dem_demo.sieve import figures
from dem_demo.sieve.deck import FORM
from dem_demo.sieve.film import gif
from dem_demo.sieve.page import page
from dem_demo.sieve.record import CONSTANT, FORMAT, RECORD, Runs
from dem_demo.sieve.report import summary

FILM = "sieve.gif"


def kind() -> Kind:
    """Name what a sieve leaves in its folder."""
    pictures = (f"{name}.png" for name in figures.names())
    own = {RECORD, CONSTANT, FORM, SUMMARY, PAGE, FILM, *pictures}
    return Kind("sieve", RECORD, FORMAT, frozenset(own))


def make(runs: Runs, folder: Path) -> dict[str, BaseException]:
    """Write what can be written; what fails does not keep the rest from being made.

    Parameters
    ----------
    runs : Runs
        As read from their files.
    folder : Path
        Existing folder for the files.

    Returns
    -------
    dict
        What went wrong, by the name of the file that is missing. An interrupt ends all.
    """
    film = functools.cache(lambda: gif(runs))
    return make_all(
        folder,
        figures.names(),
        lambda name: figures.draw(name, runs),
        {
            SUMMARY: lambda _: f"{summary(runs)}\n".encode(),
            PAGE: lambda pictures: page(runs, pictures, film()).encode(),
        },
        {FILM: lambda _: film()},
    )
