"""Force histories: the solver against scipy, the table against the solver, both against laws."""

import math
import pickle

import numpy as np
import oracle
import pytest

import contactlaw as cl
from contactlaw import laws
from contactlaw.equation import outcome, zener
from contactlaw.equation.outcome import History

R = 0.9e-3
MYC = laws.law("myc").data


def mass(model, radius=R):
    return 4 / 3 * math.pi * model.pair.sphere.density * radius**3


def impacts(model, count, seed):
    """Speeds, radii and thicknesses all over the table."""
    rng = np.random.default_rng(seed)
    speed = model.pair.yield_speed * np.exp(rng.uniform(np.log(0.05), np.log(60), count))
    radius = rng.uniform(0.1e-3, 5e-3, count)
    return speed, radius, radius / rng.uniform(0.0, 4.0, count)


@pytest.mark.parametrize("chi_over", ["below yield", "just above", "linear branch", "far above"])
@pytest.mark.parametrize("lam", [0.0, 0.3, 2.0])
def test_solver_against_scipy(lam, chi_over):
    speed_ratio = {"below yield": 0.3, "just above": 1.6, "linear branch": 8.0, "far above": 80.0}
    y = oracle.yield_ratio(speed_ratio[chi_over])
    share = np.linspace(0.01, 0.99, 23)
    force, speed = oracle.force_history(lam, y, share)
    solution = zener.solve(MYC, lam, y, 1e-11)
    path = History(solution.contact_time * np.append(share, 1.0)[None], *np.empty((3, 1, share.size + 1)))
    zener.histories(MYC, outcome.at(np.array([lam]), np.array([y])), 1e-11, path)
    assert path.force[0, :-1] == pytest.approx(force, abs=1e-7 * solution.peak_force)
    assert 1.0 - path.impulse[0, :-1] == pytest.approx(speed, abs=1e-7)


def test_solver_follows_its_own_rebound(model):
    speed, radius, thickness = impacts(model, 50, seed=1)
    contact = model.force_history(speed, radius, thickness, samples=4001, method="solve")
    rebound = model.solve(speed, radius, thickness, rtol=1e-10)
    assert contact.time[:, -1] == pytest.approx(rebound.contact_time, rel=1e-12)
    assert contact.force.max(axis=1) == pytest.approx(rebound.peak_force, rel=1e-5)
    assert contact.compression.max(axis=1) == pytest.approx(rebound.peak_compression, rel=1e-5)
    assert (contact.compression[:, -1] - rebound.residual_compression) / rebound.peak_compression == (
        pytest.approx(0.0, abs=1e-9)
    )


@pytest.mark.parametrize(
    "case", ["everywhere", "elastic limit", "just above yield", "at the second kink", "thin plate"]
)
def test_table_within_a_ten_thousandth_of_the_peak(model, case):
    speed, radius, thickness = impacts(model, 300, seed=2)
    yields = model.yield_speed(radius, thickness)
    if case == "elastic limit":
        speed = yields * np.linspace(0.999, 1.0, speed.size)
    elif case == "just above yield":
        speed = yields * (1 + np.geomspace(1e-6, 1e-2, speed.size))
    elif case == "at the second kink":  # chi = d_P/d_Y, to a few per cent
        speed = 4.19 * yields * np.linspace(0.95, 1.05, speed.size)
    elif case == "thin plate":  # lambda up to 5
        thickness = radius / np.linspace(6.0, 8.3, speed.size)
        speed = np.minimum(speed, 5.0)
    table, solved = (
        model.force_history(speed, radius, thickness, samples=101, method=method) for method in ("table", "solve")
    )
    for ours, exact in zip(table, solved, strict=True):
        scale = np.abs(exact).max(axis=1, keepdims=True)
        error = np.abs(ours - exact) / np.where(scale > 0, scale, 1.0)
        assert error.max() < 1e-4
    if case == "thin plate":
        assert np.max(model.lookup(speed, radius, thickness).inelasticity) > 4.0


@pytest.mark.parametrize("method", ["table", "solve"])
def test_impulse(model, method):
    """Integral of the force, up to lambda = 5, where the force has a long tail."""
    speed = np.array([0.1, 2.0, 8.0, 30.0])
    thickness = R / np.array([[0.01], [2.0], [5.0], [6.0]])
    assert np.max(model.lookup(speed, R, thickness).inelasticity) > 3.5
    contact = model.force_history(speed, R, thickness, 4001, method)
    expected = mass(model) * speed * (1 + model.restitution(speed, R, thickness))
    assert contact.impulse[..., -1] == pytest.approx(expected, rel=5e-5)
    parts = 0.5 * np.diff(contact.time) * (contact.force[..., 1:] + contact.force[..., :-1])
    passed = np.cumsum(parts, axis=-1) / expected[..., None]
    assert contact.impulse[..., 1:] / expected[..., None] == pytest.approx(passed, abs=1e-4)


