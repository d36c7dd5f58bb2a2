"""From rebounds to what was not known: against what is true, and against scipy alone."""

import dataclasses
import pickle
import re
import shlex
import shutil
import tracemalloc

import numpy as np
import own_laws
import pytest
from places import ROOT
from rebounds import KINDS, RADIUS, STEEL, THICKNESS, rebounds
from scipy import stats
from scipy.optimize import brentq, least_squares

import contactlaw as cl
from contactlaw.answers import law_errors
from contactlaw.answers.derivatives import FINE
from contactlaw.cli import main
from contactlaw.cli.fit import printed
from contactlaw.fitting import errors
from contactlaw.fitting.measurements import Measurements
from contactlaw.fitting.predictions import COARSE, ROUGH, Predictor, impacts
from contactlaw.fitting.unknowns import UNKNOWNS, Setting, parameters
from contactlaw.physical.law import law_of
from contactlaw.record.columns import IMPACT
from validation.inverse import coverage, elements, model


def true(pair, name):
    unknown = UNKNOWNS[name]
    sizes = {"radius": RADIUS, "thickness": THICKNESS}
    return sizes.get(name) or getattr(getattr(pair, unknown.body), unknown.field)


@pytest.mark.parametrize(
    "asked",
    [
        ("thickness",),
        ("radius",),
        ("density",),
        ("plate_density",),
        ("youngs_modulus",),
        ("plate_youngs_modulus",),
        ("plate_yield_strength",),
        ("plate_yield_strength", "thickness"),
        pytest.param(("radius", "thickness", "plate_yield_strength"), marks=pytest.mark.long),
    ],
    ids="+".join,
)
def test_exact_data_give_back_what_made_them(asked):
    data = rebounds(STEEL, kinds=KINDS, without=asked)
    found = cl.fit(STEEL, data, asked)
    for name in asked:
        assert found.values[name] == pytest.approx(true(STEEL, name), rel=2e-5)
    assert all(abs(off).max() < 2e-5 for off in found.residuals.values())
    assert set(found.values) == set(found.errors) == set(asked) == set(found.unknown)


def test_the_strength_of_a_bead_that_yields():
    pair = cl.Pair("stainless-steel-304", "tungsten-carbide")
    found = cl.fit(pair, rebounds(pair), "yield_strength")
    assert found.values["yield_strength"] == pytest.approx(pair.sphere.yield_strength, rel=2e-5)
    assert found.pair.sphere.yield_strength == found.values["yield_strength"]


RATED = cl.Pair("alloy-steel-4340", "copper-ofhc-annealed")
AS_STRONG = [
    dataclasses.replace(RATED.sphere, yield_strength=150e6, rate=(0.05, 1.0)),
    dataclasses.replace(RATED.plate, yield_strength=200e6),
]


@pytest.mark.parametrize("pair", [RATED, cl.Pair(*AS_STRONG)], ids=["one", "both"])
def test_trials_at_the_rates_of_the_impacts_are_the_model(pair):
    data = Measurements.of(rebounds(pair, kinds=KINDS[:2], speed=np.geomspace(0.3, 30.0, 12)))
    asked = parameters(pair, data, ["yield_strength", "plate_yield_strength"], {})
    of = Predictor(pair, law_of(pair, "fem"), data, asked)
    # Trials and model blend laws of different ladders, within 1e-4 (the promise for rates).
    for fineness, error in ((FINE, 1e-4), (COARSE, 1e-3), (ROUGH, 5e-2)):
        x = np.log([true(pair, one.name) for one in asked])
        (found,) = dataclasses.replace(of, fineness=fineness).predicted(x)
        assert found == pytest.approx(of.values.value, rel=error)


@pytest.mark.parametrize("law", ["myc", "jackson_green"])
def test_other_laws(law):
    pair = cl.Pair("gamma-alumina", "glass")
    data = rebounds(pair, law, speed=np.geomspace(2.0, 40.0, 9), without=("thickness",))
    found = cl.fit(pair, data, ("thickness", "yield_strength"), law)
    assert found.values["thickness"] == pytest.approx(THICKNESS, rel=1e-4)
    assert found.values["yield_strength"] == pytest.approx(472.5e6, rel=1e-4)
    assert found.law == law


