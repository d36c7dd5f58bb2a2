"""Answers of a model near edges of plates."""

import math

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson
from verlet import fallen

import contactlaw as cl
from contactlaw import Validity
from contactlaw.equation.edge import KINDS
from contactlaw.softsphere import Contacts
from tests.shared import metal
from tests.shared.polymer import PAIRS
from validation.derivations.walls import convolved

R, H, SPEED = 1e-3, 1e-3, 3.0
STEEL = cl.ImpactModel(cl.Pair("bearing-steel-52100", "glass"))
# Section 9 of the project's notes on physics, by quadrature of the closed form's convolution.
SCOUTED = {0.5e-3: 0.980, 1e-3: 0.930, 2e-3: 0.812, 4e-3: 0.727, 8e-3: 0.740}


def test_a_supported_edge_as_scouted():
    model = cl.ImpactModel(cl.Pair("glass", "glass"), law="hertz")
    found = model.restitution(2.0, R, H, "supported", list(SCOUTED))
    np.testing.assert_allclose(found, list(SCOUTED.values()), atol=1e-3)


@pytest.mark.parametrize("pair", [("bearing-steel-52100", "glass"), PAIRS[0]], ids=["", "losses"])
def test_without_an_edge_all_bits_are_those_of_an_endless_plate(pair):
    """Also beside impacts that have one, and on a half-space."""
    model = cl.ImpactModel(cl.Pair(*pair) if isinstance(pair, tuple) else pair)
    thickness, near = [H, H, math.inf], [1e-3, math.inf, 1e-3]
    for ask in (model.solve, model.lookup, model.restitution):
        endless, edged = ask(SPEED, R, thickness), ask(SPEED, R, thickness, edge_distance=near)
        for name in vars(endless) if ask != model.restitution else [None]:
            before, after = (getattr(one, name) if name else one for one in (endless, edged))
            assert before[1:].tobytes() == after[1:].tobytes()
            assert name not in (None, "restitution", "wave_fraction") or before[0] != after[0]
    one, other = model.force_history(SPEED, R, H), model.force_history(SPEED, R, H, edge="clamped")
    assert one.force.tobytes() == other.force.tobytes()


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
    for distance, error in ((0.0, 3e-3), (1e-3, 5e-4), (3e-3, 5e-4), (20e-3, 1e-4)):
        exact = STEEL.solve(SPEED, R, H, edge=kind, edge_distance=distance).restitution
        assert kernel(SPEED, R, H, distance) == pytest.approx(exact, abs=error)
    for wrong in ((-1.0, R, H, R), (SPEED, R, H, -R), (SPEED, R, H, math.nan)):
        assert math.isnan(kernel(*wrong))
    bulk = STEEL.solve(SPEED, R, math.inf).restitution
    assert kernel(SPEED, R, math.inf, R) == pytest.approx(bulk, abs=1e-4)
    exact = metal.MODEL.solve(SPEED, R, H, edge=kind, edge_distance=1e-3).restitution
    assert metal.MODEL.edge_kernel(kind)(SPEED, R, H, 1e-3) == pytest.approx(exact, abs=5e-4)


def test_tangential_answers_near_an_edge():
    far, near = (STEEL.oblique(SPEED, 2.0, R, H, 0.1, "solve", edge_distance=s) for s in (math.inf, 1e-3))
    assert near.restitution == STEEL.solve(SPEED, R, H, edge_distance=1e-3).restitution
    # both slide all the time, so that friction takes its coefficient times the normal impulse
    for hit in (far, near):
        assert hit.impulse_ratio == pytest.approx(0.1, rel=1e-6)
    assert near.sliding_speed > far.sliding_speed


