"""The LAMMPS adapter on two ranks: any communicator, and errors that one rank alone makes."""

import faulthandler
import sys

import lammps_box as box
import numpy as np
import pytest

import contactlaw as cl

WORLD = box.MPI.COMM_WORLD
FAULTS = {
    "rows lost": ("gather", "record", "save", "report"),
    "no record": ("record", "save", "report"),
    "not to be sent": ("record",),
    "no matplotlib": ("report",),
    "detached": ("loads",),
}
MESSAGES = {
    "rows lost": "TypeError: ",
    "no record": "ZeroDivisionError: division by zero",
    "not to be sent": "RuntimeError: Unsent('out of reach')",
    "no matplotlib": "ImportError: a plot needs matplotlib",
    "detached": "RuntimeError: {}: the walls were detached",
}


@pytest.fixture(scope="module")
def output(tmp_path_factory):
    """What `main` prints on two ranks; if one waits for the other, it ends with an error."""
    return box.on_two_ranks(__file__, tmp_path_factory.mktemp("ranks"))


@pytest.mark.parametrize(
    ("fault", "method"), [(fault, method) for fault, methods in FAULTS.items() for method in methods]
)
def test_an_error_on_one_rank_is_raised_on_all(fault, method, output):
    assert output.count(f"{fault}, {method}: {MESSAGES[fault].format(method)}") == 2


def test_rows_that_an_earlier_run_has_left_are_refused(output):
    assert "2 rows of both ranks" in output
    assert "mixed: " in output and "hits.1.npy: " in output and "hits.0.npy is of another run" in output


def test_a_report_that_cannot_be_drawn_keeps_its_record(output):
    notes = [line for line in output.splitlines() if line.startswith("note: ")]
    assert len(notes) == 2 and notes[0] == notes[1]
    assert "/out/record.h5, and `contactlaw report " in notes[0] and "2 rows kept" in output


@pytest.mark.parametrize("name", ["Dup", "Split", "partition"])
def test_plates_work_on_any_communicator(name, output, model):
    rebound = model.restitution(5.0, box.R, 1e-3)
    found = [line.split() for line in output.splitlines() if line.startswith(name)]
    beads = {"Dup": [2], "Split": [1, 1], "partition": [1, 1]}[name]
    assert [int(count) for _, count, _ in found] == beads
    assert [float(cor) for *_, cor in found] == pytest.approx([rebound] * len(beads), abs=1e-3)


class Unsent(Exception):
    """Has no copy on another rank."""

    def __init__(self, one, two):
        super().__init__("out of reach")


def broken(walls, fault, patch):
    """Break what one rank alone needs."""
    if fault == "rows lost" and WORLD.rank == 1:
        patch.setattr(walls, "_parts", None)
    elif fault == "no record" and WORLD.rank == 0:
        patch.setattr(walls._contacts, "record", lambda *rows, **made: 1 / 0)
    elif fault == "not to be sent" and WORLD.rank == 0:
        patch.setattr(walls._contacts, "record", lambda *rows, **made: (_ for _ in ()).throw(Unsent(1, 2)))
    elif fault == "no matplotlib" and WORLD.rank == 0:
        patch.setitem(sys.modules, "matplotlib", None)
    elif fault == "detached" and WORLD.rank == 1:
        patch.setattr(walls, "_attached", False)


def main(folder):
    """Break each method on one rank; then run on other communicators."""
    model = cl.ImpactModel(box.PAIR, law="myc")
    lmp, walls = box.scene(model, None, [box.above(x=0.03), box.above(x=-0.03)], processors="2 1 1")
    lmp.command("run 700")
    faulthandler.dump_traceback_later(100, exit=True)  # the force is compiled, which may take long
    paths = {"save": ["run.h5"], "report": ["out"]}
    for fault, methods in FAULTS.items():
        for name in methods:
            with pytest.MonkeyPatch.context() as patch:
                broken(walls, fault, patch)
                try:
                    getattr(walls, name)(*(f"{folder}/{path}" for path in paths.get(name, ())))
                except Exception as error:
                    text = f"{fault}, {name}: {type(error).__name__}: {error}\n"
                    text += "".join(f"note: {note}\n" for note in getattr(error, "__notes__", ()))
                    print(text, end="", flush=True)
    if WORLD.rank == 0:
        print(f"{cl.read_record(f'{folder}/out/record.h5').rows.size} rows kept")
    np.save(f"{folder}/hits.{WORLD.rank}.npy", walls.collisions())
    started = {"Dup": {"comm": WORLD.Dup()}, "Split": {"comm": WORLD.Split(WORLD.rank)}}
    started["partition"] = {"more": ["-partition", "2x1", "-in", "none", "-plog", "none", "-pscreen", "none"]}
    for name, how in started.items():
        places = [box.above(x=0.03), box.above(x=-0.03)] if name == "Dup" else [box.above()]
        lmp, walls = box.scene(model, None, places, **how)
        lmp.command("run 700")
        if (rows := walls.gather()) is not None:
            print(f"{name} {rows.size} {rows['restitution'][0]}\n", end="", flush=True)
    WORLD.barrier()
    if WORLD.rank == 0:
        files = [f"{folder}/hits.{rank}.npy" for rank in range(2)]
        print(f"{cl.read_record(*files).rows.size} rows of both ranks")
        np.save(files[0], rows)
        try:
            cl.read_record(*files)
        except ValueError as error:
            print(f"mixed: {error}")


if __name__ == "__main__":
    main(sys.argv[1])
