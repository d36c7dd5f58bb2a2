"""Each test of this folder ends the simulations that it has made."""

import pytest


@pytest.fixture(autouse=True)
def _closed():
    yield
    import lammps_box  # where LAMMPS is missing no test comes here

    lammps_box.close_all()
