"""Force histories: the solver against scipy, the table against the solver, both against laws."""

import math
import pickle

import numpy as np
import oracle
import pytest

import contactlaw as cl

R = 0.9e-3


def mass(model, radius=R):
    return 4 / 3 * math.pi * model.pair.sphere.density * radius**3


def impacts(model, count, seed):
    """Speeds, radii and thicknesses all over the table."""
    rng = np.random.default_rng(seed)
    speed = model.pair.yield_speed * np.exp(rng.uniform(np.log(0.05), np.log(60), count))
    radius = rng.uniform(0.1e-3, 5e-3, count)
    return speed, radius, radius / rng.uniform(0.0, 4.0, count)


@pytest.mark.parametrize("over_yield", [0.3, 1.6, 8.0, 80.0], ids=["below yield", "just above", "linear", "far above"])
@pytest.mark.parametrize("thickness", [math.inf, 0.5e-3, 0.2e-3])
def test_solver_against_scipy(model, thickness, over_yield):
    """In Hertz's units: the time T_H, and the momentum of the sphere over it."""
    speed = over_yield * model.pair.yield_speed
    hit = model.solve(speed, R, thickness, rtol=1e-11)
    path = model.force_history(speed, R, thickness, samples=25, method="solve")
    share, y = np.linspace(0.0, 1.0, 25)[1:-1], oracle.yield_ratio(over_yield)
    force, left = oracle.force_history(hit.inelasticity, y, share)
    momentum, stiffness = mass(model) * speed, 4 / 3 * model.pair.effective_modulus * math.sqrt(R)
    time = (mass(model) / (stiffness * math.sqrt(speed))) ** 0.4
    assert path.force[1:-1] == pytest.approx(force * momentum / time, abs=1e-7 * hit.peak_force)
    assert 1.0 - path.impulse[1:-1] / momentum == pytest.approx(left, abs=1e-7)
    assert path.plate_displacement.any() == (thickness < math.inf)


@pytest.mark.parametrize(
    "case", ["everywhere", "elastic limit", "just above yield", "at the second kink", "thin plate"]
)
def test_table_within_a_thousandth_of_the_peak(model, case):
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
        assert error.max() < 1e-3
    assert case != "thin plate" or np.max(model.lookup(speed, radius, thickness).inelasticity) > 4.0


@pytest.mark.parametrize("law", ["myc", "fem"])
@pytest.mark.parametrize("method", ["table", "solve"])
def test_a_history_has_the_outcome_of_its_impact(law, method):
    """Work on the contact is what is lost there, work on the plate what the wave takes."""
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law, outside="solve")
    speed, radius, thickness = at = impacts(model, 200, seed=4)
    contact, hit = model.force_history(*at, samples=2001, method=method), model.solve(*at, rtol=1e-10)
    momentum = mass(model, radius) * speed
    for path, share in (
        (contact.compression, hit.plastic_fraction + hit.other_fraction),
        (contact.plate_displacement, hit.wave_fraction),
    ):
        assert np.trapezoid(contact.force, path) / (0.5 * momentum * speed) == pytest.approx(share, abs=2e-4)
    for values, exact, bound in (
        (contact.time[:, -1], hit.contact_time, 1e-12),
        (contact.force.max(axis=1), hit.peak_force, 1e-5),
        (contact.compression.max(axis=1), hit.peak_compression, 1e-5),
        (contact.impulse[:, -1], momentum * (1.0 + hit.restitution), 5e-5),
    ):
        assert values == pytest.approx(exact, rel=bound if method == "solve" else 2e-3)
    dent = (contact.compression[:, -1] - hit.residual_compression) / hit.peak_compression
    assert dent == pytest.approx(0.0, abs=1e-9 if method == "solve" else 1e-3)


@pytest.mark.parametrize("method", ["table", "solve"])
def test_samples_and_flags_of_one_and_of_many(model, method):
    one, two = (model.force_history(60.0, R, 0.3e-3, samples, method) for samples in (256, 2))
    assert two.force.tolist() == [0.0, 0.0]
    assert two.time.tolist() == [0.0, pytest.approx(one.time[-1], rel=1e-6)]
    assert one.flags == pickle.loads(pickle.dumps(one)).flags == cl.Validity(3)
    at = [5.0, 60.0], R, [[1e-3], [0.3e-3]]
    many = model.force_history(*at, 256, method)
    assert many.force[1, 1] == pytest.approx(one.force, rel=1e-9)
    assert np.array_equal(many.flags, model.lookup(*at).flags)
