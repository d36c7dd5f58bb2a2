"""Ctrl-C and other signals: where they stop a run, and where they have to wait."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

# Windows has no terminal that hangs up.
_SIGNALS = [one for one in signal.Signals if one.name in ("SIGINT", "SIGTERM", "SIGHUP")]


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


_came: list[int] = []  # numbers of the signals since the command began
_holds: list[None] = []  # one entry for each block of `held` that is open


def _stop(number: int, frame: FrameType | None) -> None:
    _came.append(number)
    check()


@contextmanager
def interruptible() -> Iterator[None]:
    """Within this block, Ctrl-C, a request to terminate and a hang-up raise `Interrupted`."""
    # Python delivers signals to the main thread only; nohup ignores some.
    here = _SIGNALS if threading.current_thread() is threading.main_thread() else []
    before = {n: handler for n in here if (handler := signal.getsignal(n)) != signal.SIG_IGN}
    try:
        for number in before:
            signal.signal(number, _stop)
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        _came.clear()


@contextmanager
def held() -> Iterator[None]:
    """Let signals wait while this block does what must not stop halfway; `check` raises them."""
    _holds.append(None)
    try:
        yield
    finally:
        _holds.pop()


def first() -> int:
    """Return the number of the first signal that came; 0 without any."""
    return next(iter(_came), 0)


def check() -> None:
    """Raise the first signal that has waited, or whose `Interrupted` was dropped.

    Python drops an exception that is raised while it calls a destructor, the callback of a weak
    reference or a callback from C. Imports and compilation make many such calls: of a hundred
    signals that came while a run started, one was lost.
    """
    if _came and not _holds:
        raise Interrupted(_came[0])
