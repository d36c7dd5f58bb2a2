"""Drops that tell the model from one COR, beside a fit to as many drops."""

import csv
import json

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
    return plan(cl.ImpactModel(STEEL), RADIUS, np.array([1e-3, 2e-3, 5e-3]), np.array([0.1, 0.5]), USUAL).columns


@pytest.mark.parametrize(
    ("cause", "unknown"), [("yield_strength_of_the_plate", "plate_yield_strength"), ("thickness", "thickness")]
)
def test_so_many_drops_find_the_number_as_well_in_a_fit(made, cause, unknown):
    """The error of a fit, which scans and minimises, is the wanted one or a little less."""
    counts, tried = made[f"{cause}_by"], 0
    for n in np.flatnonzero(counts <= 100.0):
        error = made["error"][n] / np.sqrt(counts[n])
        data = {
            "speed": made["speed"][n],
            "radius": RADIUS,
            "restitution": made["restitution"][n],
            "restitution_error": error,
        }
        if unknown != "thickness":
            data["thickness"] = made["thickness"][n]
        found = cl.fit(STEEL, data, unknown)
        share = found.errors[unknown] / found.values[unknown]
        least = 0.05 * np.sqrt(1.0 - 1.0 / counts[n]) if counts[n] > 1 else 0.0  # of one drop fewer
        assert 0.9 * least < share < 1.1 * 0.05, (n, counts[n], share)
        tried += 1
    assert tried >= 2


def test_the_error_of_one_drop_and_its_bounces_are_those_of_drawn_times(made):
    random, g, (n, v, h) = np.random.default_rng(0), 9.80665, (5, made["speed"][5], made["drop"][5])
    speeds = v * made["restitution"][n] ** np.arange(200)
    flights = 2.0 * made["restitution"][n] * speeds[0] / g
    times = np.array([0.0, flights]) + 1e-3 * random.standard_normal((20000, 2))
    heights = h + 2e-3 * random.standard_normal(20000)
    cor = 0.5 * g * (times[:, 1] - times[:, 0]) / np.sqrt(2.0 * g * heights) + 0.02 * random.standard_normal(20000)
    assert np.std(cor) == pytest.approx(made["error"][n], rel=0.02)
    by_time = 0.5 * g * np.sqrt(2.0) * 1e-3 / speeds  # error of the COR of each bounce
    assert made["bounces"][n] == np.argmax(by_time > 0.02)


def test_a_sheet_of_the_stated_side_has_no_edges(made):
    """In the middle of it, the COR is that of an endless plate; at half of that it is not."""
    model, n = cl.ImpactModel(STEEL, law="hertz"), 0
    impact = made["speed"][n], RADIUS, made["thickness"][n]
    endless = model.restitution(*impact)
    near, far = (model.restitution(*impact, edge_distance=share * made["sheet"][n]) for share in (0.25, 0.5))
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


def test_a_half_space_has_no_side_and_an_elastic_bead_no_endless_bounces(capsys):
    asked = ["experiment", "--sphere", "glass", "--plate", "glass", "--law", "hertz", "--drop", "30cm"]
    assert main([*asked, "--thickness", "inf,5mm", "--timing-error", "1us"]) == 0
    said = capsys.readouterr().out
    assert "inf cm" not in said and "nan" not in said and said.count(" 20  ") == 2
    assert main([*ARGUMENTS, "--thickness", "inf"]) == 0
    assert "onto half-space find it to 5 %" in capsys.readouterr().out


def test_other_programs_read_the_drops(made, capsys):
    asked = ["experiment", "--sphere", "soda-lime-glass", "--plate", "E=70GPa nu=0.33 rho=2700 yield=250MPa kind=metal"]
    asked += ["--thickness", "1mm,2mm,5mm", "--drop", "10cm,50cm"]
    assert main([*asked, "--json"]) == 0
    records = json.loads(capsys.readouterr().out)
    assert main([*asked, "--csv"]) == 0
    rows = [*csv.DictReader(capsys.readouterr().out.splitlines())]
    cause = "yield_strength_of_the_plate"
    for n, (record, row) in enumerate(zip(records, rows, strict=True)):
        assert record["restitution"] == pytest.approx(made["restitution"][n])
        assert float(row["sheet_m"]) == pytest.approx(made["sheet"][n])
        counts = made[f"{cause}_by"][n]
        assert record[f"{cause}_by"] == (None if np.isnan(counts) else counts)
        assert row[f"{cause}_by_drops"] == ("" if np.isnan(counts) else f"{counts}")
    assert {record[f"{cause}_by"] is None for record in records} == {True, False}


def test_drops_that_are_drawn_find_the_thickness_as_said(made):
    """Heights, times, scatter and the law's error at random; then the thickness by interpolation."""
    random, g, model, cause = np.random.default_rng(5), 9.80665, cl.ImpactModel(STEEL), "thickness"
    at = int(np.flatnonzero(made[f"{cause}_by"] > 3.0)[0])
    v, h, counts = made["speed"][at], made["thickness"][at], int(made[f"{cause}_by"][at])
    trial = h * np.exp(np.linspace(-0.3, 0.3, 61))
    by_law = model.uncertainty(v, RADIUS, h).restitution.causes["model"]
    deviates = random.standard_normal((4, 4000, counts))
    cor = made["restitution"][at] + USUAL["scatter"] * deviates[0] + by_law * deviates[1][:, :1]
    speed = np.sqrt(2.0 * g * (made["drop"][at] + USUAL["height_error"] * deviates[2]))
    times = 2.0 * cor * speed / g + np.sqrt(2.0) * USUAL["timing_error"] * deviates[3]
    seen = (0.5 * g * times / np.sqrt(2.0 * g * made["drop"][at])).mean(axis=1)
    off = np.interp(seen, model.solve(v, RADIUS, trial).restitution, np.log(trial / h))
    assert 0.05 * np.sqrt(1.0 - 1.0 / counts) < np.std(off) < 0.053
    assert np.mean(np.abs(off) < 0.05) == pytest.approx(0.683, abs=0.04)
