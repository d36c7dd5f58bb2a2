"""Meshes in LAMMPS: a tessellated wall is the wall, whatever its triangles; files of meshes."""

import math
import struct
import sys
import warnings

import numpy as np
import pytest
from lammps_box import R, above, dropped, hole, scene, square, state
from scipy.spatial import Delaunay
from scipy.spatial.transform import Rotation as Turn

import contactlaw as cl
from contactlaw.engines.lammps import Mesh, Plate

HALF = 0.014  # half side of the tessellated square [m]
UNEVEN = Turn.from_euler("xyz", [0.3, -0.7, 1.1]).as_matrix()


def scattered():
    """Triangles with random corners, wound either way; they share no corner, as a file of STL has them."""
    rng = np.random.default_rng(5)
    ring = HALF * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    points = np.concatenate((ring, rng.uniform(-HALF, HALF, (300, 2))))
    corners = np.column_stack((points, 0.0 * points[:, 0]))[Delaunay(points).simplices[:, [0, 2, 1]]]
    return corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3)


def places(corners, triangles):
    """1000 places to hit: anywhere, on seams and on corners."""
    rng = np.random.default_rng(7)
    share = rng.dirichlet((1, 1, 1), 3000)
    share[:2000, 2] = share[:500, 1] = 0.0
    hit = np.einsum("ij,ijk->ik", share / share.sum(axis=1, keepdims=True), corners[rng.choice(triangles, 3000)])
    return rng.permutation(hit[(abs(hit[:, :2]) < 0.9 * HALF).all(axis=1)])[:1000]


@pytest.mark.parametrize("turn", [np.eye(3), UNEVEN], ids=["level", "leaning"])
def test_a_tessellated_plate_is_the_plate(model, turn):
    """COR and path agree to 1e-9 on faces, seams and corners, with friction, on both sides."""
    corners, triangles = scattered()
    hit = places(corners, triangles)
    rng = np.random.default_rng(11)
    side = rng.choice([-1.0, 1.0], len(hit))
    velocity = np.column_stack((rng.uniform(-8, 8, (len(hit), 2)), -5 * side))
    centre = hit + side[:, None] * [0, 0, R + 1.02e-5] - 2e-6 * velocity * [1, 1, 0]
    plate = Plate(turn @ [-HALF, -HALF, 0], turn @ [2 * HALF, 0, 0], turn @ [0, 2 * HALF, 0], 1e-3)
    mesh = Mesh(corners @ turn.T, triangles, 1e-3)
    (whole, ends), (parts, others) = (
        dropped(model, [wall], centre @ turn.T, velocity @ turn.T, friction=0.3, records=9999) for wall in (plate, mesh)
    )
    assert len(hit) == len(whole) == 1000
    assert parts["bead"].tolist() == whole["bead"].tolist()
    for column in ("restitution", "approach_speed", "contact_time", "peak_force", "wave_energy"):
        assert parts[column] == pytest.approx(whole[column], rel=1e-9), column
    for column in ("x", "v", "omega"):
        assert abs(others[column] - ends[column]).max() < 1e-9 * abs(ends[column]).max(), column
    assert len(set(parts["triangle"])) > 1 and parts["triangle"].min() >= 0


def test_each_triangle_has_its_thickness(model):
    corners, triangles = square(4, HALF)
    thickness = np.linspace(0.5e-3, 3e-3, len(triangles))
    rows, _ = dropped(model, [Mesh(corners, triangles, thickness)], corners[triangles].mean(axis=1) + above(1e-5))
    assert rows["triangle"].tolist() == list(range(len(triangles)))
    assert rows["restitution"] == pytest.approx(model.restitution(5.0, R, thickness), abs=5e-4)


@pytest.mark.parametrize("edges", [10, 24])
def test_more_contacts_than_slots_end_no_run(model, edges):
    """A bead that falls into a hole stays there: 24 edges are one surface, ten are several.

    Next to each other these lean by 29 degrees, so that each has a contact.
    """
    rest = math.sqrt(1 - (0.8 * math.cos(math.pi / edges)) ** 2)  # height of the centre at rest [R]
    start = 1e-6, 2e-6, (rest + 0.003) * R
    lmp, walls = scene(model, [hole(edges, 0.8 * R, 1e-3)], start, (0, 0, 0), gravity=1000.0)
    lmp.command("run 60000")
    now = state(lmp)
    assert (walls.left_out > 0) == (edges == 10)
    assert np.hypot(*now["x"][0, :2]) < 0.05 * R and abs(now["x"][0, 2] - rest * R) < 0.05 * R


@pytest.mark.parametrize("n", [1, 80])
def test_a_floor_of_many_tiny_triangles_hides_no_wall(n):
    """A bead on hundreds of tiny triangles begins to touch a wall of such: both act on it."""
    half = 1e-3
    corners, triangles = square(n, half)
    upright = corners[:, [2, 1, 0]] + [half, 0, half]
    mesh = Mesh(np.vstack((corners, upright)), np.vstack((triangles, triangles + len(corners))), math.inf)
    start, hertz = (half - R - 1e-6, 1e-5, R + 5e-7), cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="hertz")
    rows, now = dropped(hertz, [mesh], start, (1.0, 0, -12.0), steps=300)
    assert rows["restitution"] == pytest.approx([1.0, 1.0], abs=1e-9)
    assert now["v"][0] == pytest.approx([-1.0, 0.0, 12.0], abs=1e-8)


