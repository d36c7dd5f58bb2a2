"""What any scene leaves when it is stopped, killed, or refused by the disk; see `test_stop.py`."""

import multiprocessing
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple

import h5py
import numpy as np
import pytest
from demos import names

import contactlaw as cl
from contactlaw.engines.record import IMPACT
from contactlaw.reporting.gallery import Picture
from dem_demo import cli
from dem_demo.kit import disk, session
from dem_demo.kit.recorder import Dataset, Making, Recorder

FRAMES, IMPACTS = 50, 20
PICTURES = {"one.png", "two.png"}
FILES = {"dust.h5", "summary.txt", "index.html", "dust.gif", *PICTURES}


class Frame(NamedTuple):
    noise: np.ndarray  # does not compress


def fall(recorder):
    """An engine that needs none: a run of 0.4 MB."""
    random = np.random.default_rng(1)
    recorder.collisions(np.zeros(IMPACTS, IMPACT))
    for _ in range(FRAMES):
        recorder.frame(Frame(random.random(1000)))


class Dust:
    """A scene whose parts a test may replace."""

    def __init__(self):
        self.before, self.run = lambda: None, fall
        self.figures = SimpleNamespace(names=lambda: ["one", "two"], draw=self.draw)
        self.film = lambda run: b"film" * 10_000

    def draw(self, name, run):
        return Picture(b"picture" * 6000, b"")

    def read(self, folder):
        with h5py.File(folder / "dust.h5") as file:
            frames, impacts = (file[name].size for name in ("trajectories/time", "impacts/time"))
            return SimpleNamespace(reason=file.attrs["reason"], frames=frames, impacts=impacts)

    def start(self, arguments, command):
        self.before()
        show = session.Show(
            "dust", frozenset(), self.figures, self.read, lambda run: f"Dust. {run.reason}",
            lambda run: f"{run.frames} frames", lambda run, pictures, film: f"<p>{run.reason}</p>",
            self.film, lambda error: disk.complaint(error) if isinstance(error, OSError)
            else str(error),
        )  # fmt: skip
        model = cl.ImpactModel(cl.Pair("glass", "glass"))

        def simulate(folder):
            making = Making(model, ("none", "1"), command, show.files, 1.0)
            noise = Dataset("noise", "f8", "1", "noise")
            recorder = Recorder(
                folder / show.record, "dust", making, attributes={}, trajectories=[noise],
                write_scene=lambda file: None, frame_rate=100.0, axes="",
            )  # fmt: skip
            return recorder.record(self.run, show.sentence)

        return session.deliver(arguments.out, show, simulate)


@pytest.fixture
def dust(monkeypatch):
    """The scene that the command runs; its one option is the folder."""
    made = Dust()
    given = SimpleNamespace(
        parse_args=lambda argv: SimpleNamespace(start=made.start, out=Path(argv[-1]))
    )
    monkeypatch.setattr(cli, "parser", lambda: given)
    return made


def main(out):
    return cli.main(["dust", "--out", str(out)])


def fails(error):
    def fail(*_):
        raise error

    return fail


@pytest.mark.parametrize(
    ("stop", "status", "traceback"),
    [
        (lambda: signal.raise_signal(signal.SIGINT), 130, False),
        (lambda: signal.raise_signal(signal.SIGTERM), 143, False),
        (lambda: signal.raise_signal(signal.SIGHUP), 129, False),
        (fails(RuntimeError("in the middle")), 1, False),
        (fails(ValueError("in the middle")), 1, False),
        (fails(KeyError("in the middle")), 1, True),
    ],
    ids=["SIGINT", "SIGTERM", "SIGHUP", "RuntimeError", "ValueError", "KeyError"],
)
def test_what_ends_a_run_in_the_middle_keeps_what_has_been_computed(
    stop, status, traceback, dust, request, tmp_path, capsys
):
    dust.run = lambda recorder: (fall(recorder), stop(), fall(recorder))
    assert main(tmp_path / "out") == status
    errors = capsys.readouterr().err
    assert ("Traceback" in errors) is traceback
    run = dust.read(tmp_path / "out")
    assert (run.frames, run.impacts) == (FRAMES, IMPACTS)
    why = "interrupted by " + request.node.callspec.id if status > 1 else "in the middle"
    assert why in run.reason
    assert errors.splitlines()[-1] == f"dem-demo: partial, {FRAMES} frames: {run.reason}"
    assert names(tmp_path) == {"out"} and names(tmp_path / "out") == FILES
    for file in ("summary.txt", "index.html"):
        assert run.reason in (tmp_path / "out" / file).read_text()


class Dropped:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)  # Python drops exceptions of destructors


@pytest.mark.parametrize("while_it_runs", [True, False])
def test_an_interrupt_that_python_drops_ends_the_run(
    while_it_runs, dust, tmp_path, monkeypatch, capsys
):
    """With its next frame; before the record, nothing is left."""
    monkeypatch.setattr(sys, "unraisablehook", lambda dropped: None)  # pytest has one that warns
    if while_it_runs:
        dust.run = lambda recorder: (Dropped() and None, fall(recorder))
    else:
        dust.before = lambda: Dropped() and None
    assert main(tmp_path / "out") == 130
    if while_it_runs:
        run = dust.read(tmp_path / "out")
        assert (run.reason, run.frames) == ("interrupted by SIGINT", 1)
    else:
        assert "nothing was written" in capsys.readouterr().err
        assert names(tmp_path) == set()


