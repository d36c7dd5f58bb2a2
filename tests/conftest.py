"""Shared set-up; numba must find its cache folder before anything imports it."""

import os
import signal
import subprocess
import sys
from pathlib import Path

# Not a user's. A run finds what earlier ones compiled: the name of the folder in it is a hash of
# the sources, so that no old result can pass.
ROOT = Path(__file__).parent.parent
os.environ["NUMBA_CACHE_DIR"] = str(ROOT / ".pytest_cache/machine-code")

# Tests start hundreds of processes, and each would compile numba's sources again, for 2 s.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# A shell starts background jobs with Ctrl-C ignored, nohup all with SIGHUP, and so would be what
# the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP"):
    signal.signal(signal.SIGHUP, signal.SIG_DFL)

import pytest  # noqa: E402

# A check that several tests share says what it compared, as those in the tests do.
pytest.register_assert_rewrite(*(path.stem for path in (Path(__file__).parent / "shared").glob("*.py")))

from browser import CHROMIUM, browser  # noqa: E402
from command_line import run  # noqa: E402

import contactlaw as cl  # noqa: E402
from contactlaw import _jit, _kept  # noqa: E402

# Or what tests use before they make a model would be compiled in each run anew.
_jit.enable_caching()


# So many impacts that they are not integrated in Python.
FIRST = """
from validation.bench.processes import EVERY_METHOD; exec(EVERY_METHOD)
import numpy as np
from contactlaw.softsphere import Contacts
speed, sizes = np.linspace(1.0, 20.0, 2000), (0.9e-3, 1e-3)
for edges in {}, {"edge": "free", "edge_distance": 1e-3}:
    model.solve(speed, *sizes, **edges)
    Contacts(model, *sizes, **edges).advance(np.array([1e-6]), 1e-9)
model.oblique(speed, 1.0, *sizes, 0.2, method="solve")
"""


@pytest.hookimpl(tryfirst=True)
def pytest_sessionstart(session):
    """Compile what most tests need before workers start: each of them would compile the same."""
    kept = Path(os.environ["NUMBA_CACHE_DIR"], f"contactlaw-{_kept.fingerprint()}")
    if session.config.getoption("dist", "no") != "no" and not any(kept.rglob("*.nbc")):
        commands = ["-c", FIRST], ["docs/examples/plates_lammps.py"]  # which fails without LAMMPS
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": ROOT}
        running = [subprocess.Popen([sys.executable, *one], **quiet) for one in commands]
        for process in running:
            process.wait()


@pytest.fixture(scope="session")
def pair():
    """The paper's pair, Table 1."""
    return cl.Pair("gamma-alumina", "glass")


@pytest.fixture(scope="session")
def model(pair):
    return cl.ImpactModel(pair, law="myc")


@pytest.fixture
def answer(capsys):
    """Run a command line that is answered, and give what it printed."""

    def answered(line):
        made = run(line, capsys)
        assert made.status == 0, made.err
        return made

    return answered


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder to work in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def empty_pictures():
    """Do not render figures, also after a test has undone its `monkeypatch`; see `unrendered`."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("contactlaw.style.png", lambda figure: b"")
        yield


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """A blank page in a browser."""
    if CHROMIUM is None:
        pytest.skip("needs Chromium: apt-get install chromium")
    with browser(tmp_path_factory.mktemp("profile")) as page:
        yield page