# A square of 5 by 5 in two triangles, by other programs.
STL = """solid {name}
facet normal 0 0 1
outer loop
vertex 10.0 0.0 0.0
vertex 15.0 0.0 0.0
vertex 15.0 5.0 0.0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex 10.0 0.0 0.0
vertex 15.0 5.0 0.0
vertex 10.0 5.0 0.0
endloop
endfacet
End Solid {name}
"""
OBJ = """# {name}
v 10.0 0.0 0.0
g {name}
v 15.0 0.0 0.0
v 15.0 5.0 0.0
v 10.0 5.0 0.0
f 1 2 3
f 1 3 4
"""
PLY = """ply
format ascii 1.0
comment {name}
element vertex 4
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
end_header
10.0 0.0 0.0
15.0 0.0 0.0
15.0 5.0 0.0
10.0 5.0 0.0
3 0 1 2
3 0 2 3
"""
OFF = """OFF
# {name}
4 2 0
10.0 0.0 0.0
15.0 0.0 0.0
15.0 5.0 0.0
10.0 5.0 0.0
3 0 1 2
3 0 2 3
"""
TEXTS = {"stl": STL, "obj": OBJ, "ply": PLY, "off": OFF}
WRITERS = {
    "latin": lambda text: text.format(name="Gr\u00f6\u00dfe").encode("latin-1"),
    "shift-jis": lambda text: text.format(name="\u8868").encode("shift-jis"),  # its second byte is a backslash
    "utf-16": lambda text: text.format(name="\u8868").encode("utf-16"),
    "windows": lambda text: text.format(name="one vertex 1, end of solid").replace("\n", "\r\n").encode("utf-8-sig"),
    "macintosh": lambda text: text.format(name="part").replace("\n", "\r").encode(),
    "fortran": lambda text: text.format(name="part").replace("10.0", "1.0D+01").replace("15.0", "1.5d1").encode(),
}


def packed(count=2, head=b"solid"):
    """Binary STL of the same square."""
    corners = (10, 0, 0, 15, 0, 0, 15, 5, 0), (10, 0, 0, 15, 5, 0, 10, 5, 0)
    facets = (struct.pack("<3f9fH", 0, 0, 1, *three, 0) for three in corners)
    return head.ljust(80) + struct.pack("<I", count) + b"".join(facets)


FILES = [
    *((kind, write(text)) for kind, text in TEXTS.items() for write in WRITERS.values()),
    # a binary STL is told by its size, whatever its head says and follows it
    *(("stl", content) for content in (packed(), packed() + bytes(500), packed(head=b"Gr\xf6\xdfe"))),
]


@pytest.mark.parametrize(("kind", "content"), FILES, ids=lambda part: part if isinstance(part, str) else "")
def test_files_of_other_programs_are_read(tmp_path, monkeypatch, kind, content):
    pytest.importorskip("trimesh")
    monkeypatch.setitem(sys.modules, "charset_normalizer", None)  # trimesh does not install it
    path = tmp_path / f"part.{kind}"
    path.write_bytes(content)
    mesh = Mesh.read(path, 1e-3, scale=1e-3)
    assert mesh.area == pytest.approx([12.5e-6, 12.5e-6]) and mesh.dropped == 0
    assert mesh.vertices.max(axis=0) == pytest.approx([0.015, 0.005, 0.0])


@pytest.mark.parametrize(
    ("kind", "content", "message"),
    [
        ("stl", packed()[:150], "cut, or no STL: no endsolid at its end, and 150 bytes in place of 184"),
        ("stl", packed(9), "184 bytes in place of 534"),
        ("stl", b"", "0 bytes in place of 84"),
        ("stl", (STL + STL[:100]).encode(), "cut, or no STL"),
        ("stl", STL.replace(" 5.0", " nan").encode(), "not all coordinates are finite"),
        ("obj", OBJ.replace("5.0", "5,0").encode(), "not all coordinates are numbers"),
        ("obj", OBJ[:60].encode(), "0 triangles, where at least 1"),
        ("ply", PLY[:-8].encode(), "1 triangles, where at least 2"),
        ("step", b"ISO-10303", "no mesh that trimesh reads"),
    ],
)
def test_broken_files_are_refused_in_words(tmp_path, kind, content, message):
    path = tmp_path / f"part.{kind}"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=rf"path: got .*part.{kind}.*{message}.*; write it again, best as a binary"):
        Mesh.read(path, 1e-3)
    with pytest.raises(ValueError, match="scale: got .*must be positive"):
        Mesh.read(path, 1e-3, scale=0.0)
    with pytest.raises(FileNotFoundError, match="path: no file.*gone.stl"):
        Mesh.read(tmp_path / "gone.stl", 1e-3)


def test_triangles_that_are_none_are_left_out():
    """Without area, or a second time."""
    corners = [[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0], [0.02, 0, 0], [0, 0, 0]]
    with pytest.warns(UserWarning, match="4 of 5 triangles left out"):
        mesh = Mesh(corners, [[0, 1, 2], [1, 2, 0], [4, 2, 1], [0, 1, 3], [0, 0, 1]], np.array([1, 1, 2, 1, 1]) * 1e-3)
    assert (mesh.dropped, mesh.kept.tolist(), mesh.thickness.tolist()) == (4, [0], [1e-3])
    with warnings.catch_warnings(action="ignore"), pytest.raises(ValueError, match="triangles: none of 1 has an area"):
        Mesh(corners, [[0, 1, 3]], 1e-3)
