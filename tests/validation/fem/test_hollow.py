"""Spheres that are not solid by finite elements, beside a model that knows their mass alone."""

from pathlib import Path

import pytest

import contactlaw as cl
from validation.fem import hollow, store
from validation.fem.impact import impact
from validation.fem.mesh import Core

R = hollow.RADIUS


@pytest.fixture(scope="module")
def rows():
    return hollow.compared()


@pytest.mark.parametrize(("core", "error"), [(Core(0.8), 0.01), (Core(0.8, 0.2, 0.02), 0.08)])
def test_a_coarse_impact_agrees_with_the_stored_one(rows, core, error):
    row = next(n for n, one in enumerate(rows) if one.case.core == core)
    stored = {name: values[row] for name, values in store.read("hollow").data.items()}
    case, size = rows[row].case, 3 * stored["size"]
    sizes = case.speed, R, case.thickness
    found = impact(case.pair, *sizes, size=size, yields=False, core=case.core)
    assert found.restitution == pytest.approx(stored["restitution"], abs=0.004)
    assert found.peak_force == pytest.approx(stored["peak_force"], rel=error)


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
