"""No impacts have answers, too: empty ones of the same shape, whatever the wall."""

import dataclasses

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.softsphere import Contacts

R = 1e-3
MODEL = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
BARE = "array", "layers", "orthotropic"


def wall(kind, shape):
    sizes = np.full(shape, 1e-3)
    return {
        "array": sizes,
        "layers": cl.Layers([("glass", 1e-3), ("steel-s235", 1e-3)]),
        "orthotropic": cl.Orthotropic.perforated("glass", 1e-3, 0.3),
        "foundation": cl.Foundation(sizes, 1e12),
        "stiffness": cl.Foundation(R, np.full(shape, 1e12)),
        "cylinder": cl.Shell(sizes, 0.02),
        "bowl": cl.Shell(R, np.full(shape, 0.02), "sphere"),
        "layers on it": cl.Foundation(cl.Layers([("glass", 1e-3), ("steel-s235", 1e-3)]), 1e12),
    }[kind]


ALL = {
    "restitution": lambda v, h: MODEL.restitution(v, R, h),
    "lookup": lambda v, h: MODEL.lookup(v, R, h),
    "lookup with mass": lambda v, h: MODEL.lookup(v, R, h, mass=1e-5),
    "solve": lambda v, h: MODEL.solve(v, R, h),
    "oblique": lambda v, h: MODEL.oblique(v, v, R, h, 0.3),
    "oblique, solved": lambda v, h: MODEL.oblique(v, v, R, h, 0.3, method="solve"),
}
OF_BARE = {
    "edge": lambda v, h: MODEL.restitution(v, R, h, edge_distance=2e-3),
    "hole": lambda v, h: MODEL.solve(v, R, h, edge_distance=2e-3, hole_radius=5e-3),
    "edge, solved": lambda v, h: MODEL.oblique(v, v, R, h, 0.3, method="solve", edge_distance=v),
    "yield_speed": lambda v, h: MODEL.yield_speed(R + 0.0 * v, h),
    "sphere_sphere": lambda v, h: MODEL.lookup_sphere_sphere(v, R, R),
    "between": lambda v, h: cl.restitution_sphere_sphere("glass", "pom", v, R, R),
    "thickness": lambda v, h: MODEL.thickness(v, v, R),
    "speed": lambda v, h: MODEL.speed(v, R, h),
    "sensitivity": lambda v, h: MODEL.sensitivity(v, R, h),
    "uncertainty": lambda v, h: MODEL.uncertainty(v, R, h).restitution.high,
    "contacts": lambda v, h: Contacts(MODEL, R + 0.0 * v, h).advance(0.0 * v.ravel(), 1e-7).reshape(v.shape),
    "collide": lambda v, h: MODEL.collide(np.zeros((*v.shape, 3)), 0, [0.0, 0.0, 1.0], R, h, 0.3)[0][..., 0],
}


def empty(found, shape):
    fields = vars(found) if dataclasses.is_dataclass(found) else {"": found}
    return all(np.shape(one) == shape for one in fields.values() if one is not None)


@pytest.mark.parametrize("shape", [(0,), (0, 3)])
@pytest.mark.parametrize("kind", [*BARE, "foundation", "stiffness", "cylinder", "bowl", "layers on it"])
def test_no_impacts_have_empty_answers(kind, shape):
    speed, plate = np.full(shape, 2.0), wall(kind, shape)
    for name, call in (ALL | (OF_BARE if kind in BARE else {})).items():
        assert empty(call(speed, plate), shape), name
    for method in ("table", "solve"):
        history = MODEL.force_history(speed, R, plate, samples=5, method=method)
        assert history.force.shape == (*shape, 5) and history.flags.shape == shape
    with pytest.raises(cl.ArgumentError, match="speed: got no impact"):
        MODEL.constant(speed, R, plate)
