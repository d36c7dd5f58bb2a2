"""Without numba's compiler, and without a folder to keep its code in."""

import json
import os
import re
import runpy
import subprocess
import sys
import time
from warnings import catch_warnings, simplefilter

import needs
import numba
import pytest
from command_line import parsers
from forked import fill_disk, in_child, lose_home
from lasting import long
from places import ROOT

from contactlaw import _folder, _jit, _kept, cli, laws
from dem_demo.cli import scenes

PRIVATE = ROOT / "contactlaw/_numba.py"


def run(code, tmp_path, stderr=subprocess.PIPE, **variables):
    """Output of a process in a home of its own."""
    for folder in ("home", "tmp"):
        (tmp_path / folder).mkdir(exist_ok=True)
    home = {
        "HOME": str(tmp_path / "home"),
        "XDG_CACHE_HOME": str(tmp_path / "home" / "cache"),
        "TMPDIR": str(tmp_path / "tmp"),
        "NUMBA_CACHE_DIR": "",
    }
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | home | variables,
        timeout=200,
        stdout=subprocess.PIPE,
        stderr=stderr,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


WITHOUT = f"""
import sys, warnings
warnings.simplefilter("error")
sys.path.insert(0, {str(ROOT / "tests/shared")!r})
import needs
import contactlaw as cl
model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
def scene():
    import lammps_box
    lammps_box.scene(model)
asked = [lambda: model.address, lambda: model.collide_kernel]
for attempt in asked + [scene] * needs.has_lammps():
    try:
        attempt()
    except RuntimeError as error:
        print(error)
"""
# Every method of a model, beside another integration, closed forms, and each other.
ANSWERS = [
    "test_mass.py::test_it_is_as_a_sphere_of_another_density[myc]",
    "test_mass.py::test_the_equation_in_si_units",
    "test_model.py::test_sphere_on_sphere",
    "test_softsphere.py::test_unloading_and_reloading_follow_one_curve_down_to_the_dent",
    "answers/test_oblique.py::test_without_friction_or_sliding_nothing_changes_along_the_plate[table]",
]


def test_without_the_compiler_all_answers_are_there_and_c_functions_are_refused(tmp_path):
    """An impact then takes milliseconds."""
    refusals = run(WITHOUT, tmp_path, NUMBA_DISABLE_JIT="1").splitlines()
    assert list(tmp_path.rglob("home/*")) == []
    assert len(refusals) == 2 + needs.has_lammps()
    for line in refusals:
        assert line.startswith("numba is switched off (NUMBA_DISABLE_JIT is set), and ")
    tests = [f"{ROOT}/tests/{name}" for name in ANSWERS]
    code = f"import pytest; assert not pytest.main(['-p', 'no:cacheprovider', *{tests}])"
    assert f"{len(tests) + 2} passed" in run(code, tmp_path, NUMBA_DISABLE_JIT="1")


RENAMED = f"""
import sys
sys.path.insert(0, {str(ROOT / "tests/shared")!r})
import renamed_numba
from contactlaw import _jit, laws
print(_jit.private, laws.law("myc").loading(2.5))
"""


def test_without_a_private_name_of_numba_public_names_serve(tmp_path):
    """CI runs more of the tests like this: python -m pytest -p renamed_numba."""
    private, load = run(RENAMED, tmp_path).split()
    assert private == "None"
    assert float(load) == pytest.approx(laws.law("myc").loading(2.5), rel=1e-12)


def test_private_names_of_numba_stand_in_one_file():
    sources = {path: path.read_text() for path in (ROOT / "contactlaw").rglob("*.py")}
    assert {path for path, text in sources.items() if re.search(r"numba\.(core|misc|np)\b", text)} == {PRIVATE}


def test_private_names_are_taken_of_versions_that_were_tested_alone(monkeypatch):
    """If numba is newer than any that was tested: run all tests, and raise the number in `_numba`."""
    assert _jit.private
    version = numba.version_info
    monkeypatch.setattr(numba, "version_info", version._replace(short=(version.major, version.minor + 1)))
    with pytest.raises(ImportError, match="newer than contactlaw was tested with"):
        runpy.run_path(str(PRIVATE))


@pytest.fixture
def twice(tmp_path, monkeypatch):
    """Call a kernel as the next process would, and tell where its machine code is."""
    (tmp_path / "little.py").write_text("def twice(x):\n    return 2.0 * x\n")
    python = runpy.run_path(str(tmp_path / "little.py"))["twice"]
    monkeypatch.setattr(_jit, "_cached", [])
    monkeypatch.setattr(_kept.config, "CACHE_DIR", "")
    monkeypatch.setenv("CONTACTLAW_CACHE_DIR", str(tmp_path / "kept"))

    def called():
        for cached in (_kept.code_folder, _kept.warn_once, _folder.is_private):
            cached.cache_clear()
        kernel = _jit.kernel(cache=True)(python)
        assert kernel(21.0) == 42.0
        return kernel.stats

    yield called
    _kept.code_folder.cache_clear()


