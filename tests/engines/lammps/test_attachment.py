"""The LAMMPS adapter on the real engine: restitution, ranks, restarts, energy, friction."""

import math

import lammps_box as box
import numpy as np
import pytest
from lammps_box import ABOVE, PLATE, R, above, attach, dropped, flat, make, scene, state

import contactlaw as cl
from contactlaw.engines.lammps import Plate, pair_coeff


def test_a_bead_that_is_likely_in_millimetres_draws_a_warning():
    with pytest.warns(UserWarning, match="radius: 0.2 is 0.2 m; 0.2e-3 for 0.2 mm"):
        attach(make([(0, 0, 0.05)], radius=0.2), cl.ImpactModel(box.PAIR), [flat(1e-3)])


# Beads of the softened scene are faster than its softening is for.
pytestmark = pytest.mark.filterwarnings("ignore:softening. an impact:UserWarning")
SCENES = {"shower": box.shower, "drum": box.drum, "softened": box.softened, "barrel": box.barrel}


@pytest.fixture(scope="module", params=SCENES)
def whole(request):
    """A scene in one run: its name, what is left of it, and its impacts."""
    lmp = box.rain()
    walls = SCENES[request.param](lmp)
    lmp.command(f"run {box.STEPS}")
    return request.param, state(lmp), walls.gather(), box.loads_of(walls)


def assert_same(found, expected):
    for name, values in expected.items():
        assert np.array_equal(found[name], values), name


def assert_close(borne, expected):
    assert np.count_nonzero(expected) > 10
    np.testing.assert_allclose(borne, expected, rtol=1e-9, atol=1e-9 * abs(expected).max())


def test_one_run_or_many_give_the_same_bits(whole):
    name, ends, impacts, borne = whole
    lmp = box.rain()
    walls = SCENES[name](lmp)
    for _ in range(24):
        lmp.command(f"run {box.STEPS // 24}")
    assert_same(state(lmp), ends)
    rows = walls.gather()
    assert_close(box.loads_of(walls), borne)
    assert len(rows) > 150
    for column in box.ALIKE:
        assert rows[column] == pytest.approx(impacts[column], rel=1e-9), column


@pytest.fixture(scope="module")
def two_ranks(tmp_path_factory):
    """What two ranks have printed, and the file that they wrote."""
    path = tmp_path_factory.mktemp("ranks") / "shower.npz"
    return box.on_two_ranks(box.__file__, path, 120), path


def test_two_ranks_give_the_same_bits(whole, two_ranks):
    name, ends, impacts, borne = whole
    with np.load(two_ranks[1].with_stem(name)) as out:
        assert out["moved_in_contact"] >= 8
        assert_same(out, ends)
        assert_close(out["borne"], borne)
        for column in ("bead", "plate", "triangle", "restitution", "peak_force"):
            assert np.array_equal(out["rows"][column], impacts[column]), column


def test_a_report_on_two_ranks_has_the_impacts_of_both(two_ranks):
    with np.load(two_ranks[1]) as out:
        rows = out["rows"]
    folder = two_ranks[1].with_name("report")
    saved = cl.read_record(folder / "record.h5").rows
    assert all(np.array_equal(saved[name], rows[name]) for name in rows.dtype.names if name != "flags")
    assert f"{rows.size} impacts on 2 walls" in (folder / "summary.txt").read_text()


def test_an_error_on_one_rank_reaches_both(two_ranks):
    """Each rank raises the error once, and a later error of LAMMPS does not hide it."""
    assert two_ranks[0].count("caught: bead 1 on wall 0 at step") == 4
    assert two_ranks[0].count("caught") == 4


def test_a_command_without_time_steps_needs_no_other_rank(two_ranks):
    assert two_ranks[0].count("alone") == 1


def test_a_restart_in_mid_contact_gives_the_same_bits(whole, tmp_path):
    """After the restart the walls move on from where they were; two records make that of one run."""
    name, ends, impacts, _ = whole
    lmp = box.rain()
    walls = SCENES[name](lmp)
    lmp.command("run 1000")
    touching, time = np.count_nonzero(state(lmp)["d2_contactlaw"][:, PLATE]), walls.time
    lmp.command(f"write_restart {tmp_path / 'rain.restart'}")
    walls.save(tmp_path / "1.h5")
    lmp.close()
    assert touching > 3
    lmp = box.restarted(tmp_path / "rain.restart", gravity=9.81)
    walls = SCENES[name](lmp)
    assert walls.time == time == 1000 * box.DT
    lmp.command(f"run {box.STEPS - 1000}")
    assert_same(state(lmp), ends)
    walls.save(tmp_path / "2.h5")
    rows = cl.read_record(tmp_path / "1.h5", tmp_path / "2.h5").rows
    assert rows["time"] == pytest.approx(impacts["time"], abs=1e-18)
    assert all(np.array_equal(rows[name], impacts[name]) for name in box.ALIKE[1:-1])


def hit_once(model, plates, place=ABOVE, thickness=1e-3):
    """The plate of the one impact of a bead, which goes straight back."""
    (row,), now = dropped(model, plates, place)
    assert row["restitution"] == pytest.approx(model.restitution(5.0, R, thickness), abs=5e-4)
    assert abs(now["v"][0, :2]).max() < 1e-12
    return row["plate"]


