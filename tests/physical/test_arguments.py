"""Numbers as users give them: everything else is refused by name, wherever it is passed."""

import math
from decimal import Decimal
from fractions import Fraction
from functools import partial

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.softsphere import Contacts, time_step

R, H = 0.9e-3, 1e-3
# The unit that a message names, of each argument.
UNITS = {"speed": "m/s", "radius": "m", "other_radius": "m", "thickness": "m", "times": "s", "rate": "1/s"}
UNITS |= {"youngs_modulus": "Pa", "poissons_ratio": "", "density": "kg/m**3", "overlap": "m"}
MATERIAL = {"youngs_modulus": 73e9, "poissons_ratio": 0.21, "density": 2500.0, "yield_strength": 1e8}


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
    sizes = {"radius": R, "thickness": H}
    plate = {"speed": 5.0, **sizes}
    pair = {"radius": R, "other_radius": R}
    functions = [
        (model.restitution, plate),
        (model.lookup, plate),
        (model.solve, plate),
        (model.force_history, plate),
        (model.sensitivity, plate),
        (model.oblique, {**plate, "sliding_speed": 1.0, "friction": 0.1}),
        (model.constant, {**plate, "weights": 1.0}),
        (model.speed_table, {**sizes, "slowest": 0.1, "fastest": 10.0}),
        (model.yield_speed, sizes),
        (model.lookup_sphere_sphere, {"speed": 5.0, **pair}),
        (model.curve, sizes),
        (model.curve(R, H), {"speed": 5.0}),
        (model.sphere_sphere_curve, pair),
        (lambda **k: cl.restitution_sphere_sphere("nylon-66", "glass", **k), {"speed": 5.0, **pair}),
        (lambda **k: cl.load_signal(model=model, **k), {"times": 0.0, **plate, "rate": 1e5, "duration": 1e-3}),
        (lambda **k: cl.edge_distance(model.pair.plate, **k), {"thickness": H, "contact_time": 1e-6}),
        (lambda **k: Contacts(model, **k), sizes),
        (Contacts(model, R, H).advance, {"overlap": np.array([1e-6]), "step": 1e-7}),
        (lambda **k: time_step(model, **k), {**plate, "error": 1e-3}),
        (lambda **k: cl.Material("own", **k), MATERIAL),
    ]
    for function, arguments in functions:
        for name, value in arguments.items():
            yield name, value, lambda bad, f=function, a=arguments, n=name: f(**{**a, n: bad})


def test_units_are_not_lost_and_the_one_to_convert_to_is_named(model):
    for name, value, call in calls(model):
        array, unit = np.atleast_1d(np.asarray(value, dtype=np.float64)), UNITS.get(name, ".*")
        for bad in (Quantity(value), Quantity(array), array.view(UnitArray), [Quantity(value)]):
            words = rf'^{name}.*convert it to SI .*: x.to\("{unit}"\).magnitude with pint'.replace("**", r"\*\*")
            with pytest.raises(ValueError, match=words):
                call(bad)


def test_units_of_none_of_them_are_taken(model):
    class Row(dict):
        """A stand-in for a pandas Series, whose rows are attributes too."""

        units = 3.0
        unit = None

        def __array__(self, dtype=None, copy=None):
            return np.array([5.0, 6.0], dtype=dtype)

    expected = pytest.approx(model.restitution([5.0, 6.0], R, H))
    for speed in (Row(), Quantity([5.0, 6.0], None)):
        assert model.restitution(speed, R, H) == expected


ODD = ["5", True, np.True_, 1j, {1.0}, Decimal(1), Fraction(1, 2), 10**400, [1.0, 10**400], [[1.0], [1.0, 2.0]]]
ODD += [np.array("5"), np.ma.masked_array([1.0], [True]), np.longdouble("1e4000")]


@pytest.mark.parametrize("bad", ODD, ids=lambda bad: repr(bad)[:20])
def test_what_is_no_number_is_refused_by_name(model, bad):
    for name, _, call in calls(model):
        if isinstance(bad, Fraction) and name in MATERIAL:
            continue  # a material takes any real number
        if isinstance(bad, np.longdouble) and name == "thickness":
            continue  # a half-space
        with pytest.raises(ValueError, match=rf"^\W*{name}"):
            call(bad)


@pytest.mark.parametrize("kind", [np.float64, np.float32, np.array, np.longdouble])
def test_every_kind_of_number_is_taken(model, kind):
    for name, value, call in calls(model):
        if name != "overlap" and not (kind is np.array and name in MATERIAL):
            call(kind(value))


@pytest.mark.parametrize("name", ["rate", "duration", "error", "step", "slowest", "fastest"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -1.0, 0.0, [1.0], [], None], ids=repr)
def test_single_numbers_have_their_range(model, name, bad):
    for argument, _, call in calls(model):
        if argument == name and not (name == "duration" and bad is None):
            with pytest.raises(ValueError, match=f"^{name}: "):
                call(bad)


FOIL = (0.35549572329291923, 0.1, 1.1637769686423725e-07)  # lookups read out of bounds here


@pytest.mark.parametrize("outside", ["raise", "solve", "clamp"])
@pytest.mark.parametrize("law", ["fem", "myc", "hertz"])
def test_a_foil_is_refused_in_the_same_words_everywhere(law, outside):
    model = cl.ImpactModel(cl.Pair("polycarbonate", "polystyrene"), law=law, outside=outside)
    words = r"thickness: got 1.16.*e-07.*R/H is 8.593e\+05 beside .* at least 0.01 of the radius"
    of_impacts = [model.restitution, model.lookup, model.solve, model.force_history, model.sensitivity, model.constant]
    of_sizes = [model.curve, model.speed_table, *[model.yield_speed] * (law == "myc"), partial(Contacts, model)]
    for call in (*of_impacts, partial(time_step, model), *of_sizes):
        with pytest.raises(ValueError, match=words):
            call(*FOIL[call in of_sizes :])
    assert math.isnan(model.kernel(*FOIL))


def test_of_many_plates_the_foil_is_named(model):
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
