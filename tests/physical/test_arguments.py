"""What users pass for numbers: everything else is refused by name, wherever it is passed."""

import math
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.softsphere import Contacts, time_step

R, H = 0.9e-3, 1e-3


class Quantity:
    """Stand-in for arrays with units (pint's, no dependency), which numpy strips of them."""

    def __init__(self, magnitude, units="millimeter"):
        self.magnitude = np.asarray(magnitude)
        self.units = units

    def __array__(self, dtype=None, copy=None):
        return np.array(self.magnitude, dtype=dtype)

    def __float__(self):
        return float(self.magnitude)

    def __repr__(self):
        return f"<Quantity({self.magnitude}, '{self.units}')>"


class UnitArray(np.ndarray):
    """Stand-in for astropy's and unyt's arrays, which are arrays of float64 to numpy."""

    unit = "mm"


def calls(model):
    """Every public function that takes numbers: name of one argument, and the call with a value."""
    plate = {"speed": 5.0, "radius": R, "thickness": H}
    beads = {"speed": 5.0, "radius": R, "other_radius": R}
    load = {"times": 0.0, **plate, "model": model, "rate": 1e5, "duration": 1e-3}
    material = model.pair.plate
    functions = [
        (model.restitution, plate),
        (model.lookup, plate),
        (model.solve, plate),
        (model.force_history, plate),
        (model.sensitivity, plate),
        (model.yield_speed, {"radius": R, "thickness": H}),
        (model.lookup_sphere_sphere, beads),
        (model.curve, {"radius": R, "thickness": H}),
        (model.curve(R, H), {"speed": 5.0}),
        (model.sphere_sphere_curve, {"radius": R, "other_radius": R}),
        (lambda **k: cl.restitution_sphere_sphere("nylon-66", "glass", **k), beads),
        (cl.load_signal, load),
        (lambda **k: cl.edge_distance(material, **k), {"thickness": H, "contact_time": 1e-6}),
        (lambda **k: Contacts(model, **k), {"radius": R, "thickness": H}),
        (Contacts(model, R, H).advance, {"overlap": np.array([1e-6]), "step": 1e-7}),
        (lambda **k: time_step(model, **k), {**plate, "error": 1e-3}),
        (lambda **k: cl.Material("own", **k), vars_of(material)),
    ]
    for function, arguments in functions:
        for name, value in arguments.items():
            if name != "model":
                yield name, value, lambda bad, f=function, a=arguments, n=name: f(**{**a, n: bad})


def vars_of(material):
    names = ("youngs_modulus", "poissons_ratio", "density")
    return {name: getattr(material, name) for name in names} | {"yield_strength": 1e8}


def test_units_are_not_lost(model):
    for name, value, call in calls(model):
        array = np.atleast_1d(np.asarray(value, dtype=np.float64))
        for bad in (Quantity(value), Quantity(array), array.view(UnitArray), [Quantity(value)]):
            with pytest.raises(ValueError, match=rf'^{name}.*convert it to SI .*: x.to\(".*"\).magnitude with pint'):
                call(bad)


@pytest.mark.parametrize(
    ("call", "unit"),
    [
        (lambda m, q: m.restitution(q, R, H), "m/s"),
        (lambda m, q: m.restitution(5.0, q, H), "m"),
        (lambda m, q: cl.load_signal(0.0, 5.0, R, H, model=m, rate=q), "1/s"),
        (lambda m, q: cl.load_signal(q, 5.0, R, H, model=m, rate=1e5), "s"),
        (lambda m, q: Contacts(m, R, H).advance(q, 1e-7), "m"),
        (lambda m, q: cl.Material("own", q, 0.2, 2500.0), "Pa"),
        (lambda m, q: cl.Material("own", 7e10, q, 2500.0), ""),
        (lambda m, q: cl.Material("own", 7e10, 0.2, q), "kg/m**3"),
    ],
)
def test_the_unit_to_convert_to_is_named(model, call, unit):
    with pytest.raises(ValueError) as error:
        call(model, Quantity([1.0]))
    assert f'x.to("{unit}").magnitude' in str(error.value)


def test_units_of_none_of_them_are_taken(model):
    class Row(dict):
        """A stand-in for a pandas Series, whose rows are attributes too."""

        units = 3.0
        unit = None

        def __array__(self, dtype=None, copy=None):
            return np.array([5.0, 6.0], dtype=dtype)

    expected = model.restitution([5.0, 6.0], R, H)
    assert model.restitution(Row(), R, H) == pytest.approx(expected)
    assert model.restitution(Quantity([5.0, 6.0], units=None), R, H) == pytest.approx(expected)


