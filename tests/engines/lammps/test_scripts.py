"""The LAMMPS adapter under the commands of users' scripts: each does right, or says why not."""

import gc
import weakref

import lammps_box as box
import numpy as np
import pytest
from lammps_box import PLATE, R, above, attach, dropped, flat, make, state

IN_CONTACT = "run 230"  # of 200 to 301
STARTS = [above(x=0.01), above(x=-0.01), above(y=0.02)]


@pytest.fixture
def scene(model):
    """Three beads that fall on a plate, and the plates."""
    return lambda: box.scene(model, None, STARTS)


@pytest.fixture(scope="module")
def undisturbed(model):
    """Restitution of the three, and their speeds afterwards."""
    rows, now = dropped(model, None, STARTS, steps=630)
    return rows["restitution"], now["v"]


def in_a_file(lmp, tmp_path, commands):
    """Commands that the adapter does not see before they run."""
    path = tmp_path / "in.script"
    path.write_text(commands)
    lmp.file(str(path))


@pytest.mark.parametrize(
    "commands",
    [
        "reset_timestep 0",
        "reset_timestep 7000",
        "change_box all z final -0.03 0.09",
        "change_box all boundary f f p",
        "reset_atoms id",
        "reset_atoms id sort yes",
        "atom_modify sort 1 0.01",
        "set group all type 1",
        "run 10 pre no",
        "run 40 every 10 'print x'",
        "create_atoms 1 single 0.03 0 0.05\nset atom 4 diameter 1e-3 density 879",
        "balance 1.0 shift x 10 1.05",
    ],
)
def test_what_changes_nothing_in_mid_contact(scene, undisturbed, commands):
    """The rebounds have the same bits, also if the beads get other IDs; balancing rounds positions."""
    lmp, walls = scene()
    lmp.command(IN_CONTACT)
    assert (state(lmp)["d2_contactlaw"][:, PLATE] != 0.0).all()
    lmp.commands_string(commands)
    lmp.command("run 400")
    rounding = 1e-10 if "balance" in commands else 0.0
    rebounds, speeds = np.sort(walls.collisions()["restitution"]), np.sort(state(lmp)["v"][:3, 2])
    np.testing.assert_allclose(rebounds, np.sort(undisturbed[0]), rtol=rounding)
    np.testing.assert_allclose(speeds, np.sort(undisturbed[1][:, 2]), rtol=rounding)


@pytest.mark.parametrize("option", ["", " compress no"])
def test_deleted_beads_take_their_contacts_along(scene, undisturbed, option):
    """The other beads keep their contacts, under the IDs that `delete_atoms` gives them."""
    lmp, walls = scene()
    lmp.command(IN_CONTACT)
    lmp.command("group first id 1")
    lmp.command("delete_atoms group first" + option)
    assert sorted(state(lmp)["id"]) == ([2, 3] if option else [1, 2])
    lmp.command("run 400")
    assert walls.collisions()["restitution"].tolist() == undisturbed[0][1:].tolist()
    lmp.commands_string("delete_atoms group all\nrun 100")
    assert len(walls.collisions()) == 2


@pytest.mark.parametrize(
    ("delete", "name", "seen"),
    [
        ("delete_atoms group last", 3, True),
        ("\ndelete_atoms group last\nprint x", 7, True),
        ("delete_atoms group last", 7, False),
    ],
)
def test_a_new_bead_in_the_row_of_a_deleted_one_begins_anew(scene, undisturbed, delete, name, seen):
    """The new bead has the ID of the deleted one, or another. LAMMPS leaves its row as it was."""
    lmp, walls = scene()
    lmp.commands_string(f"{IN_CONTACT}\ngroup last id 3")
    lmp.commands_string(delete) if seen else type(lmp).commands_string(lmp, delete)
    lmp.create_atoms(1, [name], [1], [0.02, 0, R + 1e-4], [0, 0, -5.0])
    lmp.command(f"set atom {name} diameter {2 * R} density {box.DENSITY}")
    assert not state(lmp)["d2_contactlaw"][-1].any()
    lmp.command("reset_atoms id")
    assert sorted(state(lmp)["id"]) == [1, 2, 3]
    lmp.command("run 630")
    assert walls.collisions()["restitution"] == pytest.approx(undisturbed[0], rel=1e-9)


