"""The numbers of the law ``"fem"`` are those that the stored campaign gives."""

import json
import math

import numpy as np
import pytest

from contactlaw.laws import fem
from validation.fem import bodies, campaign, census, fit, journal, metals, store
from validation.fem.campaign import Press


def flat(numbers):
    """All numbers of a tree, in order."""
    if isinstance(numbers, dict):
        return [x for name in sorted(numbers) for x in flat(numbers[name])]
    if isinstance(numbers, list):
        return [x for one in numbers for x in flat(one)]
    return [numbers]


@pytest.fixture(scope="module")
def fitted():
    """Errors of the shipped constants of metals beside what they were fitted to; names of that."""
    read = []

    def noted(name):
        read.append(name)
        return store.read(name)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(metals, "store", type("Store", (), {"read": staticmethod(noted)}))
        constants = metals.shipped()
        return np.concatenate([metals.errors(one, constants) for one in metals.FIT]), read


def test_the_shipped_file_is_written_with_a_row_of_a_table_on_each_line():
    assert fit.FILE.read_text("utf-8") == fit.text_of(fem.fitted())


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
    data, shipped = store.read("campaign_indentation").data, fem.fitted()
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


def test_the_constants_of_hardening_and_rate_fit(fitted):
    assert np.sqrt(np.mean(fitted[0] ** 2)) < 0.0085


def test_no_fit_reads_the_set_kept_out(monkeypatch, fitted):
    read = []

    def noted(name):
        read.append(name)
        return store.read(name)

    monkeypatch.setattr(fit, "store", type("Store", (), {"read": staticmethod(noted)}))
    assert len(fit.blows()) > 400
    assert "kept_out" not in read and "everyday" in read
    assert set(fitted[1]) == set(metals.FIT)


@pytest.mark.parametrize("name", census.SEEDS)
def test_everyday_impacts_are_those_of_their_seed(name):
    assert census.drawn(name) == census.draw(census.SEEDS[name], census.COUNT)


def test_thin_plates_are_those_of_their_seed():
    assert census.drawn(census.THIN) == census.draw_thin(census.THIN_SEED)


@pytest.mark.parametrize("yielding", campaign.YIELDING)
def test_a_coarse_indentation_again(yielding):
    """On a mesh half as fine, three times as fast, it is within 3 % of the stored one."""
    data = store.read("campaign_indentation").data
    depth = 6.0 * campaign.yield_depth(40.0)
    job = campaign._pressed(40.0, yielding, 6.0, across=6, slowness=0.5)
    found = campaign.press(job)
    strains = [1.0 / 40.0 if yielding in (body, "both") else 0.0 for body in ("sphere", "plate")]
    here = np.isclose(data["sphere_yield_strain"], strains[0])
    here &= np.isclose(data["plate_yield_strain"], strains[1]) & np.isclose(data["depth"], depth)
    n = int(np.flatnonzero(here)[0])
    assert found["force"] == pytest.approx(data["force"][n], rel=0.03)
    recovered = found["unloading_work"] / found["loading_work"]
    stored = data["unloading_work"][n] / data["loading_work"][n]
    assert recovered == pytest.approx(stored, rel=0.03)


def job_once(job):
    return {"depth": job.depth}


def test_a_killed_run_goes_on(tmp_path, monkeypatch):
    monkeypatch.setattr(store, "FOLDER", tmp_path)
    jobs = [Press(math.inf, math.inf, depth) for depth in (0.01, 0.02, 0.03)]
    first = journal.complete("some", job_once, jobs[:2], 1)
    assert [row["depth"] for row in first] == [0.01, 0.02]
    lines = journal.path("some").read_text().splitlines()
    # it was killed while it wrote its second line, and an older solver wrote the first
    journal.path("some").write_text(lines[0] + "\n" + lines[1][:30])
    assert len(journal._read(journal.path("some"))) == 1
    again = journal.complete("some", job_once, jobs, 1)
    assert [row["depth"] for row in again] == [0.01, 0.02, 0.03]
    old = json.loads(lines[0]) | {"solver_version": -1}
    journal.path("some").write_text(json.dumps(old) + "\n")
    assert journal._read(journal.path("some")) == {}
    journal.forget("some")
    assert not journal.path("some").exists()


@pytest.mark.parametrize("name", bodies.SETS)
def test_drawn_bodies_are_those_of_their_seed(name):
    stored = store.read(name).data
    for key in ("speed", "radius", "thickness", "sphere", "plate"):
        assert [getattr(one, key) for one in bodies.draw(name)] == stored[key].tolist()
