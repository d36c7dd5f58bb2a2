"""The same scenes by `attach` and by a loop of one's own, which share no code but the kernel of a step."""

import numpy as np
import pytest
import scenes

SAME = "bead", "plate", "triangle", "kind", "flags", "material"
CLOSE = "restitution", "approach_speed", "contact_time", "peak_force", "plastic_energy", "wave_energy", "wall_start"


@pytest.mark.parametrize("name", scenes.SCENES)
def test_attach_and_a_loop_of_ones_own_give_the_same(name):
    scene = scenes.SCENES[name]
    own, lammps = scenes.by_loop(scene), scenes.by_attach(scene)
    assert len(own.rows) == len(lammps.rows) >= 15
    for column in SAME:
        assert np.array_equal(own.rows[column], lammps.rows[column]), column
    for column in CLOSE:
        assert own.rows[column] == pytest.approx(lammps.rows[column], rel=1e-10, abs=1e-15), column
    assert own.x == pytest.approx(lammps.x, abs=1e-15)
    assert own.v == pytest.approx(lammps.v, abs=1e-12)
    assert own.omega == pytest.approx(lammps.omega, abs=1e-9)
