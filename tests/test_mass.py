"""Beads that are no solid spheres: the mass that answers at the contact."""

import dataclasses
import math
from functools import partial

import numpy as np
import pytest
from oracle import series

import contactlaw as cl
from contactlaw import laws
from contactlaw.softsphere import Contacts, time_step
from contactlaw.table import Settings

ALUMINA = cl.material("gamma-alumina")
HEAVY = dataclasses.replace(ALUMINA, name="heavy", density=1.7 * ALUMINA.density)
RADIUS, THICKNESS = 0.9e-3, np.array([0.7e-3, 1e-3, 2e-3, math.inf])
SPEED = np.array([1.0, 5.0, 12.0, 30.0])
MASS = 4 / 3 * math.pi * HEAVY.density * RADIUS**3
AT = SPEED, RADIUS, THICKNESS


def of_mass(law):
    """The same bead: of a material with a mass of its own, and of a heavier material."""
    return cl.ImpactModel(cl.Pair(ALUMINA, "glass"), law), cl.ImpactModel(cl.Pair(HEAVY, "glass"), law)


def assert_alike(one, other, rel):
    for name, values in vars(one).items():
        np.testing.assert_allclose(values, getattr(other, name), rtol=rel, atol=1e-14, err_msg=name)


@pytest.mark.parametrize("law", laws.names())
def test_it_is_as_a_sphere_of_another_density(law):
    """Whatever is asked; tables of laws with numbers of the pair differ by their errors."""
    own, heavy = of_mass(law)
    assert_alike(own.solve(*AT, mass=MASS), heavy.solve(*AT), 1e-9)
    assert_alike(own.lookup(*AT, mass=MASS), heavy.lookup(*AT), 1e-6)
    assert own.restitution(*AT, mass=MASS) == pytest.approx(heavy.restitution(*AT), rel=1e-6)
    near = {"edge": "clamped", "edge_distance": 1e-3}
    assert_alike(own.solve(2.0, RADIUS, 1e-3, **near, mass=MASS), heavy.solve(2.0, RADIUS, 1e-3, **near), 1e-9)
    yields = own.yield_speed(RADIUS, THICKNESS, MASS)
    assert yields == pytest.approx(heavy.yield_speed(RADIUS, THICKNESS), rel=1e-6)
    angled = 3.0, [0.3, 2.0], RADIUS, 2e-3, 0.2, "solve"
    assert_alike(own.oblique(*angled, mass=MASS), heavy.oblique(*angled), 1e-9)
    one, two = own.force_history(*AT, 9, "solve", mass=MASS), heavy.force_history(*AT, 9, "solve")
    for values, others in zip(one, two, strict=True):
        np.testing.assert_allclose(values, others, rtol=1e-8, atol=1e-8 * np.abs(others).max())


def test_steps_are_as_those_of_a_sphere_of_another_density():
    own, heavy = of_mass("myc")
    step = time_step(own, 5.0, RADIUS, 1e-3, mass=MASS)
    assert step == pytest.approx(time_step(heavy, 5.0, RADIUS, 1e-3), rel=1e-5)
    forces = []
    for contacts in (Contacts(own, RADIUS, 1e-3, mass=MASS), Contacts(heavy, RADIUS, 1e-3)):
        assert contacts.mass == pytest.approx([MASS])
        forces.append([contacts.advance(np.array([x]), step)[0] for x in np.linspace(0, 1e-5, 9)])
    assert forces[0] == pytest.approx(forces[1], rel=1e-6)


def test_velocities_after_a_collision():
    own, heavy = of_mass("myc")
    at = RADIUS, 3e-3, 0.2
    given = (3.0, 0.0, -2.0), (0.0, 50.0, 0.0), (0.0, 0.0, 1.0), *at
    still, expected = (0.0, 0.0, 0.0), heavy.collide(*given)
    for found in (own.collide(*given, mass=MASS), own.collide_kernel(*given, still, MASS)):
        for one, other in zip(found, expected, strict=True):
            np.testing.assert_allclose(one, other, rtol=1e-5, atol=1e-9)
    assert math.isnan(own.collide_kernel(*given, still, 0.3 * MASS)[0][0])


def test_compiled_functions():
    own, heavy = of_mass("myc")
    at = 3.0, RADIUS, 1e-3
    assert own.kernel(*at, MASS) == pytest.approx(heavy.kernel(*at), abs=1e-12)
    assert own.kernel(*at) != own.kernel(*at, MASS)
    assert own.curve(*at[1:], MASS)(3.0) == pytest.approx(heavy.kernel(*at), abs=1e-12)
    near, other = (one.edge_kernel("free") for one in (own, heavy))
    assert near(*at, 1e-3, MASS) == pytest.approx(other(*at, 1e-3), abs=1e-9)
    for mass in (0.0, -MASS, 0.3 * MASS, 1e4 * MASS, math.nan):
        assert math.isnan(own.kernel(*at, mass)) and math.isnan(near(*at, 1e-3, mass))


def test_ranges_and_elasticities():
    """A mass that was weighed has no error; as a multiple of a solid one it moves the COR alike."""
    own, heavy = of_mass("myc")
    one, other = own.uncertainty(*AT, mass=MASS), heavy.uncertainty(*AT)
    assert one.restitution.low == pytest.approx(other.restitution.low, rel=1e-4)
    assert_alike(own.sensitivity(*AT, mass=MASS), heavy.sensitivity(*AT), 1e-5)