@pytest.mark.parametrize(
    ("change", "given", "warnings"),
    [
        (lambda: None, {"CONTACTLAW_CACHE_DIR": "/proc/x"}, 1),
        (lose_home, {}, 1),
        (fill_disk, {}, 1),
        (lambda: None, {"CONTACTLAW_NO_CACHE": "1"}, 0),
    ],
    ids=["a folder that cannot be made", "no home", "a full disk", "switched off"],
)
def test_without_a_folder_there_is_an_answer_and_at_most_one_warning(change, given, warnings, twice, tmp_path):
    def said():
        os.environ.update(given)
        change()
        with catch_warnings(record=True) as caught:
            simplefilter("always")
            twice()
        return [str(one.message) for one in caught]

    found = in_child(said)
    assert len(found) == warnings
    for one in found:
        assert one.startswith("numba cannot keep compiled code on disk")
        assert "set NUMBA_CACHE_DIR to a writable folder" in one
    assert [*tmp_path.rglob("*.nbc")] == []


def test_only_machine_code_that_nobody_uses_is_deleted(tmp_path, monkeypatch):
    """Neither results of the user, nor what a link leads to, nor another user's code."""
    monkeypatch.setattr(_kept.config, "CACHE_DIR", str(tmp_path / "home"))
    home = tmp_path / "home"

    def used_by(version):
        monkeypatch.setattr(_kept, "fingerprint", lambda: 16 * version)
        return _kept.code_folder.__wrapped__()

    unused, used, linked, theirs = map(used_by, "abcd")
    if os.geteuid() == 0:
        for path in (theirs, *theirs.iterdir()):
            os.chown(path, 65534, -1)
    linked.rename(tmp_path / "elsewhere")
    linked.symlink_to(tmp_path / "elsewhere")
    for name in ("results", 16 * "e", "0123456789abcdef0"):
        (home / f"contactlaw-{name}").mkdir()
        (home / f"contactlaw-{name}" / "impacts.csv").touch()
    before = set(tmp_path.rglob("*"))
    for path in before:
        os.utime(path, (0, time.time() - 31 * 86400))
    used_by("b")
    deleted_at_this_moment = home / f"contactlaw-{16 * 'f'}"
    deleted_at_this_moment.symlink_to(tmp_path / "nowhere")
    assert used_by("9") and used.is_dir()
    gone = {unused} if os.geteuid() == 0 else {unused, theirs}
    assert {path for path in before if not path.exists() and path.parent == home} == gone


TWINS = """
from math import cos, sin
from contactlaw._jit import enable_caching, kernel

def made_with(sign):
    @kernel
    def value(x):
        y = x
        TERMS
        return sign(y)
    return value

@kernel
def plus(y):
    return y

@kernel
def minus(y):
    return -y

above, below = made_with(plus), made_with(minus)

@kernel(cache=True)
def first(x):
    return above(x)

@kernel(cache=True)
def second(x):
    return below(x)

enable_caching()
""".replace("TERMS", "y += sin(y) * cos(y + x);" * 60)  # too much to be inlined


def test_kernels_of_one_name_stay_apart_in_the_code_of_several_processes(tmp_path):
    """Kernels of the equation's legs share a name: the same lines make each from its own force."""
    (tmp_path / "twins.py").write_text(TWINS)
    folder = {"CONTACTLAW_CACHE_DIR": str(tmp_path / "kept"), "PYTHONPATH": str(tmp_path)}
    calls = "t.first(0.1)", "t.second(0.1)", "t.first(0.1), t.second(0.1)"
    one, other, both = (
        [*map(float, run(f"import twins as t; print({call})", tmp_path, **folder).split())] for call in calls
    )
    assert one[0] == -other[0] and both == one + other


KEEP = """
from contactlaw import _jit, model  # with kernels, which are not compiled here
_jit.enable_caching()
"""


def test_the_first_process_says_that_it_compiles(tmp_path):
    """It says so once, and on a terminal only; an import writes nothing at all."""
    folder = {"NUMBA_CACHE_DIR": str(tmp_path / "numba")}
    run("import contactlaw", tmp_path, **folder)
    assert not (tmp_path / "numba").exists()
    for expected in (1, 0):
        ours, its = os.openpty()
        run(KEEP, tmp_path, its, **folder)
        os.write(its, b"end\n")
        said = ""
        while not said.endswith("end\r\n"):  # a terminal gives line by line
            said += os.read(ours, 10_000).decode()
        assert said.count("compiles") == expected and said.count("\n") == expected + 1
        os.close(ours)
        os.close(its)
    assert list(tmp_path.glob("home/*")) == list(tmp_path.glob("tmp/*")) == []


