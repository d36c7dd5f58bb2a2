"""Beads near the edges of walls, beside the integrated equation of one straight edge."""

import itertools
import math

import numpy as np
import pytest
from loops import fly

import contactlaw as cl
from contactlaw.engines.record import IMPACT, Kind
from contactlaw.equation.edge import KINDS
from contactlaw.stepping import WallContacts
from contactlaw.walls import Cylinder, Disc, Mesh, Plate, Translation

R, H, SPEED, DT = 0.9e-3, 1e-3, 3.0, 1e-7
MODEL = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), "myc")
MASS = 4 / 3 * math.pi * R**3 * MODEL.pair.sphere.density
SIDE = 0.05


def moved(wall, x, v, *, spin=(0.0, 0.0, 0.0), gravity=0.0, dt=DT, steps=400, model=MODEL, radius=R, **more):
    """Record of a bead, and its path: energy, place, force of the wall."""
    mass = 4 / 3 * math.pi * radius**3 * model.pair.sphere.density
    walls = WallContacts([wall], model, radius, np.zeros(99, IMPACT), **more)
    (contacts,), (friction,) = walls.memory(1)
    given = (np.array(one, dtype=float) for one in (x, v, spin))
    down, none = np.array([0.0, 0.0, -gravity]), np.zeros(3)
    path = fly(walls.scene, contacts, friction, *given, mass, radius, down, dt, steps, none, -1)
    path[:, 0] += mass * gravity * (path[:, 3] - radius)
    return walls.collisions().copy(), path


def dropped(wall, x, y, **options):
    return moved(wall, (x, y, 1.001 * R), (0, 0, -SPEED), **options)


def plate(edges, thickness=H, **options):
    return Plate((0, 0, 0), (SIDE, 0, 0), (0, SIDE, 0), thickness, edges=edges, **options)


def sheet(cells=10, hole=(), **options):
    """Square of cells, each of two triangles with vertices of their own, some of them left out."""
    corners = [
        (np.array([(i, j, 0), (i + 1, j, 0), (i + 1, j + 1, 0), (i, j + 1, 0)]) * SIDE / cells)[k]
        for i, j in itertools.product(range(cells), repeat=2)
        if (i, j) not in hole
        for k in (0, 1, 2, 0, 2, 3)
    ]
    return Mesh(corners, np.arange(len(corners)).reshape(-1, 3), H, **options)


def trough(edges):
    """A cylinder whose lowest line is at y = 0.021, so wide that it is flat for a bead."""
    return Cylinder((0, 0.021, 10.0), (SIDE, 0.021, 10.0), 10.0, H, edges=(None, edges))


def lid(edges):
    """A disc whose rim is at x = SIDE."""
    return Disc((SIDE - 1.0, 0.021, 0), (0, 0, 1), 1.0, H, edges=edges)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "wall", [plate, lambda kind: sheet(edges=kind), trough, lid], ids=["plate", "mesh", "trough", "lid"]
)
@pytest.mark.parametrize("distance", [0.5e-3, 1e-3, 2e-3, 4e-3, 9e-3])
def test_a_bead_near_an_edge(kind, wall, distance):
    (row,), _ = dropped(wall(kind), SIDE - distance, 0.021)
    expected = MODEL.solve(SPEED, R, H, edge=kind, edge_distance=distance)
    for name in ("restitution", "peak_force", "contact_time"):
        assert row[name] == pytest.approx(getattr(expected, name), rel=1e-3), name
    assert row["flags"] == expected.flags
    left = 0.5 * MASS * SPEED**2 * (1 - row["restitution"] ** 2)
    parts = sum(row[f"{name}_energy"] for name in ("plastic", "wave", "other", "scheme"))
    assert parts == pytest.approx(left, rel=1e-9)
    assert abs(row["scheme_energy"]) < 2e-3 * left


