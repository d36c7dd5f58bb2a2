"""The energy map of a run in LAMMPS, as other programs read it."""

import numpy as np
import pytest
from lammps_box import above, flat, scene, square

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.engines.lammps import Disc, Mesh

trimesh = pytest.importorskip("trimesh")


def vtk(path):
    """Corners (n, 3, 3) of a VTK file and the columns of its cells."""
    words = path.read_text().split()
    points, cells, *columns = (n for n, word in enumerate(words) if word in ("POINTS", "CELLS", "SCALARS"))
    corners = np.array(words[points + 3 :][: 3 * int(words[points + 1])], float).reshape(-1, 3)
    faces = np.array(words[cells + 3 :][: int(words[cells + 2])], int).reshape(-1, 4)[:, 1:]
    return corners[faces], {words[n + 1]: np.array(words[n + 6 :][: len(faces)], float) for n in columns}


def test_the_map_has_the_energy_and_the_area_of_the_walls(model, tmp_path, empty_pictures):
    place = [above(x=x, y=y) for x, y in np.random.default_rng(4).uniform(-0.02, 0.0, (6, 2))]
    place += [above(2e-3, x=0.03), above(x=-0.03, y=0.045)]
    corners, triangles = square(2, 0.025)
    mesh = Mesh(corners - [0.025, 0, 0], triangles, thickness=[0.5e-3] * 4 + [2e-3] * 4)
    disc = Disc((-0.03, 0.045, 0), (0, 0, 1), 0.01, 1e-3)
    named = {"belt": flat(1e-3, x=0.01, width=0.04), "sheet": mesh, "end": disc}
    lmp, walls = scene(model, named, place, (1.0, 0.5, -5.0), friction=0.1)
    lmp.command("run 5500")
    rows = walls.gather()
    assert walls.record().surface.names == [*named]
    assert rows.size == 8 and set(rows["plate"]) == {0, 1, 2}
    walls.report(tmp_path / "out")
    corners, columns = vtk(tmp_path / "out/energy.vtk")
    assert trimesh.triangles.area(corners).sum() == pytest.approx(0.05**2 + 0.04 * 0.1 + np.pi * 0.01**2, rel=1e-4)
    lost = sum(rows[f"{cause}_energy"].sum() for cause in ("wave", "plastic", "other", "friction"))
    assert columns["energy_J"].sum() == pytest.approx(lost, rel=1e-6)
    assert columns["impacts"].sum() == 8


def test_a_saved_record_and_its_mesh_give_the_same_map(model, tmp_path, empty_pictures, capsys):
    corners, triangles = square(3, 25.0)
    trimesh.Trimesh(corners, triangles, process=False).export(tmp_path / "part.stl")
    mesh = Mesh.read(tmp_path / "part.stl", 1e-3, scale=1e-3)
    lmp, walls = scene(model, [mesh], [above(x=x, y=0.4 * x) for x in np.linspace(-0.02, 0.02, 5)])
    lmp.command("run 700")
    walls.report(tmp_path / "own")
    saved, bare, again = (str(tmp_path / name) for name in ("own/record.h5", "rows.npy", "again"))
    assert main(["report", saved, "--out", str(tmp_path / "same")]) == 0
    assert capsys.readouterr().err == ""
    assert cl.read_record(saved).surface.names == ["part.stl"]
    np.save(bare, walls.gather())  # which knows no walls
    rows = cl.read_record(bare)
    cl.report(rows, again, [mesh])
    assert len({(tmp_path / name / "energy.vtk").read_text() for name in ("own", "same", "again")}) == 1
    # The maps of the earlier report would be those of another run.
    assert main(["report", bare, "--out", again]) == 0
    assert not (tmp_path / "again/energy.vtk").exists()
    assert "lacks materials and law; the surface of the walls" in capsys.readouterr().err
    large, (small, two) = Mesh(corners, triangles, 1e-3), square(1, 0.025)
    for meshes, words in (
        ([large], "scale: the mesh is 50 m wide"),
        ([mesh, mesh], "meshes: got 2 for the 1 walls"),
        ([Mesh(small, two, 1e-3)], "not the mesh of wall 0: it has no triangle 4, which the record has hits on"),
    ):
        with pytest.raises(ValueError, match=words):
            cl.report(rows, again, meshes)