ODD = [
    "5",
    True,
    np.True_,
    1j,
    {1.0},
    Decimal(1),
    Fraction(1, 2),
    10**400,
    [1.0, 10**400],
    [[1.0], [1.0, 2.0]],
    np.array("5"),
    np.ma.masked_array([1.0], [True]),
    np.longdouble("1e4000"),
]


@pytest.mark.parametrize("bad", ODD, ids=lambda bad: repr(bad)[:20])
def test_what_is_no_number_is_refused_by_name(model, bad):
    for name, _, call in calls(model):
        if isinstance(bad, Fraction) and name in vars_of(model.pair.plate):
            continue  # a material takes any real number
        if isinstance(bad, np.longdouble) and name == "thickness":
            continue  # a half-space
        with pytest.raises(ValueError, match=rf"^\W*{name}"):
            call(bad)


@pytest.mark.parametrize("kind", [np.float64, np.float32, np.array, np.longdouble])
def test_every_kind_of_number_is_taken(model, kind):
    for name, value, call in calls(model):
        if name == "overlap" or (kind is np.array and name in vars_of(model.pair.plate)):
            continue
        call(kind(value))


@pytest.mark.parametrize("name", ["rate", "duration", "error", "step"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -1.0, 0.0, 5e-324, [1.0], [], None], ids=repr)
def test_single_numbers_have_their_range(model, name, bad):
    for argument, _, call in calls(model):
        if argument == name and not (name == "duration" and bad in (None, 5e-324)):
            if name == "step" and bad == 5e-324:
                continue  # a step may be arbitrarily short
            with pytest.raises(ValueError, match=f"^{name}: "):
                call(bad)


FOIL = (0.35549572329291923, 0.1, 1.1637769686423725e-07)  # lookups read out of bounds here


@pytest.mark.parametrize("outside", ["raise", "solve", "clamp"])
@pytest.mark.parametrize("law", ["fem", "myc", "hertz"])
def test_a_foil_is_refused_in_the_same_words_everywhere(law, outside):
    pair = cl.Pair("polycarbonate", "polystyrene")
    model = cl.ImpactModel(pair, law=law, outside=outside)
    speed, radius, thickness = FOIL
    words = r"thickness: got 1.16.*e-07.*R/H is 8.593e\+05 beside .* at least 0.01 of the radius"
    calls = [
        lambda: model.restitution(*FOIL),
        lambda: model.restitution([speed], radius, thickness),
        lambda: model.lookup(*FOIL),
        lambda: model.solve(*FOIL),
        lambda: model.force_history(*FOIL),
        lambda: model.sensitivity(*FOIL),
        lambda: model.constant(*FOIL),
        lambda: model.curve(radius, thickness),
        lambda: model.speed_table(radius, thickness),
        lambda: Contacts(model, radius, thickness),
        lambda: time_step(model, *FOIL),
    ]
    if law == "myc":
        calls.append(lambda: model.yield_speed(radius, thickness))
    for call in calls:
        with pytest.raises(ValueError, match=words):
            call()
    assert math.isnan(model.kernel(*FOIL))


def test_of_many_plates_the_foil_is_named():
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    with pytest.raises(ValueError, match=r"got 1e-06 \(element 1\); R/H is 1000 beside a radius"):
        model.lookup(1.0, 1e-3, [1e-3, 1e-6])


def test_a_soft_bead_at_high_speed_keeps_its_stiffening_finite():
    """For the stiffening a contact is at most 10 times as wide as the plate is thick: eta < 8."""
    soft = cl.Material("gel", 1e4, 0.45, 1000.0)
    model = cl.ImpactModel(cl.Pair(soft, soft), outside="clamp")
    hit = model.lookup([1e2, 1e4, 1e5], 1e-3, [[1e-5], [1e-3]])
    for name in ("restitution", "contact_time", "peak_force", "inelasticity"):
        assert np.isfinite(getattr(hit, name)).all(), name
    assert (np.diff(np.asarray(hit.inelasticity), axis=0) < 0.0).all()  # thinner plates take more


@pytest.mark.parametrize("error", [1e-300, 1e-12])
def test_an_error_smaller_than_any_comparison_is_refused(error):
    with pytest.raises(ValueError, match=r"restitution_error: got 1e-.*at least 1e-09 of it"):
        cl.Measurements(speed=[1.0, 2.0], radius=R, restitution=[0.9, 0.8], restitution_error=error)
