"""A model builds nothing before it is asked for: what needs no table leaves none behind."""

import needs
import pytest

import contactlaw as cl
from contactlaw.softsphere import Contacts, time_step
from contactlaw.table import cache

STEEL_ON_GLASS = cl.Pair("stainless-steel-304", "glass")


def in_lammps(model):
    needs.lammps()
    from lammps_box import dropped

    from contactlaw.engines.lammps import pair_coeff

    density = model.pair.sphere.density
    pair_coeff("stainless-steel-304", radius=1e-3, speed=2.0)
    rows, _ = dropped(model, velocity=(0, 0, -2), density=density, dt=1e-8, steps=9000)
    assert len(rows) == 1


REBOUNDS = {"speed": [1.0, 2.0, 3.0], "radius": 1e-3, "restitution": [0.5, 0.45, 0.4]}
TABLES = {
    "solve": (0, lambda model: model.solve([1.0, 5.0], 1e-3, 2e-3)),
    "soft sphere": (0, lambda model: Contacts(model, 1e-3, 2e-3)),
    "time step": (0, lambda model: time_step(model, 5.0, 1e-3, 2e-3)),
    "history": (0, lambda model: model.force_history(5.0, 1e-3, 2e-3, method="solve")),
    "header": (0, lambda model: cl.export.header("law.h", model, table="none")),
    "fit": (0, lambda model: cl.fit(model.pair, REBOUNDS, "thickness")),
    "lammps": (0, in_lammps),
    "restitution": (1, lambda model: model.restitution(5.0, 1e-3, 2e-3)),
    "lookup": (1, lambda model: model.lookup(5.0, 1e-3, 2e-3)),
    "kernel": (1, lambda model: model.kernel),
}


@pytest.mark.parametrize(("tables", "ask"), TABLES.values(), ids=TABLES)
def test_only_what_looks_up_leaves_a_table(tables, ask, tmp_path, monkeypatch):
    monkeypatch.setenv("CONTACTLAW_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    cache.cached.cache_clear()
    ask(cl.ImpactModel(STEEL_ON_GLASS))
    assert len([*tmp_path.rglob("table-*.h5")]) == tables


@pytest.mark.parametrize("wrong", [5, True, object(), cl.table.Settings])
def test_a_table_of_a_wrong_type_is_refused_by_name(wrong):
    with pytest.raises(TypeError, match="table: expected a Table, Settings or the path of a file"):
        cl.ImpactModel(STEEL_ON_GLASS, table=wrong)


def test_a_law_that_is_not_made_for_auxetic_bodies_says_so():
    foam = cl.Material("foam", 1e9, -0.3, 1000, yield_strength=1e7, kind="metal")
    for pair in (cl.Pair(foam, "glass"), cl.Pair("glass", foam)):
        with pytest.raises(ValueError, match=r"'fem'; it is made .* 'foam' has -0\.3: take law="):
            cl.ImpactModel(pair)
    assert 0.0 < cl.ImpactModel(cl.Pair(foam, "glass"), law="myc").restitution(1.0, 1e-3, 1e-2) < 1
