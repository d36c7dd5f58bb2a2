"""Without numba's compiler, and without a folder to keep its code in."""

import importlib.util
import itertools
import json
import math
import os
import random
import subprocess
import sys
from pathlib import Path

import needs
import numpy as np
import pytest
from command_line import parsers
from places import ROOT

import contactlaw as cl
from contactlaw import _jit, cli
from contactlaw.softsphere import Contacts
from dem_demo.cli import scenes

IMPACT = (12.0, 0.9e-3, 1e-3)
VALUES = ("restitution", "contact_time", "peak_force", "plastic_fraction", "wave_fraction")


def answers():
    """Answers of every method of a model; without the compiler an impact takes milliseconds."""
    pair = cl.Pair("gamma-alumina", "glass")
    model = cl.ImpactModel(pair, law="myc")
    contacts = Contacts(model, 0.9e-3, 1e-3)
    moved = model.sensitivity(*IMPACT)
    solver = cl.ImpactModel(pair, law="myc", outside="solve")
    found = {
        "scalar": model.restitution(*IMPACT),
        "batch": model.restitution([5.0, 12.0], 0.9e-3, [[1e-3], [math.inf]]),
        "lookup": [getattr(model.lookup(*IMPACT), name) for name in VALUES],
        "spheres": model.lookup_sphere_sphere(12.0, 1e-3, 1e-3).restitution,
        "solve": [getattr(model.solve(*IMPACT), name) for name in VALUES],
        "half-space": model.solve(5.0, 1e-3, math.inf).contact_time,
        "elastic": cl.ImpactModel(pair, law="hertz").solve(*IMPACT).restitution,
        "beyond the table": solver.restitution(900.0, 1e-3, 1e-3),
        "history": model.force_history(*IMPACT, samples=5).force,
        "history by solver": model.force_history(*IMPACT, samples=5, method="solve").force,
        "sensitivity": [moved.speed, moved.thickness, moved.yield_strength],
        "yield speed": model.yield_speed(0.9e-3, [1e-3, math.inf]),
        "curve": model.curve(0.9e-3, 1e-3)(12.0),
        "sphere curve": model.sphere_sphere_curve(1e-3, 1e-3)(12.0),
        "kernel": model.kernel(*IMPACT),
        "oblique": model.oblique(12.0, 5.0, 0.9e-3, 1e-3, 0.3, method="solve").sliding_speed,
        "outside, from the kernel": int(math.isnan(model.kernel(1e4, 0.9e-3, 1e-3))),
        "steps": [
            contacts.advance(np.array([depth]), 1e-7)[0] for depth in (1e-6, 5e-6, 9e-6, 5e-6)
        ],
    }
    return {name: np.ravel(value).tolist() for name, value in found.items()}


def start(code, tmp_path, stderr=subprocess.PIPE, **variables):
    """Start a process in a home of its own; a variable that is None is taken away."""
    environment = {
        **os.environ,
        "HOME": str(tmp_path / "home"),
        "XDG_CACHE_HOME": str(tmp_path / "home" / "cache"),
        "TMPDIR": str(tmp_path / "tmp"),
        "PYTHONDONTWRITEBYTECODE": "1",
        "NUMBA_CACHE_DIR": None,
    } | variables
    (tmp_path / "home").mkdir(exist_ok=True)
    (tmp_path / "tmp").mkdir(exist_ok=True)
    return subprocess.Popen(
        [sys.executable, "-c", code],
        env={name: value for name, value in environment.items() if value is not None},
        stdout=subprocess.PIPE,
        stderr=stderr,
        text=True,
    )


def output(process):
    """Output of a process, and its warnings."""
    out, errors = process.communicate(timeout=200)
    assert process.returncode == 0, errors
    return out, errors


WITHOUT = "import sys, warnings; warnings.simplefilter('error'); sys.path[:0] = {path!r}\n"
WITHOUT = WITHOUT.format(path=[str(ROOT / "tests"), str(ROOT / "tests/shared")])


def test_all_answers_without_the_compiler(tmp_path):
    code = WITHOUT + "import json, test_jit; print(json.dumps(test_jit.answers()))"
    process = start(code, tmp_path, NUMBA_DISABLE_JIT="1")
    compiled = answers()
    interpreted = json.loads(output(process)[0])
    assert interpreted.keys() == compiled.keys()
    for name, values in compiled.items():
        assert interpreted[name] == pytest.approx(values, rel=1e-9, abs=1e-9), name
    assert list(tmp_path.rglob("home/*")) == []


