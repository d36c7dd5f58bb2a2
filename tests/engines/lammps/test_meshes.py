"""Meshes in LAMMPS: a tessellated wall is the wall, whatever its triangles."""

import math
import sys
import time
import warnings

import numpy as np
import pytest
from lammps_box import DENSITY, PLATE, R, above, attach, dropped, flat, make, scene, square, state
from scipy.spatial import Delaunay
from scipy.spatial.transform import Rotation as Turn

import contactlaw as cl
from contactlaw.engines.lammps import Mesh, Plate, Rotation, Tabulated, Translation, Vibration
from contactlaw.stepping.step import WIDTH
from contactlaw.walls.frame import boxes_of, framed
from contactlaw.walls.grid import FacetGrid

SQUARE = ((0, 0, 0), (1e-2, 0, 0), (0, 1e-2, 0))
HALF = 0.014  # half side of the tessellated square [m]
UNEVEN = Turn.from_euler("xyz", [0.3, -0.7, 1.1]).as_matrix()


def lattice(n):
    """Corners and triangles of a square of n x n cells."""
    return square(n, HALF)


def scattered():
    """Random corners, triangles wound either way."""
    rng = np.random.default_rng(5)
    ring = HALF * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    points = np.concatenate((ring, rng.uniform(-HALF, HALF, (300, 2))))
    triangles = Delaunay(points).simplices
    return np.column_stack((points, 0.0 * points[:, 0])), triangles[:, [[0, 1, 2], [0, 2, 1]][1]]


def soup():
    """Triangles that share no corner, as a file of STL has them."""
    corners, triangles = lattice(9)
    return corners[triangles].reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)


def fan():
    """Needles around one point."""
    angle = np.linspace(0, 2 * math.pi, 121)[:-1]
    out = HALF / np.maximum(abs(np.cos(angle)), abs(np.sin(angle)))
    rim = np.column_stack((out * np.cos(angle), out * np.sin(angle), 0 * angle))
    here = np.arange(120)
    triangles = np.stack((here, np.roll(here, -1), np.full(120, 120)), 1)
    return np.vstack((rim, [[0.007, -0.003, 0.0]])), triangles


SQUARES = {"two": lambda: lattice(1), "lattice": lambda: lattice(20), "scattered": scattered, "soup": soup, "fan": fan}


def places(corners, triangles):
    """1000 places to hit: anywhere, on seams and on corners."""
    rng = np.random.default_rng(7)
    inner = corners[(abs(corners[:, :2]) < 0.9 * HALF).all(axis=1)]
    some = rng.choice(inner, 150) if len(inner) else np.empty((0, 3))
    ends = corners[rng.choice(triangles, 400)[:, :2]]
    share = rng.uniform(0, 1, (400, 1))
    seams = share * ends[:, 0] + (1 - share) * ends[:, 1]
    seams = seams[(abs(seams[:, :2]) < 0.9 * HALF).all(axis=1)]
    rest = 1000 - len(some) - len(seams)
    anywhere = np.column_stack((rng.uniform(-0.9 * HALF, 0.9 * HALF, (rest, 2)), np.zeros(rest)))
    return np.concatenate((some, seams, anywhere))


