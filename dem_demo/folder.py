"""Results appear all at once at the end, or not at all."""

from __future__ import annotations

import os
import shutil
import signal
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

_SIGNALS = [
    getattr(signal, name)
    for name in ("SIGINT", "SIGTERM", "SIGHUP")  # Windows has no terminal that hangs up
    if hasattr(signal, name)
]


class Interrupted(BaseException):
    """The user or the system asked the run to stop.

    Parameters
    ----------
    number : int
        Number of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.exit_status = 128 + number  # what shells report for a process stopped by a signal


def _stop(number: int, frame: FrameType | None) -> None:
    raise Interrupted(number)


@contextmanager
def _on_signals(
    reaction: Callable[[int, FrameType | None], Any] | signal.Handlers,
) -> Iterator[None]:
    if threading.current_thread() is not threading.main_thread():
        yield  # Python delivers signals to the main thread only
        return
    before = {number: signal.getsignal(number) for number in _SIGNALS}
    heard = {n: handler for n, handler in before.items() if handler != signal.SIG_IGN}  # nohup
    try:
        for number in heard:
            signal.signal(number, reaction)
        yield
    finally:
        for number, handler in heard.items():
            signal.signal(number, handler)


@contextmanager
def interruptible() -> Iterator[None]:
    """Within this block, Ctrl-C, a request to terminate and a hang-up raise `Interrupted`."""
    with _on_signals(_stop):
        yield


@contextmanager
def results(folder: Path) -> Iterator[Path]:
    """Give a temporary folder whose files move into the real one when all went well.

    Parameters
    ----------
    folder : Path
        Where the results shall be; made with its parents if need be, at the end.

    Yields
    ------
    Path
        The temporary folder. It is on the same file system, so that each file moves in one step,
        and it is removed whatever happens.

    Raises
    ------
    NotADirectoryError
        If `folder`, or what it shall be in, is a file.
    """
    nearest = folder.absolute()
    while not nearest.exists():
        nearest = nearest.parent
    if not nearest.is_dir():
        raise NotADirectoryError(f"out: {nearest} is a file, not a folder")
    temporary = Path(tempfile.mkdtemp(prefix=".unfinished-", dir=nearest))
    try:
        yield temporary
        with _on_signals(signal.SIG_IGN):
            folder.mkdir(parents=True, exist_ok=True)
            for file in sorted(temporary.iterdir()):
                os.replace(file, folder / file.name)
    finally:
        with _on_signals(signal.SIG_IGN):
            shutil.rmtree(temporary)
