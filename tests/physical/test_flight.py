"""Flights in air, against an integration by scipy that shares no code."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from contactlaw.physical import flight


def flown(up, radius, density):
    """Height, time and speed on return of a sphere that takes off at a speed."""
    mass, area = density * 4 / 3 * math.pi * radius**3, math.pi * radius**2

    def rates(t, state):
        speed = max(abs(state[1]), 1e-300)
        re = 1.204 * speed * 2 * radius / 1.82e-5
        coefficient = 24 / re * (1 + 0.15 * re**0.687) + 0.42 / (1 + 42500 * re**-1.16)
        force = -9.80665 * mass * (1 - 1.204 / density) - 0.5 * 1.204 * coefficient * area * speed * state[1]
        return [state[1], force / (mass * (1 + 0.602 / density))]

    def top(t, state):
        return state[1]

    def ground(t, state):
        return state[0] + (t == 0)

    ground.terminal = True
    end = solve_ivp(rates, (0, 100), [0, up], events=[top, ground], rtol=1e-11, atol=1e-14)
    return end.y_events[0][0][0], end.t_events[1][0], -end.y_events[1][0][1]


@pytest.mark.parametrize(
    ("up", "radius", "density"),
    [(2.4, 1e-3, 2500), (1, 20e-3, 84), (5, 0.5e-3, 1000), (10, 1e-4, 2500), (6, 1e-3, 20), (20, 1e-3, 20)],
)
def test_flights_in_air(up, radius, density):
    """The last one comes back with 3 % of its speed."""
    height, time, down = flown(up, radius, density)
    for found in (flight.of_height(height, radius, density), flight.of_time(time, radius, density)):
        assert np.array(found) == pytest.approx([height, time, up, down], rel=6e-6)


def test_without_air():
    assert np.array(flight.of_time(0.4)) == pytest.approx([flight.GRAVITY * 0.02, 0.4, *[flight.GRAVITY * 0.2] * 2])