@pytest.mark.parametrize("turn", [np.eye(3), UNEVEN], ids=["level", "leaning"])
@pytest.mark.parametrize("name", SQUARES)
def test_a_tessellated_plate_is_the_plate(model, name, turn):
    """COR and path agree to 1e-9 on faces, seams and corners, with friction, on both sides."""
    corners, triangles = SQUARES[name]()
    hit = places(corners, triangles)
    rng = np.random.default_rng(11)
    side = rng.choice([-1.0, 1.0], len(hit))
    velocity = np.column_stack((rng.uniform(-8, 8, (len(hit), 2)), -5 * side))
    centre = hit + side[:, None] * [0, 0, R + 1.02e-5] - 2e-6 * velocity * [1, 1, 0]
    plate = Plate(turn @ [-HALF, -HALF, 0], turn @ [2 * HALF, 0, 0], turn @ [0, 2 * HALF, 0], 1e-3)
    mesh = Mesh(corners @ turn.T, triangles, 1e-3)
    falling = centre @ turn.T, velocity @ turn.T
    whole, ends = dropped(model, [plate], *falling, friction=0.3, records=9999)
    parts, others = dropped(model, [mesh], *falling, friction=0.3, records=9999)
    assert len(hit) == len(whole) == 1000
    assert parts["bead"].tolist() == whole["bead"].tolist()
    for column in ("restitution", "approach_speed", "contact_time", "peak_force", "wave_energy"):
        assert parts[column] == pytest.approx(whole[column], rel=1e-9), column
    for column in ("x", "v"):
        scale = abs(ends[column]).max()
        assert abs(others[column] - ends[column]).max() < 1e-9 * scale, column
    assert abs(others["omega"] - ends["omega"]).max() < 1e-9 * abs(ends["omega"]).max()
    assert len(set(parts["triangle"])) > 1 and parts["triangle"].min() >= 0


def test_each_triangle_has_its_thickness(model):
    corners, triangles = lattice(4)
    thickness = np.linspace(0.5e-3, 3e-3, len(triangles))
    middle = corners[triangles].mean(axis=1)
    rows, _ = dropped(model, [Mesh(corners, triangles, thickness)], middle + above(1e-5))
    assert rows["triangle"].tolist() == list(range(len(triangles)))
    assert rows["restitution"] == pytest.approx(model.restitution(5.0, R, thickness), abs=5e-4)


@pytest.mark.parametrize("facets", [36, 72, 360])
def test_a_cylinder_of_facets_is_one_surface(model, facets):
    """There is one contact at a time, with the COR of a plate at the same normal speed.

    A facet's normal is up to pi/facets from the cylinder's, which turns as much of the velocity.
    """
    drum = Mesh.cylinder((0, -0.05, 0), (0, 0.05, 0), 0.018, 1e-3, facets=facets)
    angle = np.random.default_rng(2).uniform(0, 2 * math.pi, 200)
    angle[:8] = np.arange(8) * 2 * math.pi / facets  # where facets meet
    out = np.column_stack((np.cos(angle), 0 * angle, np.sin(angle)))
    inside = 0.018 * math.cos(math.pi / facets) - R - 1e-5
    lmp, walls = scene(model, [drum], inside * out, 5.0 * out)
    contacts = 0
    for _ in range(70):
        lmp.command("run 10")
        slots = state(lmp)["d2_contactlaw"][:, PLATE::WIDTH]
        assert ((slots != 0.0).sum(axis=1) <= 1).all()
        contacts += (slots != 0.0).sum()
    rows = walls.collisions()
    assert contacts > 500 and sorted(rows["bead"]) == list(range(1, 201))
    v = state(lmp)["v"]
    # it swings back, with an R* between those of both sides
    expected = np.mean([model.solve(5.0, R, cl.Shell(1e-3, a)).restitution for a in (0.018, -0.018)])
    error = (1 + expected) * math.sin(math.pi / facets) ** 2 + 5e-4
    assert error < 1e-3 or facets < 360
    assert -(v * out).sum(axis=1) / 5 == pytest.approx(expected, abs=error)
    assert rows["restitution"] == pytest.approx(expected, abs=1e-3)


def test_rolling_over_seams_loses_nothing(model):
    """A bead that rolls keeps speed and spin, over 100 seams."""
    lmp = make((-0.01, 0.0003, R - 1e-9), (20, 0, 0), gravity=1e3, dt=2e-7)
    lmp.command(f"set atom 1 omega 0 {20 / R!r} 0")
    walls = attach(lmp, model, [Mesh(*lattice(100), math.inf)], friction=0.5)
    lmp.command("run 5000")
    now = state(lmp)
    assert now["x"][0, 0] >= 0.00999
    assert now["v"][0, 0] == pytest.approx(20, rel=1e-6)
    assert now["omega"][0, 1] * R == pytest.approx(20, rel=1e-6)
    assert walls.left_out == 0


