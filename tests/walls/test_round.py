"""Plates and round walls: distance and normal beside brute force, edges, and triangles for pictures.

These tests ask kernels of `contactlaw.walls`, since the force on a bead shows no distance of a wall
that it does not touch.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from loops import loop

from contactlaw.engines.record import IMPACT
from contactlaw.walls import Cone, Cylinder, Disc, Plate, Ring, Rotation, Sphere, Translation, move
from contactlaw.walls.edges import nearest_edge
from contactlaw.walls.facet import on_facet, touch_in_space
from contactlaw.walls.frame import framed
from contactlaw.walls.rest import at_rest
from contactlaw.walls.surface import OVERLAP, ROOM, overlaps

trimesh = pytest.importorskip("trimesh", reason="trimesh is missing: pip install contactlaw[lammps]")

AXIS, FOOT = np.array([2.0, -1.0, 2.0]) / 3.0, np.array([0.01, 0.02, -0.03])
E = np.linalg.svd(AXIS[None])[2][1:]  # two unit vectors across the axis


def around(profile):
    """Points of a round wall by two numbers from 0 to 1: along its profile, and around the axis."""

    def point(t, turn):
        rho, z = (np.asarray(part)[..., None] for part in profile(t))
        angle = 2 * math.pi * np.asarray(turn)[..., None]
        return FOOT + z * AXIS + rho * (np.cos(angle) * E[0] + np.sin(angle) * E[1])

    return point


# Each wall, and its points by the printed formula: distance from the axis and height along it. Axes lean.
WALLS = {
    "plate": (
        Plate(FOOT, 0.05 * E[0], 0.02 * E[1], 1e-3),
        lambda t, share: FOOT + np.stack((0.05 * t, 0.02 * np.clip(share, 0, 1)), -1) @ E,
    ),
    "cylinder": (Cylinder(FOOT, FOOT + 0.06 * AXIS, 0.02, 1e-3), around(lambda t: (0.02 + 0 * t, 0.06 * t))),
    "cone": (Cone(FOOT, FOOT + 0.05 * AXIS, 0.04, 0.01, 1e-3), around(lambda t: (0.04 - 0.03 * t, 0.05 * t))),
    "tip": (Cone(FOOT, FOOT + 0.05 * AXIS, 0.0, 0.03, 1e-3), around(lambda t: (0.03 * t, 0.05 * t))),
    "sphere": (Sphere(FOOT, 0.03, 1e-3), around(lambda t: (0.03 * np.sin(math.pi * t), 0.03 * np.cos(math.pi * t)))),
    "bowl": (
        Sphere(FOOT, 0.03, 1e-3, axis=5 * AXIS, polar=(0.4, 1.9)),
        around(lambda t: (0.03 * np.sin(0.4 + 1.5 * t), 0.03 * np.cos(0.4 + 1.5 * t))),
    ),
    "disc": (Disc(FOOT, AXIS, 0.03, 1e-3), around(lambda t: (0.03 * t, 0 * t))),
    "ring": (Ring(FOOT, 3 * AXIS, 0.01, 0.03, 1e-3), around(lambda t: (0.01 + 0.02 * t, 0 * t))),
}


def nearest(point, place):
    """Nearest point of a wall by brute force: lattices of points, each finer around the best."""
    t, share, width = 0.5, 0.5, 1.0
    while width > 1e-8:
        line = width * np.linspace(-0.5, 0.5, 41)
        ts, shares = np.meshgrid(np.clip(t + line, 0, 1), share + line, indexing="ij")
        points = point(ts, shares)
        best = np.unravel_index(np.linalg.norm(points - place, axis=2).argmin(), ts.shape)
        t, share, width = ts[best], shares[best], 0.2 * width
    return points[best]


def facets_of(wall):
    return framed([wall], [0], 1e-3).facets.view(np.recarray)


@pytest.mark.parametrize("name", WALLS)
def test_distance_and_normal_are_those_of_the_nearest_point(name):
    """On the axis, where there are many nearest points, any normal will do."""
    wall, surface = WALLS[name]
    (facet,) = facets_of(wall)
    on_axis = FOOT + np.outer((-0.031, 0.0, 0.02, 0.07), AXIS)
    points = FOOT + 0.02 * AXIS + np.random.default_rng(4).uniform(-0.06, 0.06, (60, 3))
    faces = 0
    for n, point in enumerate((*points, *on_axis)):
        touch, there = on_facet(facet, tuple(point), 0.0), nearest(surface, point)
        distance = np.linalg.norm(point - there)
        assert -touch.x == pytest.approx(distance, abs=1e-9)
        if n < len(points):
            assert touch[2:5] == pytest.approx((point - there) / distance, abs=1e-5)
            faces += touch.face
        else:
            assert np.linalg.norm(touch[2:5]) == pytest.approx(1.0) or touch.x == 0.0
        if touch.face:
            assert abs(touch.s) == -touch.x
    assert 5 < faces and (faces < 60 or name == "sphere")


@loop
def touched(frames, facets, points, radii, found, listed, there):
    """Which facets beads find in the grid, and which they overlap."""
    for i in range(len(points)):
        x = points[i, 0], points[i, 1], points[i, 2]
        for n in range(overlaps(frames, facets, x, radii[i], found)):
            listed[i, found[n].facet] = True
        for n in range(len(facets)):
            there[i, n] = touch_in_space(frames[facets[n].frame], facets[n], x, radii[i]).x > 0.0


@pytest.mark.parametrize("largest", [0.0, 1e-3, 8e-3])
def test_every_bead_that_overlaps_finds_the_wall(largest):
    """The grid lists a wall in all cells from which it is touched; some walls move."""
    rng, motions = np.random.default_rng(6), (Rotation((1, 2, 3), 30.0), Translation((0.3, 0, -0.1)), None)
    walls = [replace(wall, motion=motions[n % 3]) for n, (wall, _) in enumerate(WALLS.values())]
    made = framed(walls, [0] * len(walls), largest)
    move(made.frames, 0.2, 1e-5)
    points, radii = rng.uniform(-0.07, 0.07, (20_000, 3)), rng.uniform(1e-3, 8e-3, 20_000)
    listed, there = np.zeros((2, len(points), len(walls)), bool)
    touched(made.frames, made.facets, points, radii, np.zeros(ROOM, OVERLAP), listed, there)
    assert (listed == there).all() and there.sum(axis=0).min() > 50


SIDE = math.hypot(0.05, 0.03)  # of both cones
# Where points are on a profile, as a share of its length, and distance along the surface, number of
# the kind and radius of the hole of the nearest edge; the first end is free, the other one clamped.
ENDS = {
    # rolled out, the narrow end is a circle of the radius rho over the sine of half the angle
    "cone": [(0.1, 0.1 * SIDE, 0, math.inf), (0.6, 0.4 * SIDE, 2, 0.01 / 0.03 * SIDE)],
    "bowl": [
        (0.2, 0.2 * 1.5 * 0.03, 0, 0.03 * math.tan(0.4)),
        (0.8, 0.2 * 1.5 * 0.03, 2, 0.03 * math.tan(math.pi - 1.9)),
    ],
    "ring": [(0.1, 0.002, 0, 0.01), (0.9, 0.002, 2, math.inf)],
    "tip": [(0.1, 0.9 * SIDE, 0, math.inf)],
}


@loop
def edge_at(facets, place):
    return nearest_edge(facets[0], (place[0], place[1], place[2]), math.inf)


@pytest.mark.parametrize("name", ENDS)
def test_edges_are_where_a_wall_ends(name):
    """A tip is none. Beads near edges of discs and cylinders are in tests/stepping."""
    wall, point = WALLS[name]
    made = framed([replace(wall, edges=("free", "clamped")[: len(ENDS[name])])], [0], 1e-3)
    assert made.facets["edge_count"] == len(ENDS[name])
    for t, *edge in ENDS[name]:
        assert edge_at(made.facets, point(t, 0.25)) == pytest.approx(edge)


AREAS = {"plate": 1e-3, "cylinder": math.pi * 2.4e-3, "cone": math.pi * 0.05 * SIDE, "tip": math.pi * 0.03 * SIDE}
AREAS |= {"sphere": math.pi * 3.6e-3, "bowl": math.pi * 1.8e-3 * (math.cos(0.4) - math.cos(1.9))}
AREAS |= {"disc": math.pi * 9e-4, "ring": math.pi * 8e-4}


@pytest.mark.parametrize("name", WALLS)
def test_in_pictures_an_impact_is_on_the_triangle_where_it_was(name):
    """Triangles are 1/500 of the radius from the wall at most, and their areas add up to its own."""
    wall, point = WALLS[name]
    square = Plate((0, 0, 0), (1, 0, 0), (0, 1, 0), 1e-3)
    made = framed([square, wall, square], [0] * 3, 1e-3)
    points = point(*np.random.default_rng(8).uniform(0, 1, (2, 300)))
    hits = np.zeros(300, IMPACT)
    hits["plate"], hits["triangle"] = 1, -1
    hits["x"], hits["y"], hits["z"] = points.T
    corners, walls, triangle, _ = at_rest(made.facets, made.frames, hits)
    assert walls.tolist().count(0) == walls.tolist().count(2) == 2
    assert set(walls[triangle]) == {1}
    share = trimesh.triangles.points_to_barycentric(corners[triangle], points)
    there = trimesh.triangles.barycentric_to_points(corners[triangle], share)
    assert np.linalg.norm(points - there, axis=1).max() < 2e-3 * 0.04 and share.min() > -0.05
    assert trimesh.triangles.area(corners[walls == 1]).sum() == pytest.approx(AREAS[name], rel=4e-3)
