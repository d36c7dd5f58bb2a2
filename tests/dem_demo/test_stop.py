"""`dem-demo rain` that is stopped, killed, refused by the model or by the disk: what is kept."""

import os
import resource
import shutil
import signal
import subprocess
import sys
import time

import h5py
import pytest
import unrendered

import contactlaw as cl
from dem_demo import cli
from dem_demo.rain import engines, figures
from dem_demo.rain.record import read

COMMAND = [sys.executable, "-m", "dem_demo"]
SMALL = ["rain", "--beads", "40", "--plates", "0.5e-3,1e-3,inf", "--duration", "0.3"]
SMALL += ["--law", "myc"]
FILES = {"rain.h5", "summary.txt", "index.html", "rain.gif"}
FILES |= {f"{name}.png" for name in figures.names()}
LONG = ["rain", "--beads", "300", "--duration", "6", "--law", "myc"]  # is stopped before its end
LARGE = ["rain", "--beads", "150", "--duration", "1", "--law", "myc"]  # its record has 0.4 MB


def names(folder):
    return {path.name for path in folder.iterdir()}


# The command, which prints a line when the rain has begun.
BEGINS = """
import sys
from dem_demo import cli
from dem_demo.kit.recorder import Recorder

def frame(self, frame, real=Recorder.frame):
    real(self, frame)
    if len(self._frames) == 50:
        print("It rains", flush=True)

Recorder.frame = frame
sys.exit(cli.main(sys.argv[1:]))
"""


def start(command, folder, **more):
    return subprocess.Popen(
        command, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more
    )


def raining(argv, folder, first=""):
    """Start the command, after a line of Python, and wait until it rains."""
    process = subprocess.Popen(
        [sys.executable, "-c", first + BEGINS, *argv], cwd=folder, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert process.stdout.readline() == "It rains\n"
    return process


@pytest.mark.parametrize(
    ("number", "status", "first"),
    [
        (signal.SIGINT, 130, ""),
        (signal.SIGTERM, 143, unrendered.FIRST),
        (signal.SIGHUP, 129, unrendered.FIRST),
    ],
    ids=["SIGINT", "SIGTERM", "SIGHUP"],
)
def test_an_interrupt_in_the_middle_keeps_what_has_been_computed(number, status, first, tmp_path):
    process = raining([*LONG, "--out", "out"], tmp_path, first)
    process.send_signal(number)
    output, errors = process.communicate(timeout=120)
    assert process.returncode == status
    assert "Traceback" not in errors
    run = read(tmp_path / "out" / "rain.h5")
    assert run.reason == f"interrupted by {number.name}"
    last = errors.splitlines()[-1]
    assert last.startswith("dem-demo: partial, ")
    assert last.endswith(f" of 6 s: {run.reason}")
    assert "Written to out" in output.splitlines()[-1]
    assert names(tmp_path) == {"out"}
    assert names(tmp_path / "out") == FILES
    assert 0 < run.time.size < 1_200
    assert run.collisions.size > 0
    for file in ("summary.txt", "index.html"):
        assert run.reason in (tmp_path / "out" / file).read_text()


def test_an_interrupt_before_it_rains_leaves_nothing(tmp_path):
    process = start([*COMMAND, *LONG, "--out", "out"], tmp_path)
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=120)
    assert process.returncode in (130, -signal.SIGINT)  # -SIGINT: Python itself was still starting
    assert "nothing was written" in errors or "KeyboardInterrupt" in errors
    assert names(tmp_path) == set()


def test_an_interrupt_that_python_drops_ends_the_rain_with_its_next_frame(
    tmp_path, empty_pictures, monkeypatch, capsys
):
    class Thing:
        def __del__(self):
            signal.raise_signal(signal.SIGINT)  # Python drops exceptions of destructors

    def run(scene, model, recorder):
        Thing()
        real(scene, model, recorder)

    engine = engines.load("pymunk")
    real = engine.run
    monkeypatch.setattr(engine, "run", run)
    monkeypatch.setattr(sys, "unraisablehook", lambda dropped: None)  # pytest has one that warns
    assert cli.main([*SMALL, "--out", str(tmp_path / "out")]) == 130
    rain = read(tmp_path / "out" / "rain.h5")
    assert (rain.reason, rain.time.size) == ("interrupted by SIGINT", 1)


def test_an_interrupt_that_python_drops_before_the_record_leaves_nothing(
    tmp_path, monkeypatch, capsys
):
    class Thing:
        def __del__(self):
            signal.raise_signal(signal.SIGINT)

    def load(name, real=engines.load):
        Thing()
        return real(name)

    monkeypatch.setattr(engines, "load", load)
    monkeypatch.setattr(sys, "unraisablehook", lambda dropped: None)
    assert cli.main([*SMALL, "--out", str(tmp_path / "out")]) == 130
    assert "nothing was written" in capsys.readouterr().err
    assert names(tmp_path) == set()