@pytest.fixture(scope="module")
def by_scipy():
    """Thickness, its error and chi^2 by scipy on the answers of `ImpactModel` alone."""
    data = rebounds(STEEL, noise=0.01, seed=3, without=("thickness",))
    table = cl.ImpactModel(STEEL)

    def off(x):
        cor = table.solve(data["speed"], RADIUS, float(x[0]) * 1e-3).restitution
        return (cor - data["restitution"]) / data["restitution_error"]

    done = least_squares(off, [2.0], diff_step=1e-5, xtol=1e-12, ftol=1e-12)
    slope = done.jac[:, 0]
    return data, done.x[0] * 1e-3, 1e-3 / np.sqrt(slope @ slope), slope / 1e-3


def test_value_and_error_are_those_of_least_squares_by_scipy(by_scipy):
    data, thickness, error, _ = by_scipy
    found = cl.fit(STEEL, data, "thickness")
    assert found.values["thickness"] == pytest.approx(thickness, rel=1e-5)
    assert found.statistical_errors["thickness"] == pytest.approx(error, rel=1e-3)
    parts = found.statistical_errors["thickness"], found.model_errors["thickness"]
    assert found.errors["thickness"] == pytest.approx(np.hypot(*parts), rel=1e-12)


def test_the_model_part_of_the_error_is_its_rms_where_all_errors_are_alike(by_scipy):
    """For one rebound it is 0.43 % over the derivative of ln e by ln H, from `sensitivity`."""
    v = 1.0
    cor = float(cl.ImpactModel(STEEL).solve(v, RADIUS, THICKNESS).restitution)
    found = cl.fit(STEEL, {"speed": v, "radius": RADIUS, "restitution": cor}, "thickness")
    slope = cl.ImpactModel(STEEL).sensitivity(v, RADIUS, THICKNESS).thickness
    share = found.model_errors["thickness"] / found.values["thickness"]
    assert found.flags[0] == 0
    assert share == pytest.approx(law_errors.MODEL_ERRORS["fem"][0][0] / slope, rel=1e-3)
    assert found.statistical_errors["thickness"] == 0.0
    assert any("model alone" in note for note in found.notes)


@pytest.mark.parametrize("name", ["thickness", "density", "plate_density", "youngs_modulus"])
def test_derivatives_are_those_of_the_models_own_sensitivity(name):
    data = cl.Measurements.of(rebounds(STEEL))
    moved = parameters(STEEL, data, ["plate_yield_strength"], {name: 1e-3 * true(STEEL, name)})
    predictor = Predictor(STEEL, law_of(STEEL, "fem"), data, moved)
    x = np.log([true(STEEL, "plate_yield_strength"), true(STEEL, name)])
    (here,) = predictor.predicted(x)
    slopes = predictor.derivatives(x, here) / here[:, None]
    theirs = cl.ImpactModel(STEEL).sensitivity(data.speed, RADIUS, THICKNESS)
    field = {"density": "sphere_density", "youngs_modulus": "sphere_modulus"}.get(name, name)
    assert slopes[:, 1] == pytest.approx(getattr(theirs, field), abs=3e-4)


def test_errors_that_are_not_given_are_found_from_the_scatter():
    """If all values are proportional to the parameter, mean and 1/sqrt(n) are exact by hand."""
    v = np.full(6, 1.0)
    hit = impacts(Setting(STEEL, v, v * RADIUS, v * THICKNESS), law_of(STEEL, "fem"))
    scatter = np.array([1.01, 0.98, 1.03, 0.995, 1.002, 0.99])
    data = {"speed": v, "radius": RADIUS, "restitution": hit.restitution * scatter}
    found = cl.fit(STEEL, data, "thickness")
    fitted = cl.ImpactModel(STEEL).solve(1.0, RADIUS, found.values["thickness"]).restitution
    assert fitted == pytest.approx(np.mean(data["restitution"]), rel=1e-6)
    slope = cl.ImpactModel(STEEL).sensitivity(1.0, RADIUS, THICKNESS).thickness
    of_mean = scatter.std(ddof=1) / scatter.mean() / np.sqrt(6.0)
    widened = stats.t.ppf(stats.norm.cdf(1.0), 5) * of_mean
    share = found.statistical_errors["thickness"] / found.values["thickness"]
    assert share == pytest.approx(widened / slope, rel=0.02)


def dense(speed, slenderness, kind, size):
    """Covariance of the model's errors as a matrix, by its definition."""
    apart = np.hypot(*(np.log(x)[:, None] - np.log(x) for x in (speed, slenderness)))
    return size[:, None] * np.exp(-apart) * (kind[:, None] == kind) * size


