"""Runs from restarts and on two ranks have the bits of one run; errors reach all ranks."""

import faulthandler
import os
import subprocess
import sys
from pathlib import Path

import lammps_box as box
import numpy as np
import pytest
from lammps_box import PLATE, state
from scenes import MODELS, SCENES

import contactlaw as cl
from contactlaw import style
from contactlaw.engines.record import Kind

# Beads of the softened scene are faster than its softening is for.
pytestmark = pytest.mark.filterwarnings("ignore:softening. an impact:UserWarning")
WORLD = box.MPI.COMM_WORLD
STEPS, DECK = 2400, SCENES["deck"]
RANKS = {"deck": DECK, "softened": DECK._replace(softening=20.0)}
# What breaks on one rank alone, the methods that fail on both, and what they say.
FAULTS = {
    "rows lost": (("gather", "record", "save", "report"), "TypeError: "),
    "not to be sent": (("record", "save", "report"), "RuntimeError: Unsent('out of reach')"),
    "no matplotlib": (("report",), "ImportError: a plot needs matplotlib"),
}


def rain(split="* * *"):
    """200 beads of different size."""
    rng, n = np.random.default_rng(3), 200
    radius, velocity = rng.uniform(0.5e-3, 0.9e-3, n), rng.uniform((-8, -8, -15), (8, 8, -5), (n, 3))
    y, z = rng.uniform((-0.019, 1.7e-3), (0.019, 2.5e-3), (n, 2)).T
    # They come down at the border of the ranks, where the deck has a seam and a hole.
    x = velocity[:, 0] * (z - radius) / velocity[:, 2] + rng.uniform(-2e-5, 1e-5, n)
    return box.make(np.column_stack((x, y, z)), velocity, radius, gravity=9.81, split=split)


def attached(lmp, name):
    """Walls of a scene."""
    scene = RANKS[name]
    return box.attach(lmp, MODELS[1], scene.walls, friction=scene.friction, softening=scene.softening)


def loads_of(walls):
    """What the walls have borne in all steps."""
    return np.concatenate([one.ravel() for one in walls.loads()[1:]])


@pytest.fixture(scope="module", params=RANKS)
def whole(request):
    """A scene in one run: its name, what is left of it, its impacts and loads."""
    lmp = rain()
    walls = attached(lmp, request.param)
    lmp.command(f"run {STEPS}")
    return request.param, state(lmp), walls.gather(), loads_of(walls)


def assert_same(found, expected):
    for name, values in expected.items():
        assert np.array_equal(found[name], values), name


def assert_close(borne, expected):
    assert np.count_nonzero(expected) > 10
    np.testing.assert_allclose(borne, expected, rtol=1e-9, atol=1e-9 * abs(expected).max())


def test_a_restart_in_mid_contact_gives_the_same_bits(whole, tmp_path):
    """After the restart the walls move on from where they were; two records make that of one run."""
    name, ends, impacts, _ = whole
    lmp = rain()
    walls = attached(lmp, name)
    lmp.command("run 1150")
    touching, time = np.count_nonzero(state(lmp)["d2_contactlaw"][:, PLATE]), walls.time
    lmp.command(f"write_restart {tmp_path / 'rain.restart'}")
    walls.save(tmp_path / "1.h5")
    assert touching > 3
    lmp = box.restarted(tmp_path / "rain.restart", gravity=9.81)
    walls = attached(lmp, name)
    assert walls.time == time == 1150 * box.DT
    lmp.command(f"run {STEPS - 1150}")
    assert_same(state(lmp), ends)
    walls.save(tmp_path / "2.h5")
    rows = cl.read_record(tmp_path / "1.h5", tmp_path / "2.h5").rows
    assert rows["time"] == pytest.approx(impacts["time"], abs=1e-18)
    assert all(np.array_equal(rows[name], impacts[name]) for name in box.ALIKE[1:-1])