@pytest.mark.parametrize("edges", [10, 24])
def test_more_contacts_than_slots_end_no_run(model, edges):
    """A bead that falls into a hole stays there: 24 edges are one surface, ten are several.

    Next to each other these lean by 29 degrees, so that each has a contact.
    """
    angle = np.arange(edges) * 2 * math.pi / edges
    rim = np.column_stack((np.cos(angle), np.sin(angle), 0 * angle))
    here = np.arange(edges)
    there = np.roll(here, -1)
    ring = np.concatenate((np.stack((here, there, here + edges), 1), np.stack((there, there + edges, here + edges), 1)))
    hole = Mesh(np.vstack((0.8 * R * rim, 0.01 * rim)), ring, 1e-3)
    rest = math.sqrt(1 - (0.8 * math.cos(math.pi / edges)) ** 2)  # height of the centre at rest [R]
    start = 1e-6, 2e-6, (rest + 0.003) * R
    lmp, walls = scene(model, [hole], start, (0, 0, 0), gravity=1000.0)
    lmp.command("run 60000")
    now = state(lmp)
    assert (walls.left_out > 0) == (edges == 10)
    assert np.hypot(*now["x"][0, :2]) < 0.05 * R and abs(now["x"][0, 2] - rest * R) < 0.05 * R


def test_a_larger_bead_than_the_grid_was_made_for(model):
    """The bead finds all triangles that it touches in the cells around its own."""
    outcomes = []
    for walls in ([flat(1e-3)], [Mesh(*lattice(60), 1e-3)]):
        start = 0.0101, 0.0071, 0.02
        lmp, attached = scene(model, walls, start, (0, 0, 0), radius=0.2e-3)
        lmp.create_atoms(1, [2], [1], [0.0023, 0.0017, 5e-3 + 1e-5], [3.0, 0, -5.0])
        lmp.command(f"set atom 2 diameter 1e-2 density {DENSITY}")
        lmp.command("run 2000")
        (row,) = attached.collisions()
        outcomes.append((row["restitution"], *state(lmp)["v"][1]))
    assert outcomes[0] == pytest.approx(outcomes[1], rel=1e-9)
    assert outcomes[0][0] == pytest.approx(model.restitution(5.0, 5e-3, 1e-3), abs=5e-4)


def test_a_grid_across_its_axes_is_made_as_fast_as_along_them():
    """A cylinder's facets are long and thin; the box around one that leans holds all cells.

    When all cells in that box were looked at, the leaning one took 180 times as long.
    """
    seconds = []
    for end in ((0, 0, 0.3), (0.173, 0.173, 0.173)):
        facets = framed([Mesh.cylinder((0, 0, 0), end, 0.02, 1e-3, facets=72)], [0], R).facets
        boxes = boxes_of(facets)
        FacetGrid(facets, boxes, 0, R)  # compiles the kernel
        start = time.process_time()
        FacetGrid(facets, boxes, 0, R)
        seconds.append(time.process_time() - start)
    assert seconds[1] < 10 * seconds[0]


@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("kind", ["stl", "ply", "obj"])
def test_files_are_read(tmp_path, kind, binary):
    trimesh = pytest.importorskip("trimesh")
    sphere = trimesh.creation.icosphere(radius=30.0)
    path = tmp_path / f"part.{kind}"
    if kind == "stl" and not binary:
        path.write_text(trimesh.exchange.stl.export_stl_ascii(sphere))
    else:
        options = {} if kind != "ply" else {"encoding": "binary" if binary else "ascii"}
        sphere.export(path, **options)
    if kind == "stl":  # as some programs write it
        content = path.read_bytes()
        path.write_bytes(content + b"\0\0" if binary else content.replace(b"endsol", b"End Sol"))
    mesh = Mesh.read(path, 2e-3, scale=1e-3)
    assert mesh.area.sum() == pytest.approx(sphere.area * 1e-6, rel=1e-6)
    assert len(mesh.triangles) == len(sphere.faces) and mesh.dropped == 0
    assert np.linalg.norm(mesh.vertices, axis=1).max() == pytest.approx(0.03, rel=1e-6)


