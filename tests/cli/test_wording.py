"""Errors keep what they were raised with, and say it in the words of the shell."""

import pickle

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.answers.backend import OutsideTableError, UnsolvedError
from contactlaw.cli.parts import wording
from contactlaw.physical.materials import NoYieldStrengthError, UnknownMaterialError


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (
            cl.ArgumentError("speed", np.float64(-1.0), "must be above 0", 2),
            r"^speed: got -1\.0 \(element 2\); must be above 0$",
        ),
        (OutsideTableError(3, "too fast"), 'impact 3 .* too fast.* outside="solve"'),
        (UnsolvedError(3, "lambda = 200", "too many steps"), r"lambda = 200 \(element 3\): too"),
        (UnknownMaterialError("glas", ("glass",)), r"mean 'glass'\? contactlaw.materials\(\)"),
        (NoYieldStrengthError("myc", "glass"), 'law="fem".* Material\\('),
    ],
)
def test_errors_of_the_library_speak_of_python_and_travel(error, message):
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), vars(again)) == (type(error), vars(error))
    for each in (error, again):
        with pytest.raises(type(error), match=message):
            raise each


def test_the_number_of_an_impact_is_that_of_the_arrays(model):
    with pytest.raises(OutsideTableError) as refused:
        model.lookup([1.0, 2.0, 1e4], 0.9e-3, 1e-3)
    assert refused.value.impact == 2
    with pytest.raises(ValueError, match="10000 m/s, radius 0.9 mm, thickness 2 mm: outside"):
        with wording.naming_impact([[1.0], [1e4]], 0.9e-3, [1e-3, 2e-3]):
            raise OutsideTableError(3, "too fast")


def test_the_sphere_is_what_a_law_wants_a_strength_of():
    with pytest.raises(NoYieldStrengthError) as refused:
        cl.ImpactModel(cl.Pair("glass", "stainless-steel-304"), law="myc")
    assert wording.sentence(refused.value, {}).startswith("--sphere: law 'myc' needs a yield")
