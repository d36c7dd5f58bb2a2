"""Friction from oblique impacts: against what made the data, and as measured."""

import csv

import numpy as np
import pytest
from lasting import long
from places import ROOT

import contactlaw as cl
from contactlaw.fitting import errors
from validation.fem3d import cases

PAIR = cl.Pair("gamma-alumina", "glass")
MODEL = cl.ImpactModel(PAIR)
RADIUS, THICKNESS, SPEED = 0.9e-3, 3e-3, 3.0
KINDS = ("tangential_restitution", "rotational_restitution", "spin")


def hits(angle, friction):
    """Outcomes of beads that come at angles [deg]."""
    turned = np.radians(angle)
    sizes = RADIUS, THICKNESS, friction
    return MODEL.oblique(SPEED * np.cos(turned), SPEED * np.sin(turned), *sizes, method="solve")


def measured(kinds, angle, friction, noise=0.0, seed=0):
    """What would be measured of these beads, with the stated relative errors of 1 + beta, ..."""
    hit, random = hits(angle, friction), np.random.default_rng(seed)
    data = {"speed": SPEED, "angle": angle, "radius": RADIUS, "thickness": THICKNESS}
    for kind in kinds:
        if kind == "spin":
            exact = 2.5 * SPEED * np.sin(np.radians(angle)) * (1.0 - hit.tangential_restitution) / RADIUS
        else:
            exact = getattr(hit, kind)
        error = max(noise, 1e-3) * (exact + (kind == "rotational_restitution"))
        data[kind] = exact + (noise > 0.0) * error * random.standard_normal(angle.size)
        data[f"{kind}_error"] = error
    return data


@pytest.mark.parametrize(("kind", "friction"), [*zip(KINDS, (0.1, 0.25, 0.1), strict=True)])
def test_exact_data_give_back_the_friction(kind, friction):
    data = measured([kind], np.linspace(5.0, 75.0, 8), friction)
    found = cl.fit(PAIR, data, "friction")
    assert found.values["friction"] == pytest.approx(friction, rel=1e-5)
    assert abs(found.residuals[kind]).max() < 1e-5 and found.alternatives == ()
    sliding = {"speed": SPEED * np.cos(np.radians(data["angle"]))}
    sliding["sliding_speed"] = SPEED * np.sin(np.radians(data.pop("angle")))
    again = cl.fit(PAIR, data | sliding, "friction")
    assert again.values["friction"] == pytest.approx(found.values["friction"], rel=1e-9)


def test_the_error_of_the_model_is_that_of_the_sliding_speed_beside_finite_elements():
    """Where beads slide all the time, v_s - v_s' = 7/2 mu (1 + e) V: relative errors are equal."""
    off = [
        cases.model(case).sliding_speed / (case.friction * case.speed) - outcome["psi_after"]
        for name in cases.SETS
        for case, outcome in cases.results(name).items()
    ]
    assert np.sqrt(np.mean(np.square(off))) == pytest.approx(errors.SLIDING_ERROR, rel=0.02)
    angle = np.array([70.0])
    full = 3.5 * (1.0 + hits(angle, 0.1).restitution)
    # one error makes the spin too large and the tangential restitution too small
    for kinds in (["spin"], ["spin", "tangential_restitution"]):
        found = cl.fit(PAIR, measured(kinds, angle, 0.1), "friction")
        share = found.model_errors["friction"] / found.values["friction"]
        assert share == pytest.approx(errors.SLIDING_ERROR / full, rel=1e-3)


@pytest.mark.parametrize(("column", "kind"), [(1, "tangential_restitution"), (2, "spin")])
def test_friction_of_the_measurements_of_kharaz_and_others(column, kind):
    """Points beyond 28 degrees, where the beads slide all the time; the paper states 0.092."""
    with (ROOT / "validation/measured/kharaz-2001.csv").open(encoding="utf-8") as file:
        rows = [row[1:] for row in csv.reader(file) if row[0] in "12"]
    rows = [row for row in rows if row[column] and float(row[0]) > 28.0]
    angle, values = np.array([(row[0], row[column]) for row in rows], dtype=float).T
    data = {"speed": 3.9, "angle": angle, "radius": 2.5e-3, "thickness": np.inf, kind: values}
    found = cl.fit(cl.Pair("alumina", "glass"), data, "friction")
    assert found.values["friction"] == pytest.approx(0.092, rel=0.03)
    assert abs(found.values["friction"] - 0.092) < 2.0 * found.errors["friction"] < 0.004


@pytest.mark.parametrize(("friction", "noise"), [(0.5, 0.01), *(long(*at) for at in ((1.0, 0.03), (2.0, 0.01)))])
def test_beads_that_stick_do_not_determine_it(friction, noise):
    data = measured(KINDS[:1], np.linspace(2.0, 12.0, 4), friction, noise)
    with pytest.raises(cl.UnidentifiedError, match="friction: any above .* larger angles") as error:
        cl.fit(PAIR, data, "friction")
    bound = float(str(error.value).split("any above ")[1].split()[0])
    assert 0.05 < bound < friction


def test_with_a_thickness_from_the_cor():
    angle = np.linspace(5.0, 70.0, 3)
    data = measured([KINDS[0]], angle, 0.2) | {"restitution": hits(angle, 0.2).restitution}
    del data["thickness"]
    found = cl.fit(PAIR, data, ("friction", "thickness"))
    assert [*found.values.values()] == pytest.approx([0.2, THICKNESS], rel=1e-3)
    hit, error = found.curve(2.5, RADIUS, THICKNESS, sliding_speed=1.5)
    own = MODEL.oblique(2.5, 1.5, RADIUS, THICKNESS, 0.2, method="solve")
    assert hit.tangential_restitution == pytest.approx(own.tangential_restitution, abs=1e-3)
    assert list(error) == ["restitution", "tangential_restitution"]


def test_a_known_friction_helps_to_find_something_else():
    data = measured(["spin"], np.linspace(50.0, 80.0, 6), 0.1) | {"friction": 0.1}
    del data["radius"]
    found = cl.fit(PAIR, data, "radius", priors={"friction": 0.002})
    assert found.values["radius"] == pytest.approx(RADIUS, rel=1e-3)
    assert found.statistical_errors["radius"] / RADIUS == pytest.approx(0.02, rel=0.1)
