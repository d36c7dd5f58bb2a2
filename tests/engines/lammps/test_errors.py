"""What the LAMMPS adapter refuses, and that every refusal reaches the user."""

import math

import lammps_box as box
import numpy as np
import pytest
from lammps_box import ABOVE, PAIR, R, above, attach, dropped, flat, make, quiet, restarted, scene

import contactlaw as cl


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


HIGH, INSIDE = (0, 0, 0.02), "m deep in the wall.*place it outside"


@pytest.mark.parametrize(
    ("place", "speed", "dt", "commands", "words"),
    [
        (HIGH, 5, 1.9e-4, "run 5000", "further than its radius.*take 0.00018 s at most"),
        (ABOVE, 5, 1e-7, "set group all density 900\nrun 0", "bead 1 at step 0: density: its mass.*of that material"),
        (HIGH, 5, 1e-7, f"set group all density {1.004 * box.DENSITY}\nrun 0", "density: its mass is 2.69488e-06 kg"),
        (above(1e-6), 3, 1e-7, "run 20\ntimestep 1e-6\nrun 200", "timestep: too large for an impact at 3 m/s"),
        *(((0, 0, at * R), v, 1e-7, "run 5000", INSIDE) for at, v in ((0.91, 0), (0.998, 5))),
    ],
)
def test_impacts_that_are_refused(model, place, speed, dt, commands, words):
    """A wrong density at the first step, and not when such a bead comes to a wall, hours later."""
    lmp, _ = scene(model, None, place, (0, 0, -speed), dt=dt)
    with pytest.raises(RuntimeError, match=words):
        lmp.commands_string(commands)


@pytest.mark.parametrize(
    ("ratio", "outside", "words"),
    [(20, "raise", r"too thin.*lambda = \d+\.?\d* is above 5"), (120, "solve", "R/H = 120 is above 100")],
)
def test_a_plate_that_is_too_thin(ratio, outside, words):
    """The impact is not recorded. A foil is refused whatever the model would integrate."""
    lmp, walls = scene(cl.ImpactModel(PAIR, law="myc", outside=outside), [flat(R / ratio)], above(1e-5))
    with pytest.raises(RuntimeError, match=f"thickness: .*{words}.*thicker"):
        lmp.command("run 2000")
    assert len(walls.collisions()) == 0


def test_more_impacts_than_records(model):
    lmp, walls = scene(model, None, [above(x=0.004 * n) for n in range(5)], records=np.int64(3))
    with pytest.raises(RuntimeError, match="records: more than 3 impacts"):
        lmp.command("run 500")
    assert len(walls.collisions()) == 3


@pytest.mark.parametrize("way", ["command", "commands_string", "commands_list", "file"])
def test_an_error_stops_the_run_and_reaches_the_caller_once(model, way, tmp_path):
    """A restart file that the same commands wrote behind it is good for another time step."""
    commands = [] if way == "command" else [f"write_restart {tmp_path / 'bad.restart'}"]
    lmp, _ = scene(model, dt=4e-7)
    text = "\n".join(["run 100000", *commands])
    (tmp_path / "in.run").write_text(text)
    with pytest.raises(RuntimeError, match="timestep"):
        getattr(lmp, way)({"commands_list": text.split("\n"), "file": str(tmp_path / "in.run")}.get(way, text))
    assert lmp.extract_global("ntimestep") <= 200
    lmp.command("run 0")
    if commands:
        lmp = restarted(tmp_path / "bad.restart")
        attach(lmp, model, [flat(1e-3)])
        lmp.command("run 100")


REGION = "region b block 0 1 0 1 -1 1\ncreate_box 1 b"


@pytest.mark.parametrize(
    ("commands", "words"),
    [
        (f"units lj\natom_style sphere\n{REGION}", "units si"),
        (f"units si\natom_style atomic\n{REGION}", "atom_style sphere"),
        ("units si\natom_style sphere", "no simulation box"),
        (f"units si\ndimension 2\natom_style sphere\n{REGION}", "three dimensions"),
    ],
)
def test_another_kind_of_simulation(model, commands, words):
    with pytest.raises(ValueError, match=words):
        attach(quiet(commands), model, [flat(1e-3)])


def test_a_lammps_without_mpi(model, monkeypatch):
    lmp = make(ABOVE)
    monkeypatch.setattr(lmp, "get_mpi_comm", lambda: None)
    with pytest.raises(ValueError, match=r"without MPI: pip install contactlaw\[lammps\]"):
        attach(lmp, model, [flat(1e-3)])


STEEL = cl.ImpactModel(cl.Pair("gamma-alumina", "carbon-steel-1020"), law="myc")
LINED = cl.Layers([("pmma", 1e-3)])


@pytest.mark.parametrize(
    ("argument", "value", "words"),
    [
        ("plates", [], "plates: expected a list"),
        ("plates", flat(1e-3), "plates: expected a list"),
        ("plates", [flat(cl.Shell(LINED, R))], "beads touch 'pmma'"),
        ("plates", [flat(cl.Foundation(1e-3, 1e12), edges="free")], "only bare sheets have edges"),
        *(
            (
                "plates",
                [flat(1e-3, model=cl.ImpactModel(pair, law="hertz"))],
                "needs a model of this law and these beads",
            )
            for pair in (PAIR, cl.Pair("glass", "glass"))
        ),
        ("model", 0.9, "model: expected"),
        ("model", {}, "model: has none for any atom type"),
        ("model", {2: STEEL}, r"types of beads are 1 to 1, got \[2\]"),
        ("friction", math.nan, "friction: got nan; must be finite"),
        ("friction", True, "friction: got True; expected one number"),
        ("softening", 0.5, "softening: got 0.5; must be finite and at least 1"),
        ("parcel", 0.0, "parcel: got 0.0; must be finite and at least 1"),
        ("records", 1e3, "records: got 1000.0; must be a whole number from 1 to 1e9"),
        ("group", "beads", "group: got 'beads'; LAMMPS has none of this name, but all"),
        ("start", math.nan, "start: got nan; must be finite"),
    ],
)
def test_bad_arguments(model, argument, value, words):
    with pytest.raises((ValueError, TypeError), match=words):
        attach(make(ABOVE), **{"model": model, "plates": [flat(1e-3)], argument: value})


def test_a_bead_that_is_likely_in_millimetres_draws_a_warning():
    with pytest.warns(UserWarning, match="radius: 0.2 is 0.2 m; 0.2e-3 for 0.2 mm"):
        attach(make([(0, 0, 0.05)], radius=0.2), cl.ImpactModel(PAIR), [flat(1e-3)])


@pytest.mark.parametrize("theirs", ["fix contactlaw_halt all momentum 1 linear 1 1 1", "group contactlaw id 1"])
def test_names_that_the_user_has_taken_are_refused_and_stay_as_they_are(model, theirs):
    lmp = make(ABOVE)
    lmp.command(theirs)
    kind, name, *_ = theirs.split()
    with pytest.raises(RuntimeError, match=f"{kind} '{name}' already"):
        attach(lmp, model, [flat(1e-3)])
    assert lmp.has_id(kind, name)