def test_oblique_impacts_without_the_compiler(tmp_path):
    # its table would take hours, so both integrate
    code = """
import json
import contactlaw as cl
model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
hit = model.oblique(2.0, 1.0, 1e-3, 3e-3, 0.2)
new, _ = model.collide([[1.0, 0, -2.0], [1.0, 0, 2.0]], 0, [0, 0, 1], 1e-3, 3e-3, 0.2)
print(json.dumps([hit.sliding_speed, *new.ravel()]))
try:
    model.collide_kernel
except RuntimeError as error:
    print(error)
"""
    out, _ = output(start(WITHOUT + code, tmp_path, NUMBA_DISABLE_JIT="1"))
    numbers, refusal = out.splitlines()
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    hit = model.oblique(2.0, 1.0, 1e-3, 3e-3, 0.2, method="solve")
    rows = [hit.tangential_restitution, 0, 2 * hit.restitution, 1, 0, 2]
    assert json.loads(numbers) == pytest.approx([hit.sliding_speed, *rows], abs=1e-6)
    assert refusal.startswith("numba is switched off (NUMBA_DISABLE_JIT is set)")


REFUSALS = """
import contactlaw as cl
model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
def refused(attempt):
    try:
        attempt()
    except RuntimeError as error:
        print(error)
refused(lambda: model.address)
"""
REFUSED = "numba is switched off (NUMBA_DISABLE_JIT is set), and a C function needs its compiler\n"


def test_c_functions_are_refused_in_one_line(tmp_path):
    out, _ = output(start(WITHOUT + REFUSALS, tmp_path, NUMBA_DISABLE_JIT="1"))
    assert out == REFUSED


def test_lammps_is_refused_in_one_line(tmp_path):
    needs.lammps()
    code = WITHOUT + REFUSALS + (
        "import lammps_box\nrefused(lambda: lammps_box.scene(model))\n"
    )  # fmt: skip
    out, _ = output(start(code, tmp_path, NUMBA_DISABLE_JIT="1"))
    assert out == 2 * REFUSED


FIRST = """
import contactlaw as cl
model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
print(model.restitution(5.0, 0.9e-3, 1e-3), model.force_law.loading(2.5))
"""  # kernels that take little time to compile
HOMELESS = """
import os, pwd
del os.environ["HOME"]
pwd.getpwuid = pwd.getpwnam = {}.__getitem__  # as in a container of a user without an entry
"""
FULL = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))"


def check_first(out):
    assert [float(word) for word in out.split()] == pytest.approx([0.908113, 13.839771], abs=1e-6)


@pytest.mark.parametrize(
    ("code", "variables"),
    [
        (FIRST, {"CONTACTLAW_CACHE_DIR": "/proc/x"}),
        (HOMELESS + FIRST, {"XDG_CACHE_HOME": None, "CONTACTLAW_CACHE_DIR": None}),
        (FULL + FIRST, {}),
    ],
    ids=["a folder that cannot be made", "no home", "a full disk"],
)
def test_without_a_folder_there_is_an_answer_and_one_warning(tmp_path, code, variables):
    out, errors = output(start(code, tmp_path, **variables))
    check_first(out)
    assert errors.count("Warning") == 1
    assert errors.count("numba cannot keep compiled code on disk") == 1
    assert "set NUMBA_CACHE_DIR to a writable folder" in errors


def test_switched_off_nothing_is_written(tmp_path):
    package = Path(cl.__file__).parent

    def files():
        return {*tmp_path.rglob("*"), *package.rglob("*.nb?")}

    process = start(FIRST, tmp_path, CONTACTLAW_NO_CACHE="1", CONTACTLAW_CACHE_DIR=None)
    before = files()
    out, errors = output(process)
    check_first(out)
    assert errors == ""
    assert files() == before


def emptied(content, _):
    return b""


def truncated(content, choose):
    return content[: choose.randrange(1, len(content))]


def flipped(content, choose):
    """Flip one bit, like a failing disk."""
    damaged = bytearray(content)
    damaged[choose.randrange(len(content))] ^= 1 << choose.randrange(8)
    return bytes(damaged)


def lengthened(content, _):
    return content + b"\0"


DAMAGES = (emptied, truncated, flipped, lengthened)


