"""The stateful law: dropped with velocity Verlet, against the solver that knows no steps."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from verlet import drop, fallen

from contactlaw._jit import kernel
from contactlaw.softsphere import PARTED, Contacts, advance, resized, time_step, unit_spring

R = 0.9e-3
PHASES = np.linspace(0.02, 0.98, 13)  # of the first touch within a step
# thickness and speed: lambda 0 to 2, below and above yield (7.4 m/s on a half-space)
CASES = [(math.inf, 3.0), (math.inf, 20.0), (1e-3, 5.0), (1e-3, 15.0), (0.5e-3, 3.0)]
CASES += [(0.5e-3, 20.0), (0.35e-3, 6.0), (0.35e-3, 20.0), (0.25e-3, 3.0), (0.2e-3, 3.0)]


@kernel(cache=True)
def rest(law, spring, weight, step, steps):
    """Speed, overlap and force of a bead that was laid on the plate, after these steps."""
    x, u, state = 0.0, 0.0, PARTED
    for _ in range(steps):
        u += step * (weight - state.force) / spring.mass
        x += step * u
        state = advance(law, spring, state, x, step)
    return u, x, state.force


@pytest.fixture(scope="module")
def law(model):
    return model.force_law.data


def spring_of(model, thickness, radius=R):
    return resized(unit_spring(model, thickness), radius)


def test_unloading_and_reloading_follow_one_curve_down_to_the_dent(model):
    """The contact is loaded, half unloaded and loaded beyond, along a prescribed path."""
    # The step is so small that terms in dt^2, which are for moving bodies, vanish.
    spring, contacts, law = spring_of(model, math.inf), Contacts(model, R, math.inf), model.force_law
    curve, unit = law.unloading_curve(3.0), spring.stiffness * spring.scale**1.5
    down = np.linspace(3.0, curve.residual + 0.1, 50)  # in d_Y
    load, unload, reload, beyond = (
        np.array([contacts.advance(np.array([d * spring.scale]), 1e-15)[0] for d in path]) / unit
        for path in ([1.5, 3.0], down, down[::-1], [3.6])
    )
    assert reload == pytest.approx(unload[::-1], rel=1e-12)
    assert unload == pytest.approx([law.unloading(math.sqrt(d - curve.residual), curve) for d in down], rel=1e-9)
    assert [*load, *beyond] == pytest.approx([law.loading(math.sqrt(d)) for d in (1.5, 3.0, 3.6)], rel=1e-9)
    assert contacts.largest_compression == pytest.approx(3.6 * spring.scale, rel=1e-12)
    in_dent = np.array([0.9 * curve.residual * spring.scale])
    assert contacts.advance(in_dent, 1e-8) == 0.0 < 3.0 * spring.scale < contacts.largest_compression
    assert contacts.advance(np.array([-1e-9]), 1e-8) == contacts.largest_compression == 0.0  # apart, and without memory


@pytest.mark.parametrize("thickness", [0.3e-3, 1e-3, 3e-3])
def test_a_bead_at_rest_is_finite_and_quiet(model, law, thickness):
    spring = spring_of(model, thickness)
    weight = 9.81 * spring.mass
    u, x, force = rest(law, spring, weight, 1e-6, 2_000_000)
    assert force == pytest.approx(weight, rel=1e-3) and abs(u) < 1e-6
    # The bead is no deeper than where the relaxation holds it.
    deepest = spring.mobility * weight * spring.relaxation
    assert x <= 1.01 * (deepest + (weight / spring.stiffness) ** (2 / 3))


def test_a_bead_that_slides_is_that_of_the_integration(model):
    """In several directions; 50 steps a contact. Friction moves the surface as if it had 2/7 of the mass."""
    mu, v, psi, normal = 0.3, 3.0, np.array([0.2, 1.0, 2.0, 4.0, 8.0]), np.array([0.0, 0.0, 1.0])
    contacts, hit = Contacts(model, np.full(5, R), 1e-3), model.oblique(v, psi * mu * v, R, 1e-3, mu, method="solve")
    dt = hit.contact_time[0] / 50
    along = np.column_stack((np.cos(psi), np.sin(psi), 0.0 * psi))
    velocity, depth = mu * v * psi[:, None] * along - v * normal, np.full(5, -0.4 * v * dt)
    for _ in range(70):
        depth -= dt * velocity[:, 2]
        force = contacts.advance(depth, dt)[:, None] * normal + 3.5 * contacts.slide(normal, velocity, mu)
        velocity += dt / contacts.mass[0] * force
    assert (velocity[:, 2] > 0.0).all() and (contacts.slide(normal, velocity, mu) == 0.0).all()
    assert np.abs((velocity * along).sum(axis=1) - hit.sliding_speed).max() < 0.012 * mu * v


@pytest.mark.parametrize("distance", [0.0, 1e-4, 1e-3])
def test_contacts_right_at_the_rim_of_a_hole_are_as_in_the_equation(model, distance):
    """Nearer than contacts for which the response was fitted, they are at the distance of these."""
    near = {"edge": "free", "edge_distance": distance, "hole_radius": 2.5e-3}
    dt = float(model.solve(1.0, 2e-3, 1e-3).contact_time) / 100
    rebound = fallen(Contacts(model, 2e-3, 1e-3, **near), 1.0, dt)
    assert rebound == pytest.approx(model.solve(1.0, 2e-3, 1e-3, **near).restitution, abs=2e-4)


@pytest.mark.parametrize("error", [4e-4, 1e-4])
def test_the_advised_step_keeps_its_promise(model, law, error):
    for thickness, speed in CASES:
        step = time_step(model.__class__(model.pair, outside="solve"), speed, R, thickness, error)
        spring = spring_of(model, thickness)
        wanted = model.solve(speed, R, thickness).restitution
        dropped = [drop(law, spring, speed, step, phase) for phase in PHASES]
        assert np.abs(np.array(dropped) - wanted).max() < error


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda m, pair: time_step(m, 5.0, R, 1e-3, error=1e-7), "error"),
        (lambda m, pair: Contacts(m, R, [1e-3, -1.0]), "thickness"),
        (lambda m, pair: pair.advance(np.zeros(3), 1e-7), "overlap: expected a value"),
        (lambda m, pair: pair.advance([0.0, 0.0], 1e-7), "overlap"),
        (lambda m, pair: pair.slide((0, 0, 1), (1, 0, 0), -0.1), "friction"),
        (lambda m, pair: pair.slide((0, 0, 1), (1, 0), 0.1), "broadcast"),
        *(
            (lambda m, pair, overlap=overlap, step=step: pair.advance(np.array([2e-6, overlap]), step), message)
            for overlap, step, message in (
                (2.1 * R, 1e-7, r"overlap: got .* \(element 1\); must be at most the diameter .*blown up.*time_step"),
                (1e-6, 1e300, r"step: got 1e\+300; must be positive and at most 0.\d+ s.*time_step"),
                (math.nan, 1e-7, r"overlap: got .*element 1\); must be finite \[m\]"),
            )
        ),
    ],
)
def test_bad_input_is_named_and_changes_no_contact(model, call, words):
    contacts = Contacts(model, [R, R], 1e-3)
    contacts.advance(np.array([1e-6, 1e-6]), 1e-7)
    before = [contacts.force.copy(), contacts.plate_displacement.copy()]
    with pytest.raises(ValueError, match=words):
        call(model, contacts)
    assert np.array_equal(before, [contacts.force, contacts.plate_displacement])


@settings(deadline=None, max_examples=300)
@given(
    radius=st.sampled_from([1e-9, 1e-3, 1e3]),
    thickness=st.sampled_from([0.01, 1.0, 1e6, 1e300, math.inf]),  # in radii
    share=st.sampled_from([1e-20, 1e-6, 1.0]),
    path=st.lists(st.floats(-1.0, 1.0) | st.sampled_from([-1e300, 1e-300]), max_size=12),
)
def test_no_step_that_is_taken_gives_what_is_not_finite(model, radius, thickness, share, path):
    contacts = Contacts(model, radius, max(thickness * radius, 1e-9))
    for depth in path:
        overlap = depth * 2.0 * radius + max(depth, 0.0) * contacts.plate_displacement
        contacts.advance(overlap, share * contacts._longest)
        for values in (contacts.force, contacts.plate_displacement, contacts.largest_compression):
            assert np.isfinite(values).all() and (values >= 0.0).all()
