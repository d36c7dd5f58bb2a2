"""What is no wall and no motion is refused in words that name the argument."""

import math
from dataclasses import replace

import numpy as np
import pytest

import contactlaw as cl
from contactlaw.walls import (
    Cone,
    Cylinder,
    Disc,
    Mesh,
    Plate,
    Ring,
    Rotation,
    Sphere,
    Tabulated,
    Translation,
    Vibration,
)

ORIGIN, X, Y, UP, FAR = (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1e300, 0, 0)
PLATE, MESH = Plate(ORIGIN, X, Y, 1e-3), Mesh([ORIGIN, X, Y], [[0, 1, 2]], 1e-3)
CYLINDER, CONE = Cylinder(ORIGIN, UP, 1.0, 1e-3), Cone(ORIGIN, UP, 0.0, 1.0, 1e-3)
SPHERE, DISC, RING = Sphere(ORIGIN, 1.0, 1e-3), Disc(ORIGIN, UP, 1.0, 1e-3), Ring(ORIGIN, UP, 0.5, 1.0, 1e-3)
TURNING, SHAKEN = Rotation(UP, 1.0), Vibration(UP, 1.0)
TABLE = Tabulated([0.0, 1.0], [ORIGIN, UP])
OF_EVERY_WALL = [
    ("thickness", -1e-3, "thickness: got -0.001; must"),
    ("thickness", math.nan, "thickness: got nan; must"),
    ("model", "glass", "model: expected a contactlaw.ImpactModel"),
    ("model", {0: None}, "atom types are integers from 1 on"),
    ("model", {1: "steel"}, "expected a contactlaw.ImpactModel or None for atom type 1"),
    ("motion", UP, "motion: expected a Translation"),
    ("edges", "loose", "edges: got 'loose'; must be one of free, supp"),
    ("edges", [None] * 5, "edges: got .*expected one kind for all or one for each of"),
]
REFUSED = [
    *((wall, *row) for wall in (PLATE, MESH, DISC) for row in OF_EVERY_WALL),
    (PLATE, "edges", ("free", None, "hinged", None), "edges: got 'hinged'; must be one of"),
    (PLATE, "edge_a", FAR, "edge_a: .*none beyond"),
    (PLATE, "edge_a", Y, "edge_a, edge_b: got .*perpendicular and of some length"),
    (PLATE, "corner", (0, 0, math.nan), "corner: got .*three numbers"),
    (PLATE, "thickness", cl.Foundation(1e-3, [1.0, 2.0]), "stiffness: .*one number"),
    (CYLINDER, "thickness", cl.Foundation(1e-3, 1e12), "a round wall is a shell"),
    (MESH, "vertices", [ORIGIN, X, (0, math.nan, 0)], "vertices: .*element 2.*finite"),
    (MESH, "vertices", [ORIGIN, FAR, Y], "vertices: .*element 1.*beyond"),
    (MESH, "vertices", [(0, 0), (1, 0), (0, 1)], r"vertices: .*an array of shape \(n, 3\)"),
    (MESH, "triangles", [[0, 1, 3]], "triangles: must be numbers of vertices, 0 to 2"),
    (MESH, "triangles", [[0.0, 1.0, 2.0]], "triangles: got .*expected integers"),
    (MESH, "thickness", [1e-3, 2e-3], "thickness: got .*expected a number or one for each of 1"),
    (CYLINDER, "end", ORIGIN, "start, end: got .*must differ"),
    (CYLINDER, "radius", 0.0, "radius: got 0.0; must be positive"),
    (SPHERE, "polar", (1.0, 0.5), "polar: got .*ascend from 0 to at most math.pi"),
    (SPHERE, "axis", ORIGIN, "axis: got .*must have a direction"),
    (SPHERE, "edges", "free", "edges: got 'free'; a whole sphere has none"),
    (CONE, "start_radius", 1.0, "start_radius, end_radius: got .*take a Cylinder"),
    (CONE, "start_radius", math.nan, "start_radius, end_radius: got .*must be from 0"),
    (CONE, "edges", ("free", "free"), "edges: got .*one for each of 1"),
    (DISC, "normal", ORIGIN, "normal: got .*must have a direction"),
    (RING, "inner_radius", 2.0, "inner_radius, outer_radius: got .*smaller"),
    (Translation(UP), "velocity", (0, 0), "velocity: got .*expected three numbers"),
    (TURNING, "axis", ORIGIN, "axis: got .*must have a direction"),
    (TURNING, "speed", math.inf, "speed: got inf; must be finite"),
    (SHAKEN, "frequency", 0.0, "frequency: got 0.0; must be positive"),
    (SHAKEN, "phase", math.nan, "phase: got nan; must be finite"),
    (TABLE, "times", [0.0], r"times, displacements: got .*\(n, 3\) with n of 2 or more"),
    (TABLE, "times", [0.0, 0.0], "times: got .*must be finite and ascend"),
    (TABLE, "displacements", [ORIGIN, FAR], "displacements: must be finite"),
]


@pytest.mark.parametrize(("good", "argument", "value", "words"), REFUSED)
def test_what_is_no_wall_and_no_motion_is_refused(good, argument, value, words):
    with pytest.raises((ValueError, TypeError), match=words):
        replace(good, **{argument: value})


def test_a_cylinder_of_triangles_has_three_facets_or_more():
    with pytest.raises(ValueError, match="facets: got 2; expected an integer of 3 or more"):
        Mesh.cylinder(ORIGIN, UP, 1.0, 1e-3, facets=2)


def test_nobody_writes_into_walls_that_have_been_checked():
    here = np.zeros(3)
    assert type(replace(PLATE, corner=here).corner) is type(replace(SPHERE, centre=here).centre) is tuple
    for array in (TABLE.times, MESH.vertices, MESH.triangles, MESH.thickness):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 2
