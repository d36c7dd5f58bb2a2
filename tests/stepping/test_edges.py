"""Beads near the edges of walls in LAMMPS, beside the integrated equation of one straight edge."""

import math

import lammps_box as box
import numpy as np
import pytest
from lammps_box import R, lost
from lasting import long

import contactlaw as cl
from contactlaw.engines.record import Kind
from contactlaw.equation.edge import KINDS
from contactlaw.walls import Cylinder, Disc, Mesh, Plate, Translation

H, SPEED, SIDE = 1e-3, 3.0, 0.05
MODEL = cl.ImpactModel(box.PAIR, "myc")


def dropped(wall, x, y, velocity=(0, 0, -SPEED), **options):
    """Impacts of a bead that falls onto a place, and what is left of it."""
    return box.dropped(MODEL, [wall], (x, y, 1.001 * R), velocity, **options)


def plate(edges, thickness=H, **options):
    return Plate((0, 0, 0), (SIDE, 0, 0), (0, SIDE, 0), thickness, edges=edges, **options)


def sheet(hole=False, **options):
    """Square of ten by ten cells, of which one may be left out."""
    corners, triangles = box.square(10, SIDE / 2)
    away = abs(corners[triangles].mean(axis=1)[:, :2] + SIDE / 20).max(axis=1)
    return Mesh(corners + [SIDE / 2, SIDE / 2, 0], triangles[away > SIDE / 20 * hole], H, **options)


WALLS = {
    "plate": plate,
    "mesh": lambda kind: sheet(edges=kind),
    # a cylinder whose lowest line is at y = 0.021, so wide that it is flat for a bead
    "trough": lambda kind: Cylinder((0, 0.021, 10.0), (SIDE, 0.021, 10.0), 10.0, H, edges=(None, kind)),
    # a disc whose rim is at x = SIDE
    "lid": lambda kind: Disc((SIDE - 1.0, 0.021, 0), (0, 0, 1), 1.0, H, edges=kind),
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("wall", WALLS)
@pytest.mark.parametrize("distance", [0.5e-3, 2e-3, 9e-3, long(1e-3), long(4e-3)])
@pytest.mark.parametrize("softening", [1.0, 20.0])
def test_a_bead_near_an_edge(kind, wall, distance, softening):
    bound = 1e-3 if softening == 1.0 else 2e-3  # of the time of a softened contact
    (row,), _ = dropped(WALLS[wall](kind), SIDE - distance, 0.021, softening=softening)
    expected = MODEL.solve(SPEED, R, H, edge=kind, edge_distance=distance)
    for name in ("restitution", "peak_force", "contact_time"):
        assert row[name] == pytest.approx(getattr(expected, name), rel=bound), name
    assert row["flags"] == expected.flags
    left = 0.5 * box.MASS * SPEED**2 * (1 - row["restitution"] ** 2)
    assert lost(row) == pytest.approx(left, rel=1e-9)
    assert abs(row["scheme_energy"]) < 2e-3 * left


@pytest.mark.parametrize("count", [6, long(60)])
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
            away = h * max(reach / h, 1.1) ** rng.uniform()
            wide = 20.0 * (r + away)
            wall = Plate((away - wide, -0.5 * wide, 0), (wide, 0, 0), (0, wide, 0), h, edges=(None, kind, None, None))
            bead = {"radius": r, "density": model.pair.sphere.density, "dt": dt, "steps": 1000}
            rows, _ = box.dropped(model, [wall], (0, 0, r + 0.3 * dt * v), (0, 0, -v), **bead)
            expected = model.solve(v, r, h, edge=kind, edge_distance=away).restitution
            if far.inelasticity < 2.0:
                off.append(abs(rows["restitution"][:1].max(initial=0.0) - expected))
    assert len(off) > 2.7 * count
    assert max(off) < 1e-3 and np.median(off) < 1e-4


NEAR = 1e-3
OF_EACH = sheet(edges=lambda middle: np.where(middle[:, 0] > 0.999 * SIDE, "clamped", None))
SIDES = [
    ("free", (0.02, NEAR)),
    (None, (SIDE - NEAR, 0.02)),
    ("supported", (0.02, SIDE - NEAR)),
    ("clamped", (NEAR, 0.02)),
]


@pytest.mark.parametrize(
    ("wall", "kind", "place"),
    [
        *((plate([kind for kind, _ in SIDES]), *side) for side in SIDES),
        (OF_EACH, "clamped", (SIDE - NEAR, 0.02)),
        (OF_EACH, None, (0.02, NEAR)),
    ],
)
def test_each_side_has_its_kind_in_the_order_of_a_walk_or_by_its_place(wall, kind, place):
    (row,), _ = dropped(wall, *place)
    some = {"edge": kind, "edge_distance": NEAR} if kind else {}
    assert row["restitution"] == pytest.approx(MODEL.solve(SPEED, R, H, **some).restitution, abs=1e-3)


def test_the_rim_of_a_hole_is_found_and_creases_are_none():
    whole, holed = sheet(edges="free"), sheet(hole=True, edges="free")
    assert len(whole.rim) == 40 and len(holed.rim) == 44
    cell = SIDE / 10
    (row,), _ = dropped(holed, 5 * cell + 1e-3, 4.5 * cell)
    hole = 2.0 * cell / math.pi  # the radius of a circle that is as long as the rim
    np.testing.assert_allclose(np.sort(holed.rim["hole"]), [hole] * 4 + [math.inf] * 40)
    expected = MODEL.restitution(SPEED, R, H, edge_distance=1e-3, hole_radius=hole)
    # steps take the response of the nearest of a few radii, see `place_of`
    assert row["restitution"] == pytest.approx(expected, rel=0.01)
    assert expected - MODEL.restitution(SPEED, R, H, edge_distance=1e-3) > 0.025
    assert len(Mesh.cylinder((0, 0, 0), (0, 0, SIDE), SIDE, H, facets=9, edges="free").rim) == 18


def test_an_edge_moves_with_its_plate():
    (still,), _ = dropped(plate("free"), SIDE - 1e-3, 0.02)
    (row,), _ = dropped(plate("free", motion=Translation((20.0, 0, 0))), SIDE - 1e-3, 0.02, (20.0, 0, -SPEED))
    assert row["restitution"] == pytest.approx(still["restitution"], abs=1e-9)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("x", "speed"), [(1e-6, 0), (1e-3, 3), (0.015, -3)])