@pytest.fixture
def kept_kernel(tmp_path):
    """Give a function that makes a kernel as the next process would, and its folder."""
    (tmp_path / "little.py").write_text("def twice(x):\n    return 2.0 * x\n")
    spec = importlib.util.spec_from_file_location("little", tmp_path / "little.py")
    little = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(little)
    _jit.enable_caching()  # from here on a kernel has the disk when it is made
    made = _jit.kernel(cache=True)(little.twice)
    made(1.0)
    yield lambda: _jit.kernel(cache=True)(little.twice), Path(made.stats.cache_path)
    del _jit._cached[-1:]


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_file_of_machine_code_is_made_anew(damage, suffix, kept_kernel):
    kernel, folder = kept_kernel
    choose, hits = random.Random(1), []
    (path,) = folder.glob(f"little.twice*.{suffix}")
    whole = {path: path.read_bytes() for path in folder.glob("little.*")}
    for _ in range(8):
        path.write_bytes(damage(path.read_bytes(), choose))
        for _ in range(2):
            again = kernel()
            assert again(21.0) == 42.0
            hits.append(sum(again.stats.cache_hits.values()))
    assert hits == [0, 1] * 8  # compiled, and then read
    assert {path: path.read_bytes() for path in folder.glob("little.*")}.keys() == whole.keys()


def test_a_damaged_c_function_is_made_anew(kept_kernel):
    import ctypes

    kernel, folder = kept_kernel
    double = kernel().py_func

    def answer():
        made = _jit.c_function("float64(float64)", double, cache=True)
        return ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(made.address)(21.0), made

    for path in folder.glob("little.*"):  # the kernel's
        path.unlink()
    assert answer()[0] == 42.0
    for path, damage in itertools.product(sorted(folder.glob("little.*")), DAMAGES):
        path.write_bytes(damage(path.read_bytes(), random.Random(2)))
        for hits in (0, 1):
            value, made = answer()
            assert (value, made.cache_hits) == (42.0, hits)


@pytest.mark.long
def test_two_processes_that_start_at_once_both_answer(tmp_path):
    """So do processes after them, whatever has happened to the files meanwhile."""
    folder = tmp_path / "kept"
    both = [start(FIRST, tmp_path, CONTACTLAW_CACHE_DIR=str(folder)) for _ in range(2)]
    results = [output(process) for process in both]
    for out, errors in results:
        check_first(out)
        assert errors == ""
    assert results[0] == results[1]
    (kept,) = folder.glob("contactlaw-*")
    before = {path: path.stat().st_mtime_ns for path in kept.rglob("*.nbc")}
    assert before
    assert output(start(FIRST, tmp_path, CONTACTLAW_CACHE_DIR=str(folder))) == results[0]
    assert {path: path.stat().st_mtime_ns for path in kept.rglob("*.nbc")} == before  # none written
    files, choose = sorted(kept.rglob("*.nb?")), random.Random(3)
    for path, damage in zip(files, itertools.cycle(DAMAGES)):  # each another of index and data
        path.write_bytes(damage(path.read_bytes(), choose))
    assert output(start(FIRST, tmp_path, CONTACTLAW_CACHE_DIR=str(folder))) == results[0]
    rebuilt = {path: path.stat().st_mtime_ns for path in files}
    assert output(start(FIRST, tmp_path, CONTACTLAW_CACHE_DIR=str(folder))) == results[0]
    assert {path: path.stat().st_mtime_ns for path in kept.rglob("*.nb?")} == rebuilt


TWINS = """
import math
from contactlaw import _jit

def made_with(sign):
    @_jit.kernel
    def value(x):
        y = x
        {terms}
        return sign(y)
    return value

@_jit.kernel
def plus(y):
    return y

@_jit.kernel
def minus(y):
    return -y

above, below = made_with(plus), made_with(minus)

@_jit.kernel(cache=True)
def first(x):
    return above(x)

@_jit.kernel(cache=True)
def second(x):
    return below(x)

_jit.enable_caching()
"""


def test_kernels_of_one_name_stay_apart_in_the_code_of_several_processes(tmp_path):
    """Kernels of the equation's legs share a name: the same lines make each from its own force."""
    terms = "\n        ".join(
        "y += math.sin(y) * math.cos(y + x)" for _ in range(60)
    )  # not inlined
    (tmp_path / "twins.py").write_text(TWINS.format(terms=terms))
    folder = {"CONTACTLAW_CACHE_DIR": str(tmp_path / "kept"), "PYTHONPATH": str(tmp_path)}
    outputs = [
        output(start(f"import twins; print({calls})", tmp_path, **folder))
        for calls in (
            "twins.first(0.1)",
            "twins.second(0.1)",
            "twins.first(0.1), twins.second(0.1)",
        )
    ]
    one, other, *both = [float(word) for out, _ in outputs for word in out.split()]
    assert one == -other
    assert both == [one, other]


