"""From rebounds to what was not known: against what is true, and against scipy alone."""

import contextlib
import dataclasses
import pickle
import re
import shutil
import tracemalloc

import numpy as np
import own_laws
import polymer
import pytest
from lasting import long
from places import ROOT
from rebounds import KINDS, RADIUS, STEEL, THICKNESS, rebounds
from scipy import stats
from scipy.optimize import brentq, least_squares

import contactlaw as cl
from contactlaw.answers import law_errors
from contactlaw.cli.fit import printed
from contactlaw.record.columns import IMPACT
from validation.inverse import coverage, elements, model

ALUMINA, GLASS = cl.Pair("gamma-alumina", "glass"), cl.Pair("glass", "glass")
ON_CARBIDE = cl.Pair("stainless-steel-304", "tungsten-carbide")
RATED = cl.Pair("alloy-steel-4340", "copper-ofhc-annealed")
SOFT = cl.Pair("stainless-steel-304", "alumina")  # on a plate like hard beads on a thinner one
MODEL = cl.ImpactModel(STEEL)


def true(pair, name):
    """A size of `rebounds`, or a number of a body."""
    sizes = {"radius": RADIUS, "thickness": THICKNESS}
    body, field = (pair.plate, name[6:]) if name.startswith("plate_") else (pair.sphere, name)
    return sizes.get(name) or getattr(body, field)


@pytest.mark.parametrize(
    ("pair", "law", "unknown", "error"),
    [
        *(
            (STEEL, "fem", (f"{body}{name}",), 2e-5)
            for body, names in (
                ("", ("thickness", "radius", "density", "youngs_modulus")),
                ("plate_", ("density", "youngs_modulus", "yield_strength")),
            )
            for name in names
        ),
        (STEEL, "fem", ("plate_yield_strength", "thickness"), 2e-5),
        long(STEEL, "fem", ("radius", "thickness", "plate_yield_strength"), 2e-5),
        (ON_CARBIDE, "fem", ("yield_strength",), 2e-5),
        (SOFT, "fem", ("yield_strength", "thickness"), 2e-5),
        (RATED, "fem", ("plate_yield_strength",), 1e-3),  # strengths at the rates of the impacts
        (ALUMINA, "myc", ("thickness", "yield_strength"), 1e-4),
        (ALUMINA, "jackson_green", ("thickness", "yield_strength"), 1e-4),
    ],
)
def test_exact_data_give_back_what_made_them(pair, law, unknown, error):
    speed = np.geomspace(2.0, 40.0, 9) if pair is ALUMINA else None
    found = cl.fit(pair, rebounds(pair, law, KINDS, speed=speed, without=unknown), unknown, law)
    for name in unknown:
        assert found.values[name] == pytest.approx(true(pair, name), rel=error)
        if name not in ("radius", "thickness"):
            assert true(found.pair, name) == found.values[name]
    assert all(abs(off).max() < error for off in found.residuals.values())
    assert set(found.values) == set(found.errors) == set(unknown) == set(found.unknown)
    assert found.law.startswith(law) and not found.alternatives


def test_a_second_regime_that_fits_as_well_is_named():
    """Within 5 %, these four rebounds also fit a hard bead on a thin plate: 3130 MPa and 0.51 mm for 205 and 1."""
    unknown = "yield_strength", "thickness"
    data = rebounds(SOFT, speed=np.geomspace(1.0, 12.0, 12)[::3], thickness=1e-3, without=unknown)
    data["restitution_error"] = 0.05 * data["restitution"]
    found = cl.fit(SOFT, data, unknown)
    assert found.alternatives
    for regime in found.alternatives:
        assert regime["thickness"] < 0.6e-3 and regime["yield_strength"] > 1e9
        bead = dataclasses.replace(found.pair.sphere, yield_strength=regime["yield_strength"])
        there = cl.ImpactModel(cl.Pair(bead, found.pair.plate)).solve(data["speed"], RADIUS, regime["thickness"])
        assert np.sqrt(np.mean((there.restitution / data["restitution"] - 1.0) ** 2)) < 0.05
    assert any("fitted as well by yield strength of the bead" in note for note in found.notes)


def test_a_loss_factor_is_found_of_a_polymer_that_has_none_and_of_one_that_has_another():
    bead = dataclasses.replace(polymer.SOFT, loss_factor=(0.12, 1.5e4))
    data = rebounds(cl.Pair(bead, "glass"), speed=[0.5, 1.0, 2.0, 3.0], thickness=2e-2)
    other, none = (
        cl.fit(cl.Pair(dataclasses.replace(bead, loss_factor=loss), "glass"), data, "loss_factor")
        for loss in ((0.3, 1.5e4), None)
    )
    assert other.values["loss_factor"] == pytest.approx(0.12, rel=1e-3)
    assert none.values["loss_factor"] == pytest.approx(0.12, rel=0.02)
    assert 5e3 < none.pair.sphere.loss_factor[1] < 4e4