def test_an_interrupt_while_figures_are_drawn_keeps_the_record(dust, tmp_path, capsys):
    dust.figures.draw = lambda name, run: signal.raise_signal(signal.SIGINT)
    assert main(tmp_path / "out") == 130
    assert names(tmp_path / "out") == {"dust.h5"}
    assert dust.read(tmp_path / "out").reason == ""  # the run itself is complete
    assert "index.html is missing: interrupted by SIGINT" in capsys.readouterr().err


def check_what_a_full_disk_leaves(dust, out, capsys):
    assert main(out) == 1
    output, errors = capsys.readouterr()
    assert "Traceback" not in errors
    last = errors.splitlines()[-1]
    assert last.startswith("dem-demo: partial, ") and ": the disk is full (" in last
    run = dust.read(out)
    assert "the disk is full" in run.reason and run.reason in output
    assert (run.frames, run.impacts) == (FRAMES // 2, IMPACTS)
    assert "summary.txt" in names(out)
    assert names(out) <= FILES
    assert not list(out.parent.glob(".unfinished-*"))


def test_a_full_disk_keeps_what_fits(dust, tmp_path, capsys):
    small = tmp_path / "small"
    small.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=320k", "tmpfs", str(small)]
    if shutil.which("mount") is None or subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("mounting a small disk needs more rights")
    try:
        check_what_a_full_disk_leaves(dust, small / "out", capsys)
        assert names(small / "out") < FILES  # no room for all
        for file in (small / "out").glob("*.png"):
            assert file.read_bytes() == dust.draw("", None).wide, file  # whole, or not at all
    finally:
        subprocess.run(["umount", str(small)], check=True)


def test_files_that_may_not_grow_keep_what_fits(dust, tmp_path, capsys):
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, before[1]))
    try:
        check_what_a_full_disk_leaves(dust, tmp_path / "out", capsys)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert names(tmp_path / "out") == FILES


def test_a_killed_run_is_cleaned_up_by_the_next_and_a_living_one_is_not(dust, tmp_path):
    fork = multiprocessing.get_context("fork")

    def begun(name):
        """Process of a run that has begun and does not end, and its temporary folder."""
        inside, known = fork.Event(), {*tmp_path.glob(".unfinished-*")}
        dust.run = lambda recorder: (fall(recorder), inside.set(), time.sleep(60))
        process = fork.Process(target=lambda: sys.exit(main(tmp_path / name)))
        process.start()
        assert inside.wait(30)
        (folder,) = {*tmp_path.glob(".unfinished-*")} - known
        return process, folder

    (living, mine), (killed, other) = begun("living"), begun("killed")
    killed.kill()
    killed.join()
    assert other.exists()
    dust.run = fall
    assert main(tmp_path / "out") == 0
    assert mine.exists() and not other.exists()
    os.kill(living.pid, signal.SIGINT)
    living.join()
    assert living.exitcode == 130
    assert names(tmp_path) == {"living", "out"}


def test_an_earlier_run_is_replaced_as_a_whole(dust, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(out) == 0
    (out / "notes.txt").write_text("mine")
    with h5py.File(out / "dust.h5", "a") as file:  # as if an older version had left a figure
        file.attrs["files"] = [*file.attrs["files"], "old.png"]
    (out / "old.png").write_text("of an earlier run")
    before = (out / "dust.h5").read_bytes()
    capsys.readouterr()
    assert main(out) == 0
    assert f"Written to {out}, in the place of an earlier dust: " in capsys.readouterr().out
    assert names(out) == FILES | {"notes.txt"}
    assert (out / "notes.txt").read_text() == "mine"
    assert (out / "dust.h5").read_bytes() != before


@pytest.mark.parametrize("name", ["index.html", "dust.h5", "summary.txt"])
def test_a_folder_with_other_files_of_our_names_is_refused(name, dust, tmp_path, capsys):
    (tmp_path / name).write_text("mine")
    assert main(tmp_path) == 1
    assert f"--out: {tmp_path} holds {name}, which no dust has left there" in (
        capsys.readouterr().err
    )
    assert names(tmp_path) == {name} and (tmp_path / name).read_text() == "mine"


def test_a_file_in_the_way(dust, tmp_path, capsys):
    path = tmp_path / "out"
    path.write_text("mine")
    assert main(path) == 1
    message = f"dem-demo: --out: {path} is a file, not a folder; name a folder, which may be new\n"
    assert capsys.readouterr().err == message
    assert path.read_text() == "mine"


def test_a_partial_run_does_not_replace_a_complete_one(dust, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(out) == 0
    complete = (out / "dust.h5").read_bytes()
    dust.run = lambda recorder: (fall(recorder), fails(RuntimeError("at the end"))())
    capsys.readouterr()
    assert main(out) == 1
    assert f"Written to {out / 'partial'}: " in capsys.readouterr().out
    assert (out / "dust.h5").read_bytes() == complete
    assert names(out) == FILES | {"partial"} and names(out / "partial") == FILES
    assert dust.read(out / "partial").reason == "at the end"
    dust.run = fall
    assert main(out) == 0
    assert names(out) == FILES


@pytest.mark.parametrize("film", [True, False])
def test_a_picture_that_fails_does_not_cost_the_rest(film, dust, tmp_path, capsys):
    fail = fails(ZeroDivisionError("in a figure"))
    dust.figures.draw, dust.film = (dust.draw, fail) if film else (fail, dust.film)
    assert main(tmp_path / "out") == 1
    missing = {"dust.gif"} if film else PICTURES
    assert names(tmp_path / "out") == FILES - missing
    errors = capsys.readouterr().err
    for name in missing:
        assert f"dem-demo: {name} is missing: in a figure" in errors
