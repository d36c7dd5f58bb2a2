"""Plates with edges: the response against the exact one, and the equation with its memory."""

import csv
import functools
import math

import numpy as np
import pytest
from lasting import long
from scipy.signal import argrelmax
from scipy.special import sici

from contactlaw import laws
from contactlaw.equation import outcome, zener
from contactlaw.equation.corrections import CONTACT_TIME
from contactlaw.equation.edge import KINDS, SIZE, Edges
from contactlaw.equation.force import HERTZ
from contactlaw.equation.outcome import History
from contactlaw.laws import fem
from contactlaw.physical.responses import response_of
from validation.accuracy import edges as independent
from validation.derivations import edges as exact
from validation.derivations.walls import convolved

MYC = laws.law("myc").data
USUAL = exact.DURATIONS[(exact.DURATIONS > 0.05) & (exact.DURATIONS < 1000.0)]
# Mobility at a free edge over that far from it, `shared/PHYSICS.md`, section 9.
AT_THE_EDGE = {0.0: 3.27, 0.2: 3.53, 0.3: 3.70, 0.5: 4.18}


@pytest.fixture(autouse=True)
def a_few_durations(monkeypatch):
    monkeypatch.setattr(exact, "DURATIONS", USUAL[::3])


@functools.cache
def exact_work(kind, poisson, radius):
    return exact.work(exact.speeds(kind, poisson, radius))


def error_of_work(kind, poisson, radius=math.inf):
    response = response_of(kind, poisson, 1.0 / (1.0 + radius))
    added = 0.0
    for part in response.reshape(-1, SIZE):
        blocks = part[:12].reshape(3, 4)[:, :3]
        added = added + np.tensordot(part[12:], exact.columns(exact.rates_of(blocks)), 1)
    wanted = exact_work(kind, poisson, radius)
    return np.abs((exact.work(added) - wanted) / np.maximum(1.0 + wanted, 0.3)).max()


@pytest.mark.parametrize(("poisson", "ratio"), AT_THE_EDGE.items())
def test_the_mobility_at_a_free_edge(poisson, ratio):
    """The closed form by the derivation, and by the weights of all rates."""
    assert 1.0 + exact.at_the_edge("free", poisson) == pytest.approx(ratio, abs=0.006)
    total = 1.0
    for part in response_of("free", poisson).reshape(-1, SIZE):
        turns = part[2:12:4] != 0.0  # the imaginary part of a steady z is 0
        total += part[12::2].sum() + part[13::2][~turns].sum()
    assert total == pytest.approx(ratio, rel=0.01)


# between those of the fit; at a clamped and at a supported edge they make no difference
@pytest.mark.parametrize(
    ("poisson", "kind"),
    [*((0.15, kind) for kind in KINDS if kind != "supported"), long(0.15, "supported"), long(0.4, "free")],
)
def test_the_fitted_response_does_the_work_of_the_exact_one(kind, poisson):
    assert error_of_work(kind, poisson) < 0.005
    if kind != "free":
        assert (response_of(kind, poisson) == response_of(kind, 0.4)).all()


@pytest.mark.parametrize(  # between those of the fit
    "radius", [4.0, *(long(radius) for radius in (20.0, 1.0))]
)
def test_the_fitted_response_near_holes(radius):
    assert error_of_work("free", 0.3, radius) < 0.01


def solved(law, lam, y, edges):
    return zener._run(zener.TO_THE_END, law, lam, y, 1e-9, edges=edges)


def near(kind, poisson, rate):
    rate = np.atleast_1d(np.asarray(rate, float))
    response = np.tile(response_of(kind, poisson), (rate.size, 1))
    return Edges(response, np.ones(rate.size), rate, np.zeros(rate.size))


def read():
    with independent.FILE.open() as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("law", ["hertz", "myc", "fem"])
