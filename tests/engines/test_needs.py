"""What engines ask of a model, and which models have it."""

from types import SimpleNamespace

import pytest
from pymunk_room import DT, Full, drop

import contactlaw as cl
from contactlaw.engines.needs import knows, knows_rebounds
from contactlaw.engines.record import IMPACT
from dem_demo.rain.baseline import ConstantRestitution


@pytest.mark.parametrize(
    ("make", "beads", "rebounds"),
    [
        (lambda: cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc"), True, True),
        (lambda: ConstantRestitution(cl.Pair("gamma-alumina", "glass"), 0.9), True, False),
        (lambda: SimpleNamespace(curve=lambda radius, thickness: lambda speed: 0.5), False, False),
        (Full, True, True),
    ],
    ids=["ImpactModel", "ConstantRestitution", "curve alone", "stub"],
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
