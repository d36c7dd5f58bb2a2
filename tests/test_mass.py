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
    """Compare the fields of answers, or numbers."""
    ours, theirs = (vars(answer) if hasattr(answer, "__dict__") else {"": answer} for answer in (one, other))
    for name, values in ours.items():
        np.testing.assert_allclose(values, theirs[name], rtol=rel, atol=1e-14, err_msg=name)


def steps(contacts):
    """Force of each step of a contact that grows."""
    return np.array([contacts.advance(np.array([x]), 1e-7)[0] for x in np.linspace(0, 1e-5, 9)])


# What is asked with the mass of the bead, and how far the answers of two tables may be apart.
EDGE = {"edge": "clamped", "edge_distance": 1e-3}
FALLING = (3.0, 0.0, -2.0), (0.0, 50.0, 0.0), (0.0, 0.0, 1.0), RADIUS, 3e-3, 0.2
ASKED = {
    "solve": (lambda m, **mass: m.solve(*AT, **mass), 1e-9),
    "lookup": (lambda m, **mass: m.lookup(*AT, **mass), 1e-6),
    "restitution": (lambda m, **mass: m.restitution(*AT, **mass), 1e-6),
    "near an edge": (lambda m, **mass: m.solve(2.0, RADIUS, 1e-3, **EDGE, **mass), 1e-9),
    "yield speed": (lambda m, **mass: m.yield_speed(RADIUS, THICKNESS, **mass), 1e-6),
    "oblique": (lambda m, **mass: m.oblique(3.0, [0.3, 2.0], RADIUS, 2e-3, 0.2, "solve", **mass), 1e-9),
    "history": (lambda m, **mass: np.abs(m.force_history(*AT, 9, "solve", **mass)).max(axis=-1), 1e-8),
}
OF_ONE_LAW = {
    "elasticities": (lambda m, **mass: m.sensitivity(*AT, **mass), 1e-5),
    "range": (lambda m, **mass: m.uncertainty(*AT, **mass).restitution.low, 1e-4),
    "time step": (lambda m, **mass: time_step(m, 5.0, RADIUS, 1e-3, **mass), 1e-5),
    "collide": (lambda m, **mass: np.array(m.collide(*FALLING, **mass)), 1e-5),
    "steps": (lambda m, **mass: steps(Contacts(m, RADIUS, 1e-3, **mass)), 1e-6),
    "curve": (lambda m, **mass: m.curve(RADIUS, 1e-3, *mass.values())(3.0), 1e-12),
    "kernel": (lambda m, **mass: m.kernel(3.0, RADIUS, 1e-3, *mass.values()), 1e-12),
    "edge kernel": (lambda m, **mass: m.edge_kernel("free")(3.0, RADIUS, 1e-3, 1e-3, *mass.values()), 1e-9),
}


@pytest.mark.parametrize("law", laws.names())
def test_it_is_as_a_sphere_of_another_density(law):
    """Whatever is asked; tables of laws with numbers of the pair differ by their errors."""
    own, heavy = of_mass(law)
    for ask, rel in (ASKED | (OF_ONE_LAW if law == "myc" else {})).values():
        assert_alike(ask(own, mass=MASS), ask(heavy), rel)


def test_compiled_functions_answer_a_mass_out_of_range_with_nan():
    own, heavy = of_mass("myc")
    at, near, rest = (3.0, RADIUS, 1e-3), own.edge_kernel("free"), (0.0, 0.0, 0.0)
    np.testing.assert_allclose(own.collide_kernel(*FALLING, rest, MASS), heavy.collide(*FALLING), rtol=1e-5, atol=1e-9)
    for mass in (0.0, -MASS, 0.3 * MASS, 1e4 * MASS, math.nan):
        assert math.isnan(own.kernel(*at, mass)) and math.isnan(near(*at, 1e-3, mass))
        assert np.isnan(own.collide_kernel(*FALLING, rest, mass)).all()


