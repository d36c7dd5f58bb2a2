"""The shape of the package, held by tests rather than by good intentions."""

import ast
import collections
import io
import os
import re
import shutil
import subprocess
import sys
import tokenize
from pathlib import Path

import pytest

import contactlaw
from contactlaw import _kept

ROOT = Path(contactlaw.__file__).parent
# From the bottom to the top; what stands in one layer imports from layers below and from its own.
LAYERS = """
_version
_arrays _bisect _errors _folder _numba
_kept
_jit
_spline
emit  # kernels in other languages; knows none of them
equation  # no units, no files
laws
_atomic _template _content _escaped _readable parser
table
quantities style
physical  # SI units
record  # of impacts, and its file
answers  # by a table or by the solver
fitting
model  # where the towers meet
histories  # of the impacts of a record
spectrum sensor
comparison dashpot walls
stepping  # the contacts of a time step; no engine
softsphere
export reporting
engines
cli
"""
LAYERS = [{*line.partition("#")[0].split()} for line in LAYERS.strip().splitlines()]
# Within a folder, the same: the order of its files.
FILES = """
equation: force outcome elastic tangential corrections edge recall numbers legs losses motion notes integrator
  near_edge zener
table: lookup grid sweep shapes certificate table slides file cache
answers: few backend solver tabulated yields beads compiled constant loads oblique derivatives
  sensitivity speed_table law_errors uncertainty find
walls: memory profile edges motion plate round mesh facet grid frame surface rest
stepping: edge spring energy friction rigid bounce softened plate_rows trouble contact bead step
fitting: drops measurements unknowns predictions errors search identify notes fit
emit: types languages program function
export: functions page_functions c_header liggghts_wall scene_file lammps_fix web_page
record: columns hdf5 file
reporting: limits page surface meshes run summary charts figures files
engines/lammps: beads bodies memory callback attachment
engines/pymunk: friction handlers models record registry edges lookahead contacts impacts attachment
cli/parts: wording table columns impacts bands options figure own rebounds chosen measured
cli/constant: records walls
cli/cor: tables figures files
cli/fit: printed
physical: arguments flight kind hardness flow materials plates pair impacts rate responses law strengths
  scaling measured validity history bodies rebound oblique
"""
ENTRIES = (entry.partition(":") for entry in re.split(r"\n(?! )", FILES.strip()))  # a line of spaces goes on
FILES = {folder: names.split() for folder, _, names in ENTRIES}
KERNELS = [*(ROOT / "equation").glob("[a-z]*.py"), *(ROOT / f"table/{name}.py" for name in ("lookup", "grid"))]
LAWS = sorted((ROOT / "laws").glob("*[a-z].py"))
PLAIN = """
__future__ collections contactlaw dataclasses functools hashlib importlib itertools json math numpy scipy typing
"""
# The size of each room, which may only fall (CONTRIBUTING says how a new law, engine or scene raises
# one). Python is counted in tokens, without comments, docstrings and line breaks, so that neither
# longer lines nor missing explanations save any. Other text of the packages (sources of other
# languages, pages, numbers) counts in lines.
SIZES = {
    "contactlaw": 213_006,
    "contactlaw/answers": 11_695,
    "contactlaw/cli": 25_233,
    "contactlaw/emit": 8_837,
    "contactlaw/engines": 16_798,
    "contactlaw/equation": 15_239,
    "contactlaw/export": 8_721,
    "contactlaw/fitting": 11_972,
    "contactlaw/laws": 10_242,
    "contactlaw/physical": 22_404,
    "contactlaw/record": 4_293,
    "contactlaw/reporting": 8_026,
    "contactlaw/stepping": 21_991,
    "contactlaw/table": 12_233,
    "contactlaw/walls": 19_140,
    "dem_demo": 15_979,
    "validation": 84_630,
    "tests": 184_159,
    "all Python": 504_211,
    "other text": 3_086,
}
FREE = {"COMMENT", "NL", "NEWLINE", "INDENT", "DEDENT", "ENDMARKER"}
DATA = {".h5", ".hdf5", ".csv", ".png", ".gif", ".stl", ".typed"}
VALIDATION = ROOT.parent / "validation"
DEMO = ROOT.parent / "dem_demo"
EXAMPLES = ROOT.parent / "docs/examples"
HOUSE = "contactlaw", "dem_demo", "validation", "tests", "docs"
# Modules from which users import; other names for them are in contactlaw.__all__.
FOR_USERS = {*re.findall(r'^    "contactlaw\.(\w+)', (ROOT.parent / "docs/public.py").read_text(), re.MULTILINE)}
# Private to users, but imported by finite elements and demo: numba's settings, the version, files
# that are written whole, and units of what is printed.
SHARED = {"contactlaw._jit", "contactlaw._jit.kernel", "contactlaw._atomic"}
SHARED |= {"contactlaw._version", "contactlaw._version.VERSION"}
SHARED |= {"contactlaw._readable", "contactlaw._readable.scale_of"}