def test_files_that_are_no_mesh(tmp_path):
    with pytest.raises(FileNotFoundError, match="path: no file.*gone.stl"):
        Mesh.read(tmp_path / "gone.stl", 1e-3)
    wrong = tmp_path / "wrong.stl"
    wrong.write_text("solid\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 1 x\nendsolid")
    with pytest.raises(ValueError, match="path: got .*wrong.stl.; no mesh that trimesh reads"):
        Mesh.read(wrong, 1e-3)
    with pytest.raises(ValueError, match="scale: got .*must be positive"):
        Mesh.read(wrong, 1e-3, scale=0.0)


STL = "solid {name}\n" + "".join(
    "facet normal 0 0 1\nouter loop\n" + "".join(f"vertex {x} {y} 0.0\n" for x, y in corners) + "endloop\nendfacet\n"
    for corners in (((10.0, 0.0), (15.0, 0.0), (15.0, 5.0)), ((10.0, 0.0), (15.0, 5.0), (10.0, 5.0)))
)
STL += "endsolid {name}\n"
OBJ = "# {name}\nv 10.0 0.0 0.0\ng {name}\nv 15.0 0.0 0.0\nv 15.0 5.0 0.0\nv 10.0 5.0 0.0\nf 1 2 3\nf 1 3 4\n"
LIST = "10.0 0.0 0.0\n15.0 0.0 0.0\n15.0 5.0 0.0\n10.0 5.0 0.0\n3 0 1 2\n3 0 2 3\n"
COORDINATES = "".join(f"property float {axis}\n" for axis in "xyz")
PLY = f"ply\nformat ascii 1.0\ncomment {{name}}\nelement vertex 4\n{COORDINATES}element face 2\n"
PLY += f"property list uchar int vertex_indices\nend_header\n{LIST}"
OFF = f"OFF\n# {{name}}\n4 2 0\n{LIST}"
TEXTS = {"stl": STL, "obj": OBJ, "ply": PLY, "off": OFF}
PACKED = np.zeros(2, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
PACKED["corners"][..., :2] = [[(10, 0), (15, 0), (15, 5)], [(10, 0), (15, 5), (10, 5)]]


def packed(count=2, head=b"solid"):
    """Binary STL of the same square."""
    return head.ljust(80) + count.to_bytes(4, "little") + PACKED.tobytes()


@pytest.mark.parametrize("kind", TEXTS)
@pytest.mark.parametrize(
    "written",
    [
        lambda text: text.format(name="Gr\u00f6\u00dfe").encode("latin-1"),
        lambda text: text.format(name="\u8868").encode("shift-jis"),  # its second byte is a backslash
        lambda text: text.format(name="\u8868").encode("utf-16"),
        lambda text: text.format(name="one vertex 1, end of solid").replace("\n", "\r\n").encode("utf-8-sig"),
        lambda text: text.format(name="part").replace("\n", "\r").encode(),
        lambda text: text.format(name="part").replace("10.0", "1.0D+01").replace("15.0", "1.5d1").encode(),
    ],
    ids=["latin", "shift-jis", "utf-16", "windows", "macintosh", "fortran"],
)
def test_texts_of_other_programs_are_read(tmp_path, monkeypatch, written, kind):
    monkeypatch.setitem(sys.modules, "charset_normalizer", None)  # trimesh does not install it
    path = tmp_path / f"part.{kind}"
    path.write_bytes(written(TEXTS[kind]))
    mesh = Mesh.read(path, 1e-3)
    assert mesh.area == pytest.approx([12.5, 12.5]) and mesh.vertices.max(axis=0).tolist() == [15.0, 5.0, 0.0]


@pytest.mark.parametrize("content", [packed(), packed() + bytes(500), packed(head="Gr\u00f6\u00dfe".encode("latin-1"))])
def test_binary_stl_is_told_by_its_size(tmp_path, content):
    (tmp_path / "part.stl").write_bytes(content)
    assert Mesh.read(tmp_path / "part.stl", 1e-3).area == pytest.approx([12.5, 12.5])


@pytest.mark.parametrize(
    ("kind", "content", "message"),
    [
        ("stl", packed()[:150], "cut, or no STL: no endsolid at its end, and 150 bytes in place of 184"),
        ("stl", packed(1), "184 bytes in place of 134"),
        ("stl", packed(0), "184 bytes in place of 84"),
        ("stl", packed(9), "184 bytes in place of 534"),
        ("stl", packed(0)[:84], "0 triangles, where at least 1"),
        ("stl", b"", "0 bytes in place of 84"),
        ("stl", (STL + STL[:100]).encode(), "cut, or no STL"),
        ("stl", STL.replace(" 5.0", " nan").encode(), "not all coordinates are finite"),
        ("stl", STL.replace("5.0", "5,0").encode(), "not all coordinates are numbers"),
        ("obj", OBJ.replace("5.0", "5,0").encode(), "not all coordinates are numbers"),
        ("obj", OBJ[:60].encode(), "0 triangles, where at least 1"),
        ("obj", b"", "0 triangles, where at least 1"),
        ("ply", b"", "Not a ply file"),
        ("ply", PLY[:-8].encode(), "1 triangles, where at least 2"),
        ("off", OFF[:-8].encode(), "1 triangles, where at least 2"),
        ("step", b"ISO-10303", "no mesh that trimesh reads"),
    ],
)
def test_broken_files_are_refused_in_words(tmp_path, kind, content, message):
    path = tmp_path / f"part.{kind}"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=rf"path: got .*part.{kind}.*{message}.*; write it again, best as a binary"):
        Mesh.read(path, 1e-3)