@pytest.mark.parametrize(
    ("commands", "gone"),
    [
        ("unfix contactlaw_halt\nunfix contactlaw\nrun 300", "fix 'contactlaw'"),
        ("unfix contactlaw_force\nrun 300", "fix 'contactlaw_force'"),
        ("run 230\nunfix contactlaw_halt\nunfix contactlaw\nrun 300", "fix 'contactlaw'"),
        ("run 300\nunfix contactlaw\nrun 300", "fix 'contactlaw'"),  # LAMMPS itself fails
        ("variable contactlaw_error delete\nrun 300", "variable 'contactlaw_error'"),
    ],
)
def test_parts_that_a_file_takes_out(scene, model, tmp_path, commands, gone):
    """An error is raised, no segmentation fault; plates can be attached anew afterwards."""
    lmp, walls = scene()
    with pytest.raises(RuntimeError, match=rf"{gone}.*taken out by a command.*detach\(\)"):
        in_a_file(lmp, tmp_path, commands)
    impacts = 3 if commands.startswith("run 300") else 0
    lmp.command("set group all z 0.001 vz -5")
    anew = attach(lmp, model, [flat(1e-3)])
    lmp.command("run 630")
    assert len(anew.collisions()) == 3 and len(walls.collisions()) == impacts


@pytest.mark.parametrize("way", ["string", "file"])
def test_clear_ends_an_attachment(scene, model, tmp_path, way):
    """The record stays, names are free, and plates can be attached again.

    A restart file may bring the adapter's group back.
    """
    lmp, walls = scene()
    path = tmp_path / "old.restart"
    lmp.command(f"write_restart {path}")
    commands = f"run 400\nclear\nread_restart {path}\n{box.MOTION.format(dt=box.DT, gravity=0.0)}"
    lmp.commands_string(commands) if way == "string" else in_a_file(lmp, tmp_path, commands)
    assert "command" not in vars(lmp) and not lmp.has_id("fix", "contactlaw_force")
    lmp.command("minimize 0 0 5 5")
    walls.detach()
    anew = attach(lmp, model, [flat(1e-3)])
    lmp.command("run 630")
    assert len(anew.collisions()) == len(walls.collisions()) == 3


DUMP = "dump d all custom 50 DUMP id type x y z vx vy vz\nrun 500\nundump d"
IN_A_FILE = [
    (IN_CONTACT, "minimize 0 0 10 10", "minimize, rerun: the force of the walls depends on the time steps"),
    (DUMP, "rerun DUMP dump x y z vx vy vz", "at step 50: minimize, rerun: the force"),
    # LAMMPS calls ``fix external`` in set-ups only: beads would fly through plates
    ("run 0", "run_style respa 2 2", "run_style respa: the force of the walls.*use 'run_style verlet'"),
]


@pytest.mark.parametrize(("before", "command", "words"), IN_A_FILE)
def test_what_plates_cannot_follow_in_a_file(scene, tmp_path, before, command, words):
    """It is not taken for time steps: the history of the beads stays."""
    lmp, walls = scene()
    before, command = (text.replace("DUMP", str(tmp_path / "beads.dump")) for text in (before, command))
    lmp.commands_string(before)
    was = state(lmp)
    with pytest.raises(RuntimeError, match=words):
        in_a_file(lmp, tmp_path, command)
    assert np.array_equal(was["d2_contactlaw"], state(lmp)["d2_contactlaw"])
    assert "rerun" in command or np.array_equal(was["x"], state(lmp)["x"])
    lmp.commands_string("run_style verlet\nrun 630")
    assert len(walls.collisions()) == 3


def test_plates_that_nobody_holds_act_all_the_same(model, undisturbed):
    """The plates live as long as the LAMMPS object, and no longer."""
    lmp = make(STARTS)
    attach(lmp, model, [flat(1e-3)])
    gc.collect()
    lmp.command("run 630")
    assert np.array_equal(state(lmp)["v"], undisturbed[1])
    alive = weakref.ref(lmp)
    del lmp
    gc.collect()
    assert alive() is None


def test_methods_take_what_lammps_takes(scene, undisturbed):
    """Named arguments, strings of several commands, and texts that only look like commands work."""
    lmp, walls = scene()
    lmp.command(cmd="run 100")
    lmp.commands_list(cmdlist=["run 100", "run 100"])
    lmp.commands_string('print """\nunfix contactlaw\n"""\nrun 330 # minimize')
    with pytest.raises(TypeError, match="argument"):
        lmp.command()
    assert np.array_equal(walls.collisions()["restitution"], undisturbed[0])
