"""From a command to its folder: simulate, read the record, print, draw, and move all files."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from contactlaw.reporting.gallery import Picture
from dem_demo.kit import disk
from dem_demo.kit.options import Refused
from dem_demo.kit.place import PARTIAL, earlier, entries, replace, workplace
from dem_demo.kit.signals import Interrupted

SUMMARY, PAGE = "summary.txt", "index.html"

Film = Callable[[], bytes]


class Show(NamedTuple):
    """How a scene makes its files. A run is what `read` returns; it has a `reason`."""

    name: str
    """Name of the scene; its record is NAME.h5, its film NAME.gif."""
    others: frozenset[str]
    """Names of further files that a simulation writes; files of an engine are not listed."""
    figures: ModuleType
    """Package with the `names` and `draw` of a `Gallery`."""
    read: Callable[[Path], Any]
    """Reads the records in a folder."""
    summary: Callable[[Any], str]
    progress: Callable[[Any], str]
    page: Callable[[Any, Mapping[str, Picture], Film], str]
    film: Callable[[Any], bytes]
    sentence: Callable[[BaseException], str]
    """Puts an error into words."""

    @property
    def record(self) -> str:
        """File name of the record."""
        return f"{self.name}.h5"

    @property
    def products(self) -> set[str]:
        """Names of all files that are made of the records."""
        pictures = (f"{name}.png" for name in self.figures.names())
        return {SUMMARY, PAGE, *pictures, f"{self.name}.gif"}

    @property
    def files(self) -> set[str]:
        """Names of all files of the results, without those of an engine."""
        return {self.record, *self.others, *self.products}


def deliver(out: Path, show: Show, simulate: Callable[[Path], BaseException | None]) -> int:
    """Simulate a scene and write its files; an interrupted run keeps what it has computed.

    Parameters
    ----------
    out : Path
        The folder for the results.
    show : Show
        How the scene makes its files.
    simulate : callable
        Writes the records into a folder; returns the exception that stopped it, if any.

    Returns
    -------
    int
        Exit status of the command.
    """
    old, complete = earlier(out, show.name)
    others = sorted(show.files & {*entries(out)} - old)
    if others:
        raise Refused(
            f"--out: {out} holds {', '.join(others)}, which no {show.name} has left there; name "
            "another folder"
        )
    with workplace(out) as folder:
        stop = simulate(folder)
        if not (folder / show.record).exists():
            assert stop is not None
            if isinstance(stop, Interrupted):
                raise stop
            raise Refused(f"{show.sentence(stop)}; nothing could be kept")
        run = show.read(folder)
        reason = run.reason or (show.sentence(stop) if stop is not None else "")
        print(show.summary(run), flush=True)
        failed = make(show, run, folder)
        written = ", ".join(entries(folder))
        target = out / PARTIAL if reason and complete else out
        replace(folder, target, show.name)
    replaced = f", in the place of an earlier {show.name}" if old and target == out else ""
    print(f"\nWritten to {target}{replaced}: {written}", flush=True)
    for name, why in failed.items():
        print(f"dem-demo: {name} is missing: {show.sentence(why)}", file=sys.stderr)
    if reason:
        print(f"dem-demo: partial, {show.progress(run)}: {reason}", file=sys.stderr)
    return max((getattr(e, "exit_status", 1) for e in (stop, *failed.values()) if e), default=0)


def make(show: Show, run: Any, folder: Path) -> dict[str, BaseException]:
    """Make all files of a run, the most useful ones first in case the disk fills up.

    If one file fails, the others are still made; an interrupt ends all.

    Returns
    -------
    dict
        The exception for each file that is missing, by its name.
    """
    failed: dict[str, BaseException] = {}
    pictures: dict[str, Picture] = {}
    film = functools.cache(lambda: show.film(run))

    @contextmanager
    def attempt(name: str) -> Iterator[Path]:
        try:
            yield folder / name
        except Exception as error:
            failed[name] = error

    try:
        for name in show.figures.names():
            with attempt(f"{name}.png"):
                pictures[name] = show.figures.draw(name, run)
        with attempt(SUMMARY) as path:
            disk.write(path, f"{show.summary(run)}\n".encode())
        with attempt(PAGE) as path:
            disk.write(path, show.page(run, pictures, film).encode())
        for name, picture in pictures.items():
            with attempt(f"{name}.png") as path:
                disk.write(path, picture.wide)
        with attempt(f"{show.name}.gif") as path:
            disk.write(path, film())
    except Interrupted as error:
        failed |= dict.fromkeys(sorted(show.products - {*entries(folder)}), error)
    return failed