def test_value_and_error_are_those_of_least_squares_by_scipy():
    data = rebounds(STEEL, noise=0.01, seed=3, without=("thickness",))

    def off(x):
        cor = MODEL.solve(data["speed"], RADIUS, float(x[0]) * 1e-3).restitution
        return (cor - data["restitution"]) / data["restitution_error"]

    done = least_squares(off, [2.0], diff_step=1e-5, xtol=1e-12, ftol=1e-12)
    found = cl.fit(STEEL, data, "thickness")
    assert found.values["thickness"] == pytest.approx(done.x[0] * 1e-3, rel=1e-5)
    assert found.statistical_errors["thickness"] == pytest.approx(1e-3 / np.linalg.norm(done.jac), rel=1e-3)
    parts = found.statistical_errors["thickness"], found.model_errors["thickness"]
    assert found.errors["thickness"] == pytest.approx(np.hypot(*parts), rel=1e-12)


def test_without_errors_of_the_data_one_rebound_has_that_of_the_model_alone():
    data = rebounds(STEEL, speed=[1.0], without=("thickness",))
    del data["restitution_error"]
    found = cl.fit(STEEL, data, "thickness")
    assert found.statistical_errors["thickness"] == 0.0 < found.model_errors["thickness"]
    assert any("model alone" in note for note in found.notes)


@pytest.mark.parametrize(("count", "plates", "close"), [(40, "many", 1e-3), (1500, "one", 5e-3), (1500, "many", 6e-2)])
def test_the_models_errors_are_alike_where_speeds_and_plates_are(count, plates, close):
    """Within a factor e in speed and in R/H; beyond 400 different impacts, those in one cell err alike.

    Matrices of all rebounds would take 140 MB for 1500 of them.
    """
    random = np.random.default_rng(4)
    v = np.exp(random.uniform(-1.0, 1.0, count))
    h = 1e-3 * np.exp(random.uniform(-0.3, 0.5, count)) if plates == "many" else np.full(count, THICKNESS)
    v[1], h[1] = v[0], h[0]  # equal impacts
    hit, data = MODEL.solve(v, RADIUS, h), rebounds(STEEL, speed=v, thickness=h)
    assert not hit.flags.any()
    tracemalloc.start()
    found = cl.fit(STEEL, data, "density")
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 40e6
    slope = MODEL.sensitivity(v, RADIUS, h).sphere_density
    # Gain of a weighted mean of values with equal relative errors; errors of CORs below 0.3 are relative to 0.3.
    gain = slope / np.sum(slope**2) * np.maximum(0.3 / hit.restitution, 1.0)
    apart = np.hypot(*(np.log(x)[:, None] - np.log(x) for x in (v, h)))
    exact = law_errors.MODEL_ERRORS["fem"][0][0] * np.sqrt(gain @ np.exp(-apart) @ gain)
    assert found.model_errors["density"] / found.values["density"] == pytest.approx(exact, rel=close)


def test_errors_that_are_not_given_are_found_from_the_scatter():
    """If all values are proportional to the parameter, mean and 1/sqrt(n) are exact by hand."""
    scatter = np.array([1.01, 0.98, 1.03, 0.995, 1.002, 0.99])
    cor = MODEL.solve(1.0, RADIUS, THICKNESS).restitution * scatter
    found = cl.fit(STEEL, {"speed": np.ones(6), "radius": RADIUS, "restitution": cor}, "thickness")
    fitted = MODEL.solve(1.0, RADIUS, found.values["thickness"]).restitution
    assert fitted == pytest.approx(np.mean(cor), rel=1e-6)
    slope = MODEL.sensitivity(1.0, RADIUS, THICKNESS).thickness
    of_mean = scatter.std(ddof=1) / scatter.mean() / np.sqrt(6.0)
    widened = stats.t.ppf(stats.norm.cdf(1.0), 5) * of_mean
    share = found.statistical_errors["thickness"] / found.values["thickness"]
    assert share == pytest.approx(widened / slope, rel=0.02)


@pytest.mark.parametrize("name", ["density", "plate_density", "youngs_modulus"])
def test_a_prior_enters_the_error(name):
    """A number known to 10 % adds an error to H by the ratio of the two derivatives."""
    data = rebounds(STEEL, speed=[1.0], without=("thickness",))
    alone, with_it = (cl.fit(STEEL, data, "thickness", priors=p) for p in ({}, {name: 0.1 * true(STEEL, name)}))
    slopes = MODEL.sensitivity(1.0, RADIUS, THICKNESS)
    field = {"density": "sphere_density", "youngs_modulus": "sphere_modulus"}.get(name, name)
    extra = 0.1 * getattr(slopes, field) / slopes.thickness * THICKNESS
    before, after = (one.statistical_errors["thickness"] for one in (alone, with_it))
    assert np.sqrt(after**2 - before**2) == pytest.approx(abs(extra), rel=0.02)
    assert with_it.values["thickness"] == pytest.approx(THICKNESS, rel=1e-4)


