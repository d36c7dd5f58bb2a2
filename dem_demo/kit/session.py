"""From a command to its folder: simulate, read the record, print, draw, and move all files."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from contactlaw import _atomic
from dem_demo.kit.signals import Interrupted

FORESEEN = Interrupted, OSError, ValueError, RuntimeError  # their messages suffice: no traceback


class Show(NamedTuple):
    """How a scene makes its files. A run is what `read` returns."""

    name: str  # of the scene; its record is NAME.h5, its film NAME.gif
    figures: ModuleType  # package with the `names` and `draw` of a `Gallery`
    read: Callable[[Path], Any]  # reads the records in a folder
    summary: Callable[[Any], str]
    page: Callable[[Any, Mapping[str, bytes], bytes], str]
    film: Callable[[Any], bytes]


def deliver(out: Path, show: Show, simulate: Callable[[Path], BaseException | None]) -> int:
    """Simulate a scene and write its files.

    Of a run that has not come to its end, with all its figures, the records alone are kept, as
    ``*-partial.h5``: what they have until then is whole, and an earlier run in the folder stays as
    it is. The next one that comes to its end removes them.
    """
    with _atomic.folder(out) as folder:
        text, stop = "", simulate(folder)
        if stop is None:
            try:
                run = show.read(folder)
                text = f"{show.summary(run)}\n"
                make(show, run, text, folder)
            except (Exception, Interrupted) as error:
                text, stop = "", error
        if stop is not None:
            for file in list(folder.iterdir()):
                if file.suffix == ".h5":
                    file.rename(_partial(file))
                else:
                    file.unlink()
        written = sorted(file.name for file in folder.iterdir())
        if not written:
            assert stop is not None
            raise stop
    if stop is None:
        for name in written:
            _partial(out / name).unlink(missing_ok=True)
    print(f"{text}\nWritten to {out}: {', '.join(written)}", flush=True)
    if stop is None:
        return 0
    if not isinstance(stop, FORESEEN):
        traceback.print_exception(stop)
    print(f"dem-demo: stopped: {sentence(stop)}", file=sys.stderr)
    return int(getattr(stop, "exit_status", 1))


def make(show: Show, run: Any, summary: str, folder: Path) -> None:
    """Make all files of a run, the summary first."""
    (folder / "summary.txt").write_text(summary, encoding="utf-8")
    pictures = {name: show.figures.draw(name, run) for name in show.figures.names()}
    film = show.film(run)
    (folder / "index.html").write_text(show.page(run, pictures, film), encoding="utf-8")
    for name, picture in pictures.items():
        (folder / f"{name}.png").write_bytes(picture)
    (folder / f"{show.name}.gif").write_bytes(film)


def sentence(error: BaseException) -> str:
    """Say what went wrong, and at which impact if that is known."""
    where = "; ".join(getattr(error, "__notes__", []))
    text = str(error) or type(error).__name__
    return f"{where}: {text}" if where else text


def _partial(record: Path) -> Path:
    return record.with_stem(f"{record.stem}-partial")
