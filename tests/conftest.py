"""Shared set-up; numba must find a fresh cache folder before anything imports it."""

import os
import signal
import sys
import tempfile
from pathlib import Path

# A stale cache would let an old result pass; and the tests must not write into a user's folders.
# Workers of one run share theirs.
if "PYTEST_XDIST_WORKER" not in os.environ:
    _CACHE = tempfile.TemporaryDirectory(prefix="contactlaw-numba-")
    os.environ["NUMBA_CACHE_DIR"] = _CACHE.name

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
pytest.register_assert_rewrite(
    *(path.stem for path in (Path(__file__).parent / "shared").glob("*.py"))
)

from browser import CHROMIUM, browser  # noqa: E402

import contactlaw as cl  # noqa: E402


@pytest.fixture(scope="session")
def pair():
    """The paper's pair, Table 1."""
    return cl.Pair("gamma-alumina", "glass")


@pytest.fixture(scope="session")
def model(pair):
    return cl.ImpactModel(pair, law="myc")


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