def imported(path):
    """Absolute names of the modules that a file imports, anywhere in it."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def own(path):
    """What a file imports of the package: its parts, as tuples; not the names for users."""
    for name in imported(path):
        if name.startswith("contactlaw.") and name.split(".")[1] not in contactlaw.__all__:
            yield tuple(name.split(".")[1:])


def level(name):
    found = [n for n, layer in enumerate(LAYERS) if name in layer]
    assert found, f"contactlaw.{name} has no place in LAYERS"
    return found[0]


@pytest.mark.parametrize("path", [*KERNELS, *LAWS], ids=lambda path: path.stem)
def test_kernels_and_laws_are_plain_numpy(path):
    """None of them imports numba, and a law knows no kernel."""
    assert {name.partition(".")[0] for name in imported(path)} <= {*PLAIN.split()}
    if path in LAWS and path.stem not in ("_branches", "_expansion", "_law"):
        assert {name[0] for name in own(path)} <= {"laws", "_errors", "_bisect"}


@pytest.mark.parametrize("path", sorted(ROOT.rglob("*.py")), ids=lambda path: str(path.relative_to(ROOT)))
def test_imports_run_upwards_only(path):
    place = path.relative_to(ROOT).with_suffix("").parts
    if place in (("__init__",), ("__main__",)):
        return
    folder, stem = place[0], place[-1]
    for name in own(path):
        assert level(name[0]) <= level(folder), f"{path} imports {'.'.join(name)}"
        if len(place) == 1 and name[0] != folder:
            assert level(name[0]) < level(folder), f"{path} imports {'.'.join(name)}"
        inside = place[:-1]
        order = FILES.get("/".join(inside))
        if order and name[: len(inside)] == inside and stem != "__init__" and name > inside:
            later = order[order.index(stem) :]
            assert name[len(inside)] not in later, f"{path} imports {'.'.join(name)}"


def test_a_refused_argument_carries_its_name():
    """Else the command line would have to find it in the message."""
    named = re.compile(r'[^\w]ValueError\(\s*f?"[a-z_]+(, [a-z_]+)*: ')
    for path in [*ROOT.rglob("*.py"), *DEMO.rglob("*.py")]:
        assert not named.search(path.read_text()), path


@pytest.mark.parametrize(("room", "shared"), [("engines", {"needs", "record"}), ("cli", {"parts"})])
def test_an_engine_and_a_subcommand_know_no_other(room, shared):
    """What serves several is a part."""
    for path in (ROOT / room).rglob("*.py"):
        home = path.relative_to(ROOT / room).with_suffix("").parts[0]
        used = {name[1] for name in own(path) if name[0] == room and len(name) > 1}
        assert home == "__init__" or used <= {home, *shared}, path


def test_the_model_is_public_methods():
    """The methods only delegate, so the file is little more than docstrings."""
    assert tokens(ROOT / "model.py") <= 2_300
    (model,) = (node for node in ast.parse((ROOT / "model.py").read_text()).body if isinstance(node, ast.ClassDef))
    names = [node.name for node in model.body if isinstance(node, ast.FunctionDef)]
    private = [name for name in names if name.startswith("_")]
    assert len(names) > 15 and private == ["__init__", "__reduce__", "__repr__"]


def tokens(path):
    """Number of tokens of a module, without comments and docstrings."""
    text = path.read_text("utf-8")
    documented = ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef
    nodes = [node for node in ast.walk(ast.parse(text)) if isinstance(node, documented)]
    docstrings = {
        (node.body[0].lineno, node.body[0].col_offset) for node in nodes if ast.get_docstring(node) is not None
    }
    found = tokenize.generate_tokens(io.StringIO(text).readline)
    return sum(tokenize.tok_name[token.type] not in FREE and token.start not in docstrings for token in found)


def test_no_room_outgrows_its_size():
    top = ROOT.parent
    sizes = collections.Counter()
    for path in [top / "conftest.py", *(path for name in HOUSE for path in (top / name).rglob("*"))]:
        name = path.relative_to(top)
        if path.suffix == ".py":
            sizes.update(dict.fromkeys(["all Python", *map(str, name.parents)], tokens(path)))
        elif path.is_file() and "__pycache__" not in name.parts and path.suffix not in DATA:
            sizes["other text"] += path.read_bytes().count(b"\n") if name.parts[0] in HOUSE[:2] else 0
    above = {room: sizes[room] - most for room, most in SIZES.items() if sizes[room] > most}
    assert not above, (
        f"{above} above SIZES: delete what a room no longer needs, share what it has twice, or let a library do it"
    )


def test_sizes_only_fall():
    """No number is above the one in the versions of this file before, unless a commit says that it raises some.

    The subject of that commit begins with "Raise SIZES". It is the last version that is compared.
    """
    name = "tests/test_architecture.py"
    git = ["git", "-C", str(ROOT.parent)]
    log = subprocess.run([*git, "log", "-2", "--format=%H %s", "--", name], capture_output=True, text=True)
    if not log.stdout:
        pytest.skip("needs the history of a clone")
    for line in log.stdout.splitlines():
        commit, _, subject = line.partition(" ")
        source = subprocess.run([*git, "show", f"{commit}:{name}"], capture_output=True, text=True, check=True).stdout
        assigned = [node for node in ast.parse(source).body if isinstance(node, ast.Assign)]
        for node in assigned:
            if node.targets[0].id == "SIZES":
                before = ast.literal_eval(node.value)
                assert before.keys() <= SIZES.keys()
                raised = {room: most for room, most in SIZES.items() if most > before.get(room, most)}
                assert not raised, f"{raised} were smaller in commit {commit[:8]}"
        if subject.startswith("Raise SIZES"):
            break


def test_every_folder_has_a_size():
    folders = {f"contactlaw/{path.parent.name}" for path in ROOT.glob("*/__init__.py")}
    assert folders == {name for name in SIZES if "/" in name}


PROGRAMS = [path for folder in (VALIDATION, DEMO, EXAMPLES) for path in sorted(folder.rglob("*.py"))]


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: str(path.relative_to(ROOT.parent)))
def test_programs_import_public_names_only(path):
    """Examples import what is for users; the demo's kit knows no scene, and a scene no other."""
    home = path.relative_to(DEMO).parts[0] if path.is_relative_to(DEMO) else None
    scenes = {folder.parent.name for folder in DEMO.glob("*/command.py")}
    assert {"rain", "sieve"} <= scenes
    for name in imported(path):
        package, *parts = name.split(".")
        if package == "contactlaw" or (package == "dem_demo" and not home):
            assert name in SHARED or not any(part.startswith("_") for part in parts), name
        if path.is_relative_to(EXAMPLES):
            assert package not in ("dem_demo", "validation"), name
            assert package != "contactlaw" or not parts or parts[0] in {*contactlaw.__all__, *FOR_USERS}, name
        elif home and package == "contactlaw":
            assert parts[:2] != ["cli", "parts"] or parts[2:3] in (["wording"], []), name
        elif home and package == "dem_demo" and parts:
            assert parts[0] in {"kit", home if home in {"kit", *scenes} else "cli"}, name