@pytest.mark.parametrize("share", [0.7, 1.0, 6.0])
def test_the_equation_in_si_units(share):
    """A mass on Hertz's spring in series with the plate's mobility, by another integrator."""
    pair, speed, thickness = cl.Pair(ALUMINA, "glass"), 3.0, 0.8e-3
    mass, plate = share * 4 / 3 * math.pi * ALUMINA.density * RADIUS**3, pair.plate
    spring = 4 / 3 * pair.effective_modulus * math.sqrt(RADIUS)
    mobility = math.sqrt(3 * plate.density / plate.plane_modulus) / (4 * plate.density * thickness**2)
    e, time, _ = series(mass, spring, mobility, speed)
    hit = cl.ImpactModel(pair, "hertz").solve(speed, RADIUS, thickness, mass=mass)
    assert (hit.restitution, hit.contact_time) == pytest.approx((e, time), rel=1e-5)


@pytest.mark.parametrize("mass", [None, MASS / 1.7])
def test_yield_speeds_know_the_end_of_a_table_that_was_given(mass):
    pair, small = cl.Pair(ALUMINA, "glass"), Settings(largest_inelasticity=0.5)
    for table in (small, cl.ImpactModel(pair, table=small).table):
        with pytest.raises(ValueError, match="the inelasticity .*above 0.5"):
            cl.ImpactModel(pair, table=table).yield_speed(RADIUS, 0.27e-3, mass)


def test_an_impact_beyond_the_table_is_named_by_its_place_and_mass():
    model, at = of_mass("myc")[0], (5.0, RADIUS, 1e-4)
    falling = np.array([(0, 0, 1.0), (0, 0, 1.0), (0, 0, -2.0)])
    with pytest.raises(ValueError, match="thickness: impact 2 is outside"):
        model.collide(falling, 0, (0, 0, 1.0), 1e-3, [3e-3, 3e-3, 0.02e-3], 0.2)
    for ask in (model.lookup, model.restitution, partial(time_step, model)):
        with pytest.raises(ValueError, match="thickness: impact 0 is outside"):
            ask(*at, mass=1e-5)
    with pytest.raises(ValueError, match="thickness: impact 1 is outside"):
        model.oblique(5.0, 1.0, RADIUS, [1e-2, 1e-4], 0.2, mass=[4e-6, 1e-5])


def test_each_impact_has_its_own_and_a_hollow_bead_is_flagged():
    """Of the mass of a solid sphere all is as without; a heavier bead loses more to the plate."""
    model = cl.ImpactModel(cl.Pair("carbon-steel-1020", "glass"))
    solid = 4 / 3 * math.pi * model.pair.sphere.density * RADIUS**3
    shares = np.array([0.66, 0.94, 0.96, 1.0, 3.0])
    hits = model.lookup(3.0, RADIUS, 2e-3, mass=solid * shares)
    alone = [model.restitution(3.0, RADIUS, 2e-3, mass=share * solid) for share in shares]
    assert hits.restitution == pytest.approx(alone, rel=1e-12) and (np.diff(alone) < 0).all()
    for ask in (model.solve, model.lookup):
        assert_alike(ask(*AT, mass=solid), ask(*AT), 1e-9)
    assert ((hits.flags & cl.Validity.NOT_SOLID) > 0).tolist() == [True, True, False, False, False]
    assert cl.explain(cl.Validity.NOT_SOLID)[0].startswith("lighter than a solid sphere")


@pytest.mark.parametrize(
    ("mass", "words"),
    [
        (0.3 * MASS, "a thin shell, which bends under the contact"),
        (1e4 * MASS, "is it in grams"),
        (-MASS, "mass: got -.* kilograms"),
        (math.nan, "mass: got nan; must lie between"),
        ([MASS, 0.0], r"\(element 1\)"),
        ("1 g", "mass: got '1 g'; expected a number"),
    ],
)
def test_masses_that_are_none(mass, words):
    model, at = cl.ImpactModel(cl.Pair("gamma-alumina", "glass")), (3.0, RADIUS, 1e-3)
    asked = partial(model.lookup, *at), partial(model.oblique, *at, 1e-3, 0.2), partial(Contacts, model, *at[1:])
    for ask in asked:
        with pytest.raises(ValueError, match=words):
            ask(mass=mass)