def test_an_interrupt_while_figures_are_drawn_keeps_the_record(tmp_path, monkeypatch, capsys):
    def draw(name, run, real=figures.draw):
        if name == sorted(figures.names())[2]:
            os.kill(os.getpid(), signal.SIGINT)
        return real(name, run)

    monkeypatch.setattr(figures, "draw", draw)
    assert cli.main([*SMALL, "--out", str(tmp_path / "out")]) == 130
    assert names(tmp_path / "out") == {"rain.h5"}
    assert read(tmp_path / "out" / "rain.h5").reason == ""  # the rain itself is complete
    assert "index.html is missing: interrupted by SIGINT" in capsys.readouterr().err


class Failing:
    """A model that raises an error after some impacts."""

    def __init__(self, error):
        self.error, self.left = error, 20

    def curve(self, model, radius, thickness):
        real = type(model)._real_curve(model, radius, thickness)

        def restitution(speed):
            self.left -= 1
            if self.left < 0:
                raise self.error
            return real(speed)

        return restitution


@pytest.mark.parametrize(
    ("failure", "traceback"), [(RuntimeError, False), (ValueError, False), (KeyError, True)]
)
def test_a_failing_impact_keeps_those_before_it(
    failure, traceback, empty_pictures, monkeypatch, tmp_path, capsys
):
    failing = Failing(failure("in the middle"))
    monkeypatch.setattr(cl.ImpactModel, "_real_curve", cl.ImpactModel.curve, raising=False)
    monkeypatch.setattr(cl.ImpactModel, "curve", lambda *arguments: failing.curve(*arguments))
    assert cli.main([*SMALL, "--out", str(tmp_path / "out")]) == 1
    errors = capsys.readouterr().err
    assert ("Traceback" in errors) is traceback
    last = errors.splitlines()[-1]
    assert last.startswith("dem-demo: partial, 0.")
    for part in ("bead ", "(radius 0.", " on plate ", " m/s, t = ", "in the middle"):
        assert part in last
    assert names(tmp_path / "out") == FILES
    monkeypatch.undo()
    run = read(tmp_path / "out" / "rain.h5")
    assert 10 < run.collisions.size <= 20
    assert run.reason in last


def test_an_impact_outside_the_table_names_what_would_help(tmp_path, empty_pictures, capsys):
    """Beads of bearing steel hit each other harder than the law's table reaches."""
    hard = ["rain", "--sphere", "carbon-steel-1020", "--law", "myc", "--duration", "0.3"]
    hard += ["--beads", "40", "--out", str(tmp_path / "out")]
    assert cli.main(hard) == 1
    (refusal,) = capsys.readouterr().err.splitlines()
    for part in ("bead of carbon-steel-1020", "on the plate of 0.5 mm", " m/s: ", "chi = "):
        assert part in refusal
    for remedy in ("--law fem", "--outside solve", "--outside clamp", "(--speed)"):
        assert remedy in refusal
    assert "ImpactModel" not in refusal
    assert names(tmp_path) == set()
    assert cli.main([*hard, "--outside", "clamp"]) == 0
    assert "outside the table, the value is that of its border" in capsys.readouterr().out


# One of each kind: elastic, metals (the softest, without a rate, with one), polymer, rubber.
KINDS = "glass", "lead", "aluminium-6061-t6", "aluminium-2024-t351", "pmma", "epdm"


@pytest.mark.parametrize(
    "sphere",
    [one if one in KINDS else pytest.param(one, marks=pytest.mark.long) for one in cl.materials()],
)
def test_every_bead_of_the_catalogue_runs_with_the_law_fem(sphere, tmp_path, monkeypatch, capsys):
    """The beads fall on glass at up to 15 m/s."""
    if sphere != "glass":  # draw for one pair only, of bodies that do not yield: drawing is slow
        monkeypatch.setattr("dem_demo.kit.session.make", lambda show, run, folder: {})
    few = ["rain", "--law", "fem", "--beads", "15", "--duration", "0.2", "--plates", "1e-3,3e-3"]
    # lead is so weak, and rubber so soft, that they are compressed deeper than their tables reach
    if sphere in ("lead", "natural-rubber", "epdm"):
        few += ["--outside", "solve"]
    few += ["--sphere", sphere, "--out", str(tmp_path / "out")]
    assert cli.main(few) == 0, capsys.readouterr().err
    run = read(tmp_path / "out" / "rain.h5")
    assert run.law == "fem"
    assert run.collisions.size > 0


def test_a_killed_run_is_cleaned_up_by_the_next_and_a_living_one_is_not(tmp_path, empty_pictures):
    living = raining([*LONG, "--out", "living"], tmp_path, unrendered.FIRST)
    (mine,) = tmp_path.glob(".unfinished-*")
    killed = raining([*LONG, "--out", "killed"], tmp_path)
    (other,) = {*tmp_path.glob(".unfinished-*")} - {mine}
    killed.send_signal(signal.SIGKILL)
    killed.communicate()
    assert other.exists()
    assert cli.main([*SMALL, "--out", str(tmp_path / "out")]) == 0
    assert not other.exists()
    assert mine.exists()
    living.send_signal(signal.SIGINT)
    living.communicate(timeout=120)
    assert names(tmp_path) == {"living", "out"}