def test_triangles_that_are_none_are_left_out(model):
    corners = np.array([[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0], [0.02, 0, 0], [0, 0, 0]])
    triangles = [[0, 1, 2], [1, 2, 0], [4, 2, 1], [0, 1, 3], [0, 0, 1]]
    with pytest.warns(UserWarning, match="4 of 5 triangles left out"):
        mesh = Mesh(corners, triangles, [1e-3, 1e-3, 2e-3, 1e-3, 1e-3])
    assert (mesh.dropped, mesh.kept.tolist(), mesh.thickness.tolist()) == (4, [0], [1e-3])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(ValueError, match="triangles: none of 1 has an area"):
            Mesh(corners, [[0, 1, 3]], 1e-3)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"vertices": [[0, 0, 0], [1, 0, 0], [0, math.nan, 0]]}, "vertices: .*element 2.*finite"),
        ({"vertices": [[0, 0, 0], [1e300, 0, 0], [0, 1, 0]]}, "vertices: .*element 1.*beyond"),
        ({"vertices": [[0, 0], [1, 0], [0, 1]]}, r"vertices: .*an array of shape \(n, 3\)"),
        ({"vertices": "part.stl"}, "vertices: got .*expected an array"),
        ({"triangles": [[0, 1, 3]]}, "triangles: must be numbers of vertices, 0 to 2"),
        ({"triangles": [[0.0, 1.0, 2.0]]}, "triangles: got .*expected integers"),
        ({"triangles": np.empty((0, 3), int)}, "triangles: got .*expected integers"),
        ({"thickness": [1e-3, 2e-3]}, "thickness: got .*expected a number or one for each of 1"),
        ({"thickness": -1e-3}, "thickness: got -0.001; must"),
        ({"thickness": math.nan}, "thickness"),
        ({"model": "glass"}, "model: expected a contactlaw.ImpactModel"),
        ({"model": {0: None}}, "atom types are integers from 1 on"),
        ({"motion": (0, 0, 1)}, "motion: expected a Translation"),
    ],
)
def test_what_is_no_mesh_is_refused(change, message):
    good = {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]}
    with pytest.raises((ValueError, TypeError), match=message):
        Mesh(**{**good, "thickness": 1e-3, **change})


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Mesh.cylinder((0, 0, 0), (0, 0, 0), 1.0, 1e-3), "start, end: got .*must differ"),
        (lambda: Mesh.cylinder((0, 0, 0), (0, 0, 1), -1.0, 1e-3), "radius"),
        (lambda: Mesh.cone((0, 0, 0), (0, 0, 1), 0.0, 0.0, 1e-3), "radius"),
        (lambda: Mesh.cylinder((0, 0, 0), (0, 0, 1), 1.0, 1e-3, facets=2), "facets: got 2; exp"),
        (lambda: Mesh.disc((0, 0, 0), (0, 0, 0), 1.0, 1e-3), "normal: got .*must have a direction"),
        (lambda: Mesh.disc((0, 0, 0), (0, 0, 1), math.inf, 1e-3), "radius: got .*must be positive"),
        (lambda: Plate((0, 0, 0), (1e300, 0, 0), (0, 1, 0), 1e-3), "edge_a: .*none beyond"),
        (lambda: Plate((0, 0, math.nan), (1, 0, 0), (0, 1, 0), 1e-3), "corner: .* three numbers"),
        (lambda: Plate(SQUARE[0], SQUARE[1], (1e-2, 1e-2, 0), 1e-3), "perpendicular"),
        (lambda: Plate(SQUARE[0], (0, 0, 0), SQUARE[2], 1e-3), "perpendicular"),
        (lambda: Plate((0, 0), *SQUARE[1:], 1e-3), "corner"),
        (lambda: Plate(*SQUARE, 0.0), "thickness"),
        (lambda: Plate(*SQUARE, math.nan), "thickness"),
        (lambda: Plate(*SQUARE, 1e-3, "glass"), "model"),
        (lambda: Translation((0, 0)), "velocity: got .*expected three numbers"),
        (lambda: Translation((0, 0, math.nan)), "velocity"),
        (lambda: Rotation((0, 0, 0), 1.0), "axis: got .*must have a direction"),
        (lambda: Rotation((0, 0, 1), math.inf), "speed: got .*must be finite"),
        (lambda: Vibration((0, 0, 1e-3), 0.0), "frequency: got .*must be positive"),
        (lambda: Vibration((0, 0, 1e-3), 50.0, math.nan), "phase: got .*must be finite"),
        (lambda: Tabulated([0.0], [[0, 0, 0]]), "with n of 2 or more"),
        (lambda: Tabulated([0.0, 0.0], [[0, 0, 0]] * 2), "times: got .*must be finite and ascend"),
        (lambda: Tabulated([0.0, 1.0], [[0, 0, 0], [0, 0, 1e300]]), "displacements"),
        (lambda: Tabulated("ab", [[0, 0, 0]] * 2), "times, displacements"),
        (lambda: Plate((0, 0, 0), (1, 0, 0), (0, 1, 0), 1e-3, motion=5.0), "motion: expected"),
    ],
)
def test_shapes_and_motions_that_are_none_are_refused(call, message):
    with pytest.raises((ValueError, TypeError), match=message):
        call()


