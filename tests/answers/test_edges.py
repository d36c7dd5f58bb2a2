"""Answers of a model near edges of plates."""

import math

import metal
import numpy as np
import polymer
import pytest
from scipy.integrate import cumulative_simpson

import contactlaw as cl
from contactlaw import Validity
from contactlaw.equation.edge import KINDS

R, H, SPEED = 1e-3, 1e-3, 3.0
STEEL = cl.ImpactModel(cl.Pair("bearing-steel-52100", "glass"))
# Section 9 of the project's notes on physics, by quadrature of the closed form's convolution.
SCOUTED = {0.5e-3: 0.980, 1e-3: 0.930, 2e-3: 0.812, 4e-3: 0.727, 8e-3: 0.740}


def test_a_supported_edge_as_scouted():
    model = cl.ImpactModel(cl.Pair("glass", "glass"), law="hertz")
    found = model.restitution(2.0, R, H, "supported", list(SCOUTED))
    np.testing.assert_allclose(found, list(SCOUTED.values()), atol=1e-3)


@pytest.mark.parametrize("model", [STEEL, polymer.MODELS[0]], ids=["", "losses"])
def test_without_an_edge_all_bits_are_those_of_an_endless_plate(model):
    """Also beside impacts that have one, and on a half-space."""
    at = SPEED, R, [H, H, math.inf]
    for ask in (model.solve, model.lookup):
        endless, edged = ask(*at), ask(*at, edge_distance=[1e-3, math.inf, 1e-3])
        for name, values in vars(endless).items():
            assert values[1:].tobytes() == getattr(edged, name)[1:].tobytes()
        assert endless.restitution[0] != edged.restitution[0] == model.restitution(SPEED, R, H, edge_distance=1e-3)
    endless, edged = model.force_history(SPEED, R, H), model.force_history(SPEED, R, H, edge="clamped")
    assert endless.force.tobytes() == edged.force.tobytes()


@pytest.mark.parametrize("kind", KINDS)
def test_the_plate_takes_the_work_of_the_force(kind):
    """By a quadrature over the history, whose plate is where the sphere would be uncompressed.

    The path is off by up to 3e-5 of the displacement, as steps near edges are.
    """
    hit = STEEL.solve(SPEED, R, H, edge=kind, edge_distance=1.5e-3)
    lost = hit.plastic_fraction + hit.wave_fraction + hit.other_fraction
    assert hit.restitution**2 + lost == pytest.approx(1.0, abs=1e-9)
    path = STEEL.force_history(SPEED, R, H, 2001, "solve", kind, 1.5e-3)
    mass = STEEL.pair.sphere.density * 4.0 / 3.0 * math.pi * R**3
    speed = SPEED - cumulative_simpson(path.force, x=path.time, initial=0.0) / mass
    sphere = cumulative_simpson(speed, x=path.time, initial=0.0)
    np.testing.assert_allclose(path.plate_displacement, sphere - path.compression, atol=5e-10)
    plate = np.gradient(path.plate_displacement, path.time, edge_order=2)
    work = cumulative_simpson(path.force * plate, x=path.time)[-1] / (0.5 * mass * SPEED**2)
    assert work == pytest.approx(hit.wave_fraction, abs=2e-4)
    coarse = STEEL.force_history(SPEED, R, H, 5, "solve", kind, 1.5e-3)
    np.testing.assert_allclose(coarse.plate_displacement, path.plate_displacement[::500], rtol=1e-5)


@pytest.mark.parametrize("kind", KINDS)
def test_the_kernel_answers_as_the_solver(kind):
    kernel = STEEL.edge_kernel(kind)
    for thickness, distance, error in (
        (H, 0.0, 3e-3),
        (H, 1e-3, 5e-4),
        (H, 3e-3, 5e-4),
        (H, 20e-3, 1e-4),
        (math.inf, R, 1e-4),
    ):
        exact = STEEL.solve(SPEED, R, thickness, edge=kind, edge_distance=distance).restitution
        assert kernel(SPEED, R, thickness, distance) == pytest.approx(exact, abs=error)
    for wrong in ((-1.0, R, H, R), (SPEED, R, H, -R), (SPEED, R, H, math.nan)):
        assert math.isnan(kernel(*wrong))
    exact = metal.MODEL.solve(SPEED, R, H, edge=kind, edge_distance=1e-3).restitution
    assert metal.MODEL.edge_kernel(kind)(SPEED, R, H, 1e-3) == pytest.approx(exact, abs=5e-4)


def test_tangential_answers_near_an_edge():
    """Both slide all the time, so that friction takes its coefficient times the normal impulse."""
    far, near = (STEEL.oblique(SPEED, 2.0, R, H, 0.1, "solve", edge_distance=s) for s in (math.inf, 1e-3))
    assert near.restitution == STEEL.solve(SPEED, R, H, edge_distance=1e-3).restitution
    assert [far.impulse_ratio, near.impulse_ratio] == pytest.approx([0.1, 0.1], rel=1e-6)
    assert near.sliding_speed > far.sliding_speed


def test_what_is_flagged():
    assert STEEL.solve(SPEED, R, H, edge_distance=0.999 * H).flags == Validity.NEAR_EDGE
    assert STEEL.solve(SPEED, R, H, edge_distance=1.001 * H).flags == 0
    light = cl.ImpactModel(cl.Pair("glass", "bearing-steel-52100"))
    speed, thin = 150.0, 0.35e-3  # two radii of the contact are more than the thickness
    far = light.solve(speed, R, thin, edge="supported", edge_distance=1e-3)
    wide = 2.0 * math.sqrt(R * far.peak_compression)
    assert wide > 1.1 * thin
    for distance, flagged in ((0.8 * wide, True), (1.2 * wide, False)):
        found = light.solve(speed, R, thin, edge="supported", edge_distance=distance)
        assert bool(found.flags & Validity.NEAR_EDGE) is flagged


def test_a_pair_with_a_rate_is_as_strong_near_an_edge():
    near = metal.MODEL.lookup([2.0, 20.0], R, H, "free", 2e-3)
    for n, speed in enumerate((2.0, 20.0)):
        alike = metal.at_strength(speed, R).solve(speed, R, H, edge_distance=2e-3)
        assert near.restitution[n] == pytest.approx(alike.restitution, abs=1e-6)