@pytest.mark.parametrize(("count", "plates", "close"), [(40, "many", 1e-8), (1500, "one", 5e-3), (1500, "many", 6e-2)])
def test_the_shared_errors_of_the_model_are_those_of_their_matrix(count, plates, close):
    """They agree exactly up to 400 different impacts; beyond, impacts in one cell err alike."""
    random = np.random.default_rng(4)
    v, h = np.exp(random.uniform(-1.0, 2.0, (2, count))) * [[1.0], [1e-3]]
    h = h if plates == "many" else np.full(count, THICKNESS)
    v[1], h[1] = v[0], h[0]  # equal impacts
    data = cl.Measurements(
        speed=v,
        radius=RADIUS,
        thickness=h,
        restitution=np.full(count, 0.5),
        peak_force=np.where(np.arange(count) % 3 == 0, 10.0, np.nan),
    )
    moved = parameters(STEEL, data, ["density"], {})
    predictor = Predictor(STEEL, law_of(STEEL, "fem"), data, moved)
    x = np.log([STEEL.sphere.density])
    shared = errors.model_errors(predictor, x, predictor.impacts(predictor.setting(x)))
    row, kind = predictor.values.row, predictor.values.kind
    size = np.linalg.norm(shared, axis=1)
    matrix = dense(v[row], RADIUS / h[row], kind, size)
    error = random.uniform(0.5, 2.0, row.size) * size
    gain, off = random.standard_normal((2, row.size)) / error, random.standard_normal(row.size)
    off *= error
    exact = off @ np.linalg.solve(np.diag(error**2) + matrix, off)
    assert errors.chi_squared(off, error, shared) == pytest.approx(exact, rel=close)
    exact, propagated = gain @ matrix @ gain.T, gain @ shared
    assert propagated @ propagated.T == pytest.approx(exact, rel=close, abs=close * exact.max())


def test_many_rebounds_take_little_memory():
    """10,000 rebounds once took 3.3 GB and 45 s; as matrices 2000 would take 250 MB."""
    v = np.exp(np.random.default_rng(1).uniform(np.log(0.1), np.log(8.0), 2000))
    data = rebounds(STEEL, speed=v, noise=0.01, without=("thickness",))
    tracemalloc.start()
    found = cl.fit(STEEL, data, "thickness")
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 40e6
    assert found.values["thickness"] == pytest.approx(THICKNESS, abs=4.0 * found.errors["thickness"])


def test_a_prior_enters_the_error():
    """A density known to 10 % adds an error to H by the ratio of the two derivatives."""
    data = rebounds(STEEL, speed=[1.0], without=("thickness",))
    alone = cl.fit(STEEL, data, "thickness")
    with_it = cl.fit(STEEL, data, "thickness", priors={"density": 0.1 * STEEL.sphere.density})
    moved = cl.ImpactModel(STEEL).sensitivity(1.0, RADIUS, THICKNESS)
    extra = 0.1 * moved.sphere_density / moved.thickness * THICKNESS
    errors_of = [one.statistical_errors["thickness"] for one in (alone, with_it)]
    assert np.sqrt(errors_of[1] ** 2 - errors_of[0] ** 2) == pytest.approx(abs(extra), rel=0.02)
    assert with_it.values["thickness"] == pytest.approx(THICKNESS, rel=1e-4)


def test_a_prior_of_the_unknown_itself_pulls_it():
    data = rebounds(STEEL, speed=[1.0])
    pulled = cl.fit(STEEL, data | {"thickness": 1.5e-3}, "thickness", priors={"thickness": 1e-6})
    assert pulled.values["thickness"] == pytest.approx(1.5e-3, rel=2e-3)


def test_a_strength_from_below_yield_is_refused_with_what_is_known():
    pair = cl.Pair("gamma-alumina", "glass")
    data = rebounds(pair, speed=np.geomspace(0.3, 4.0, 10), noise=0.005)
    with pytest.raises(cl.UnidentifiedError, match="yield_strength: any above") as caught:
        cl.fit(pair, data, "yield_strength")
    (least,) = re.findall(r"above (\S+) MPa", str(caught.value))
    # at that strength the fastest just yields, with what the errors leave
    yields_at = cl.Pair(dataclasses.replace(pair.sphere, yield_strength=float(least) * 1e6), pair.plate).yield_speed
    assert 1.0 < yields_at < 4.5
    assert pickle.loads(pickle.dumps(caught.value)).unknown == ("yield_strength",)