def test_impacts_are_those_of_a_large_plate_of_finite_elements(kind, law):
    """Within 1 % of the COR or 0.001; lambda to 1, all distances. See `validation/data/edges.csv`.

    A plate that gives way so much that the sphere never leaves it has a COR of 0.
    """
    data = {"hertz": HERTZ, "myc": MYC, "fem": fem.law(*independent.FEM).data}[law]
    rows = [row for row in read() if (row["edge"], row["law"]) == (kind, law)]
    assert len(rows) >= 24
    for poisson in {row["poissons_ratio"] for row in rows}:
        these = [row for row in rows if row["poissons_ratio"] == poisson]
        lam, y, s, e, share = np.array(
            [
                [
                    float(row[name])
                    for name in ("inelasticity", "yield_compression", "distance", "restitution", "plate_fraction")
                ]
                for row in these
            ]
        ).T
        edges = near(kind, float(poisson), s**-2)
        found = solved(data, lam, np.where(np.isinf(y), 1.0, y), edges)
        assert (found.status[e > 0.0] == zener.OK).all()
        np.testing.assert_allclose(found.restitution, np.maximum(e, 0.0), rtol=0.01, atol=1e-3)
        left = e > 0.0
        np.testing.assert_allclose(found.wave_fraction[left], share[left], atol=0.01)
        losses = found.plastic_fraction + found.wave_fraction + found.other_fraction
        np.testing.assert_allclose(found.restitution[left] ** 2 + losses[left], 1.0, atol=1e-7)


@pytest.mark.parametrize(("lam", "bound"), [(0.3, 3.5e-4), (0.7, 8e-4), (1.0, 1.5e-3)])
def test_impacts_near_a_supported_edge_are_as_by_a_convolution_in_time(lam, bound):
    """With the exact response, that of an image, from where the edge is hardly felt to right at it."""
    rate, step = np.array([0.01, 0.02, 0.03, 0.05, 0.1, 0.3, 1.0, 8.0]), CONTACT_TIME / 1000
    time = step * np.arange(1, 4000)
    images = [np.insert(sici(1.0 / (one * time))[0], 0, 0.5 * math.pi) * 2.0 / math.pi for one in rate]
    expected = [convolved(lam, image, step) for image in images]
    found = solved(HERTZ, np.full(rate.size, lam), np.ones(rate.size), near("supported", 0.3, rate)).restitution
    assert np.abs(found - expected).max() < bound


def test_an_edge_that_is_far_away_is_none():
    """The implicit steps beside the integrator of endless plates, with all fields."""
    lam, y = np.array([0.02, 0.1, 0.5, 1.5]), 0.2
    far = solved(MYC, lam, np.full(4, y), near("free", 0.3, np.full(4, 1e-12)))
    endless = zener._run(zener.TO_THE_END, MYC, lam, y, 1e-10)
    for name in set(zener.Solution._fields) - {"status"}:
        np.testing.assert_allclose(getattr(far, name), getattr(endless, name), rtol=1e-4, atol=3e-5, err_msg=name)


def test_a_plate_gives_no_more_energy_than_it_was_given():
    """Its fitted response drives a force by up to 1e-4: right at a supported edge, all it does."""
    one = solved(MYC, np.full(1, 3.0), np.full(1, 0.1), near("supported", 0.2, 2.5e5))
    assert one.wave_fraction[0] >= 0.0
    assert one.restitution[0] ** 2 + one.plastic_fraction[0] == pytest.approx(1.0, abs=1e-7)


def test_a_plate_that_comes_back_presses_harder_than_the_impact():
    """The largest force of such a contact is the second one; it is on the loading curve again."""
    edges = near("clamped", 0.3, 0.25)
    lam, y, time = np.array([5.0]), np.array([0.1]), np.linspace(0.0, 30.0, 6001)
    one, path = solved(MYC, lam, y, edges), History(time[None], *np.empty((3, 1, time.size)))
    zener.histories(MYC, outcome.at(lam, y), 1e-9, path, edges)
    first, second = path.force[0, argrelmax(path.force[0])[0]]
    assert second > 1.2 * first
    assert one.peak_force[0] == pytest.approx(second, rel=1e-4)
    assert one.peak_compression[0] == pytest.approx(path.compression.max(), rel=1e-4)
    shares = one.restitution**2 + one.plastic_fraction + one.wave_fraction
    assert shares[0] == pytest.approx(1.0, abs=1e-7)
