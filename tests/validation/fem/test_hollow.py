"""Spheres that are not solid by finite elements, beside a model that knows their mass alone."""

from pathlib import Path

import numpy as np
import pytest

import contactlaw as cl
from validation.fem import elements, hollow, mesh, solver, store
from validation.fem.impact import impact
from validation.fem.mesh import SOLID, Core

R = hollow.RADIUS


@pytest.fixture(scope="module")
def rows():
    return hollow.compared()


@pytest.mark.parametrize("core", [Core(0.3), Core(0.9), *hollow.CORES])
def test_a_mesh_weighs_what_the_sphere_does(core):
    """A core has steps, as an element belongs to it or not; a hollow has none."""
    one = (mesh.layered if core.density else mesh.hollow)(R, 5e-3 * R, 0.1 * R, core)
    dense = 1.0 if one.relative is None else one.relative[:, 0]
    volume = dense * elements.volumes(one.elements, one.nodes)
    mass = 1.5 * volume.sum() / R**3
    assert mass == pytest.approx(core.mass, rel=0.016 if core.density else 1.2e-3)


def test_an_element_is_as_stiff_and_heavy_as_its_material():
    """A core that fills its sphere acts as a sphere of its own material."""
    glass = cl.material("glass")
    other = cl.Material("other", 3.0 * glass.youngs_modulus, glass.poissons_ratio, 5000.0)
    found = []
    for core, material in ((Core(2.0, 5000.0 / glass.density, 3.0), glass), (SOLID, other)):
        one = mesh.layered(R, 0.02 * R, 0.2 * R, core)
        body, force = solver.body(one, material, 0, 1.0, False), np.zeros_like(one.nodes)
        elements.add_forces(body, one.nodes, np.sin(one.nodes / R), 1e-9, force)
        step = elements.stable_step(body, one.nodes, material.density)
        found.append([step, elements.strain_energy(body, one.nodes), *force.ravel()])
    assert found[0] == pytest.approx(found[1], rel=1e-9, abs=1e-13)


def test_a_coarse_impact_agrees_with_the_stored_one(rows):
    row = next(n for n, one in enumerate(rows) if one.case.core == Core(0.8))
    stored = {name: values[row] for name, values in store.read("hollow").data.items()}
    case, size = rows[row].case, 3 * stored["size"]
    sizes = case.speed, R, case.thickness
    found = impact(case.pair, *sizes, size=size, yields=False, core=case.core)
    assert found.restitution == pytest.approx(stored["restitution"], abs=0.004)
    assert found.peak_force == pytest.approx(stored["peak_force"], rel=0.01)


def test_the_mass_is_all_that_counts_where_the_inside_is_as_stiff(rows):
    """Errors are those of solid spheres, or nearly so, and so is the share of vibration."""
    data, shares = store.read("hollow").data, []
    for n, one in enumerate(rows):
        if one.case.core.modulus == 1.0:
            assert abs(one.law - one.fem) < 0.0065
            assert max(abs(one.contact_time), abs(one.peak_force)) < 0.015
            if one.case.yields and one.case.plate == "glass" and one.case.thickness > R:
                shares.append((data["vibration"][n] + data["friction_loss"][n]) / one.other)
    assert len(shares) == 4 and 0.865 < min(shares) and max(shares) < 0.895


def test_the_mesh_is_fine_enough(rows):
    same = next(one for one in rows if one.case.yields and one.case.core == rows[-1].case.core)
    assert rows[-1].fem == pytest.approx(same.fem, rel=1e-3)
    assert store.read("hollow").data["mesh_error"].max() < 0.014


def test_the_docs_have_the_table(rows):
    page = (Path(cl.__file__).parents[1] / "docs/how_sure.md").read_text()
    for core in dict.fromkeys(one.case.core for one in rows):
        found = [one for one in rows[:-1] if one.case.core == core]
        errors = [f"{one.fem:.3f} ({100.0 * (one.law / one.fem - 1.0):+.1f} %)" for one in found]
        worst = (max((getattr(one, k) for one in found), key=abs) for k in found[0]._fields[-2:])
        errors += [""] * (6 - len(errors)) + [f"{100.0 * error:+.0f} %" for error in worst]
        shell = f"{1.0 - core.radius:.2f} R" if core.radius else "solid"
        name = f"{core.radius:g} R, {core.density:g}, {core.modulus:g}"
        cells = name if core.density and core.radius else shell, f"{core.mass:.2f}"
        assert f"| {' | '.join([*cells, *errors])} |" in page
