"""A row of the benchmark's output, and how times are taken."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any


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


def seconds(function: Callable[[], object], repeat: int = 7) -> float:
    """Least time of some calls after a first one, which may compile [s]."""
    function()
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


def per_call(function: Callable[[], object], calls: int = 20_000) -> float:
    """Time of one of many calls from a Python loop, the loop included [s]."""

    def loop() -> None:
        for _ in range(calls):
            function()

    return seconds(loop, repeat=5) / calls


def in_turns(simulations: dict[str, Any], steps: int, rounds: int) -> dict[str, list[float]]:
    """Time of a step of each LAMMPS in every round [us]; they take turns, to see the same noise."""
    from mpi4py import MPI

    times: dict[str, list[float]] = {name: [] for name in simulations}
    for _ in range(rounds):
        for name, lmp in simulations.items():
            MPI.COMM_WORLD.Barrier()
            start = time.perf_counter()
            lmp.command(f"run {steps} pre no post no")
            MPI.COMM_WORLD.Barrier()
            times[name].append((time.perf_counter() - start) / steps * 1e6)
    return times


def on_ranks(module: str, ranks: int, *arguments: object) -> Any:
    """Run a module on some ranks of MPI, and read the JSON that it prints."""
    mpirun = Path(sys.executable).with_name("mpirun")
    command = [mpirun, "-np", ranks, sys.executable, "-m", module, *arguments]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True)
    return json.loads(done.stdout)