def halves(left=1e-3, right=1e-3, order=(0, 1)):
    """Two plates that share the edge x = 0."""
    plates = [flat(left, x=-0.05, width=0.05), flat(right, x=0.0, width=0.05)]
    return [plates[n] for n in order]


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_a_bead_that_crosses_a_seam_takes_its_contact_along(model, order, friction):
    """The bits are those on one plate, also if the bead crosses twice, or moves fast in x."""
    ends = []
    for plates in (halves(order=order), [flat(1e-3)]):
        for side in (-1, 1):
            start = above(2e-6, x=-side * 50e-6)
            lmp, walls = scene(model, plates, start, (side * 20, 0, -5), friction=friction, dt=5e-8)
            lmp.command("run 60")
            assert state(lmp)["d2_contactlaw"][0, PLATE] != 0.0
            assert state(lmp)["x"][0, 0] * side > 0  # the bead crossed while in contact
            lmp.command("run 300")
            (row,) = walls.collisions()
            ends.append((row["restitution"], row["contact_time"], *state(lmp)["v"][0]))
    assert np.array_equal(ends[:2], ends[2:])


@pytest.mark.parametrize(("order", "thickness"), [((0, 1), 0.5e-3), ((1, 0), 3e-3)])
def test_where_two_thicknesses_meet_the_first_plate_is_hit(model, order, thickness):
    assert hit_once(model, halves(0.5e-3, 3e-3, order), thickness=thickness) == 0


def test_a_ridge_is_hit_once(model):
    """A ridge is the edge of a roof, the outer corner of a box, or the rim of tiles."""
    left = Plate((0, -0.05, 0), (-0.03, 0, -0.04), (0, 0.1, 0), 1e-3)
    right = Plate((0, -0.05, 0), (0.03, 0, -0.04), (0, 0.1, 0), 1e-3)
    down = Plate((0, -0.05, 0), (0, 0.1, 0), (0, 0, -0.05), 1e-3)
    level = flat(1e-3, x=-0.05, width=0.05)
    for plates in ([left, right], [right, left], [level, down], [down, level]):
        hit_once(model, plates)
    tiles = [Plate((x, 0, 0), (0.05, 0, 0), (0, 0.05, 0), 1e-3) for x in (-0.05, 0)]
    for x in (-1e-5, 0.0, 1e-5):
        rows, now = dropped(model, tiles, (x, -R - 1e-4, 0), (0, 5, 0))
        assert len(rows) == 1
        assert abs(now["v"][0, 0]) < 1e-12


def test_without_friction_a_bead_keeps_its_spin(model):
    lmp, walls = scene(model, None, above(), (3, 0, -5))
    lmp.command("set group all omega 100 200 300")
    lmp.command("run 700")
    (row,) = walls.collisions()
    assert [row[f"spin_{axis}"] for axis in "xyz"] == [100, 200, 300]
    slip = math.hypot(3 - 200 * R, 100 * R)
    assert row["sliding_speed"] == pytest.approx(slip, rel=1e-9)
    assert row["sliding_speed_after"] == pytest.approx(slip, rel=1e-9)


def test_a_new_bead_knows_nothing_of_the_one_whose_place_it_takes(model):
    """LAMMPS reuses rows of the history as they are."""
    lmp, walls = scene(model, None, [above(1e-5), above(1e-5, x=0.02)])
    lmp.command("run 40")
    old = state(lmp)["d2_contactlaw"]
    assert (old[:, PLATE] == 1.0).all()
    type(lmp).commands_string(lmp, "group gone id 2\ndelete_atoms group gone compress no")  # unseen by the adapter
    lmp.create_atoms(1, [7], [1], [0.03, 0, R + 2e-5], [0, 0, -5.0])
    type(lmp).command(lmp, f"set atom 7 diameter {2 * R} density {box.DENSITY}")
    assert np.array_equal(state(lmp)["d2_contactlaw"][1], old[1])  # otherwise nothing is checked
    lmp.command("run 400")
    rows = walls.collisions()
    assert rows["bead"].tolist() == [1, 7]
    assert rows["restitution"][1] == pytest.approx(rows["restitution"][0], abs=2e-4)


@pytest.mark.parametrize("step", [51, 50, 55, 100000, 0])
def test_the_clock_may_be_reset_in_mid_contact(model, step):
    """A reset of LAMMPS's step counter changes only the times in the record."""
    outcomes = []
    for command in ("", f"reset_timestep {step}"):
        lmp, walls = scene(model, [flat(0.5e-3)], above(1e-5))
        lmp.commands_string(f"run 50\n{command}\nrun 400")
        (row,) = walls.collisions()
        outcomes.append((row, state(lmp)))
    (plain, path), (moved, moved_path) = outcomes
    assert_same(moved_path, path)
    for name in set(box.ALIKE) - {"time", "wall_start"}:
        assert plain[name] == moved[name], name
    shift = step - 50 if step >= 50 else -50  # LAMMPS starts anew at 0 where the step goes back
    for name in ("time", "wall_start"):
        assert moved[name] - plain[name] == pytest.approx(shift * box.DT, abs=1e-12)
    assert plain["time"] == pytest.approx(2e-6, rel=1e-6)


