"""Without numba's compiler, and without a folder to keep its code in."""

import importlib.util
import json
import math
import os
import random
import shutil
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


def answers(**oblique):
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
        "sliding": model.oblique(2.0, 1.0, 1e-3, 3e-3, 0.2, **oblique).sliding_speed,
        "collide": model.collide([[1.0, 0, -2.0], [1.0, 0, 2]], 0, [0, 0, 1], 1e-3, 3e-3, 0.2)[0],
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


WITHOUT = f"""
import sys, warnings
warnings.simplefilter("error")
sys.path[:0] = {[str(ROOT / "tests"), str(ROOT / "tests/shared")]!r}
import json, needs, test_jit
import contactlaw as cl
print(json.dumps(test_jit.answers()))
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


def test_without_the_compiler_all_answers_are_there_and_c_functions_are_refused(tmp_path):
    process = start(WITHOUT, tmp_path, NUMBA_DISABLE_JIT="1")
    compiled = answers(method="solve")
    printed, *refusals = output(process)[0].splitlines()
    interpreted = json.loads(printed)
    assert interpreted.keys() == compiled.keys()
    for name, values in compiled.items():
        # Here both integrate; but `collide` has a table when compiled, with an error of its own.
        exact = {"sliding": 1e-6, "collide": 1e-3}.get(name, 1e-9)
        assert interpreted[name] == pytest.approx(values, rel=exact, abs=exact), name
    assert list(tmp_path.rglob("home/*")) == []
    assert len(refusals) == 2 + needs.has_lammps()
    for line in refusals:
        assert line.startswith("numba is switched off (NUMBA_DISABLE_JIT is set), and ")


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
    ("code", "variables", "warned"),
    [
        (FIRST, {"CONTACTLAW_CACHE_DIR": "/proc/x"}, 1),
        (HOMELESS + FIRST, {"XDG_CACHE_HOME": None, "CONTACTLAW_CACHE_DIR": None}, 1),
        (FULL + FIRST, {}, 1),
        (FIRST, {"CONTACTLAW_NO_CACHE": "1", "CONTACTLAW_CACHE_DIR": None}, 0),
    ],
    ids=["a folder that cannot be made", "no home", "a full disk", "switched off"],
)
def test_without_a_folder_there_is_an_answer_and_at_most_one_warning(
    tmp_path, code, variables, warned
):
    out, errors = output(start(code, tmp_path, **variables))
    check_first(out)
    assert errors.count("Warning") == warned
    assert errors.count("numba cannot keep compiled code on disk") == warned
    assert errors.count("set NUMBA_CACHE_DIR to a writable folder") == warned
    if not warned:
        assert {path.name for path in tmp_path.rglob("*")} == {"home", "tmp"}
        assert list(Path(cl.__file__).parent.rglob("*.nb?")) == []


DAMAGES = {
    "emptied": lambda content, at: b"",
    "truncated": lambda content, at: content[: at + 1],
    "one bit": lambda content, at: content[:at] + bytes([content[at] ^ 4]) + content[at + 1 :],
    "lengthened": lambda content, at: content + b"\0",
}


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_a_damaged_file_of_machine_code_is_made_anew(damage, suffix, tmp_path):
    (tmp_path / "little.py").write_text("def twice(x):\n    return 2.0 * x\n")
    spec = importlib.util.spec_from_file_location("little", tmp_path / "little.py")
    little = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(little)
    _jit.enable_caching()  # from here on a kernel has the disk when it is made

    def hits():
        """Of a kernel made as the next process would."""
        kernel = _jit.kernel(cache=True)(little.twice)
        del _jit._cached[-1:]
        assert kernel(21.0) == 42.0
        return sum(kernel.stats.cache_hits.values()), Path(kernel.stats.cache_path)

    folder = hits()[1]
    (path,) = folder.glob(f"little.twice*.{suffix}")
    choose, found = random.Random(1), []
    for _ in range(8):
        content = path.read_bytes()
        path.write_bytes(damage(content, choose.randrange(len(content) - 1)))
        found += [hits()[0], hits()[0]]
    assert found == [0, 1] * 8  # compiled, and then read
    assert len(list(folder.iterdir())) == 2
    shutil.rmtree(folder)


TWINS = """
from math import cos, sin
from contactlaw import _jit

def made_with(sign):
    @_jit.kernel
    def value(x):
        y = x
        TERMS
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
""".replace("TERMS", "y += sin(y) * cos(y + x);" * 60)  # too much to be inlined


def test_kernels_of_one_name_stay_apart_in_the_code_of_several_processes(tmp_path):
    """Kernels of the equation's legs share a name: the same lines make each from its own force."""
    (tmp_path / "twins.py").write_text(TWINS)
    folder = {"CONTACTLAW_CACHE_DIR": str(tmp_path / "kept"), "PYTHONPATH": str(tmp_path)}
    code = "import twins as t; print(t.{}(0.1), t.{}(0.1))"
    outputs = [
        output(start(code.format(*names), tmp_path, **folder))[0].split()
        for names in (("first", "first"), ("second", "second"), ("first", "second"))
    ]
    (one, _), (other, _), both = (list(map(float, words)) for words in outputs)
    assert one == -other and both == [one, other]


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


@pytest.mark.parametrize(
    "given",
    [
        [one for one in COMMANDS if one.split()[1] in ("cor", "constant", "history")],
        pytest.param(COMMANDS, marks=pytest.mark.long),
    ],
    ids=["common", "all"],
)
def test_a_second_process_compiles_nothing(given, tmp_path):
    """A kernel that several commands need is read, or compiled, by the first that needs it."""
    given = [one for one in given if one not in IN_LAMMPS or needs.has_lammps()]
    rain = next((n for n, one in enumerate(given) if one.startswith("dem-demo rain")), None)
    words = [
        one.replace("RAIN", f"{tmp_path}/out{rain}").replace("OUT", f"{tmp_path}/out{n}").split()
        for n, one in enumerate(given)
    ]
    for _ in range(2):
        done = subprocess.run(
            [sys.executable, "-c", COUNTED], input=json.dumps(words),
            cwd=ROOT / "docs/examples", capture_output=True, text=True,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
    found = dict(zip(given, json.loads(done.stdout.splitlines()[-1]), strict=True))
    assert {one: seen for one, seen in found.items() if seen != [0, []]} == {}


def test_every_subcommand_has_its_second_process():
    names = {name for name, one in parsers(cli.parser()) if one.get_default("run")}
    names |= {f"dem-demo {scene}" for scene in scenes()}
    assert {name for name in names for command in COMMANDS if command.startswith(name)} == names