@pytest.fixture(scope="module")
def two_ranks(tmp_path_factory):
    """What `main` prints on two ranks, and its folder; if one waits for the other, it ends with an error."""
    folder, mpirun = tmp_path_factory.mktemp("ranks"), Path(sys.executable).with_name("mpirun")
    path = os.pathsep.join([str(Path(box.__file__).parent), os.environ.get("PYTHONPATH", "")])
    command, environment = [mpirun, "-np", "2", sys.executable, __file__, folder], os.environ | {"PYTHONPATH": path}
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout, folder


def test_two_ranks_in_many_pieces_give_the_same_bits(whole, two_ranks):
    name, ends, impacts, borne = whole
    with np.load(two_ranks[1] / f"{name}.npz") as out:
        assert out["moved_in_contact"] >= 8
        assert_same(out, ends)
        assert_close(out["borne"], borne)
        for column in ("bead", "plate", "triangle", "restitution", "peak_force"):
            assert np.array_equal(out["rows"][column], impacts[column]), column


def test_a_report_on_two_ranks_has_the_impacts_of_both(two_ranks):
    folder = two_ranks[1] / "report"
    rows, saved = np.load(two_ranks[1] / "deck.npz")["rows"], cl.read_record(folder / "record.h5").rows
    assert all(np.array_equal(saved[name], rows[name]) for name in rows.dtype.names if name != "flags")
    assert f"{np.count_nonzero(rows['kind'] == Kind.IMPACT)} impacts on 2 walls" in (folder / "summary.txt").read_text()


@pytest.mark.parametrize(
    ("words", "count"),
    [
        *((f"{fault}, {name}: {said}", 2) for fault, (methods, said) in FAULTS.items() for name in methods),
        # each of two errors once on each rank, and a later error of LAMMPS does not hide it
        ("caught: bead 1 on wall 0 at step", 4),
        ("caught", 4),
        ("a command without time steps needs no other rank", 1),
        (f"bodies: [1, 3] [{Kind.OF_BODY:d}, {Kind.IMPACT:d}]", 1),  # and one rank without any
        ("2 rows kept", 1),
        ("note: ", 2),
        ("/out/record.h5, and `contactlaw report ", 2),
    ],
)
def test_what_happens_on_one_rank_reaches_all(words, count, two_ranks):
    assert two_ranks[0].count(words) == count


@pytest.mark.parametrize(("name", "beads"), [("Dup", [2]), ("Split", [1, 1]), ("partition", [1, 1])])
def test_plates_work_on_any_communicator(name, beads, two_ranks, model):
    found = [line.split() for line in two_ranks[0].splitlines() if line.startswith(name)]
    assert [int(count) for _, count, _ in found] == beads
    rebound = model.restitution(5.0, box.R, 1e-3)
    assert [float(cor) for *_, cor in found] == pytest.approx([rebound] * len(beads), abs=1e-3)


def in_chunks(folder, name, chunks=120):
    """Run a scene in chunks on every rank; rank 0 writes; return the walls."""
    lmp = rain("2 1 1")
    walls = attached(lmp, name)
    moved, before = 0, [np.array([])] * 2
    for _ in range(chunks):
        lmp.command(f"run {STEPS // chunks}")
        own = state(lmp)
        parts = WORLD.allgather(own["id"][own["d2_contactlaw"][:, PLATE] != 0.0])
        moved += sum(len(np.intersect1d(a, b)) for a, b in zip(before, parts[::-1], strict=True))
        before = parts
    parts = WORLD.gather(own)
    rows, borne = walls.gather(), loads_of(walls)
    if WORLD.rank == 0:
        ends = {name: np.concatenate([part[name] for part in parts]) for name in own}
        ends = {name: values[np.argsort(ends["id"])] for name, values in ends.items()}
        np.savez(folder / name, **ends, rows=rows, moved_in_contact=moved, borne=borne)
    return walls


class Unsent(Exception):
    """Has no copy on another rank."""

    def __init__(self, one, two):
        super().__init__("out of reach")


