"""Drops that tell the model from one COR, beside a fit to as many drops."""

import numpy as np
import pytest
from command_line import refused

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.cli.experiment import plan

STEEL = cl.Pair("soda-lime-glass", cl.Material("metal", 70e9, 0.33, 2700.0, 250e6, kind="metal"))
RADIUS = 2e-3
USUAL = {"timing_error": 1e-3, "height_error": 2e-3, "scatter": 0.02}
ARGUMENTS = ["experiment", "--sphere", "soda-lime-glass", "--plate", "aluminium-6061-t6"]


@pytest.fixture(scope="module")
def made():
    return plan(cl.ImpactModel(STEEL), RADIUS, np.array([1e-3, 2e-3, 5e-3]), np.array([0.1, 0.5]), USUAL)


@pytest.mark.parametrize(
    ("cause", "unknown"), [("yield strength of the plate", "plate_yield_strength"), ("thickness", "thickness")]
)
def test_so_many_drops_find_the_number_as_well_in_a_fit(made, cause, unknown):
    """The error of a fit, which scans and minimises, is the wanted one or a little less."""
    counts, tried = made.found[cause], 0
    for n in np.flatnonzero(counts <= 100.0):
        error = made.error[n] / np.sqrt(counts[n])
        data = {
            "speed": made.speed[n],
            "radius": RADIUS,
            "restitution": made.restitution[n],
            "restitution_error": error,
        }
        if unknown != "thickness":
            data["thickness"] = made.thickness[n]
        found = cl.fit(STEEL, data, unknown)
        share = found.errors[unknown] / found.values[unknown]
        least = 0.05 * np.sqrt(1.0 - 1.0 / counts[n]) if counts[n] > 1 else 0.0  # of one drop fewer
        assert 0.9 * least < share < 1.1 * 0.05, (n, counts[n], share)
        tried += 1
    assert tried >= 2


def test_the_error_of_one_drop_and_its_bounces_are_those_of_drawn_times(made):
    random, g, (n, v, h) = np.random.default_rng(0), 9.80665, (5, made.speed[5], made.drop[5])
    speeds = v * made.restitution[n] ** np.arange(200)
    flights = 2.0 * made.restitution[n] * speeds[0] / g
    times = np.array([0.0, flights]) + 1e-3 * random.standard_normal((20000, 2))
    heights = h + 2e-3 * random.standard_normal(20000)
    cor = 0.5 * g * (times[:, 1] - times[:, 0]) / np.sqrt(2.0 * g * heights) + 0.02 * random.standard_normal(20000)
    assert np.std(cor) == pytest.approx(made.error[n], rel=0.02)
    by_time = 0.5 * g * np.sqrt(2.0) * 1e-3 / speeds  # error of the COR of each bounce
    assert made.bounces[n] == np.argmax(by_time > 0.02)


def test_a_sheet_of_the_stated_side_has_no_edges(made):
    """In the middle of it, the COR is that of an endless plate; at half of that it is not."""
    model, n = cl.ImpactModel(STEEL, law="hertz"), 0
    impact = made.speed[n], RADIUS, made.thickness[n]
    endless = model.restitution(*impact)
    near, far = (model.restitution(*impact, edge_distance=share * made.sheet[n]) for share in (0.25, 0.5))
    assert far == pytest.approx(endless, abs=3e-3) and abs(near - endless) > 3e-3


def test_the_command_says_what_to_do(capsys):
    assert main(ARGUMENTS) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "The thickest sheet that tells its thickness: " in said and "yield strength of the plate: " in said
    for options, words in (
        (["--drop", "200"], "--drop: got 200.0; must lie between"),
        (["--scatter", "0"], "--scatter: got"),
        (["--thickness", "1um"], "thickness"),
    ):
        refused([*ARGUMENTS, *options], words, capsys=capsys)
