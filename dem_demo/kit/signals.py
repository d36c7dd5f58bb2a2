"""Ctrl-C and other signals: where they stop a run, and where they have to wait."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
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
        super().__init__(f"interrupted by {signal.Signals(number).name}")
        self.exit_status = 128 + number  # what shells report for a process stopped by a signal


_raised: list[int] = []


def _stop(number: int, frame: FrameType | None) -> None:
    _raised.append(number)
    raise Interrupted(number)


def raise_dropped() -> None:
    """Raise an interrupt again that Python or a library dropped; not while one is handled.

    Python drops an exception that is raised while it calls a destructor, the callback of a weak
    reference or a callback from C. Imports and compilation make many such calls: of a hundred
    signals that came while a run started, one was lost.
    """
    if _raised:
        raise Interrupted(_raised[0])


@contextmanager
def _on_signals(reaction: Callable[[int, FrameType | None], Any]) -> Iterator[None]:
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
    try:
        with _on_signals(_stop):
            yield
    finally:
        _raised.clear()


@contextmanager
def noted() -> Iterator[list[int]]:
    """Collect the numbers of the signals of this block in a list; they interrupt nothing.

    At the end of a run the list is ignored, since little is left to do.
    """
    came: list[int] = []
    with _on_signals(lambda number, frame: came.append(number)):
        yield came


@contextmanager
def undisturbed() -> Iterator[None]:
    """Delay interrupts: the first signal that comes within this block is raised at its end.

    It protects steps that must not stop halfway, such as writing HDF5 or moving files.
    """
    with noted() as came:
        yield
    if came:
        raise Interrupted(came[0])