# Every subcommand with what it needs; in the folder of the examples.
PAIR = "--sphere gamma-alumina --plate glass"
BEAD = f"{PAIR} --radius 0.9mm"
DEMO = "--out OUT --beads"
COMMANDS = [
    f"contactlaw cor {BEAD} --thickness 1mm --speed 5",
    f"contactlaw cor {BEAD} --thickness 1mm --speed 1:5:4 --plot OUT.png",
    f"contactlaw cor {BEAD} --thickness 1mm,2mm --speed 1:5:3 --out OUT.csv",
    f"contactlaw constant --table {BEAD} --thickness 1mm --speed 1,10",
    f"contactlaw constant {BEAD} --thickness 1mm --speed 1,5",
    f"contactlaw cor {BEAD} --thickness 1mm --speed 5 --angle 30 --friction 0.2",
    f"contactlaw cor {BEAD} --thickness 1mm --speed 5 --angle 9,60 --friction 1 --plot OUT.png",
    f"contactlaw cor --history {BEAD} --thickness 1mm --speed 5",
    f"contactlaw fit rebounds.csv {BEAD} --thickness 1mm --unknown yield_strength",
    f"contactlaw compare rebounds.csv {BEAD} --thickness 1mm",
    "contactlaw materials",
    f"contactlaw find thickness {BEAD} --cor 0.8 --speed 5",
    f"contactlaw find speed {BEAD} --cor 0.8 --thickness 1mm",
    f"contactlaw explore {PAIR} --out OUT.html",
    f"contactlaw export header {PAIR} --table none --out OUT.h",
    f"contactlaw export header {PAIR} --out OUT.h",
    "contactlaw export lammps --out OUT",
    f"contactlaw export liggghts {PAIR} --out OUT",
    "contactlaw table info",
    "contactlaw table check --points 100",
    f"contactlaw table build --law jackson_green {PAIR} --out OUT.h5",
    f"dem-demo rain {DEMO} 5 --plates 1mm --duration 0.05",
    "contactlaw report RAIN/rain.h5 --out OUT",
    f"dem-demo sieve {DEMO} 12 --duration 0.004 --speed 2.5",
]
IN_LAMMPS = COMMANDS[-1:]
# Runs each of the commands that it is given; tells their status, and the kernels that they compile.
COUNTED = """
import json, sys
from numba.core import event
import contactlaw.cli, contactlaw.style, dem_demo.cli

# to draw takes kernels, to render takes only time
contactlaw.style.png = lambda figure: b""

class Compiled(event.Listener):
    def on_start(self, event):
        names.append(event.data["dispatcher"].py_func.__name__)
    def on_end(self, event):
        pass

event.register("numba:compile", Compiled())
found = []
for program, *words in json.load(sys.stdin):
    names = []
    main = contactlaw.cli.main if program == "contactlaw" else dem_demo.cli.main
    found.append((main(words), names))
print(json.dumps(found))
"""


@pytest.mark.parametrize(
    "given", [[one for one in COMMANDS if one.split()[1] in ("cor", "constant")], long(COMMANDS)], ids=["common", "all"]
)
def test_a_second_process_compiles_nothing(given, tmp_path):
    """A kernel that several commands need is read, or compiled, by the first that needs it."""
    given = [one for one in given if one not in IN_LAMMPS or needs.has_lammps()]
    rain = next((n for n, one in enumerate(given) if one.startswith("dem-demo rain")), None)
    words = [
        one.replace("RAIN", f"{tmp_path}/out{rain}").replace("OUT", f"{tmp_path}/out{n}").split()
        for n, one in enumerate(given)
    ]
    nothing = [[0, []]] * len(given)
    for _ in range(2):
        done = subprocess.run(
            [sys.executable, "-c", COUNTED],
            input=json.dumps(words),
            cwd=ROOT / "docs/examples",
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
        if (found := json.loads(done.stdout.splitlines()[-1])) == nothing:
            break
    assert dict(zip(given, found, strict=True)) == dict(zip(given, nothing, strict=True))


def test_every_subcommand_has_its_second_process():
    names = {name for name, one in parsers(cli.parser()) if one.get_default("run")}
    names |= {f"dem-demo {scene}" for scene in scenes()}
    assert {name for name in names for command in COMMANDS if command.startswith(name)} == names
