"""The first answer of a fresh process, with numba's cache warm and cold."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator

from validation.bench.row import Row

# numba imports scipy.linalg where scipy is installed, as it is for these benchmarks: 0.3 s that a
# user of contactlaw alone does not wait for. Hidden, it is as if it were not installed.
HIDDEN = "import sys; sys.modules['scipy'] = None"
FIRST = """
import contactlaw as cl
model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
model.restitution({arguments})
"""
SCALAR, BATCH = "5.0, 0.9e-3, 1e-3", "[5.0, 6.0], 0.9e-3, 1e-3"


def run(code: str, folder: str) -> float:
    """Wall time of a fresh process [s]."""
    start = time.perf_counter()
    environment = {**os.environ, "NUMBA_CACHE_DIR": folder}
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)
    return time.perf_counter() - start


def imports() -> tuple[float, str, None, str, None, None, str]:
    """Fields of a row: time of the import by -X importtime, and its largest parts."""
    code = "import contactlaw.model"  # `import contactlaw` alone defers the import of its model
    command = [sys.executable, "-X", "importtime", "-c", code]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stderr.splitlines()
    times = {
        parts[2].strip(): int(parts[1]) / 1e6
        for line in lines
        if len(parts := line.split("|")) == 3 and parts[1].strip().isdigit()
    }
    note = ", ".join(f"{name} {times[name]:.2f} s" for name in ("numpy", "numba", "h5py"))
    return times["contactlaw.model"], "s", None, "", None, None, f"of it {note}"


def rows() -> Iterator[Row]:
    """Measure whole processes, the interpreter's own start included."""
    with tempfile.TemporaryDirectory() as folder:
        empty = min(run("pass", folder) for _ in range(3))
        numba = min(run("import numba, h5py", folder) for _ in range(3))
        kernel = "import numba; numba.njit('f8(f8)')(lambda x: x)"
        any_kernel = min(run(kernel, folder) for _ in range(3))
        code = HIDDEN + FIRST.format(arguments=SCALAR)
        cold = run(code, folder)
        warm = min(run(code, folder) for _ in range(3))
        beside_scipy = min(run(FIRST.format(arguments=SCALAR), folder) for _ in range(3))
        code = HIDDEN + FIRST.format(arguments=BATCH)
        run(code, folder)
        batch = min(run(code, folder) for _ in range(3))
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    note = f"python {empty:.2f} s, numba and h5py {numba:.2f} s, any kernel {any_kernel:.2f} s"
    yield Row("import of ImpactModel", *imports())
    yield Row("first answer, warm cache", warm, "s", 1, note=note)
    yield Row("the same where scipy is installed", beside_scipy, "s", 1, note="numba imports it")
    yield Row("first batch, warm cache", batch, "s", 1)
    yield Row("first answer, cold cache", cold, "s", 6, note=f"largest process {memory:.0f} MB")