def test_ready_meshes_have_the_areas_of_their_shapes():
    n = 720
    cone = Mesh.cone((0, 0, 0), (0.1, 0.2, 0.3), 0.05, 0.02, 1e-3, facets=n)
    slant = math.hypot(math.sqrt(0.14), 0.03)
    assert cone.area.sum() == pytest.approx(math.pi * 0.07 * slant, rel=1e-4)
    tip = Mesh.cone((0, 0, 0), (0, 0, 0.1), 0.0, 0.02, 1e-3, facets=n)
    assert len(tip.triangles) == n and tip.dropped == 0
    assert tip.area.sum() == pytest.approx(math.pi * 0.02 * math.hypot(0.1, 0.02), rel=1e-4)
    disc = Mesh.disc((0, 0, 0), (1, 2, 3), 0.05, 1e-3, facets=n)
    assert disc.area.sum() == pytest.approx(math.pi * 0.05**2, rel=1e-4)
    assert abs(disc.vertices @ [1, 2, 3]).max() < 1e-15


def test_a_bead_of_no_contact_has_no_restitution_to_show(model):
    lmp, walls = scene(model, None, [above(1e-5), (0.01, 0, 0.02)])
    lmp.command("run 400")
    shown = lmp.numpy.extract_atom("d_contactlaw_restitution")[:2]
    assert shown.tolist() == [walls.collisions()["restitution"][0], 0.0]