def test_the_first_process_says_that_it_compiles(tmp_path):
    """It says so once, and on a terminal only; the tests above show that pipes stay quiet.

    An import writes nothing at all; the first answer, machine code where numba keeps it.
    """
    import pty

    folder = {"NUMBA_CACHE_DIR": str(tmp_path / "numba")}
    output(start("import contactlaw", tmp_path, **folder))
    for expected in (1, 0):
        assert {path.name for path in tmp_path.rglob("*")} >= {"home", "tmp"}
        assert (tmp_path / "numba").exists() == (expected == 0)
        ours, its = pty.openpty()
        check_first(output(start(FIRST, tmp_path, its, **folder))[0])
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
    f"contactlaw sweep {BEAD} --thickness 1mm,2mm --speed 1:5:3 --out OUT.csv",
    f"contactlaw speed-table {BEAD} --thickness 1mm --slowest 1 --fastest 10",
    f"contactlaw constant {BEAD} --thickness 1mm --speed 1,5 --lammps",
    f"contactlaw oblique {BEAD} --thickness 1mm --speed 5 --angle 30 --friction 0.2",
    f"contactlaw oblique {BEAD} --thickness 1mm --speed 5 --angle 9,60 --friction 1 --plot OUT.png",
    f"contactlaw oblique {BEAD} --thickness 1mm --speed 5 --angle 9,60 --friction 1 --fluent OUT.c",
    f"contactlaw history {BEAD} --thickness 1mm --speed 5",
    f"contactlaw history {BEAD} --thickness 1mm --speed 5 --solve",
    f"contactlaw fit rebounds.csv {BEAD} --thickness 1mm --unknown yield_strength",
    "contactlaw materials",
    f"contactlaw thickness {BEAD} --cor 0.8 --speed 5",
    f"contactlaw speed {BEAD} --cor 0.8 --thickness 1mm",
    f"contactlaw explore {PAIR} --out OUT.html",
    f"contactlaw export header {PAIR} --table none --out OUT.h",
    f"contactlaw export header {PAIR} --out OUT.h",
    f"contactlaw export liggghts {PAIR} --out OUT",
    "contactlaw table info",
    "contactlaw table check --points 100",
    f"contactlaw table build --law jackson_green {PAIR} --out OUT.h5",
    f"dem-demo rain {DEMO} 5 --plates 1mm --duration 0.05",
    "contactlaw report RAIN/rain.h5 --out OUT",
    f"dem-demo sieve {DEMO} 12 --duration 0.004 --speed 2.5",
    f"dem-demo drum {DEMO} 4 --duration 0.01 --speed 2.5",
]
IN_LAMMPS = COMMANDS[-2:]
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


@pytest.fixture(scope="module")
def second(tmp_path_factory):
    """What `in_a_second_process` gives for all commands."""
    given = [one for one in COMMANDS if one not in IN_LAMMPS or needs.has_lammps()]
    return in_a_second_process(given, tmp_path_factory.mktemp("commands"))


def in_a_second_process(given, folder):
    """Status of each command, and what it compiles, in the second process that gives them all.

    A kernel that one of them needs is read, or compiled, by the first that needs it.
    """
    rain = next((n for n, one in enumerate(given) if one.startswith("dem-demo rain")), None)
    given_rain = [one.replace("RAIN", str(folder / f"out{rain}")) for one in given]
    words = [
        one.replace("OUT", str(folder / f"out{n}")).split() for n, one in enumerate(given_rain)
    ]
    for _ in range(2):
        done = subprocess.run(
            [sys.executable, "-c", COUNTED], input=json.dumps(words),
            cwd=ROOT / "docs/examples", capture_output=True, text=True,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
    return dict(zip(given, json.loads(done.stdout.splitlines()[-1]), strict=True))


def test_a_second_process_of_common_commands_compiles_nothing(tmp_path):
    given = [one for one in COMMANDS if one.split()[1] in ("cor", "constant", "history")]
    assert set(map(repr, in_a_second_process(given, tmp_path).values())) == {"[0, []]"}


@pytest.mark.long
@pytest.mark.parametrize("command", COMMANDS)
def test_a_second_process_compiles_nothing(command, second):
    if command in IN_LAMMPS:
        needs.lammps()
    assert second[command] == [0, []]


def test_every_subcommand_has_its_second_process():
    names = {name for name, one in parsers(cli.parser()) if one.get_default("run")}
    names |= {f"dem-demo {scene}" for scene in scenes()}
    assert {name for name in names for command in COMMANDS if command.startswith(name)} == names
