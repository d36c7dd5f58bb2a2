"""Round walls: distance and normal beside brute force, edges, curvature, and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from loops import loop
from scipy.spatial.transform import Rotation as Turn

from contactlaw.walls import Cone, Cylinder, Disc, Ring, Rotation, Sphere, Translation, move
from contactlaw.walls.facet import on_facet, touch_in_space
from contactlaw.walls.frame import framed
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
        (lambda: Sphere((0, 0, 0), 1.0, 1e-3, polar=(1.0, 0.5)), "polar: got .*ascend from 0 to pi"),
        (lambda: Sphere((0, 0, 0), 1.0, 1e-3, axis=(0, 0, 0)), "axis: got .*must have a direction"),
        (lambda: Disc((0, 0, 0), (0, 0, 0), 1.0, 1e-3), "normal: got .*must have a direction"),
        (lambda: Ring((0, 0, 0), (0, 0, 1), 0.02, 0.01, 1e-3), "inner_radius, outer_radius: got .*smaller"),
    ],
)
def test_what_is_no_round_wall_is_refused(call, message):
    with pytest.raises((ValueError, TypeError), match=message):
        call()