def test_what_is_flagged():
    plate, contact = H, STEEL.solve(SPEED, R, H, edge_distance=0.999 * H)
    assert contact.flags == Validity.NEAR_EDGE
    assert STEEL.solve(SPEED, R, H, edge_distance=1.001 * plate).flags == 0
    light = cl.ImpactModel(cl.Pair("glass", "bearing-steel-52100"))
    speed, radius, thin = 150.0, R, 0.35e-3  # two radii of the contact are more than the thickness
    far = light.solve(speed, radius, thin, edge="supported", edge_distance=1e-3)
    wide = 2.0 * math.sqrt(radius * far.peak_compression)
    assert wide > 1.1 * thin
    for distance, flagged in ((0.8 * wide, True), (1.2 * wide, False)):
        found = light.solve(speed, radius, thin, edge="supported", edge_distance=distance)
        assert bool(found.flags & Validity.NEAR_EDGE) is flagged


@pytest.mark.parametrize("kind", KINDS)
def test_bodies_with_losses_in_steps_and_by_the_solver(kind):
    model = cl.ImpactModel(PAIRS[1])
    contacts = Contacts(model, R, H, kind, 2e-3)
    far, exact = (model.solve(2.0, R, H, edge=kind, edge_distance=s) for s in (math.inf, 2e-3))
    found = fallen(contacts, 2.0, float(far.contact_time) / 200)
    assert found == pytest.approx(exact.restitution, abs=6e-3)


def test_wrong_edges_are_refused():
    with pytest.raises(ValueError, match="edge: got 'loose'; must be one of free, supported, cl"):
        STEEL.restitution(SPEED, R, H, "loose", 1e-3)
    with pytest.raises(ValueError, match=r"edge_distance: got -1.0; must lie between 0 and inf"):
        STEEL.solve(SPEED, R, H, edge_distance=-1.0)
    with pytest.raises(ValueError, match="hole_radius: the rim of a hole is a free edge"):
        STEEL.solve(SPEED, R, H, edge="clamped", edge_distance=R, hole_radius=R)


def test_a_pair_with_a_rate_is_as_strong_near_an_edge():
    near = metal.MODEL.lookup([2.0, 20.0], R, H, "free", 2e-3)
    for n, speed in enumerate((2.0, 20.0)):
        alike = metal.at_strength(speed, R).solve(speed, R, H, edge_distance=2e-3)
        assert near.restitution[n] == pytest.approx(alike.restitution, abs=1e-6)


@pytest.mark.parametrize("distance", [4e-3, 5e-3, 1e-2])
def test_an_edge_answers_as_the_modes_of_a_large_plate(distance):
    """The response near an edge is derived from waves along it, that of the plate from all its modes."""
    model = cl.ImpactModel(cl.Pair("glass", "steel-s235"), law="hertz")
    steel, speed, radius, size, place = model.pair.plate, 1.0, 3e-3, (0.15, 0.1), (distance, 0.05)
    bending, areal = steel.plane_modulus * H**3 / 12.0, steel.density * H
    unit = (math.pi * model.pair.sphere.density / model.pair.effective_modulus) ** 0.4 * radius / speed**0.2  # T_H
    path, highest, step = math.sqrt(bending / areal), 1000.0 / unit, 3.2181 / 500
    counts = (np.arange(1, int(math.sqrt(highest / path) * side / math.pi) + 2) for side in size)
    m, n = (number.ravel() for number in np.meshgrid(*counts))
    omega = path * math.pi**2 * ((m / size[0]) ** 2 + (n / size[1]) ** 2)
    shape = np.sin(m * math.pi * place[0] / size[0]) * np.sin(n * math.pi * place[1] / size[1])
    strength = 4.0 / (areal * size[0] * size[1]) * shape**2 * np.exp(-((omega / (0.45 * highest)) ** 2)) / omega
    back = np.array([(strength * np.sin(omega * t)).sum() for t in np.arange(1500) * step * unit])
    endless = 1.0 / (8.0 * math.sqrt(bending * areal))
    back[0] = endless
    expected = convolved(float(model.solve(speed, radius, H).inelasticity), back / endless, step)
    assert model.solve(speed, radius, H, edge="supported", edge_distance=distance).restitution == pytest.approx(
        expected, abs=0.002
    )
