"""The energy map of a run in LAMMPS, as other programs read it."""

import numpy as np
import pytest
from lammps_box import ABOVE, above, flat, scene, square

from contactlaw.cli import main
from contactlaw.engines.lammps import Mesh, Vibration

trimesh = pytest.importorskip("trimesh")


def lost(rows):
    return sum(rows[f"{cause}_energy"] for cause in ("wave", "plastic", "other", "friction"))


def numbers(path):
    """Corners (n, 3, 3) of a VTK file and the columns of its cells, read line by line."""
    words = path.read_text().split()
    at = words.index("POINTS")
    count = int(words[at + 1])
    corners = np.array(words[at + 3 : at + 3 + 3 * count], float).reshape(-1, 3)
    at = words.index("CELLS")
    cells = np.array(words[at + 3 : at + 3 + int(words[at + 2])], int).reshape(-1, 4)
    columns = {
        words[at + 1]: np.array(words[at + 6 : at + 6 + len(cells)], float)
        for at, word in enumerate(words)
        if word == "SCALARS"
    }
    return corners[cells[:, 1:]], columns


def test_the_map_has_the_energy_and_the_area_of_the_walls(model, tmp_path, empty_pictures):
    """Also on a wall that moves: energy is where the bead hit it, not where it was then."""
    rng = np.random.default_rng(4)
    place = [above(x=x, y=y) for x, y in rng.uniform(-0.02, 0.0, (6, 2))] + [above(2e-3, x=0.03)]
    corners, triangles = square(2, 0.025)
    walls = [
        Mesh(corners - [0.025, 0, 0], triangles, thickness=[0.5e-3] * 4 + [2e-3] * 4),
        flat(1e-3, x=0.01, width=0.04, motion=Vibration((4e-3, 0, 0), 600.0)),
    ]
    lmp, found = scene(model, walls, place, (1.0, 0.5, -5.0), friction=0.1)
    lmp.command("run 5500")
    rows = found.gather()
    assert rows.size == 7 and set(rows["plate"]) == {0, 1}
    found.report(tmp_path / "out")
    corners, columns = numbers(tmp_path / "out/energy.vtk")
    side = np.diff(corners, axis=1)
    area = 0.5 * np.linalg.norm(np.cross(side[:, 0], side[:, 1]), axis=1)
    assert area.sum() == pytest.approx(0.05**2 + 0.04 * 0.1, rel=1e-6)
    assert columns["energy_J"].sum() == pytest.approx(lost(rows).sum(), rel=1e-6)
    assert columns["impacts"].sum() == 7
    (moved,) = rows[rows["plate"] == 1]
    ended = moved["time"] + moved["contact_time"]
    shift = 4e-3 * np.sin(1.2e3 * np.pi * ended)
    assert shift > 3.9e-3
    (hit,) = np.flatnonzero((columns["impacts"] > 0) & (corners[:, :, 0].min(axis=1) >= 0.0099))
    low, high = corners[hit].min(axis=0), corners[hit].max(axis=0)
    there = moved["x"] - shift, moved["y"]
    assert (low[:2] <= there).all() and (there <= high[:2]).all()
    mesh = trimesh.load(tmp_path / "out/energy.ply", process=False)
    assert mesh.area == pytest.approx(area.sum(), rel=1e-6)
    assert mesh.vertices[mesh.faces] == pytest.approx(corners)
    energy = mesh.metadata["_ply_raw"]["face"]["data"]["energy_J"]
    assert np.ravel(energy) == pytest.approx(columns["energy_J"], abs=1e-20)
    bright = mesh.visual.vertex_colors[mesh.faces[:, 0], :3].astype(int).sum(axis=1)
    assert bright[columns["J_per_m2"].argmax()] == bright.max()


def test_a_saved_record_and_its_mesh_give_the_same_map(model, tmp_path, empty_pictures, capsys):
    corners, triangles = square(3, 25.0)
    trimesh.Trimesh(corners, triangles, process=False).export(tmp_path / "part.stl")
    mesh = Mesh.read(tmp_path / "part.stl", 1e-3, scale=1e-3)
    places = [above(x=x, y=0.4 * x) for x in np.linspace(-0.02, 0.02, 5)]
    lmp, walls = scene(model, [mesh], places)
    lmp.command("run 700")
    walls.report(tmp_path / "own")
    assert main(["report", str(tmp_path / "own/record.h5"), "--out", str(tmp_path / "same")]) == 0
    assert capsys.readouterr().err == ""
    np.save(tmp_path / "rows.npy", walls.gather())  # which knows no walls
    command = ["report", str(tmp_path / "rows.npy"), "--out", str(tmp_path / "again")]
    stl = str(tmp_path / "part.stl")
    assert main([*command, "--mesh", stl, "--scale", "1mm"]) == 0
    for name in ("energy.vtk", "energy.ply"):
        own = (tmp_path / "own" / name).read_text()
        assert own == (tmp_path / "same" / name).read_text()
        assert own == (tmp_path / "again" / name).read_text()
    assert main(command) == 0  # the maps of the earlier report would be those of another run
    assert not list((tmp_path / "again").glob("energy.[vp]*[ky]"))
    assert "lacks materials and law; the surface of the walls" in capsys.readouterr().err
    assert main([*command, "--mesh", stl]) == 1
    assert "--scale: the mesh is 50 m wide" in capsys.readouterr().err
    assert main([*command, "--mesh", stl, "--mesh", stl]) == 1
    assert "--mesh: got 2 for the 1 walls" in capsys.readouterr().err
    corners, triangles = square(1, 25.0)
    trimesh.Trimesh(corners, triangles, process=False).export(tmp_path / "other.stl")
    assert main([*command, "--mesh", str(tmp_path / "other.stl"), "--scale", "1mm"]) == 1
    assert "not the mesh of wall 0: it has no triangle 4, which the record has hits on" in capsys.readouterr().err


def test_a_report_that_fails_on_rank_0_is_an_error(model, tmp_path):
    lmp, walls = scene(model, None, ABOVE)
    with pytest.raises(ValueError, match="has no impact on a wall yet"):
        walls.report(tmp_path / "out")
    lmp.command("run 700")
    walls.report(tmp_path / "out")
    assert "1 impact on 1 wall, gamma-alumina on glass" in (tmp_path / "out/index.html").read_text()