def test_a_product_is_told_where_its_factors_are_not():
    """Below yield only the mobility of a thin plate counts, and so only H^2 sqrt(rho2)."""
    pair = cl.Pair("gamma-alumina", "glass")
    data = rebounds(pair, speed=np.geomspace(0.3, 4.0, 10), noise=0.01, without=("thickness",))
    with pytest.raises(cl.UnidentifiedError, match="do not determine .* separately. They determine") as caught:
        cl.fit(pair, data, ("thickness", "plate_density"))
    ((powers, value, error),) = caught.value.known
    assert powers == {"thickness": 1.0, "plate_density": pytest.approx(0.25, abs=0.02)}
    exact = THICKNESS * pair.plate.density ** powers["plate_density"]
    assert value == pytest.approx(exact, rel=3.0 * error)
    assert error < 0.05


@pytest.mark.parametrize(("law", "asked"), [("myc", "plate_yield_strength"), ("hertz", "yield_strength")])
def test_what_a_law_does_not_depend_on_is_refused(law, asked):
    pair = cl.Pair("gamma-alumina", "glass")
    with pytest.raises(cl.UnidentifiedError, match=f"law '{law}' does not depend on it"):
        cl.fit(pair, rebounds(pair, law, noise=0.01), asked, law)


def test_a_thickness_that_may_be_any_larger_is_refused():
    """The contact time on thick plates tends to that on a half-space, which bounds no thickness."""
    pair, speed, size = cl.Pair("glass", "glass"), np.array([0.5, 1.0, 2.0]), np.ones(3)
    thick = impacts(Setting(pair, speed, RADIUS * size, 3e-3 * size), law_of(pair, "fem"))
    time = np.asarray(thick.contact_time)
    data = {"speed": speed, "radius": RADIUS, "contact_time": time}
    data["contact_time_error"] = 2e-3 * time
    with pytest.raises(cl.UnidentifiedError, match="thickness on one side only: above") as refused:
        cl.fit(pair, data, "thickness")
    bound = float(str(refused.value).split("above ")[1].split()[0])
    there = impacts(Setting(pair, speed, RADIUS * size, bound * size), law_of(pair, "fem")).contact_time
    assert 4.0 < np.sum(((there / time - 1.0) / 2e-3) ** 2) < 5.0  # two standard errors, from the best or a half-space


def test_an_error_is_the_distance_at_which_the_sum_of_squares_rises_by_one():
    """The COR of a thick plate tends to 1: its error is larger than that of a linear model, 0.123."""
    pair, speed, size = cl.Pair("glass", "glass"), np.array([0.5, 1.0, 2.0]), np.ones(3)

    def cor(thickness):
        return impacts(Setting(pair, speed, RADIUS * size, thickness * size), law_of(pair, "fem")).restitution

    data = {"speed": speed, "radius": RADIUS, "restitution": cor(4e-3), "restitution_error": 0.008 * cor(4e-3)}
    found = cl.fit(pair, data, "thickness")
    error = brentq(lambda x: np.sum(((cor(4e-3 * np.exp(x)) / cor(4e-3) - 1.0) / 0.008) ** 2) - 1.0, 0.0, 1.0)
    assert error > 0.135
    assert found.statistical_errors["thickness"] / found.values["thickness"] == pytest.approx(error, rel=0.02)


def test_rebounds_beyond_the_models_limits_are_flagged_one_by_one():
    data = rebounds(STEEL, speed=[1.0, 2.0, 70.0], without=("plate_yield_strength",))
    found = cl.fit(STEEL, data, "plate_yield_strength")
    expected = cl.ImpactModel(STEEL, outside="solve").solve(data["speed"], RADIUS, THICKNESS).flags
    assert found.flags.tolist() == expected.tolist()
    assert found.flags[2] and not found.flags[0]


def test_a_mistake_in_the_data_is_named():
    data = rebounds(STEEL, noise=0.01, without=("thickness",))
    data["restitution"][4] *= 1.2
    found = cl.fit(STEEL, data, "thickness")
    assert any("COR of rebound 4" in note and "mistake" in note for note in found.notes)
    assert any("errors and the model's allow" in note for note in found.notes)