@pytest.mark.parametrize("law", ["myc", "fem"])
@pytest.mark.parametrize("method", ["table", "solve"])
def test_energy(law, method):
    """Work on the contact is what is lost there, work on the plate what the wave takes."""
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law, outside="solve")
    speed, radius, thickness = impacts(model, 200, seed=4)
    contact = model.force_history(speed, radius, thickness, samples=2001, method=method)
    rebound = model.lookup(speed, radius, thickness)
    energy = 0.5 * mass(model, radius) * speed**2
    for way, share in (
        (contact.compression, rebound.plastic_fraction + rebound.other_fraction),
        (contact.plate_displacement, rebound.wave_fraction),
    ):
        assert np.trapezoid(contact.force, way) / energy == pytest.approx(share, abs=2e-4)


def test_half_space_stays_where_it_is_and_elastic_contact_is_symmetric():
    glass = cl.ImpactModel(cl.Pair("glass", "glass"), law="hertz")
    contact = glass.force_history(3.0, 1e-3, math.inf)
    assert not contact.plate_displacement.any()
    assert contact.force == pytest.approx(contact.force[::-1], abs=1e-6 * contact.force.max())
    # Johnson 1985, Eq. 11.24: largest force from the energy, and F = K d^1.5 on the way
    stiffness = 4 / 3 * glass.pair.effective_modulus * math.sqrt(1e-3)
    assert contact.force == pytest.approx(stiffness * contact.compression**1.5, abs=1e-9)
    assert contact.compression.max() == pytest.approx((1.25 * mass(glass, 1e-3) * 3.0**2 / stiffness) ** 0.4, rel=1e-4)


@pytest.mark.parametrize("method", ["table", "solve"])
def test_shapes_of_the_answer(model, method):
    one = model.force_history(5.0, R, 1e-3, method=method)
    assert {values.shape for values in one} == {(256,)}
    many = model.force_history([5.0, 20.0], R, [[1e-3], [2e-3], [3e-3]], 10, method)
    assert {values.shape for values in many} == {(3, 2, 10)}
    assert many.force[0, 0] == pytest.approx(np.interp(many.time[0, 0], one.time, one.force), rel=1e-3)
    two = model.force_history(5.0, R, 1e-3, samples=2, method=method)
    assert two.force.tolist() == [0.0, 0.0]
    assert two.time.tolist() == [0.0, pytest.approx(one.time[-1], rel=1e-6)]
    assert model.force_history([], R, 1e-3, method=method).force.shape == (0, 256)


@pytest.mark.parametrize("method", ["table", "solve"])
def test_flags_are_those_of_the_rebound(model, method):
    many = [5.0, 60.0], R, [[1e-3], [0.3e-3]]
    assert np.array_equal(model.force_history(*many, 5, method).flags, model.lookup(*many).flags)
    one = model.force_history(60.0, R, 0.3e-3, 5, method)
    assert one.flags == pickle.loads(pickle.dumps(one)).flags == cl.Validity(3)


def test_outside_the_table(model):
    beyond = (4000.0, R, 1e-3)  # overload 66
    inside = (5.0, R, 1e-3)
    with pytest.raises(ValueError, match="outside the table, its overload"):
        model.force_history(*beyond)
    both = [np.array(values) for values in zip(inside, beyond, strict=True)]
    solving = cl.ImpactModel(model.pair, law="myc", outside="solve").force_history(*both)
    assert solving.force[1] == pytest.approx(model.force_history(*beyond, method="solve").force, rel=1e-9)
    assert (solving.force[0] == model.force_history(*inside).force).all()
    clamping = cl.ImpactModel(model.pair, law="myc", outside="clamp")
    assert np.isfinite(clamping.force_history(*both).force).all()
    assert clamping.clamped == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"samples": 1}, "samples: got 1; must be an integer from 2 to 1 000 000"),
        ({"samples": 10.0}, "samples: got 10.0; must be an integer"),
        ({"method": "spline"}, "method: got 'spline'; must be 'table' or 'solve'"),
        ({"speed": math.nan}, "speed: got nan"),
    ],
)
def test_wrong_arguments(model, arguments, message):
    with pytest.raises(ValueError, match=message):
        model.force_history(**({"speed": 5.0, "radius": R, "thickness": 1e-3} | arguments))