def test_a_bead_rests_and_rolls_near_edges(kind, x, speed):
    """It keeps its height, gains no energy, and rolls past the reach of the edge."""
    g = 9.81
    lmp, walls = box.scene(MODEL, [plate(kind)], (x, 0.02, R - 1e-9), (speed, 0, 0), gravity=g, friction=0.3)
    lmp.commands_string(f"set group all omega 0 {-speed / R!r} 0\nrun 1")
    energies = []
    for _ in range(490):
        now = box.state(lmp)
        (along, _, z), v, w = now["x"][0], now["v"][0], now["omega"][0]
        energies.append(box.MASS * (0.5 * v @ v + 0.2 * R**2 * w @ w + g * (z - R)))
        assert 0.0 < along < SIDE
        lmp.command("run 100 post no")
    assert not len(walls.collisions()) and -1e-7 < z - R < 0.0
    assert max(energies) <= energies[0] + 1e-12 * abs(energies[0])


@pytest.mark.parametrize(("kind", "distance"), [("clamped", 4e-3), ("supported", 3e-3)])
def test_a_plate_that_comes_back_strikes_again(kind, distance):
    """The energies of all strikes add up, and none but the first may count as an impact."""
    rows, now = dropped(plate(kind, 0.15e-3), distance, 0.02, steps=3000)
    first, *later = rows
    expected = MODEL.solve(SPEED, R, 0.15e-3, edge=kind, edge_distance=distance)
    assert expected.flags & cl.Validity.STRIKES_AGAIN
    assert max(first["restitution"], 0.0) == pytest.approx(expected.restitution, abs=1e-3)
    assert later and all(row["kind"] == Kind.STRUCK for row in later)
    assert lost(rows).sum() == pytest.approx(0.5 * box.MASS * (SPEED**2 - (now["v"] ** 2).sum()), rel=1e-9)
    receded = bool(first["restitution"] < 0.0)
    assert bool(first["flags"] & cl.Validity.STRIKES_AGAIN) == receded
