"""A row of the benchmark's output, and the one way to take times."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass
class Row:
    """One target: what was measured, in which unit, and what it is compared with."""

    name: str
    measured: float
    unit: str
    target: float | None = None
    peer: str = ""
    ratio: float | None = None  # peer's time over ours
    least_ratio: float | None = None
    note: str = ""

    @property
    def met(self) -> bool:
        """Whether the target and the least ratio, where given, are met."""
        fast = self.target is None or self.measured <= self.target
        return fast and (self.least_ratio is None or (self.ratio or 0.0) >= self.least_ratio)

    def __str__(self) -> str:
        """Put the row in the columns that `validation.bench` prints."""
        target = "-" if self.target is None else f"{self.target:g}"
        ratio = "" if self.ratio is None else f"{self.peer}: {self.ratio:.3g}x"
        if self.least_ratio is not None:
            ratio += f" (target {self.least_ratio:g}x)"
        verdict = "" if self.met else "NOT MET  "
        line = f"{self.name:34s} {self.measured:9.3g} {self.unit:2s} {target:>8s}  {ratio}"
        return f"{line}  {verdict}{self.note}".rstrip()


def in_turns(
    tasks: Mapping[str, Callable[[], object]], rounds: int = 7, clock: Callable[[], float] = time.perf_counter
) -> dict[str, NDArray[np.float64]]:
    """Take the times of each task in every round [s], after a first one, which may compile.

    They take turns, so that all see the same noise of the machine.
    """
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for turn in range(rounds + 1):
        for name, task in tasks.items():
            start = clock()
            task()
            if turn > 0:
                times[name].append(clock() - start)
    return {name: np.array(taken) for name, taken in times.items()}


def seconds(task: Callable[[], object], rounds: int = 7) -> float:
    """Least time of some calls after a first one [s]."""
    return float(in_turns({"": task}, rounds)[""].min())


def per_call(function: Callable[[], object], calls: int = 20_000) -> float:
    """Time of one of many calls from a Python loop, the loop included [s]."""

    def loop() -> None:
        for _ in range(calls):
            function()

    return seconds(loop, 5) / calls


def on_ranks(module: str, ranks: int, *arguments: object) -> Any:
    """Run a module on some ranks of MPI, and read the JSON that it prints."""
    mpirun = Path(sys.executable).with_name("mpirun")
    command = [mpirun, "-np", ranks, sys.executable, "-m", module, *arguments]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True)
    return json.loads(done.stdout)
