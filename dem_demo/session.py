"""From a command to its folder: simulate, read back, tell, draw, and put everything in place."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from dem_demo.folder import files, workplace
from dem_demo.options import Refused
from dem_demo.place import Kind, Place
from dem_demo.signals import Interrupted

FORESEEN = (Interrupted, OSError, ValueError, RuntimeError)  # they say all that is to be said


class Steps(NamedTuple):
    """What a command does with its folder."""

    simulate: Callable[[Path], BaseException | None]
    """Fills the folder with records; returns what stopped it, if anything did."""
    read: Callable[[Path], Any]
    """Reads the records back; the run has a `reason`, empty if it is complete."""
    summary: Callable[[Any], str]
    progress: Callable[[Any], str]
    make: Callable[[Any, Path], dict[str, BaseException]]
    """Makes all other files; returns what went wrong, by the name of the file."""
    sentence: Callable[[BaseException], str]
    """Puts an error into words."""


def deliver(out: Path, kind: Kind, steps: Steps) -> int:
    """Run a command's steps; what has been computed is kept if it is stopped.

    Parameters
    ----------
    out : Path
        The folder for the results.
    kind : Kind
        What belongs there.
    steps : Steps
        What is to be done.

    Returns
    -------
    int
        Exit status of the command.
    """
    target = Place(out, kind)
    with workplace(out) as folder:
        stop = steps.simulate(folder)
        if not (folder / kind.record).exists():
            assert stop is not None
            raise Refused(f"{steps.sentence(stop)}; nothing could be kept")
        run = steps.read(folder)
        print(steps.summary(run), flush=True)
        failed = steps.make(run, folder)
        written = ", ".join(file.name for file in files(folder))
        reached = target.fill(folder, complete=not run.reason)
    replaced = target.earlier and reached == target.path
    earlier = f", in the place of an earlier {kind.name}" * replaced
    print(f"\nWritten to {reached}{earlier}: {written}", flush=True)
    for name, why in failed.items():
        print(f"dem-demo: {name} is missing: {steps.sentence(why)}", file=sys.stderr)
    if run.reason:
        print(f"dem-demo: partial, {steps.progress(run)}: {run.reason}", file=sys.stderr)
    return max((getattr(e, "exit_status", 1) for e in (stop, *failed.values()) if e), default=0)
