"""Elasticities from the table against difference quotients of the solver, and invariants."""

import dataclasses
import math

import numpy as np
import pytest

import contactlaw as cl

SPEED = np.array([3.0, 12.0, 25.0, 40.0, 55.0])
THICKNESS = np.array([0.4e-3, 0.7e-3, 1e-3, 3e-3, 0.5e-3])
RADIUS = 0.9e-3


def solved(pair, speed=SPEED, radius=RADIUS, thickness=THICKNESS, law="myc"):
    model = cl.ImpactModel(pair, law=law)
    return np.log(model.solve(speed, radius, thickness, rtol=1e-13).restitution)


def quotient(function, step=1e-4):
    """Derivative of function(factor) with respect to ln(factor) at 1, to the fourth order."""
    near, far = (
        (function(math.exp(h)) - function(math.exp(-h))) / (2 * h) for h in (step, 2 * step)
    )
    return (4 * near - far) / 3


def changed(pair, body, field, factor):
    material = getattr(pair, body)
    other = dataclasses.replace(material, **{field: getattr(material, field) * factor})
    bodies = {"sphere": pair.sphere, "plate": pair.plate, body: other}
    return cl.Pair(**bodies)


INPUTS = {
    "speed": lambda pair, x: solved(pair, speed=SPEED * x),
    "radius": lambda pair, x: solved(pair, radius=RADIUS * x),
    "thickness": lambda pair, x: solved(pair, thickness=THICKNESS * x),
    "sphere_density": lambda pair, x: solved(changed(pair, "sphere", "density", x)),
    "plate_density": lambda pair, x: solved(changed(pair, "plate", "density", x)),
    "sphere_modulus": lambda pair, x: solved(changed(pair, "sphere", "youngs_modulus", x)),
    "plate_modulus": lambda pair, x: solved(changed(pair, "plate", "youngs_modulus", x)),
    "yield_strength": lambda pair, x: solved(changed(pair, "sphere", "yield_strength", x)),
}


@pytest.fixture(scope="module")
def moved(model):
    return model.sensitivity(SPEED, RADIUS, THICKNESS)


@pytest.mark.parametrize("name", INPUTS)
def test_elasticities_are_those_of_the_solver(pair, moved, name):
    expected = quotient(lambda x: INPUTS[name](pair, x))
    # the derivative of a cubic spline is one order worse than its value, 1e-7
    assert getattr(moved, name) == pytest.approx(expected, abs=1e-4)
    assert np.abs(expected).max() > 0.02  # there was something to compare


def test_every_input_is_compared(moved):
    assert set(INPUTS) == {field.name for field in dataclasses.fields(moved)}


def test_other_units_change_nothing(moved):
    """Units of length, and of stress and density together, leave the COR as it is."""
    assert moved.radius == pytest.approx(-moved.thickness, abs=1e-14)
    stresses = moved.sphere_modulus + moved.plate_modulus + moved.yield_strength
    assert stresses + moved.sphere_density + moved.plate_density == pytest.approx(0.0, abs=1e-13)
    # and of time: V0 as the root of stress over density
    assert moved.speed == pytest.approx(-2 * stresses, abs=1e-13)


def test_below_yield_the_strength_does_not_matter(model):
    one = model.sensitivity(2.0, RADIUS, 0.5e-3)
    assert one.yield_strength == 0.0
    assert one.speed == pytest.approx(0.1 * one.radius, rel=1e-12)  # both through lambda


def test_on_a_half_space_the_plate_does_not_bend(model):
    one = model.sensitivity(20.0, RADIUS, math.inf)
    assert one.thickness == one.radius == one.plate_density == 0.0
    v = 20.0 / model.pair.yield_speed
    q = v**-0.8
    exact = -0.8 * q * (1 - q) / (2 * (1 - (1 - q) ** 2))  # Eq. 21
    assert one.speed == pytest.approx(exact, abs=1e-5)


def test_shapes_and_refusals(model):
    assert model.sensitivity([1.0, 2.0], RADIUS, [[1e-3], [2e-3], [3e-3]]).speed.shape == (3, 2)
    assert isinstance(model.sensitivity(1.0, RADIUS, 1e-3).speed, float)
    with pytest.raises(ValueError, match="outside the table"):
        model.sensitivity(5.0, RADIUS, 1e-5)
    with pytest.raises(ValueError, match="speed: got -1.0"):
        model.sensitivity(-1.0, RADIUS, 1e-3)
