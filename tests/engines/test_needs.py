"""What engines ask of a model, and which models have it."""

from types import SimpleNamespace

import pytest
from pymunk_room import DT, Full, drop

import contactlaw as cl
from contactlaw.engines.needs import knows, knows_rebounds
from contactlaw.engines.record import IMPACT


def constant(radius, other):
    return lambda speed: 0.5


@pytest.mark.parametrize(
    ("make", "beads", "rebounds"),
    [
        (lambda: cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc"), True, True),
        (lambda: SimpleNamespace(curve=constant, sphere_sphere_curve=constant), True, False),
        (lambda: SimpleNamespace(curve=constant), False, False),
        (Full, True, True),
    ],
    ids=["ImpactModel", "two curves", "curve alone", "stub"],
)
def test_who_knows_what(make, beads, rebounds):
    model = make()
    assert callable(model.curve(0.9e-3, 1e-3))
    assert (knows(model, "sphere_sphere_curve"), knows_rebounds(model)) == (beads, rebounds)


def test_a_model_that_passes_questions_on():
    class Wrapped:
        inner = Full()

        def __getattr__(self, name):
            return getattr(self.inner, name)

    space, _, impacts = drop(Wrapped())
    space.step(DT)
    assert impacts.collisions().dtype == IMPACT