@pytest.mark.parametrize("count", [12, pytest.param(60, marks=pytest.mark.long)])
@pytest.mark.parametrize("kind", KINDS)
def test_random_impacts_near_edges(kind, count):
    """Lambda to 2; from a thickness away to where edges no longer matter; 50 steps a contact."""
    rng, off = np.random.default_rng(65), []
    for pair in (("stainless-steel-304-2b", "glass"), ("carbon-steel-1020", "pom"), ("glass", "aluminium-6082-t6")):
        model = cl.ImpactModel(cl.Pair(*pair))
        for logs in rng.uniform(np.log([0.05, 1e-4, 0.5]), np.log([8.0, 8e-3, 4.0]), (count, 3)):
            v, r, h = np.exp(logs) * (1.0, 1.0, np.exp(logs[1]))
            far, dt = model.solve(v, r, h), float(model.solve(v, r, math.inf).contact_time) / 50
            reach = cl.edge_distance(model.pair.plate, h, float(far.contact_time))
            distance = h * max(reach / h, 1.1) ** rng.uniform()
            wide = 20.0 * (r + distance)
            wall = Plate((0, 0, 0), (wide, 0, 0), (0, wide, 0), h, edges=(None, kind, None, None))
            start = wide - distance, 0.5 * wide, r + 0.3 * dt * v
            rows, _ = moved(wall, start, (0, 0, -v), dt=dt, steps=1000, model=model, radius=r)
            expected = model.solve(v, r, h, edge=kind, edge_distance=distance).restitution
            if far.inelasticity < 2.0:
                off.append(abs(rows["restitution"][:1].max(initial=0.0) - expected))
    assert len(off) > 2.7 * count
    assert max(off) < 1e-3 and np.median(off) < 1e-4


def test_sides_are_in_the_order_of_a_walk():
    kinds = ("free", None, "supported", "clamped")
    near = 1e-3
    points = [(0.02, near), (SIDE - near, 0.02), (0.02, SIDE - near), (near, 0.02)]
    for kind, point in zip(kinds, points, strict=True):
        (row,), _ = dropped(plate(kinds), *point)
        some = {"edge": kind, "edge_distance": near} if kind else {}
        assert row["restitution"] == pytest.approx(MODEL.solve(SPEED, R, H, **some).restitution, abs=1e-3)


def test_the_rim_of_a_hole_is_found_and_creases_are_none():
    whole, holed = sheet(edges="free"), sheet(hole=[(4, 4)], edges="free")
    assert len(whole.rim) == 40 and len(holed.rim) == 44
    cell = SIDE / 10
    (row,), _ = dropped(holed, 5 * cell + 1e-3, 4.5 * cell)
    hole = 2.0 * cell / math.pi  # the radius of a circle that is as long as the rim
    np.testing.assert_allclose(np.sort(holed.rim["hole"]), [hole] * 4 + [math.inf] * 40)
    expected = MODEL.restitution(SPEED, R, H, edge_distance=1e-3, hole_radius=hole)
    # steps take the response of the nearest of a few radii, see `place_of`
    assert row["restitution"] == pytest.approx(expected, rel=0.01)
    assert expected - MODEL.restitution(SPEED, R, H, edge_distance=1e-3) > 0.025
    cube = np.array(list(itertools.product((0, SIDE), (0, SIDE), (0, 2e-3))))
    sides = np.array([[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4]])
    triangles = np.concatenate((sides[:, [0, 1, 2]], sides[:, [0, 2, 3]]))
    tray = Mesh(cube, triangles, H, edges="clamped")  # an open box of low walls
    assert len(tray.rim) == 4
    # the floor meets no edge where it is joined to a wall
    assert dropped(tray, 1e-3, 0.02)[0] == dropped(Mesh(cube, triangles, H), 1e-3, 0.02)[0]


@pytest.mark.filterwarnings("ignore:Mesh. .* triangles left out")
@pytest.mark.parametrize("distance", [1.5e-3, 0.021])
def test_a_rim_is_the_sheets_where_vertices_differ_in_the_last_bit(distance):
    """Half of the triangles have a twin that differs so, too."""
    whole, rng = sheet(edges="free"), np.random.default_rng(1)
    corners = whole.vertices[whole.triangles[np.r_[:200, :200:2]]].reshape(-1, 3).astype(np.float32)
    corners = np.nextafter(corners, corners + rng.integers(-1, 2, corners.shape))
    found = Mesh(corners, np.arange(900).reshape(-1, 3), H, edges="free")
    (row,), (like,) = (dropped(wall, SIDE - distance, 0.021)[0] for wall in (found, whole))
    assert row["restitution"] == pytest.approx(like["restitution"], abs=1e-4)


