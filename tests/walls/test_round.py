"""Round walls: distance and normal beside brute force, edges, curvature, and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from loops import loop
from scipy.optimize import lsq_linear
from scipy.spatial.transform import Rotation as Turn

from contactlaw.engines.record import IMPACT
from contactlaw.walls import Cone, Cylinder, Disc, Plate, Ring, Rotation, Sphere, Translation, move
from contactlaw.walls.edges import nearest_edge
from contactlaw.walls.facet import on_facet, touch_in_space
from contactlaw.walls.frame import framed
from contactlaw.walls.rest import at_rest
from contactlaw.walls.surface import OVERLAP, ROOM, overlaps

AXIS, FOOT = np.array([2.0, -1.0, 2.0]) / 3.0, np.array([0.01, 0.02, -0.03])
# Each wall, and its points by the printed formula: from two numbers between 0 and 1, distance from
# the axis and height along it. Axes lean.
WALLS = {
    "cylinder": (Cylinder(FOOT, FOOT + 0.06 * AXIS, 0.02, 1e-3), lambda t: (0.02, 0.06 * t)),
    "cone": (Cone(FOOT, FOOT + 0.05 * AXIS, 0.04, 0.01, 1e-3), lambda t: (0.04 - 0.03 * t, 0.05 * t)),
    "tip": (Cone(FOOT, FOOT + 0.05 * AXIS, 0.0, 0.03, 1e-3), lambda t: (0.03 * t, 0.05 * t)),
    "sphere": (Sphere(FOOT, 0.03, 1e-3), lambda t: (0.03 * np.sin(math.pi * t), 0.03 * np.cos(math.pi * t))),
    "bowl": (
        Sphere(FOOT, 0.03, 1e-3, axis=5 * AXIS, polar=(0.4, 1.9)),
        lambda t: (0.03 * np.sin(0.4 + 1.5 * t), 0.03 * np.cos(0.4 + 1.5 * t)),
    ),
    "disc": (Disc(FOOT, AXIS, 0.03, 1e-3), lambda t: (0.03 * t, 0.0)),
    "ring": (Ring(FOOT, 3 * AXIS, 0.01, 0.03, 1e-3), lambda t: (0.01 + 0.02 * t, 0.0)),
}
E = np.linalg.svd(AXIS[None])[2][1:]  # two unit vectors across the axis


def nearest(profile, point):
    """Nearest point of a wall by brute force: lattices of points, each finer around the best."""
    t, angle, width = 0.5, math.pi, 1.0
    while width > 1e-8:
        ts = np.clip(t + width * np.linspace(-0.5, 0.5, 41), 0.0, 1.0)[:, None]
        angles = angle + width * np.linspace(-math.pi, math.pi, 41)
        rho, z = profile(ts)
        across = np.cos(angles)[..., None] * E[0] + np.sin(angles)[..., None] * E[1]
        places = FOOT + (z + 0.0 * ts)[..., None] * AXIS + (rho + 0.0 * ts)[..., None] * across
        best = np.unravel_index(np.linalg.norm(places - point, axis=2).argmin(), (41, 41))
        t, angle, width = ts[best[0], 0], angles[best[1]], 0.2 * width
    return places[best]


@pytest.mark.parametrize("name", WALLS)
def test_distance_and_normal_are_those_of_the_nearest_point(name):
    wall, profile = WALLS[name]
    facet = framed([wall], [0], 1e-3).facets.view(np.recarray)[0]
    points = FOOT + 0.02 * AXIS + np.random.default_rng(4).uniform(-0.06, 0.06, (60, 3))
    faces = 0
    for point in points:
        touch, there = on_facet(facet, tuple(point), 0.0), nearest(profile, point)
        assert -touch.x == pytest.approx(np.linalg.norm(point - there), abs=1e-9)
        normal = (point - there) / np.linalg.norm(point - there)
        assert touch[2:5] == pytest.approx(normal, abs=1e-5)
        faces += touch.face
        if touch.face:
            assert abs(touch.s) == -touch.x
    assert 5 < faces and (faces < 60 or name == "sphere")


def test_the_distance_from_a_plate_is_that_of_the_nearest_point():
    sides = np.array([0.05 * E[0], 0.02 * E[1]])
    facet = framed([Plate(FOOT, *sides, 1e-3)], [0], 1e-3).facets.view(np.recarray)[0]
    for point in FOOT + np.random.default_rng(5).uniform(-0.06, 0.06, (60, 3)):
        there = FOOT + lsq_linear(sides.T, point - FOOT, (0.0, 1.0), "bvls", 1e-15).x @ sides
        assert -on_facet(facet, tuple(point), 0.0).x == pytest.approx(np.linalg.norm(point - there), abs=1e-9)


@pytest.mark.parametrize("name", WALLS)
def test_a_bead_on_the_axis_has_a_distance_and_a_normal(name):
    wall, profile = WALLS[name]
    facet = framed([wall], [0], 1e-3).facets.view(np.recarray)[0]
    for height in (-0.031, 0.0, 0.02, 0.07):
        touch = on_facet(facet, tuple(FOOT + height * AXIS), 0.0)
        rho, z = np.array([profile(t) for t in np.linspace(0, 1, 20001)]).T
        assert -touch.x == pytest.approx(np.hypot(rho, z - height).min(), abs=1e-7)
        assert np.linalg.norm(touch[2:5]) == pytest.approx(1.0) or touch.x == 0.0


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


def test_a_moved_wall_is_the_same_wall_elsewhere():
    turn = Rotation((0, 0, 1), 2.0, (0.02, 0, 0))
    made = framed([Cylinder(FOOT, FOOT + 0.06 * AXIS, 0.02, 1e-3, motion=turn)], [0], 1e-3)
    move(made.frames, 0.4, 1e-5)
    frame, facet = made.frames.view(np.recarray)[0], made.facets.view(np.recarray)[0]
    matrix = Turn.from_rotvec([0, 0, 0.8]).as_matrix()
    hub = np.array([0.02, 0, 0])
    there = hub + matrix @ (FOOT - hub), hub + matrix @ (FOOT + 0.06 * AXIS - hub)
    still = framed([Cylinder(*there, 0.02, 1e-3)], [0], 1e-3).facets.view(np.recarray)[0]
    for point in np.random.default_rng(3).uniform(-0.06, 0.06, (50, 3)):
        assert touch_in_space(frame, facet, tuple(point), 0.01)[:5] == pytest.approx(
            on_facet(still, tuple(point), 0.01)[:5], abs=1e-12
        )


@loop
def nearest_edges(facet, points, found):
    for i in range(len(points)):
        found[i, 0], found[i, 1], found[i, 2] = nearest_edge(
            facet[0], (points[i, 0], points[i, 1], points[i, 2]), math.inf
        )


SIDE = math.hypot(0.05, 0.03)  # of both cones
# Where points are on a profile, as a share of its length, and distance along the surface, number of
# the kind and radius of the hole of the nearest edge; the first end is free, the other one clamped.
ENDS = {
    "cylinder": [(0.25, 0.015, 0, math.inf), (0.9, 0.006, 2, math.inf)],
    # rolled out, the narrow end is a circle of the radius rho over the sine of half the angle
    "cone": [(0.1, 0.1 * SIDE, 0, math.inf), (0.6, 0.4 * SIDE, 2, 0.01 / 0.03 * SIDE)],
    "bowl": [
        (0.2, 0.2 * 1.5 * 0.03, 0, 0.03 * math.tan(0.4)),
        (0.8, 0.2 * 1.5 * 0.03, 2, 0.03 * math.tan(math.pi - 1.9)),
    ],
    "ring": [(0.1, 0.002, 0, 0.01), (0.9, 0.002, 2, math.inf)],
    "disc": [(0.1, 0.027, 0, math.inf)],
    "tip": [(0.1, 0.9 * SIDE, 0, math.inf)],
    "sphere": [],
}


@pytest.mark.parametrize("name", ENDS)
def test_edges_are_where_a_wall_ends(name):
    """Tip, pole and middle are none."""
    wall, profile = WALLS[name]
    some = ENDS[name]
    count = {"sphere": 0, "disc": 1, "tip": 1}.get(name, 2)
    wall = replace(wall, edges=("free", "clamped")[:count])
    made = framed([wall], [0], 1e-3)
    points, found = np.zeros((len(some), 3)), np.zeros((len(some), 3))
    for n, (t, *_) in enumerate(some):
        rho, z = profile(t)
        points[n] = FOOT + z * AXIS + rho * E[1]
    nearest_edges(made.facets, points, found)
    assert found == pytest.approx(np.array([rest for _, *rest in some]).reshape(-1, 3))
    assert made.facets["edge_count"] == count


@pytest.mark.parametrize("name", WALLS)
def test_in_pictures_an_impact_is_on_the_triangle_where_it_was(name):
    """Triangles are 1/500 of the radius from the wall at most, and their areas add up to its own."""
    wall, profile = WALLS[name]
    square = Plate((0, 0, 0), (1, 0, 0), (0, 1, 0), 1e-3)
    made = framed([square, wall, square], [0] * 3, 1e-3)
    rng = np.random.default_rng(8)
    points = []
    for t, angle in rng.uniform(0, 1, (300, 2)):
        rho, z = profile(t)
        points.append(FOOT + z * AXIS + rho * (math.cos(7 * angle) * E[0] + math.sin(7 * angle) * E[1]))
    hits = np.zeros(300, IMPACT)
    hits["plate"], hits["triangle"] = 1, -1
    hits["x"], hits["y"], hits["z"] = np.transpose(points)
    corners, walls, triangle, _ = at_rest(made.facets, made.frames, hits)
    assert walls.tolist().count(0) == walls.tolist().count(2) == 2
    assert set(walls[triangle]) == {1}
    for point, (first, second, third) in zip(points, corners[triangle], strict=True):
        sides = np.transpose((second - first, third - first))
        share, *_ = np.linalg.lstsq(sides, point - first, rcond=None)
        assert np.linalg.norm(point - first - sides @ share) < 2e-3 * 0.04
        assert share.min() > -0.05 and share.sum() < 1.05
    ts = np.linspace(0, 1, 2001)
    rho, z = (part + 0.0 * ts for part in profile(ts))
    area = math.pi * ((rho[1:] + rho[:-1]) * np.hypot(np.diff(rho), np.diff(z))).sum()
    sides = np.diff(corners[walls == 1], axis=1)
    assert 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum() == pytest.approx(area, rel=4e-3)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Cylinder((0, 0, 0), (0, 0, 0), 1.0, 1e-3), "start, end: got .*must differ"),
        (lambda: Cylinder((0, 0, 0), (0, 0, 1), 0.0, 1e-3), "radius: got 0.0; must be positive"),
        (lambda: Cylinder((0, 0, 0), (0, 0, 1), math.nan, 1e-3), "radius: got nan; must be positive"),
        (lambda: Cylinder((0, 0, 0), (0, 0, 1), 1.0, -1e-3), "thickness: got -0.001; must"),
        (lambda: Cylinder((0, 0), (0, 0, 1), 1.0, 1e-3), "start: got .*three numbers"),
        (lambda: Cylinder((0, 0, 0), (0, 0, 1), 1.0, 1e-3, "glass"), "model: expected"),
        (lambda: Cylinder((0, 0, 0), (0, 0, 1), 1.0, 1e-3, motion=5), "motion: expected"),
        (lambda: Cylinder((0, 0, 0), (0, 0, 1), 1.0, 1e-3, edges="loose"), "edges: got 'loose'; must be one of"),
        (lambda: Cone((0, 0, 0), (0, 0, 1), 1.0, 1.0, 1e-3), "start_radius, end_radius: got .*take a Cylinder"),
        (lambda: Cone((0, 0, 0), (0, 0, 1), -1.0, 1.0, 1e-3), "start_radius, end_radius: got .*must be from 0"),
        (lambda: Cone((0, 0, 0), (0, 0, 1), 0.0, 1.0, 1e-3, edges=("free", "free")), "edges: got .*each of 1"),
        (lambda: Sphere((0, 0, 0), -1.0, 1e-3), "radius: got -1.0; must be positive"),
        (lambda: Sphere((0, 0, 0), 1.0, 1e-3, polar=(1.0, 0.5)), "polar: got .*ascend from 0 to at most math.pi"),
        (lambda: Cone((0, 0, 0), (0, 0, 1), 0.0, math.nan, 1e-3), "start_radius, end_radius: got .*must be from 0"),
        (lambda: Sphere((0, 0, 0), 1.0, 1e-3, axis=(0, 0, 0)), "axis: got .*must have a direction"),
        (lambda: Sphere((0, 0, 0), 1.0, 1e-3, edges="free"), "edges: got 'free'; a whole sphere has none"),
        (lambda: Disc((0, 0, 0), (0, 0, 0), 1.0, 1e-3), "normal: got .*must have a direction"),
        (lambda: Ring((0, 0, 0), (0, 0, 1), 0.02, 0.01, 1e-3), "inner_radius, outer_radius: got .*smaller"),
    ],
)
def test_what_is_no_round_wall_is_refused(call, message):
    with pytest.raises((ValueError, TypeError), match=message):
        call()