def test_a_prior_of_the_unknown_itself_pulls_it():
    data = rebounds(STEEL, speed=[1.0])
    pulled = cl.fit(STEEL, data | {"thickness": 1.5e-3}, "thickness", priors={"thickness": 1e-6})
    assert pulled.values["thickness"] == pytest.approx(1.5e-3, rel=2e-3)


def test_a_size_of_each_rebound_with_a_prior():
    """Each rebound has a radius of its own, and all radii are off by the same factor."""
    data = rebounds(STEEL, kinds=KINDS, without=("thickness",)) | {"radius": np.full(12, 1.05 * RADIUS)}
    found = cl.fit(STEEL, data, ("thickness", "radius"), priors={"radius": 1e-4})
    assert found.values["radius"] == pytest.approx(RADIUS, rel=2e-3)
    assert found.radius == pytest.approx(found.values["radius"])


def test_a_strength_from_below_yield_is_refused_with_what_is_known():
    data = rebounds(ALUMINA, speed=np.geomspace(0.3, 4.0, 10), noise=0.005)
    with pytest.raises(cl.UnidentifiedError, match="yield_strength: any above") as caught:
        cl.fit(ALUMINA, data, "yield_strength")
    (least,) = re.findall(r"above (\S+) MPa", str(caught.value))
    # at that strength the fastest just yields, with what the errors leave
    weak = dataclasses.replace(ALUMINA.sphere, yield_strength=float(least) * 1e6)
    assert 1.0 < cl.Pair(weak, "glass").yield_speed < 4.5
    assert pickle.loads(pickle.dumps(caught.value)).unknown == ("yield_strength",)


def test_a_product_is_told_where_its_factors_are_not():
    """Below yield only the mobility of a thin plate counts, and so only H^2 sqrt(rho2)."""
    data = rebounds(ALUMINA, speed=np.geomspace(0.3, 4.0, 10), noise=0.01, without=("thickness",))
    with pytest.raises(cl.UnidentifiedError, match="do not determine .* separately. They determine") as caught:
        cl.fit(ALUMINA, data, ("thickness", "plate_density"))
    ((powers, value, error),) = caught.value.known
    assert powers == {"thickness": 1.0, "plate_density": pytest.approx(0.25, abs=0.02)}
    exact = THICKNESS * ALUMINA.plate.density ** powers["plate_density"]
    assert value == pytest.approx(exact, rel=3.0 * error)
    assert error < 0.05


@pytest.mark.parametrize(("law", "unknown"), [("myc", "plate_yield_strength"), ("hertz", "yield_strength")])
def test_what_a_law_does_not_depend_on_is_refused(law, unknown):
    with pytest.raises(cl.UnidentifiedError, match=f"law '{law}' does not depend on it"):
        cl.fit(ALUMINA, rebounds(ALUMINA, law, noise=0.01), unknown, law)


def chi_squared(data, kind, thickness):
    """Sum of squares that glass on a plate of a thickness has."""
    hit = cl.ImpactModel(GLASS).solve(data["speed"], RADIUS, thickness, rtol=1e-10)
    return np.sum(((getattr(hit, kind) - data[kind]) / data[f"{kind}_error"]) ** 2)


def test_a_thickness_that_may_be_any_larger_is_refused():
    """The contact time on thick plates tends to that on a half-space, which bounds no thickness."""
    data = rebounds(GLASS, kinds=["contact_time"], speed=[0.5, 1.0, 2.0], thickness=3e-3, without=("thickness",))
    data["contact_time_error"] *= 0.2
    with pytest.raises(cl.UnidentifiedError, match="thickness on one side only: above") as refused:
        cl.fit(GLASS, data, "thickness")
    bound = float(str(refused.value).split("above ")[1].split()[0])
    assert 4.0 < chi_squared(data, "contact_time", bound) < 5.0  # two standard errors, from the best or a half-space


def test_an_error_is_the_distance_at_which_the_sum_of_squares_rises_by_one():
    """The COR of a thick plate tends to 1: its error is larger than that of a linear model, 0.123."""
    data = rebounds(GLASS, speed=[0.5, 1.0, 2.0], thickness=4e-3, without=("thickness",))
    data["restitution_error"] *= 0.8
    found = cl.fit(GLASS, data, "thickness")
    error = brentq(lambda x: chi_squared(data, "restitution", 4e-3 * np.exp(x)) - 1.0, 0.0, 1.0)
    assert error > 0.135
    assert found.statistical_errors["thickness"] / found.values["thickness"] == pytest.approx(error, rel=0.02)