def test_a_mesh_takes_the_kind_of_each_edge():
    found = sheet(edges=lambda middle: np.where(middle[:, 0] > 0.999 * SIDE, "clamped", None))
    assert len(found.rim) == 10
    (row,), _ = dropped(found, SIDE - 2e-3, 2e-3)
    expected = MODEL.restitution(SPEED, R, H, edge="clamped", edge_distance=2e-3)
    assert row["restitution"] == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize("edges", ["loose", ("free", "free"), ("free", None, "hinged", None), 3])
@pytest.mark.parametrize("wall", [plate, lambda kind: sheet(edges=kind)], ids=["plate", "mesh"])
def test_what_is_no_kind_of_edge_is_refused(wall, edges):
    with pytest.raises(ValueError, match="edges: got .*(must be one of free, supported, cl|expected one)"):
        wall(edges)


@pytest.mark.parametrize("walls", [(plate(None), plate("free")), (sheet(20), sheet(20, edges="clamped"))])
def test_far_from_edges_all_bits_are_those_of_an_endless_plate(walls):
    found = [dropped(wall, 0.026, 0.024, friction=0.2, spin=(0, 300, 0)) for wall in walls]
    assert found[0][0].tobytes() == found[1][0].tobytes()
    assert found[0][1].tobytes() == found[1][1].tobytes()


def test_an_edge_moves_with_its_plate():
    still, _ = dropped(plate("free"), SIDE - 1e-3, 0.02)
    passing = plate("free", motion=Translation((20.0, 0, 0)))
    start = SIDE - 1e-3 - 20.0 * DT  # the bead is a step ahead of the walls
    (row,), _ = moved(passing, (start, 0.02, 1.001 * R), (20.0, 0, -SPEED))
    assert row["restitution"] == pytest.approx(still[0]["restitution"], abs=1e-9)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("x", "speed"), [(1e-6, 0), (0.3e-3, 0), (1e-3, 3), (0.015, -3)])
def test_a_bead_rests_and_rolls_near_edges(kind, x, speed):
    """It keeps its height, gains no energy, and rolls past the reach of the edge."""
    end = (0, -speed / R, 0)
    rows, path = moved(
        plate(kind), (x, 0.02, R - 1e-9), (speed, 0, 0), spin=end, gravity=9.81, steps=50_000, friction=0.3
    )
    on = path[(path[:, 1] > 0.0) & (path[:, 1] < SIDE)]
    assert np.isfinite(path).all() and len(on) > 49_000 and not len(rows)
    assert on[:, 0].max() <= on[0, 0] + 1e-12 * abs(on[0, 0])
    assert -1e-7 < on[-1, 3] - R < 0.0
    assert on[-20_000:, 4].mean() == pytest.approx(9.81 * MASS, rel=0.02)


@pytest.mark.parametrize(("kind", "distance"), [("clamped", 4e-3), ("supported", 3e-3)])
def test_a_plate_that_comes_back_strikes_again(kind, distance):
    """The energies of all strikes add up, and none but the first may count as an impact."""
    start = (distance, 0.02, 1.001 * R)
    rows, path = moved(plate(kind, 0.15e-3), start, (0, 0, -SPEED), steps=3000)
    first, *later = rows
    expected = MODEL.solve(SPEED, R, 0.15e-3, edge=kind, edge_distance=distance)
    assert expected.flags & cl.Validity.STRIKES_AGAIN
    assert max(first["restitution"], 0.0) == pytest.approx(expected.restitution, abs=1e-3)
    assert later and all(row["kind"] == Kind.STRUCK for row in later)
    lost = sum(rows[f"{name}_energy"].sum() for name in ("plastic", "wave", "other", "scheme"))
    assert lost == pytest.approx(0.5 * MASS * SPEED**2 - path[-1, 0], rel=1e-9)
    receded = bool(first["restitution"] < 0.0)
    assert bool(first["flags"] & cl.Validity.STRIKES_AGAIN) == receded