def check_what_a_full_disk_leaves(process, folder):
    output, errors = process.communicate(timeout=300)
    assert process.returncode == 1, errors
    assert "Traceback" not in errors
    last = errors.splitlines()[-1]
    assert last.startswith("dem-demo: partial, ")
    assert ": the disk is full (" in last
    assert "Partial, " in output
    run = read(folder / "rain.h5")
    assert "the disk is full" in run.reason
    assert run.time.size > 0
    assert "summary.txt" in names(folder)
    assert names(folder) <= FILES
    assert not list(folder.parent.glob(".unfinished-*"))


def test_a_full_disk_keeps_what_fits(tmp_path):
    small = tmp_path / "small"
    small.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=320k", "tmpfs", str(small)]
    if shutil.which("mount") is None or subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("mounting a small disk needs more rights")
    try:
        check_what_a_full_disk_leaves(
            start([*COMMAND, *LARGE, "--out", "small/out"], tmp_path), small / "out"
        )
        for file in (small / "out").glob("*.png"):
            assert file.read_bytes().endswith(b"IEND\xaeB`\x82"), file  # whole, or not at all
    finally:
        subprocess.run(["umount", str(small)], check=True)


def test_files_that_may_not_grow_keep_what_fits(tmp_path):
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, 300_000))

    environment = {**os.environ, "CONTACTLAW_NO_CACHE": "1"}
    command = [*unrendered.COMMAND, *LARGE, "--out", "out"]
    process = start(command, tmp_path, preexec_fn=limit, env=environment)
    check_what_a_full_disk_leaves(process, tmp_path / "out")


def test_an_earlier_rain_is_replaced_as_a_whole(tmp_path, empty_pictures, capsys):
    out = tmp_path / "out"
    assert cli.main([*SMALL, "--out", str(out)]) == 0
    (out / "notes.txt").write_text("mine")
    with h5py.File(out / "rain.h5", "a") as file:  # as if an older version had left a figure
        file.attrs["files"] = [*file.attrs["files"], "old.png"]
    (out / "old.png").write_text("of an earlier rain")
    before = (out / "rain.h5").read_bytes()
    capsys.readouterr()
    assert cli.main([*SMALL, "--seed", "2", "--out", str(out)]) == 0
    assert f"Written to {out}, in the place of an earlier rain: " in capsys.readouterr().out
    assert names(out) == FILES | {"notes.txt"}
    assert (out / "notes.txt").read_text() == "mine"
    assert (out / "rain.h5").read_bytes() != before


@pytest.mark.parametrize("name", ["index.html", "rain.h5", "summary.txt"])
def test_a_folder_with_other_files_of_our_names_is_refused(name, tmp_path, capsys):
    (tmp_path / name).write_text("mine")
    assert cli.main([*SMALL, "--out", str(tmp_path)]) == 1
    assert (
        f"--out: {tmp_path} holds {name}, which no rain has left there" in capsys.readouterr().err
    )
    assert names(tmp_path) == {name}
    assert (tmp_path / name).read_text() == "mine"


def test_a_partial_rain_does_not_replace_a_complete_one(
    tmp_path, empty_pictures, monkeypatch, capsys
):
    out = tmp_path / "out"
    assert cli.main([*SMALL, "--out", str(out)]) == 0
    complete = (out / "rain.h5").read_bytes()

    real = engines.load("pymunk").run

    def fail(scene, model, recorder):
        real(scene, model, recorder)
        raise RuntimeError("at the end")

    monkeypatch.setattr("dem_demo.rain.engines.pymunk.run", fail)
    capsys.readouterr()
    assert cli.main([*SMALL, "--out", str(out)]) == 1
    assert f"Written to {out / 'partial'}: " in capsys.readouterr().out
    assert (out / "rain.h5").read_bytes() == complete
    assert names(out) == FILES | {"partial"}
    assert names(out / "partial") == FILES
    assert read(out / "partial" / "rain.h5").reason == "at the end"
    monkeypatch.undo()
    assert cli.main([*SMALL, "--out", str(out)]) == 0
    assert names(out) == FILES


@pytest.mark.parametrize("product", ["dem_demo.rain.figures.draw", "dem_demo.rain.film.gif"])
def test_a_figure_that_fails_does_not_cost_the_rest(product, tmp_path, monkeypatch, capsys):
    def fail(*arguments):
        raise ZeroDivisionError("in a figure")

    monkeypatch.setattr(product, fail)
    assert cli.main([*SMALL, "--out", str(tmp_path / "out")]) == 1
    errors = capsys.readouterr().err
    missing = FILES - names(tmp_path / "out")
    assert missing == ({"rain.gif"} if "gif" in product else FILES & {*map(str, missing)})
    for name in missing:
        assert f"dem-demo: {name} is missing: in a figure" in errors
    assert {"rain.h5", "summary.txt", "index.html"} <= names(tmp_path / "out")
