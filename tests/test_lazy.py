"""A model builds nothing before it is asked for: what needs no table leaves none behind."""

import json
import os
import subprocess
import sys
import warnings
from pathlib import Path

import needs
import numpy as np
import pytest

import contactlaw as cl
from contactlaw import _folder
from contactlaw.laws import Law
from contactlaw.laws._branches import Loading
from contactlaw.softsphere import time_step
from contactlaw.table.lookup import lam_max

# Runs each of the codes that it is given, with an empty cache of tables; tells what is left in it.
EACH = """
import json, os, sys
from pathlib import Path
import contactlaw as cl
from contactlaw.softsphere import Contacts, time_step
from contactlaw.answers import tabulated
from contactlaw.table import cache
found = {}
for name, code in json.load(sys.stdin).items():
    folder = Path(sys.argv[1]) / name
    folder.mkdir()
    os.environ["CONTACTLAW_CACHE_DIR"] = str(folder / "cache")
    cache.cached.cache_clear()
    tabulated._default.cache_clear()
    pair = cl.Pair("stainless-steel-304", "glass")
    model = cl.ImpactModel(pair)
    exec(code)
    found[name] = [path.name for path in folder.rglob("table-*.h5")]
print(json.dumps(found))
"""
WITHOUT = {
    "solve": "model.solve([1.0, 5.0], 1e-3, 2e-3)",
    "soft sphere": "Contacts(model, 1e-3, 2e-3); time_step(model, 5.0, 1e-3, 2e-3)",
    "history": "model.force_history(5.0, 1e-3, 2e-3, method='solve')",
    "header": "cl.export.header(folder / 'law.h', model, table='none')",
    "fit": "cl.fit(pair, {'speed': [1., 2., 3.], 'radius': 1e-3, 'restitution': [.5, .45, .4]},"
    " 'thickness')",
    "lammps": """
from lammps_box import dropped
from contactlaw.engines.lammps import pair_coeff
pair_coeff("stainless-steel-304", radius=1e-3, speed=2.0)
rows, _ = dropped(model, velocity=(0, 0, -2), density=pair.sphere.density, dt=1e-8, steps=9000)
assert len(rows) == 1""",
}
TABLED = {
    "restitution": "model.restitution(5.0, 1e-3, 2e-3)",
    "lookup": "model.lookup(5.0, 1e-3, 2e-3)",
    "kernel": "model.kernel",
}


@pytest.fixture(scope="module")
def left(tmp_path_factory):
    """Names of the tables that each code leaves, in a process where nothing has been asked for."""
    codes = WITHOUT | TABLED
    if not needs.has_lammps():
        del codes["lammps"]
    # The compiled kernels stay where they are, or the process would compile them again.
    more = {
        "NUMBA_CACHE_DIR": os.environ.get("NUMBA_CACHE_DIR", str(_folder.folder())),
        "PYTHONPATH": os.pathsep.join([str(Path(needs.__file__).parent), *sys.path]),
    }
    done = subprocess.run(
        [sys.executable, "-c", EACH, str(tmp_path_factory.mktemp("caches"))],
        input=json.dumps(codes), env=os.environ | more, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.parametrize("name", WITHOUT | TABLED)
def test_only_what_looks_up_leaves_a_table(name, left):
    if name == "lammps":
        needs.lammps()
    assert len(left[name]) == (name in TABLED)


STEEL_ON_GLASS = cl.Pair("stainless-steel-304", "glass")


def test_the_largest_inelasticity_is_that_of_the_table():
    elastic = Law.of(
        name="elastic", source="s", yield_coefficient=None, unloading=[], scale=1.0,
        loading=[Loading(0.0, np.polynomial.Polynomial([0.0, 0.0, 0.0, 1.0]))], range=(0.01, 0.2),
    )  # fmt: skip
    for law in ("fem", "myc", "hertz", "jackson_green", elastic):
        model = cl.ImpactModel(STEEL_ON_GLASS, law=law)
        assert model.largest_inelasticity == pytest.approx(lam_max(model.table.packed), rel=1e-12)


def test_a_time_step_is_refused_where_a_lookup_is():
    model = cl.ImpactModel(STEEL_ON_GLASS)
    for ask in (model.lookup, lambda *impact: time_step(model, *impact)):
        with pytest.raises(ValueError, match=r"lambda = 12\.\d+ is above 6: the plate is too thin"):
            ask(5.0, 1e-3, 2e-4)
    assert time_step(cl.ImpactModel(STEEL_ON_GLASS, outside="solve"), 5.0, 1e-3, 2e-4) > 0.0


@pytest.mark.parametrize("wrong", [5, True, object(), cl.table.Settings])
def test_a_table_of_a_wrong_type_is_refused_by_name(wrong):
    with pytest.raises(TypeError, match="table: expected a Table, Settings or the path of a file"):
        cl.ImpactModel(STEEL_ON_GLASS, table=wrong)


def test_a_warning_about_the_table_shows_the_users_line():
    coarse = cl.table.Settings(inelasticity_nodes=8, log_overload_step=0.9)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc", table=coarse)
        assert not caught  # the table is made on first use
        model.restitution(5.0, 1e-3, 1e-3)
        exec("cl.ImpactModel(pair, law='myc', table=table).lookup(5.0, 1e-3, 1e-3)",  # no __name__
             {"cl": cl, "pair": cl.Pair("gamma-alumina", "glass"), "table": coarse})  # fmt: skip
    lines = [one.filename for one in caught if "less accurate" in str(one.message)]
    assert lines == [__file__, "<string>"]


def test_a_law_that_is_not_made_for_auxetic_bodies_says_so():
    foam = cl.Material("foam", 1e9, -0.3, 1000, yield_strength=1e7, kind="metal")
    for pair in (cl.Pair(foam, "glass"), cl.Pair("glass", foam)):
        with pytest.raises(ValueError, match=r"'fem' is made for .* 'foam' has -0\.3: take law="):
            cl.ImpactModel(pair)
    assert 0.0 < cl.ImpactModel(cl.Pair(foam, "glass"), law="myc").restitution(1.0, 1e-3, 1e-2) < 1
