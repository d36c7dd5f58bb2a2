"""The numbers of the law ``"fem"`` are those that the stored campaign gives."""

import dataclasses
import json
import math

import numpy as np
import pytest
from lasting import long

from contactlaw.laws import fem
from validation.fem import campaign, cases, census, fit, journal, metals, store
from validation.fem.campaign import Press


def flat(numbers):
    """All numbers of a tree, in order."""
    if isinstance(numbers, dict):
        return [x for name in sorted(numbers) for x in flat(numbers[name])]
    if isinstance(numbers, list):
        return [x for one in numbers for x in flat(one)]
    return [numbers]


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:divide by zero")
def test_the_fit_gives_the_numbers_that_are_shipped():
    # least squares of powers: the last digits of coefficients that hardly matter are the machine's
    ours, shipped = (np.array(flat(one)) for one in (fit.numbers(), fem.fitted()))
    assert ours.shape == shipped.shape
    np.testing.assert_allclose(ours, shipped, rtol=1e-3, atol=1e-3)


@pytest.mark.filterwarnings("ignore:divide by zero")
def test_the_fit_to_indentations_gives_the_numbers_that_are_shipped():
    """The part of the whole fit that needs no impacts."""
    data, shipped = store.read(campaign.NAME).data, fem.fitted()
    stiff, friction = fit.stiffening(data)
    assert friction == pytest.approx(0.0, abs=0.02)
    for yielding in campaign.YIELDING:
        for name, ours in fit.case(data, yielding, stiff, friction).items():
            theirs = flat(shipped["curves"][name][yielding])
            np.testing.assert_allclose(flat(ours), theirs, rtol=1e-3, atol=1e-3)


@pytest.mark.long
def test_the_constants_of_hardening_and_rate_are_where_their_fit_ends():
    """A step of Gauss and Newton from the constants that are shipped leads hardly anywhere."""
    constants = metals.shipped()
    assert np.abs(np.divide(metals.step(constants), constants)).max() < 0.03


def test_the_constants_of_hardening_and_rate_fit():
    off = np.concatenate([metals.errors(name, metals.shipped()) for name in metals.FIT])
    assert np.sqrt(np.mean(off**2)) < 0.0085


def test_the_strength_of_bodies_with_losses_is_where_its_fit_ends():
    """Elastic impacts, to which it was not fitted, are within 2 %, rms 0.6 %."""
    found = fem.fitted()
    low, here, high = (
        metals.errors_by("polymers", {**found, "pressure": x * found["pressure"]}) for x in (0.7, 1.0, 1.3)
    )
    flows = np.array([case.yields or case.plate_yields for case in cases.stored("polymers")])
    assert np.abs(here[~flows]).max() < 0.02 and np.sqrt(np.mean(here[~flows] ** 2)) < 0.0065
    rms = [np.sqrt(np.mean(off[flows] ** 2)) for off in (low, here, high)]
    assert rms[1] < min(rms[0], rms[2]) and rms[1] < 0.012


def test_no_fit_reads_a_set_that_was_kept_out(monkeypatch):
    names, read = list(metals.FIT), store.read
    monkeypatch.setattr(store, "read", lambda name: names.append(name) or read(name))
    assert len(fit.blows()) > 400 and "everyday" in names
    assert not [name for name in names if "kept_out" in name or name == "everyday_5"]


def test_a_set_is_drawn_by_its_seed():
    """A new set is drawn as the one that was kept out."""
    drawn = census.draw(20261127, 80)
    stored = cases.stored("kept_out")
    assert [(one.speed, one.thickness, one.pair) for one in stored] == [
        (one.speed, one.thickness, one.pair) for one in drawn
    ]


@pytest.mark.parametrize("yielding", ["plate", long("both")])
def test_a_coarse_indentation_again(yielding):
    """On a mesh half as fine, twice as fast, it is within 3 % of the stored one."""
    data = store.read(campaign.NAME).data
    ratios = [40.0 if yielding in (body, "both") else math.inf for body in ("sphere", "plate")]
    n, job = next(
        (n, job)
        for n, job in enumerate(campaign.stored())
        if [job.sphere, job.plate] == pytest.approx(ratios) and data["depth"][n] > 0.03
    )
    found = campaign.press(dataclasses.replace(job, across=6, slowness=0.5))
    assert found["force"] == pytest.approx(data["force"][n], rel=0.03)
    recovered = found["unloading_work"] / found["loading_work"]
    stored = data["unloading_work"][n] / data["loading_work"][n]
    assert recovered == pytest.approx(stored, rel=0.03)


def test_an_impact_is_computed_again_from_its_file(tmp_path, monkeypatch):
    """Its inputs, its other columns and what the file says of itself stay."""
    data, attributes = store.read("verification")
    (n,) = np.flatnonzero((data["check"] == "mesh") & (data["size"] == 0.04) & (data["thickness"] == 1e-3))
    monkeypatch.setattr(store, "FOLDER", tmp_path)
    row = {name: values[[n]] for name, values in data.items()}
    store.write("verification", attributes["about"], row, dict.fromkeys(row, "-"))
    journal.again("verification", 1)
    again, made = store.read("verification")
    assert made["about"] == attributes["about"] and again["check"] == ["mesh"]
    for name in ("speed", "thickness", "size", "restitution", "peak_force", "elements"):
        assert again[name] == pytest.approx(data[name][n], rel=1e-6), name


def job_once(job):
    return {"depth": job.depth}


def job_anew(job):
    """Done where `job_once` was lost."""
    return {"depth": -job.depth}


def test_a_killed_run_goes_on(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "FOLDER", tmp_path)
    jobs = [Press(math.inf, math.inf, depth) for depth in (0.01, 0.02, 0.03)]
    first = journal.complete("some", job_once, jobs[:2], 1)
    assert [row["depth"] for row in first] == [0.01, 0.02]
    lines = journal.path("some").read_text().splitlines()
    # it was killed while it wrote its second line, and an older solver wrote another one
    old = json.loads(lines[1]) | {"solver_version": -1}
    journal.path("some").write_text("\n".join([lines[0], json.dumps(old), lines[1][:30]]))
    again = journal.complete("some", job_anew, jobs, 1)
    assert [row["depth"] for row in again] == [0.01, -0.02, -0.03]
    journal.forget("some")
    assert not journal.path("some").exists()
