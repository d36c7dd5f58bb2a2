"""The stored finite elements beside the model; what the README says of them."""

import re
from pathlib import Path

import numpy as np
import pytest

import contactlaw as cl
from validation.fem import compare, published, store
from validation.fem.studies import STUDIES

README = (Path(__file__).parent.parent / "README.md").read_text()


@pytest.fixture(scope="module")
def matrix():
    return compare.comparison("matrix")


def interpolated(name, way, loading=True):
    x, force, top = compare.indentation(name)
    part = slice(None, top + 1) if loading else slice(None, top - 1, -1)
    return np.interp(way, x[part], force[part])


@pytest.mark.parametrize("name", STUDIES)
def test_every_result_says_what_made_it(name):
    attributes = store.read(name).attributes
    assert {"about", "command", "date", "solver_version", "mesh"} <= set(attributes)
    assert attributes["command"] == f"python -m validation.fem {name}"


def test_results_are_small():
    assert sum(store.path(name).stat().st_size for name in STUDIES) < 3e6


def test_a_result_that_is_missing_names_the_command():
    with pytest.raises(FileNotFoundError, match="python -m validation.fem nothing"):
        store.read("nothing")


def test_a_result_with_nan_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "FOLDER", tmp_path)
    with pytest.raises(ValueError, match="force.*'bad'.*not finite"):
        store.write("bad", "", {"force": np.array([np.nan])}, {})
    assert not store.path("bad").exists()


def test_discretisation_error():
    """Of elements of 0.01 R against 0.005 R, recorded: COR, force and time 0.1 %, strain 0.2 %."""
    data = store.read("verification").data
    for thickness in (0.5e-3, 1e-3):
        rows = (data["check"] == "mesh") & (data["thickness"] == thickness)
        for name, bound in (
            ("restitution", 1e-3), ("peak_force", 1e-3), ("contact_time", 1e-3),
            ("plastic_strain", 2e-3),
        ):  # fmt: skip
            coarse, _, fine, finest = data[name][rows]
            assert abs(fine / finest - 1) < bound
            assert abs(fine - finest) < 0.5 * abs(coarse - finest)


def test_no_wave_comes_back():
    """A plate twice as wide changes nothing."""
    data = store.read("verification").data
    near, far = data["restitution"][data["check"] == "width"]
    assert near == pytest.approx(far, rel=1e-5)


def test_energy_balance_of_all_stored_impacts():
    for name in ("verification", "matrix", "pairs", "limits"):
        data = store.read(name).data
        assert data["balance"].max() < 0.01, name
        assert data["hourglass"].max() < 0.02, name


def test_indentation_is_static_and_agrees_with_calculix():
    data = store.read("indentation").data
    assert max(v for k, v in data.items() if k.startswith("kinetic")) < 0.01
    way = np.linspace(0.5, 9.8, 100)
    peak = compare.indentation("calculix")[1].max()
    for loading in (True, False):
        ours = interpolated("10_calculix_mesh", way, loading)
        assert np.abs(ours - interpolated("calculix", way, loading)).max() < 0.015 * peak
    slow = interpolated("10_twice_as_slow", way)
    assert interpolated("10", way) == pytest.approx(slow, rel=0.015)


def test_which_law_is_right():
    """The paper's percentages: MYC 6 %, Thornton 64 % low, Stronge 40 % high; and their range."""
    way = np.linspace(0.5, 10.0, 200)
    fem = interpolated("30", way)
    off = {name: curve / fem - 1 for name, curve in compare.loading_curves(way).items()}
    assert np.abs(off["myc"]).max() < 0.06
    assert off["thornton"][-1] == pytest.approx(-0.64, abs=0.01)
    assert off["stronge"][way > 2.5] == pytest.approx(0.43, abs=0.03)
    deep = compare.loading_curves(np.array([30.0]))["myc"] / interpolated("30", 30.0) - 1
    assert deep > 0.25  # not beyond: 6 % up to 17 d_Y


def test_the_model_over_the_matrix(matrix):
    errors = compare.errors(matrix)
    assert errors["modified Zener"][0] < 0.05
    assert errors["modified Zener"][1] < 0.02
    # an independent ranking: each step of the physics left out costs
    ranked = [errors[name][1] for name in errors if "Zener" in name or "Mueller" in name]
    assert ranked == sorted(ranked)


def test_one_table_serves_every_pair_below_yield_only():
    """A sphere stiffer than its plate loses half the plastic work that the model has."""
    case = compare.comparison("pairs")
    cor = case.fem["restitution"].reshape(3, 3, 4)  # inelasticity, pair, speed
    spread = cor.max(axis=1) - cor.min(axis=1)
    assert spread[:, 0].max() < 0.003
    assert spread[:, 3].min() > 0.05
    steel = np.char.startswith(case.fem["sphere"].astype(str), "bearing")
    fast = case.speed_ratio > 3.0
    share = case.fem["plastic"] / np.maximum(case.model["plastic_fraction"], 1e-9)
    assert share[steel & fast].max() < 0.5 < 0.7 < share[~steel & fast].min()


def test_an_edge_nearer_than_one_and_a_half_edge_distances_answers():
    data = store.read("edge").data
    ratio, cor = data["width"] / data["edge_distance"], data["restitution"]
    assert cor[ratio > 1.45] == pytest.approx(cor[-1], abs=0.002)
    assert abs(cor[np.isclose(ratio, 0.8, atol=0.01)] - cor[-1]) > 0.05


def test_the_readme_states_what_was_measured(matrix):
    largest, rms = 100 * compare.errors(matrix)["modified Zener"]
    stated = re.search(r"within (\d\.\d) % of them \(rms (\d\.\d) %\)", README)
    assert [float(x) for x in stated.groups()] == [round(largest, 1), round(rms, 1)]


def test_published_formulas():
    assert published.mueller(np.array([0.25])) == pytest.approx(0.6731, abs=1e-4)
    # at the yield speed Eq. 22 goes over into Eq. 3
    lam, q = 0.1, 0.1 * (5 / 4) ** 0.6
    g = q + (1 + q) ** -0.2
    below, above = (
        published.closed_form(lam * v**0.2, v, np.array(1.0)) for v in (g - 1e-9, g + 1e-9)
    )
    assert below == pytest.approx(above, abs=1e-5)
    ends = published.thornton(np.array([0.2, 0.25 / 0.68])), published.stronge(np.array([1.0]))
    assert ends[0] == pytest.approx([0.2**1.5, (0.25 / 0.68) ** 1.5])
    assert ends[1] == pytest.approx(1.0)


def test_force_history_is_the_models():
    pair = cl.Pair("gamma-alumina", "glass")
    time, force = published.force_history(pair, 26.0, 0.9e-3, 0.5e-3)
    solved = cl.ImpactModel(pair).solve(26.0, 0.9e-3, 0.5e-3)
    assert force.max() == pytest.approx(solved.peak_force, rel=1e-5)
    assert force[-1] < 1e-3 * force.max()
    mass = 4 / 3 * np.pi * 879.0 * 0.9e-3**3
    impulse = mass * 26.0 * (1 + solved.restitution)
    assert np.trapezoid(force, time) == pytest.approx(impulse, rel=1e-5)


def test_figures_are_drawn(tmp_path):
    from validation.fem import figures

    for name in ("indentation", "errors", "paper"):
        figure = figures.FIGURES[name]()
        figure.savefig(tmp_path / f"{name}.png")
        assert all(axes.get_xlabel() for axes in figure.axes if axes.get_label() != "<colorbar>")
