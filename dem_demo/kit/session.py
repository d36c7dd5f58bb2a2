"""From a command to its folder: simulate, read the record, print, draw, and move all files."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from dem_demo.kit.gallery import Picture
from dem_demo.kit.options import Refused
from dem_demo.kit.place import Place, entries, workplace
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
    def files(self) -> set[str]:
        """Names of all files of the results, without those of an engine."""
        pictures = (f"{name}.png" for name in self.figures.names())
        return {self.record, f"{self.name}.gif", SUMMARY, PAGE, *self.others, *pictures}


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
    target = Place(out, show)
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
        reached = target.fill(folder, complete=not reason)
    replaced = target.earlier and reached == target.path
    earlier = f", in the place of an earlier {show.name}" * replaced
    print(f"\nWritten to {reached}{earlier}: {written}", flush=True)
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
    pictures: dict[str, Picture] = {}
    film = functools.cache(lambda: show.film(run))

    def draw(name: str) -> None:
        pictures[name] = show.figures.draw(name, run)

    def write(name: str, content: Callable[[], bytes]) -> None:
        try:
            (folder / name).write_bytes(content())
        except BaseException:
            (folder / name).unlink(missing_ok=True)
            raise

    contents: dict[str, Callable[[], bytes]] = {
        SUMMARY: lambda: f"{show.summary(run)}\n".encode(),
        PAGE: lambda: show.page(run, pictures, film).encode(),
        **{f"{name}.png": partial(_wide, pictures, name) for name in show.figures.names()},
        f"{show.name}.gif": film,
    }
    steps: list[tuple[str, Callable[[], None]]] = [
        *((f"{name}.png", partial(draw, name)) for name in show.figures.names()),
        *((name, partial(write, name, content)) for name, content in contents.items()),
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


def _wide(pictures: Mapping[str, Picture], name: str) -> bytes:
    return pictures[name].wide