def broken(walls, fault, patch):
    """Break what one rank alone needs."""
    if fault == "rows lost" and WORLD.rank == 1:
        patch.setattr(walls, "_parts", None)
    elif fault == "not to be sent" and WORLD.rank == 0:
        patch.setattr(walls._contacts, "record", lambda *rows, **made: (_ for _ in ()).throw(Unsent(1, 2)))
    elif fault == "no matplotlib" and WORLD.rank == 0:
        patch.setitem(sys.modules, "matplotlib", None)


BODIES = f"""
    create_atoms 1 single -0.02 0 0.00091
    create_atoms 1 single -0.019 0 0.00241
    create_atoms 1 single 0.02 0 0.00091
    fix number all property/atom mol
    set group all diameter 1.8e-3 density {box.DENSITY} mol 1
    set atom 3 mol 2
    velocity all set 0 0 -1
    group clump id 1 2
    group free id 3
    fix body clump rigid/small molecule
    fix move free nve/sphere
    comm_modify cutoff 0.01
    timestep 1e-7"""


def show(*words):
    sys.stdout.write(" ".join(map(str, words)) + "\n")  # at once, or lines of both ranks mix
    sys.stdout.flush()


def break_each_method(walls, folder):
    paths = {"save": [f"{folder}/run.h5"], "report": [f"{folder}/out"]}
    for fault, (methods, _) in FAULTS.items():
        for name in methods:
            with pytest.MonkeyPatch.context() as patch:
                broken(walls, fault, patch)
                try:
                    getattr(walls, name)(*paths.get(name, ()))
                except Exception as error:
                    notes = [f"\nnote: {note}" for note in getattr(error, "__notes__", ())]
                    show(f"{fault}, {name}: {type(error).__name__}: {error}", *notes)


def make_errors(lmp):
    for commands in ("run 100000", "velocity all set 0 0 -5\nrun 150\nno_command", "print told"):
        lmp.command("set group all z 0.001 vz -5")
        try:
            lmp.commands_string(commands)
        except RuntimeError as error:
            show(f"caught: {error}")


def main(folder):
    """Run the scenes, break each method on one rank, then run on other communicators."""
    model = cl.ImpactModel(box.PAIR, law="myc")
    reported, *_ = [in_chunks(folder, name) for name in RANKS]
    style.png = lambda figure: b""  # the other rank would wait, and take all of its core
    reported.report(folder / "report")
    faulthandler.dump_traceback_later(100, exit=True)
    split = "2 1 1"
    lmp, _ = box.scene(model, None, box.above(x=0.03), dt=4e-7, split=split)
    make_errors(lmp)
    if WORLD.rank == 0:
        lmp.command("variable one equal 1")
        show("a command without time steps needs no other rank")
    both = [box.above(x=0.03), box.above(x=-0.03)]
    lmp, walls = box.scene(model, None, both, split=split)
    lmp.command("run 700")
    break_each_method(walls, folder)
    lmp = box.quiet("atom_modify map array" + box.BOX.format(processors=split) + BODIES)
    bodies = box.attach(lmp, model, [box.flat(1e-3), box.flat(1e-3, height=-0.01)], rigid="body")
    for command in ("run 800", "unfix body", "fix more clump nve/sphere", "run 10"):
        lmp.command(command)
    if (rows := bodies.gather()) is not None:
        show("bodies:", rows["bead"].tolist(), rows["kind"].tolist())
    started = {"Dup": {"comm": WORLD.Dup()}, "Split": {"comm": WORLD.Split(WORLD.rank)}}
    started["partition"] = {"more": ["-partition", "2x1", "-in", "none", "-plog", "none", "-pscreen", "none"]}
    for name, how in started.items():
        lmp, walls = box.scene(model, None, both if name == "Dup" else box.ABOVE, **how)
        lmp.command("run 700")
        if (rows := walls.gather()) is not None:
            show(name, rows.size, rows["restitution"][0])
    WORLD.barrier()
    if WORLD.rank == 0:
        show(cl.read_record(folder / "out/record.h5").rows.size, "rows kept")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
