"""What fits and their measurements refuse, beside what tests/cli has of them."""

import dataclasses

import numpy as np
import polymer
import pytest
from rebounds import STEEL

import contactlaw as cl
from contactlaw.physical import flight

NAN = np.nan
REBOUNDS = {"speed": [1.0, 2.0], "radius": 1e-3, "restitution": [0.5, 0.45]}
OBLIQUE = {"speed": 3.0, "radius": 1e-3, "thickness": 1e-3, "angle": 30.0, "spin": 9.0}
DROPS = {"drop": [0.3, 0.3], "bounce": [0.18, 0.1], "radius": 1.0}


def changed(data, change):
    """Data with other values, or without those that are None."""
    return {name: values for name, values in (data | change).items() if values is not None}


@pytest.mark.parametrize(
    ("data", "change", "unknown", "message"),
    [
        *(
            (REBOUNDS, change, "thickness", message)
            for change, message in (
                ({"restitution": None}, "at least one of restitution"),
                ({"restitution": [NAN, NAN]}, "restitution: no rebound has one"),
                ({"peak_force_error": 1.0}, "there is no peak_force"),
                ({"cor": 0.9}, "data: does not know 'cor'"),
            )
        ),
        (REBOUNDS, {}, "yield_strenght", "unknown: got 'yield_strenght'; must be of"),
        (REBOUNDS, {"speed": 1.0, "restitution": 0.5}, ("thickness", "plate_density"), "1 measured values"),
        *(
            (OBLIQUE, change, unknown, message)
            for change, unknown, message in (
                (
                    {"spin": None, "restitution": 0.9},
                    "friction",
                    "do not depend on friction: measure one of tangential",
                ),
                ({"radius": None}, "radius", r"friction: has to be given \[-\]"),
                ({"radius": None, "friction": -0.1}, "radius", "friction: got -0.1"),
                ({"spin": -9.0}, "friction", "spin: got -9.0 .*its size, without a sign"),
                ({"tangential_restitution": 70.0}, "friction", "tangential_.*: got 70.0 .*in per cent"),
                ({"rotational_restitution": -1.0}, "friction", "rotational_restitution: got -1.0"),
                ({"angle": 90.0}, "friction", "angle: got 90.0; .* from the plate's normal"),
                ({"angle": 0.0}, "friction", "spin: got 9.0 .* came without sliding"),
                ({"angle": None}, "friction", "angle: has to be given with spin"),
                ({"sliding_speed": 1.0}, "friction", "angle: give angles or sliding speeds"),
            )
        ),
    ],
)
def test_fits_of_wrong_data(data, change, unknown, message):
    with pytest.raises(ValueError, match=message):
        cl.fit(STEEL, changed(data, change), unknown)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"bounce_error": -1e-3}, "bounce_error: got -0.001 .*; must lie between 0"),
        ({"time_error": 1e-3}, "time_error: there is no bounce whose COR it enters"),
        ({"bounce_error": 1e-3, "restitution_error": 0.01}, "restitution_error: leave it out beside bounce"),
    ],
)
def test_wrong_drops(change, message):
    with pytest.raises(cl.ArgumentError, match=message):
        cl.Measurements.of(DROPS | change)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: cl.Measurements.of(DROPS, density=2.5), "density: got 2.5; .* in g/cm3"),
        (
            lambda: flight.of_height([0.3, NAN], 1e-5, 2500.0),
            "radius: got 1e-05; such a bead has fallen at its terminal speed",
        ),
        # an error smaller than that of any comparison
        (
            lambda: cl.Measurements(**REBOUNDS, restitution_error=1e-12),
            "restitution_error: got 1e-.*at least 1e-09 of it",
        ),
        (lambda: cl.fit(STEEL, [1.0, 2.0], "thickness"), "data: expected"),
        (lambda: cl.fit(("steel", "glass"), {}, "thickness"), "pair: expected"),
    ],
)
def test_wrong_arguments(call, message):
    with pytest.raises((ValueError, TypeError), match=message):
        call()


NO_LOSS = cl.Pair(dataclasses.replace(polymer.SOFT, loss_factor=None), "glass")


@pytest.mark.parametrize(
    ("pair", "unknown", "priors", "message"),
    [
        (STEEL, "thickness", {"colour": 1.0}, "priors: got 'colour'"),
        (STEEL, "thickness", {"density": 9000.0}, "got 9000.0; the standard error of density must be .* below it"),
        (NO_LOSS, "loss_factor", {"loss_factor": 0.01}, "loss_factor has no value"),
    ],
)
def test_wrong_priors(pair, unknown, priors, message):
    data = REBOUNDS if unknown == "thickness" else REBOUNDS | {"thickness": 1e-2}
    with pytest.raises(ValueError, match=message):
        cl.fit(pair, data, unknown, priors=priors)