def test_the_curve_of_a_fit_is_the_models_with_its_values():
    data = rebounds(STEEL, noise=0.01, without=("thickness",))
    found = cl.fit(STEEL, data, "thickness")
    hit, errors_of = found.curve([0.5, 5.0], RADIUS, found.values["thickness"])
    table = cl.ImpactModel(found.pair)
    own = table.solve([0.5, 5.0], RADIUS, found.values["thickness"])
    assert hit.restitution == pytest.approx(own.restitution, rel=3e-6)  # a fit's rtol
    assert hit.flags.tolist() == own.flags.tolist()
    slope = table.sensitivity([0.5, 5.0], RADIUS, found.values["thickness"]).thickness
    share = found.errors["thickness"] / found.values["thickness"]
    assert errors_of["restitution"] == pytest.approx(slope * share * own.restitution, rel=3e-3)


def test_missing_values_are_left_out():
    data = rebounds(STEEL, kinds=KINDS[:2], without=("thickness",))
    first = data["restitution"][0]
    data["restitution"][[0, 3]] = np.nan
    data["contact_time"] = [None, *data["contact_time"][1:3], *data["contact_time"][3:]]
    data["restitution"][0] = first  # or the first would have nothing
    found = cl.fit(STEEL, data, "thickness")
    assert found.rows["restitution"].tolist() == [0, 1, 2, *range(4, 12)]
    assert found.rows["contact_time"].tolist() == list(range(1, 12))


def test_rebounds_of_which_nothing_was_measured_are_left_out_as_on_the_command_line():
    data = rebounds(STEEL, without=("thickness",))
    gaps = {k: np.insert(v, [0, 5], np.nan) if np.ndim(v) else v for k, v in data.items()}
    with pytest.warns(UserWarning, match=r"rebounds \[0 6\] have no quantity and are left out"):
        found = cl.fit(STEEL, gaps, "thickness")
    assert found.values == cl.fit(STEEL, data, "thickness").values


def test_the_errors_of_a_law_of_ones_own_are_not_known():
    data = rebounds(own_laws.PAIR, "myc", without=("thickness",))
    found = cl.fit(own_laws.PAIR, data, "thickness", own_laws.own())
    assert printed.record(found)["model_errors"] == {"thickness": None}
    assert next(line for line in printed.text(found) if "+-" in line).endswith("  not known")


def test_a_size_of_each_rebound_with_a_prior():
    """Each rebound has a radius of its own, and all radii are off by the same factor."""
    data = rebounds(STEEL, kinds=KINDS, without=("thickness",))
    data["radius"] = np.full(12, 1.05 * RADIUS)
    found = cl.fit(STEEL, data, ("thickness", "radius"), priors={"radius": 1e-4})
    assert found.values["radius"] == pytest.approx(RADIUS, rel=2e-3)
    assert found.radius == pytest.approx(found.values["radius"])


@pytest.mark.parametrize(
    ("change", "asked", "message"),
    [
        ({"speed": [1.0, np.nan]}, "thickness", "speed: got nan"),
        ({"restitution": [0.5, 85.0]}, "thickness", r"restitution: got 85.0 .*per cent\?"),
        ({"restitution": None}, "thickness", "at least one of restitution"),
        ({"restitution": [np.nan, np.nan]}, "thickness", "restitution: no rebound has one"),
        ({"restitution_error": [0.0, 0.1]}, "thickness", "restitution_error: got 0.0"),
        ({"restitution_error": [np.nan, 0.1]}, "thickness", "restitution_error: got nan"),
        ({"contact_time": 5.0e-6, "contact_time_error": -1.0}, "thickness", "contact_time_error"),
        ({"peak_force_error": 1.0}, "thickness", "there is no peak_force"),
        ({"radius": None}, "thickness", "radius: has to be given"),
        ({"thickness": 1e-3}, "thickness", "thickness: is unknown and given"),
        ({}, "yield_strenght", "unknown: got 'yield_strenght'; must be of"),
        ({}, (), "unknown: got .*; must be one to 3"),
        ({}, ("thickness", "thickness"), "unknown: got .*; must be one to 3"),
        ({"speed": 1.0, "restitution": 0.5}, ("thickness", "plate_density"), "1 measured values"),
        ({"cor": 0.9}, "thickness", "data: does not know 'cor'"),
        ({"speed": []}, "thickness", "no rebound|do not broadcast"),
        ({"restitution": ["a", "b"]}, "thickness", "restitution: got .* expected"),
    ],
)
def test_what_is_refused(change, asked, message):
    data = {"speed": [1.0, 2.0], "radius": 1e-3, "restitution": [0.5, 0.45]} | change
    data = {name: values for name, values in data.items() if values is not None}
    with pytest.raises(ValueError, match=message):
        cl.fit(STEEL, data, asked)


