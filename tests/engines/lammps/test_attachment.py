"""Walls in a LAMMPS simulation: where plates meet, beads that come and go, and how walls are taken out."""

import pytest
from lammps_box import ABOVE, PLATE, R, above, attach, dropped, flat, make, scene, state

from contactlaw.engines.lammps import Plate


def halves(left=1e-3, right=1e-3):
    """Two plates that share the edge x = 0."""
    return [flat(left, x=-0.05, width=0.05), flat(right, x=0.0, width=0.05)]


def upright(*edge):
    return Plate((0, -0.05, 0), edge, (0, 0.1, 0), 1e-3)


ROOF, CORNER = [upright(0.03, 0, -0.04), upright(-0.03, 0, -0.04)], [halves()[0], upright(0, 0, -0.05)]
MEETING = [(halves(0.5e-3, 3e-3), 0.5e-3), (halves(3e-3, 0.5e-3), 3e-3), *((pair, 1e-3) for pair in (ROOF, CORNER))]


@pytest.mark.parametrize(("plates", "thickness"), [*MEETING, *((plates[::-1], 1e-3) for plates, _ in MEETING[2:])])
def test_where_plates_meet_the_first_is_hit_once(model, plates, thickness):
    """In a seam of two thicknesses, on a roof, and on the outer corner of a box."""
    (row,), now = dropped(model, plates)
    assert row["restitution"] == pytest.approx(model.restitution(5.0, R, thickness), abs=5e-4)
    assert abs(now["v"][0, :2]).max() < 1e-12


def test_a_bead_that_is_hit_while_it_touches_a_plate(model):
    """The record has the speed of the hit, and the step is checked for it."""
    lmp, walls = scene(model, None, above(1e-9), (0, 0, -0.01))
    lmp.commands_string("run 20\nset atom 1 vz -5\nrun 500")
    (row,) = walls.collisions()
    assert row["approach_speed"] == pytest.approx(5.0, rel=1e-4)
    assert 0.85 < row["restitution"] < 0.95
    lmp.commands_string(f"timestep 4e-7\nset atom 1 z {R + 1e-9} vz -0.01\nrun 20")
    with pytest.raises(RuntimeError, match="timestep: too large for an impact at 5 m/s"):
        lmp.commands_string("set atom 1 vz -5\nrun 200")


def test_detach_gives_the_simulation_back(model):
    """Twice, with a method of the user's own, and after parts have gone or LAMMPS was closed."""
    lmp = make(ABOVE)
    own = lmp.command = lmp.command
    walls = attach(lmp, model, [flat(1e-3)])
    lmp.command("run 100")
    assert lmp.command is not own
    type(lmp).command(lmp, "unfix contactlaw_force")  # behind the adapter's back
    walls.detach()
    walls.detach()
    assert lmp.command is own and "commands_string" not in vars(lmp)
    kinds = "fix", "compute", "variable", "group"
    assert not [name for kind in kinds for name in lmp.available_ids(kind) if name and "contactlaw" in name]
    lmp.command("run 2000")
    assert lmp.numpy.extract_atom("v")[0, 2] == pytest.approx(-5.0, rel=1e-12)  # through the plate
    lmp, walls = scene(model, None, above(1e-5))
    lmp.command("run 500")
    lmp.close()
    walls.detach()
    assert len(walls.collisions()) == 1


def test_walls_act_on_the_beads_of_a_group(model):
    """Others fly through, of any mass and speed, and so do types without a model.

    A bead that is taken out has left the walls.
    """
    lmp = make([above(x=0.01 * n) for n in range(4)], types=2, kind=[1, 1, 1, 2])
    lmp.commands_string("group gone id 1\ngroup two id 2\ngroup beads id 1 2 4\ngroup gone delete")
    lmp.command("set atom 3*4 density 1 vz -20000")  # further than its radius in a step
    walls = attach(lmp, {1: model, 2: None}, [flat(1e-3)], group="beads")
    lmp.commands_string("run 0\nset atom 3*4 vz -5\nrun 220")
    assert (state(lmp)["d2_contactlaw"][:, PLATE] != 0.0).tolist() == [True, True, False, False]
    with pytest.raises(Exception, match="Cannot delete group beads"):
        lmp.command("group beads delete")
    lmp.commands_string("group beads subtract beads two\nrun 1000")
    assert walls.collisions()["bead"].tolist() == [1]
    assert state(lmp)["v"][1, 2] < 0.0 and (state(lmp)["v"][2:, 2] == -5.0).all()
    lmp.commands_string("group beads clear\ngroup beads dynamic two every 1\nset atom 2 z 2e-4")
    with pytest.raises(RuntimeError, match="bead 2 on wall 0 .* deep in the wall"):
        lmp.command("run 1")