def test_rebounds_beyond_the_models_limits_are_flagged_one_by_one():
    found = cl.fit(STEEL, rebounds(STEEL, speed=[1.0, 2.0, 70.0]), "plate_yield_strength")
    assert (
        found.flags.tolist()
        == cl.ImpactModel(STEEL, outside="solve").solve([1.0, 2.0, 70.0], RADIUS, THICKNESS).flags.tolist()
    )
    assert found.flags[2] and not found.flags[0]


def test_a_mistake_in_the_data_is_named():
    data = rebounds(STEEL, noise=0.01, without=("thickness",))
    data["restitution"][4] *= 1.2
    notes = cl.fit(STEEL, data, "thickness").notes
    assert any("COR of rebound 4" in note and "mistake" in note for note in notes)
    assert any("errors and the model's allow" in note for note in notes)


def test_the_curve_of_a_fit_is_the_models_with_its_values():
    found = cl.fit(STEEL, rebounds(STEEL, noise=0.01, without=("thickness",)), "thickness")
    thickness = found.values["thickness"]
    hit, errors = found.curve([0.5, 5.0], RADIUS, thickness)
    own = MODEL.solve([0.5, 5.0], RADIUS, thickness)
    assert hit.restitution == pytest.approx(own.restitution, rel=3e-6)  # a fit's rtol
    assert hit.flags.tolist() == own.flags.tolist()
    slope = MODEL.sensitivity([0.5, 5.0], RADIUS, thickness).thickness
    expected = slope * found.errors["thickness"] / thickness * own.restitution
    assert errors["restitution"] == pytest.approx(expected, rel=3e-3)


def test_missing_values_and_rebounds_of_which_nothing_was_measured_are_left_out():
    data = rebounds(STEEL, kinds=KINDS[:2], without=("thickness",))
    data["restitution"][3] = np.nan
    data["contact_time"] = [None, *data["contact_time"][1:]]
    found = cl.fit(STEEL, data, "thickness")
    assert found.rows["restitution"].tolist() == [0, 1, 2, *range(4, 12)]
    assert found.rows["contact_time"].tolist() == list(range(1, 12))
    gaps = {name: np.insert(np.array(v, float), [0, 5], np.nan) if np.ndim(v) else v for name, v in data.items()}
    with pytest.warns(UserWarning, match=r"rebounds \[0 6\] have no quantity and are left out"):
        assert cl.fit(STEEL, gaps, "thickness").values == found.values


def test_the_errors_of_a_law_of_ones_own_are_not_known():
    found = cl.fit(own_laws.PAIR, rebounds(own_laws.PAIR, "myc", without=("thickness",)), "thickness", own_laws.own())
    assert printed.record(found)["model_errors"] == {"thickness": None}
    assert next(line for line in printed.text(found) if "+-" in line).endswith("  not known")


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
    found = {"yield_strength": [], "thickness": []}
    for impact in model.unseen()[::10]:
        for unknown, fits in found.items():
            name, value = elements.asked(unknown, impact)
            if name:
                with contextlib.suppress(cl.UnidentifiedError):
                    fits.append(elements.one_found(impact, name, value, ("restitution",)))
    strengths, sizes = found.values()
    assert len(strengths) > 8 and len(sizes) > 10
    inside = [one for one in strengths if not one.flagged]
    assert elements.score(inside).within[1] >= 0.9  # within 5 %
    thin = [one for one in sizes if one.slenderness > 0.9 and not one.flagged]
    assert elements.score(thin).within[1] == 1.0
    assert elements.score(sizes).covered[1] >= 0.85


def test_the_page_prints_what_the_command_prints(folder, answer):
    """docs/fit.md shows the command and its output."""
    shutil.copy(ROOT / "docs/examples/rebounds.csv", folder)
    shows = re.compile(r"contactlaw (fit rebounds.csv .*?)```\n\n```text\n(.*?)```", re.DOTALL)
    command, shown = shows.search((ROOT / "docs/fit.md").read_text("utf-8")).groups()
    output = [line.rstrip() for line in answer(command.replace("\\\n", " ")).out.splitlines()]
    *lines, more = shown.splitlines()
    assert (output[: len(lines)], more) == (lines, "...")


@pytest.mark.parametrize(("name", "law"), [long("thickness", "fem"), ("density", "fem"), ("yield_strength", "myc")])
def test_the_true_value_is_within_the_stated_error_as_often_as_it_should(name, law):
    """A part of `python -m validation.inverse coverage`: within 3 standard errors of 68 %."""
    sets = 30
    for row in coverage.tally((name,), sets, 2, law):
        assert row.answered == sets
        assert abs(row.within["all"] - 0.683) < 3.0 * (0.683 * 0.317 / sets) ** 0.5
