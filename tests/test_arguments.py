"""What users pass for numbers: everything else is refused by name, wherever it is passed."""

import math
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import contactlaw as cl
from contactlaw import closed_form, turning_point
from contactlaw.softsphere import Contacts, time_step

R, H = 0.9e-3, 1e-3


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
        (closed_form.mueller, {"inelasticity": 0.1}),
        (closed_form.peng, {"speed_ratio": 2.0, "thickness_ratio": 1.0, "eta": 0.1, "c": 0.1}),
        (turning_point.restitution, {"speed_ratio": 2.0, "inelasticity_at_yield": 0.1}),
    ]
    for function, arguments in functions:
        for name, value in arguments.items():
            if name != "model":
                yield name, value, lambda bad, f=function, a=arguments, n=name: f(**{**a, n: bad})


def vars_of(material):
    names = ("youngs_modulus", "poissons_ratio", "density")
    return {name: getattr(material, name) for name in names} | {"yield_strength": 1e8}


ODD = [
    "5", b"5", True, np.True_, 1j, {}, {1.0}, object(), Decimal(1), Fraction(1, 2), 10**400,
    [1.0, 10**400], [[1.0], [1.0, 2.0]], np.array("5"), np.datetime64("2020"), len,
    np.ma.masked_array([1.0], [True]), np.longdouble("1e4000"),
]  # fmt: skip


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
                continue  # a short step is no mistake
            with pytest.raises(ValueError, match=f"^{name}: "):
                call(bad)
