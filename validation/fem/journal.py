"""Long studies that go on where they were stopped: one line of a file for each finished job."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import as_completed
from pathlib import Path
from typing import Any, TypeVar

from numpy.typing import NDArray
from tqdm import tqdm

from validation.fem import cases, store
from validation.fem.cases import Case
from validation.fem.solver import VERSION

_Job = TypeVar("_Job")


def complete(
    name: str, function: Callable[[_Job], dict[str, Any]], jobs: Sequence[_Job], processes: int
) -> list[dict[str, Any]]:
    """Outcomes of all jobs, in their order; those that an earlier run has finished are read.

    Parameters
    ----------
    name : str
        Name of the study; its journal lies beside the results until `forget` removes it.
    function : callable
        ``function(job)`` gives numbers and lists by name; it runs in a process of its own.
    jobs : sequence
        Jobs, whose ``repr`` tells them apart.
    processes : int
        How many run side by side.

    Returns
    -------
    list of dict

    Raises
    ------
    Exception
        What a job raises; the finished ones are kept.
    """
    done = _read(path(name))
    missing = [job for job in jobs if repr(job) not in done]
    bar = tqdm(total=len(jobs), initial=len(jobs) - len(missing), desc=name, disable=None)
    with bar, path(name).open("a") as file, cases.workers(processes) as pool:
        running = {pool.submit(function, job): job for job in missing}
        for finished in as_completed(running):
            job, outcome = running[finished], finished.result()
            done[repr(job)] = outcome
            line = {"job": repr(job), "solver_version": VERSION, "outcome": outcome}
            file.write(json.dumps(line) + "\n")
            file.flush()
            bar.update()
    return [done[repr(job)] for job in jobs]


def again(name: str, processes: int) -> None:
    """Compute the impacts of a stored study again, from their inputs in its file."""
    data, attributes = store.read(name)
    impacts(name, str(attributes["about"]), cases.stored(name), processes, data)


def impacts(
    name: str, about: str, listed: Sequence[Case], processes: int, beside: Mapping[str, NDArray[Any]] | None = None
) -> None:
    """Compute impacts as a study that goes on where it was stopped, and store them.

    Columns `beside` their inputs and outcomes are stored with them.
    """
    rows = complete(name, cases.solve, listed, processes)
    cases.save(name, about, {**(beside or {}), **cases.columns(rows)})
    forget(name)


def path(name: str) -> Path:
    """Path of the journal of a study."""
    return store.FOLDER / f".fem_{name}.jsonl"


def forget(name: str) -> None:
    """Remove the journal of a study whose result is stored."""
    path(name).unlink(missing_ok=True)


def _read(journal: Path) -> dict[str, dict[str, Any]]:
    """Read the outcomes of a journal by job, but for those of another version of the solver."""
    done = {}
    for line in journal.read_text().splitlines() if journal.exists() else ():
        try:
            entry = json.loads(line)
        except json.JSONDecodeError:  # the last line of a run that was killed while it wrote
            continue
        if entry["solver_version"] == VERSION:
            done[entry["job"]] = entry["outcome"]
    return done