@pytest.mark.parametrize("share", [0.7, 1.0, 6.0])
def test_the_equation_in_si_units(share):
    """A mass on Hertz's spring in series with the plate's mobility, by another integrator."""
    pair, speed, thickness = cl.Pair(ALUMINA, "glass"), 3.0, 0.8e-3
    mass, plate = share * 4 / 3 * math.pi * ALUMINA.density * RADIUS**3, pair.plate
    spring = 4 / 3 * pair.effective_modulus * math.sqrt(RADIUS)
    mobility = math.sqrt(3 * plate.density / plate.plane_modulus) / (4 * plate.density * thickness**2)
    e, time = series(mass, spring, mobility, speed)
    hit = cl.ImpactModel(pair, "hertz").solve(speed, RADIUS, thickness, mass=mass)
    assert hit.restitution == pytest.approx(e, rel=1e-5)
    assert hit.contact_time == pytest.approx(time, rel=1e-5)


@pytest.mark.parametrize("mass", [None, MASS / 1.7])
def test_yield_speeds_know_the_end_of_a_table_that_was_given(mass):
    pair = cl.Pair(ALUMINA, "glass")
    small = Settings(largest_inelasticity=0.5)
    for table in (small, cl.ImpactModel(pair, table=small).table):
        with pytest.raises(ValueError, match="the inelasticity .*above 0.5"):
            cl.ImpactModel(pair, table=table).yield_speed(RADIUS, 0.27e-3, mass)


def test_an_impact_beyond_the_table_is_named_by_its_place():
    falling = np.array([(0, 0, 1.0), (0, 0, 1.0), (0, 0, -2.0)])
    with pytest.raises(ValueError, match="thickness: impact 2 is outside"):
        of_mass("myc")[0].collide(falling, 0, (0, 0, 1.0), 1e-3, [3e-3, 3e-3, 0.02e-3], 0.2)


def test_a_plate_too_thin_for_a_mass_is_refused():
    model, at = of_mass("myc")[0], (5.0, RADIUS, 1e-4)
    for ask in (model.lookup, model.restitution, partial(time_step, model)):
        with pytest.raises(ValueError, match="thickness: impact 0 is outside"):
            ask(*at, mass=1e-5)
    with pytest.raises(ValueError, match="thickness: impact 1 is outside"):
        model.oblique(5.0, 1.0, RADIUS, [1e-2, 1e-4], 0.2, mass=[4e-6, 1e-5])


@pytest.mark.parametrize("law", ["fem", "myc"])
def test_the_mass_of_the_solid_sphere_changes_nothing(law):
    model = cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-2024-t351"), law)
    mass = 4 / 3 * math.pi * model.pair.sphere.density * RADIUS**3
    for ask in (model.solve, model.lookup):
        assert_alike(ask(*AT, mass=mass), ask(*AT), 1e-9)


def test_each_impact_has_its_own():
    model = cl.ImpactModel(cl.Pair("carbon-steel-1020", "glass"))
    solid = 4 / 3 * math.pi * model.pair.sphere.density * RADIUS**3
    shares = np.array([[0.7], [1.0], [4.0]])
    found = model.restitution(3.0, RADIUS, [1e-3, 2e-3], mass=shares * solid)
    for n, share in enumerate(shares[:, 0]):
        alone = [model.restitution(3.0, RADIUS, h, mass=share * solid) for h in (1e-3, 2e-3)]
        assert found[n] == pytest.approx(alone, rel=1e-12)
    assert (np.diff(found[:, 0]) < 0).all()  # a heavier bead loses more to the plate


def test_a_hollow_bead_is_flagged():
    model = cl.ImpactModel(cl.Pair("carbon-steel-1020", "glass"))
    solid = 4 / 3 * math.pi * model.pair.sphere.density * RADIUS**3
    flags = model.lookup(1.0, RADIUS, 2e-3, mass=solid * np.array([0.66, 0.94, 0.96, 3.0])).flags
    assert ((flags & cl.Validity.NOT_SOLID) > 0).tolist() == [True, True, False, False]
    assert cl.explain(cl.Validity.NOT_SOLID)[0].startswith("lighter than a solid sphere")


@pytest.mark.parametrize(
    ("mass", "words"),
    [
        (0.3 * MASS, "a thin shell, which bends under the contact"),
        (1e4 * MASS, "is it in grams"),
        (0.0, "mass: got 0.0; must lie between"),
        (-MASS, "mass: got -.* kilograms"),
        (math.nan, "mass: got nan; must lie between"),
        (math.inf, "mass: got inf; must lie between"),
        ([MASS, 0.0], r"\(element 1\)"),
        ("1 g", "mass: got '1 g'; expected a number"),
    ],
)
def test_masses_that_are_none(mass, words):
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    for ask in (model.restitution, model.lookup, model.solve, model.force_history):
        with pytest.raises(ValueError, match=words):
            ask(3.0, RADIUS, 1e-3, mass=mass)
    with pytest.raises(ValueError, match=words):
        model.oblique(3.0, 1.0, RADIUS, 1e-3, 0.2, mass=mass)
    with pytest.raises(ValueError, match=words):
        Contacts(model, RADIUS, 1e-3, mass=mass)
