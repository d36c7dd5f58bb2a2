"""The stateful law: dropped with velocity Verlet, against the solver that knows no steps."""

import math

import numpy as np
import pytest

from contactlaw import laws
from contactlaw._jit import kernel
from contactlaw.softsphere import PARTED, advance, resized, unit_spring

R = 0.9e-3
G = 9.81
PHASES = np.linspace(0.02, 0.98, 13)  # of the first touch within a step
# thickness and speed: lambda 0 to 2, below and above yield (7.4 m/s on a half-space)
CASES = [(math.inf, 3.0), (math.inf, 20.0), (1e-3, 5.0), (1e-3, 15.0), (0.5e-3, 3.0)]
CASES += [(0.5e-3, 20.0), (0.35e-3, 6.0), (0.35e-3, 20.0), (0.25e-3, 3.0), (0.2e-3, 3.0)]


@kernel
def drop(law, spring, speed, step, phase):
    """COR of one bead that first touches at this phase of a step."""
    x, u, state = -phase * speed * step, speed, PARTED
    for n in range(10**7):
        u -= 0.5 * step * state.force / spring.mass
        x += u * step
        state = advance(law, spring, state, x, step)
        u -= 0.5 * step * state.force / spring.mass
        if n > 2 and state.force == 0.0 and u < 0.0:
            return -u / speed
    return math.nan


@kernel
def rest(law, spring, force, step, steps, trace):
    """Positions of a bead that is put on the plate with no speed, under a steady force."""
    x = u = 0.0
    state = PARTED
    for n in range(steps):
        u += 0.5 * step * (force - state.force) / spring.mass
        x += u * step
        state = advance(law, spring, state, x, step)
        u += 0.5 * step * (force - state.force) / spring.mass
        if n % (steps // trace.shape[0]) == 0:
            trace[n // (steps // trace.shape[0])] = x, u, state.force
    return state


@pytest.fixture(scope="module")
def law(model):
    return laws.law(model.law).functions


def spring_of(model, thickness, radius=R):
    return resized(unit_spring(model, thickness), radius)


def largest_error(model, law, thickness, speed, steps):
    hit = model.solve(speed, R, thickness)
    assert hit.inelasticity < 2.05
    spring = spring_of(model, thickness)
    dropped = [drop(law, spring, speed, hit.contact_time / steps, phase) for phase in PHASES]
    return np.abs(np.array(dropped) - hit.restitution).max()


@pytest.mark.parametrize(("thickness", "speed"), CASES)
def test_drops_have_the_restitution_of_the_solver(model, law, thickness, speed):
    assert largest_error(model, law, thickness, speed, 20) < 5e-4
    assert largest_error(model, law, thickness, speed, 50) < 1e-4


@pytest.mark.parametrize(("thickness", "speed"), [(math.inf, 3.0), (0.5e-3, 20.0), (0.2e-3, 3.0)])
def test_second_order_in_the_step(model, law, thickness, speed):
    hit = model.solve(speed, R, thickness)
    # root mean square over the phases; without the relaxation, which has no part in the order
    spring = spring_of(model, thickness)._replace(relaxation=math.inf)
    errors = [
        np.sqrt(
            np.mean(
                [
                    (drop(law, spring, speed, hit.contact_time / n, phase) - hit.restitution) ** 2
                    for phase in PHASES
                ]
            )
        )
        for n in (40, 160, 640)
    ]
    orders = np.log2(np.array(errors[:-1]) / errors[1:]) / 2
    assert (orders > 2.2).all(), (errors, orders)  # 2.5: contact begins and ends inside a step


def test_the_relaxation_of_the_plate_moves_no_restitution(model, law):
    for thickness in (1e-3, 0.5e-3, 0.25e-3):
        hit = model.solve(3.0, R, thickness)
        spring = spring_of(model, thickness)
        pair = [
            drop(law, one, 3.0, hit.contact_time / 200, 0.5)
            for one in (spring, spring._replace(relaxation=math.inf))
        ]
        assert 0.0 < abs(pair[1] - pair[0]) < 2e-5