def test_a_bead_that_is_hit_while_it_touches_a_plate(model):
    """The record has the speed of the hit, and the step is checked for it."""
    lmp, walls = scene(model, None, above(1e-9), (0, 0, -0.01))
    lmp.commands_string("run 20\nset atom 1 vz -5\nrun 500")
    (row,) = walls.collisions()
    assert row["approach_speed"] == pytest.approx(5.0, rel=1e-4)
    assert 0.85 < row["restitution"] < 0.95
    lmp, _ = scene(model, None, above(1e-9), (0, 0, -0.01), dt=4e-7)
    lmp.command("run 20")
    with pytest.raises(RuntimeError, match="timestep: too large for an impact at 5 m/s"):
        lmp.commands_string("set atom 1 vz -5\nrun 200")


def test_detach_gives_the_simulation_back(model):
    lmp, walls = scene(model)
    lmp.command("run 100")
    walls.detach()
    walls.detach()
    assert "command" not in vars(lmp)
    assert not [
        name
        for kind in ("fix", "compute", "variable", "group")
        for name in lmp.available_ids(kind)
        if name and "contactlaw" in name
    ]
    lmp.command("run 2000")
    assert lmp.numpy.extract_atom("v")[0, 2] == pytest.approx(-5.0, rel=1e-12)  # through the plate


def test_detach_after_the_simulation_has_changed_or_gone(model):
    lmp, walls = scene(model)
    type(lmp).command(lmp, "unfix contactlaw_force")  # behind the adapter's back
    walls.detach()
    attach(lmp, model, [flat(1e-3)]).detach()
    lmp, walls = scene(model, None, above(1e-5))
    lmp.command("run 500")
    lmp.close()
    walls.detach()
    assert len(walls.collisions()) == 1


def test_detach_restores_the_methods_that_were_there(model):
    lmp = make(ABOVE)
    own = lmp.command
    lmp.command = own
    walls = attach(lmp, model, [flat(1e-3)])
    assert lmp.command is not own
    walls.detach()
    assert lmp.command is own


def test_beads_meet_each_other_and_plates(model):
    """A pair style acts beside the plates: one of two beads that meet rebounds from a plate."""
    lmp = make([above(1e-5), above(2 * R + 1e-4)], (0, 0, -3), dt=5e-8)
    line = pair_coeff("gamma-alumina", radius=R, speed=6.0)
    lmp.commands_string(f"comm_modify vel yes\npair_style granular\n{line}")
    walls = attach(lmp, model, [flat(math.inf)])
    lmp.command("run 4000")
    v = state(lmp)["v"][:, 2]
    # elastic and of equal mass: the lower one rebounds, they swap, it rebounds again
    assert len(walls.collisions()) == 2
    assert v == pytest.approx([3, 3], rel=5e-3)


def test_walls_act_on_the_beads_of_a_group(model):
    """Others fly through, of any mass and speed; a bead that is taken out has left the walls."""
    lmp = make([above(), above(x=0.01), above(x=0.02)])
    lmp.commands_string("group gone id 1\ngroup two id 2\ngroup beads id 1 2\ngroup gone delete")
    lmp.command("set atom 3 density 1 vz -20000")  # further than its radius in a step
    walls = attach(lmp, model, [flat(1e-3)], group="beads")
    lmp.commands_string("run 0\nset atom 3 vz -5\nrun 220")
    assert (state(lmp)["d2_contactlaw"][:, PLATE] != 0.0).tolist() == [True, True, False]
    with pytest.raises(Exception, match="Cannot delete group beads"):
        lmp.command("group beads delete")
    lmp.commands_string("group beads subtract beads two\nrun 1000")
    assert walls.collisions()["bead"].tolist() == [1]
    assert (state(lmp)["v"][1:, 2] < 0.0).all() and state(lmp)["v"][2, 2] == -5.0
    lmp.commands_string("group beads clear\ngroup beads dynamic two every 1\nset atom 2 z 2e-4")
    with pytest.raises(RuntimeError, match="bead 2 on wall 0 .* deep in the wall"):
        lmp.command("run 1")


def test_beads_that_share_a_plate_are_flagged(model):
    """From both sides at once, and by the wave of one before; not far away, late or beside."""
    places = [above(), (0, 0, -R - 1e-4), above(2e-4, x=4e-3), above(x=-0.04), above(2e-3, y=0.03), above(x=0.041)]
    velocity = np.array([(0, 0, -5)] * len(places))
    velocity[1] *= -1
    lmp = make(places, velocity)
    walls = attach(lmp, model, [flat(0.5e-3, width=0.09), flat(0.5e-3, x=0.04)])
    lmp.command("run 6000")
    rows = np.sort(walls.record().rows, order="bead")
    assert (rows["flags"] & cl.Validity.SHARED_PLATE > 0).tolist() == [True, True, True, False, False, False]
