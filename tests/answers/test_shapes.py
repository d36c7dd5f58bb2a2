"""Answers have the broadcast shape of their arguments, whatever the wall; no impacts have empty ones."""

import dataclasses

import kinds
import numpy as np
import pytest

import contactlaw as cl
from contactlaw.softsphere import Contacts

R = 1e-3
GLASS = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
LINED = cl.Layers([("glass", 1e-3), ("steel-s235", 1e-3)])
# Of each kind of wall, as a function of an array of thicknesses.
WALLS = {
    "array": lambda h: h,
    "layers": lambda h: LINED,
    "orthotropic": lambda h: cl.Orthotropic.perforated("glass", 1e-3, 0.3),
    "foundation": lambda h: cl.Foundation(h, 1e12),
    "stiffness": lambda h: cl.Foundation(R, 1e15 * h),
    "cylinder": lambda h: cl.Shell(h, 0.02),
    "bowl": lambda h: cl.Shell(R, 20.0 * h, "sphere"),
    "layers on it": lambda h: cl.Foundation(LINED, 1e12),
}
SLIDING = {"sliding_speed": 1.0, "friction": 0.3}
OF_ALL_WALLS = [
    ("restitution", {}),
    ("lookup", {}),
    ("lookup", {"mass": 4e-5}),
    ("solve", {}),
    ("oblique", SLIDING),
    ("oblique", SLIDING | {"method": "solve"}),
]
NEAR_EDGES = [
    ("restitution", {"edge_distance": 2e-3}),
    ("solve", {"edge_distance": 2e-3, "hole_radius": 5e-3}),
    ("oblique", SLIDING | {"method": "solve", "edge_distance": 2e-3}),
]
OF_PLATES = {
    "sensitivity": lambda v, h: GLASS.sensitivity(v, R, h),
    "uncertainty": lambda v, h: GLASS.uncertainty(v, R, h).restitution.high,
    "yield_speed": lambda v, h: GLASS.yield_speed(R + 0.0 * v, h),
    "sphere_sphere": lambda v, h: GLASS.lookup_sphere_sphere(v, R, R),
    "between": lambda v, h: cl.restitution_sphere_sphere("glass", "pom", v, R, R),
    "thickness": lambda v, h: GLASS.thickness(0.1 * v, v, R),
    "speed": lambda v, h: GLASS.speed(0.1 * v, R, h),
    "contacts": lambda v, h: Contacts(GLASS, R + 0.0 * v, h).advance(0.0 * v.ravel(), 1e-7).reshape(v.shape),
    "collide": lambda v, h: GLASS.collide(np.zeros((*v.shape, 3)), 0, [0.0, 0.0, 1.0], R, h, 0.3)[0][..., 0],
}


@pytest.mark.parametrize("shape", [(0,), (0, 3), (2, 3)])
@pytest.mark.parametrize(
    ("wall", "model"),
    [*((name, GLASS) for name in WALLS), ("array", kinds.model("rate of the sphere"))],
    ids=[*WALLS, "rate"],
)
def test_answers_have_the_shape_of_the_impacts(wall, model, shape):
    speed, plate = np.full(shape, 2.0), WALLS[wall](np.full(shape[-1:], 1e-3))
    methods = OF_ALL_WALLS + (NEAR_EDGES if wall in ("array", "layers") else [])
    answers = [(name, getattr(model, name)(speed, radius=R, thickness=plate, **more)) for name, more in methods]
    if model is GLASS and wall in ("array", "layers", "orthotropic"):
        answers += [(name, call(speed, plate)) for name, call in OF_PLATES.items()]
    for name, answer in answers:
        fields = vars(answer) if dataclasses.is_dataclass(answer) else {"": answer}
        assert all(np.shape(values) == shape for values in fields.values() if values is not None), name
    for method in ("table", "solve"):
        history = model.force_history(speed, R, plate, samples=5, method=method)
        assert history.force.shape == (*shape, 5) and history.flags.shape == shape
    if speed.size:
        assert model.constant(speed, R, plate).impacts == speed.size
    else:
        with pytest.raises(cl.ArgumentError, match="speed: got no impact"):
            model.constant(speed, R, plate)