def test_import_is_light():
    """Nothing but the core dependencies is loaded, no kernel is compiled, and contacts need no engine."""
    code = (
        "import sys, contactlaw\n"
        "heavy = {'pymunk', 'matplotlib', 'scipy', 'tqdm', 'filelock', 'platformdirs', 'lammps'}\n"
        "assert not heavy & set(sys.modules), heavy & set(sys.modules)\n"
        "from contactlaw.table import lookup\n"
        "from contactlaw.equation import zener\n"
        "for f in (lookup.restitution_on_plate, zener.extremes):\n"
        "    assert not f.signatures, f\n"
        "import contactlaw.softsphere, contactlaw.stepping, contactlaw.walls\n"
        "engines = ('contactlaw.engines', 'lammps', 'mpi4py', 'pymunk')\n"
        "assert not [name for name in sys.modules if name.startswith(engines)]\n"
    )
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_a_changed_source_never_yields_an_old_result(tmp_path):
    """This holds also though the edit is not in the file of the function that Python calls."""
    package = tmp_path / "contactlaw"
    shutil.copytree(ROOT, package, ignore=shutil.ignore_patterns("__pycache__", "engines"))
    code = "from contactlaw import _jit, laws; _jit.enable_caching(); print(laws.law('myc').loading(2.5))"

    def force():
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "numba")}
        command = [sys.executable, "-c", code]
        return float(subprocess.run(command, check=True, cwd=tmp_path, env=environment, stdout=-1).stdout)

    before = force()
    assert force() == before  # from the cache
    source = (package / "equation/force.py").read_text()
    line = "return piece_force(law, max(pieces_begun - 1, 0), q)"
    assert source.count(line) == 1
    (package / "equation/force.py").write_text(source.replace(line, line.replace("return", "return 2.0 *")))
    assert force() == pytest.approx(2.0 * before, rel=1e-12)
    assert len(list((tmp_path / "numba").iterdir())) == 2


def test_the_name_of_the_cache_is_of_the_sources_that_count():
    """They are all files with kernels, and what tables come from; none that only shows answers.

    This reads the list itself, because the name is a hash of all of them.
    """
    counting = _kept._sources().keys()
    code = "import sys, contactlaw.table.cache; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    tables = {*done.stdout.split()} - {"contactlaw"}
    assert {"contactlaw.table", "contactlaw.laws._law", "contactlaw.equation.zener"} <= tables
    for path in ROOT.rglob("*.py"):
        name = path.relative_to(ROOT)
        module = ".".join(("contactlaw", *name.with_suffix("").parts)).removesuffix(".__init__")
        assert name.as_posix() in counting or not ("@kernel" in path.read_text() or module in tables), name
    homes = {name.partition("/")[0] for name in counting}
    assert homes >= {"_jit.py", "answers", "softsphere.py", "stepping", "walls"}
    assert not homes & {"cli", "report", "fitting", "style.py", "__init__.py"}


def test_every_public_name_is_there():
    """Modules are imported when a name is first used: a typo would show only then."""
    assert set(contactlaw.__all__) == {*contactlaw._MODULE_OF, "export", "__version__"}
    for name in contactlaw.__all__:
        assert getattr(contactlaw, name) is not None
