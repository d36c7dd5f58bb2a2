"""Parts of a mesh that look round, and what to take in their place."""

import numpy as np
import pytest
from scipy.spatial import Delaunay
from scipy.spatial.transform import Rotation as Turn

from contactlaw.walls import Mesh
from contactlaw.walls.roundness import round_parts

trimesh = pytest.importorskip("trimesh")
made, joined = trimesh.creation, trimesh.util.concatenate


def revolved(rho, z):
    return made.revolve(np.stack((rho + 0.0 * z, z + 0.0 * rho), axis=1), sections=48)


def bowl(start, end):
    angle = np.linspace(start, end, 20)
    return revolved(0.1 * np.sin(angle), 0.1 * np.cos(angle))


def without(mesh, lost):
    return mesh.submesh([np.flatnonzero(~lost(mesh.triangles_center))], append=True)


TUBE, HEIGHT = revolved(0.1, np.linspace(0.1, 0.3, 30)), np.linspace(0, 0.1, 20)
HOPPER = revolved(np.array([0.02, 0.1]), np.array([0, 0.08 * 2**0.5]))  # its normals have no principal axis
for corner, angle in zip(HOPPER.vertices, np.random.default_rng(1).uniform(-0.03, 0.03, 96), strict=True):
    corner[:] = Turn.from_euler("z", angle).apply(corner)
X, Y = np.meshgrid(np.linspace(0, 1, 8), np.linspace(0, 1, 8))
SHEET = np.column_stack([one.ravel() for one in (X, Y, 0.01 * X**2)])
ROUND = {
    "can": (made.cylinder(0.1, 0.3), "Cylinder((0, 0, -0.15), (0, 0, 0.15), 0.1"),
    "tip": (made.cone(0.1, 0.3), "Cone((0, 0, 0), (0, 0, 0.3), 0.1, 0"),
    "ball": (made.icosphere(2, 0.1), "Sphere((0, 0, 0), 0.1"),
    "cap": (bowl(0, 1.2), "Sphere((0, 0, 0), 0.1, axis=(0, 0, 1), polar=(0, 1.2)"),
    "zone": (bowl(0.5, 2.0), "Sphere((0, 0, 0), 0.1, axis=(0, 0, 1), polar=(0.5, 2)"),
    "silo": (
        joined([TUBE, HOPPER]),
        "Cylinder((0, 0, 0.1), (0, 0, 0.3), 0.1; Cone((0, 0, 0), (0, 0, 0.113137), 0.02, 0.1",
    ),
}
OTHER = {
    "box": made.box(),
    "disc": revolved(np.array([0.0, 0.1]), np.zeros(2)),
    "prism": made.cylinder(0.1, 0.3, sections=12),
    "bent sheet": trimesh.Trimesh(SHEET, Delaunay(SHEET[:, :2]).simplices),
    "torus": made.torus(0.1, 0.03),
    "capsule": made.capsule(0.2, 0.05),
    "half a pipe": without(TUBE, lambda at: at[:, 0] > 0),
    "pipe with a hole": without(TUBE, lambda at: np.hypot(at[:, 1], at[:, 2] - 0.2) + (at[:, 0] < 0) < 0.03),
    "barrel": revolved(0.1 + 0.01 * np.sin(np.pi / 0.1 * HEIGHT), HEIGHT),
    "oval pipe": TUBE.copy().apply_scale([1.0, 1.01, 1.0]),
}


@pytest.mark.parametrize("name", ROUND)
def test_the_wall_to_take_is_named(name):
    """Also where the mesh leans and is wound otherwise."""
    mesh, walls = ROUND[name]
    assert round_parts(mesh.vertices, mesh.faces) == [f"{one}, thickness=...)" for one in walls.split("; ")]
    turn = Turn.from_euler("xyz", [0.3, -0.7, 1.1])
    leaning = round_parts(turn.apply(mesh.vertices) + [0.5, -0.3, 0.2], mesh.faces[:, ::-1])
    assert [one.split("(")[0] for one in leaning] == [one.split("(")[0] for one in walls.split("; ")]


@pytest.mark.parametrize("name", OTHER)
def test_other_shapes_are_not(name):
    assert round_parts(OTHER[name].vertices, OTHER[name].faces) == []


def test_the_warning_is_short(tmp_path):
    joined([TUBE.copy().apply_translation([x, 0, 0]) for x in range(7)]).export(tmp_path / "pipes.stl")
    with pytest.warns(
        UserWarning, match=r"7 of its parts look round.*(Cylinder.*){5} 0.1, thickness=...\); and 2 more$"
    ):
        Mesh.read(tmp_path / "pipes.stl", 1e-3)