@pytest.mark.parametrize(
    ("priors", "message"),
    [
        ({"colour": 1.0}, "priors: got 'colour'"),
        ({"density": 0.0}, "the standard error of density must be positive"),
        ({"density": 9000.0}, "got 9000.0; the standard error of density must be positive and below it"),
        ({"density": "1"}, "density: got '1'; expected one number"),
        ({"yield_strength": 1e6}, "has no value that"),
    ],
)
def test_priors_that_are_refused(priors, message):
    pair = cl.Pair(dataclasses.replace(STEEL.sphere, yield_strength=None), STEEL.plate)
    data = {"speed": [1.0, 2.0], "radius": 1e-3, "restitution": [0.5, 0.45]}
    with pytest.raises(ValueError, match=message):
        cl.fit(pair, data, "thickness", priors=priors)


def test_things_that_are_no_data():
    with pytest.raises(TypeError, match="data: expected"):
        cl.fit(STEEL, [1.0, 2.0], "thickness")
    with pytest.raises(TypeError, match="pair: expected"):
        cl.fit(("steel", "glass"), {}, "thickness")


def test_of_a_record_clumps_are_left_out():
    """Their COR is that of the mass at the contact, which a fit does not take."""
    rows = np.ones(3, IMPACT)
    rows["kind"], rows["plate"], rows["restitution"] = [0, 6, 0], 0, [0.5, 0.6, 0.7]
    with pytest.warns(UserWarning, match="data: 1 impacts of rigid bodies are left out"):
        measured = cl.Measurements.of(cl.Record(rows))
    assert measured.restitution.tolist() == [0.5, 0.7] and measured.line.tolist() == [0, 2]


@pytest.mark.parametrize("law", ["fem", "myc"])
def test_the_stated_errors_of_the_model_are_those_beside_finite_elements(law):
    for stated, measured in zip(law_errors.MODEL_ERRORS[law], model.rms(law), strict=True):
        assert stated == pytest.approx(measured, rel=0.01)


def test_finite_elements_that_no_fit_has_seen():
    """A tenth of `python -m validation.inverse elements`: every tenth impact."""
    some = model.unseen()[::10]
    strengths, sizes = [], []
    for one in some:
        for unknown, found in (("yield_strength", strengths), ("thickness", sizes)):
            name, value = elements.asked(unknown, one)
            if not name:
                continue
            try:
                found.append(elements.one_found(one, name, value, ("restitution",)))
            except cl.UnidentifiedError:
                continue
    assert len(strengths) > 8 and len(sizes) > 10
    inside = [one for one in strengths if not one.flagged]
    assert elements.score(inside).within[1] >= 0.9  # within 5 %
    thin = [one for one in sizes if one.slenderness > 0.9 and not one.flagged]
    assert elements.score(thin).within[1] == 1.0
    assert elements.score(sizes).covered[1] >= 0.85


def test_the_page_prints_what_the_command_prints(capsys, monkeypatch, tmp_path):
    """docs/fit.md shows the command and its output."""
    docs = ROOT / "docs"
    command, shown = re.search(
        r"(contactlaw fit rebounds.csv .*?)```\n\n```text\n(.*?)```", (docs / "fit.md").read_text("utf-8"), re.DOTALL
    ).groups()
    monkeypatch.chdir(tmp_path)
    shutil.copy(docs / "examples/rebounds.csv", tmp_path)
    assert main(shlex.split(command.replace("\\\n", " "))[1:]) == 0
    printed = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    *lines, more = shown.splitlines()
    assert (printed[: len(lines)], more) == (lines, "...")


SETS = 30


@pytest.mark.parametrize(
    ("name", "law"),
    [pytest.param("thickness", "fem", marks=pytest.mark.long), ("density", "fem"), ("yield_strength", "myc")],
)
def test_the_true_value_is_within_the_stated_error_as_often_as_it_should(name, law):
    """A part of `python -m validation.inverse coverage`: within 3 standard errors of 68 %."""
    rows = coverage.tally((name,), SETS, 2, law)
    spread = (0.683 * 0.317 / SETS) ** 0.5
    for row in rows:
        assert row.answered == SETS
        assert abs(row.within["all"] - 0.683) < 3.0 * spread
