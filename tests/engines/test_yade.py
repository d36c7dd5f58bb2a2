"""YADE's example beside the solver."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from places import ROOT

import contactlaw as cl


def printed():
    """What the example prints in YADE: of each plate its thickness [mm], COR, COR integrated, and both tangential CORs.

    YADE has the system's Python and numpy. What else contactlaw needs is linked to in a folder that stays, since
    machine code is of the place of its source, and of one numpy.
    """
    if not shutil.which("yade"):
        pytest.skip("YADE: yade is missing: apt-get install --no-install-recommends yade")
    version = "import sys; sys.exit(sys.version_info[:2] != " + repr(sys.version_info[:2]) + ")"
    if subprocess.run(["/usr/bin/python3", "-c", version]).returncode:
        pytest.skip("YADE: the system's Python has another version than this one, whose packages it cannot use")
    folder = ROOT / ".pytest_cache/yade"
    folder.mkdir(parents=True, exist_ok=True)
    for name in "contactlaw", "numba", "llvmlite", "h5py", "platformdirs", "filelock", "tqdm":
        package = Path(importlib.util.find_spec(name).origin).parent
        for part in package, package.with_name(f"{name}.libs"):
            link = folder / part.name
            link.unlink(missing_ok=True)
            link.symlink_to(part)
    environment = os.environ | {"PYTHONPATH": str(folder), "NUMBA_CACHE_DIR": str(folder / "machine-code")}
    done = subprocess.run(
        ["yade", "-x", "-n", ROOT / "docs/examples/yade_softsphere.py"],
        env=environment,
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, done.stderr
    number = r"([\d.]+)"
    line = rf"{number} mm: COR {number}, integrated {number};\s+along {number}, integrated {number}"
    return np.array(re.findall(line, done.stdout), float)


def test_the_example_has_the_impacts_of_the_solver():
    """The example prints four digits; tangential CORs in its steps differ from the solver's by 1.6e-3."""
    thickness, cor, integrated, along, integrated_along = printed().T
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    hit = model.oblique(5.0, 3.0, 0.9e-3, 1e-3 * thickness, 0.2, method="solve")
    assert thickness.tolist() == [0.5, 1.0, 3.0]
    assert integrated == pytest.approx(hit.restitution, abs=6e-5)
    assert integrated_along == pytest.approx(hit.tangential_restitution, abs=6e-5)
    assert cor == pytest.approx(hit.restitution, abs=3e-4)
    assert np.abs(along - integrated_along).max() < 2e-3  # steps promise 0.012 mu V, which is 4e-3 here
