"""The energy map of a run in LAMMPS, as other programs read it."""

import sys

import numpy as np
import pytest
from lammps_box import ABOVE, above, flat, numbers, scene, square

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.engines.lammps import Disc, Mesh, Vibration

trimesh = pytest.importorskip("trimesh")


def lost(rows):
    return sum(rows[f"{cause}_energy"] for cause in ("wave", "plastic", "other", "friction"))


def test_the_map_has_the_energy_and_the_area_of_the_walls(model, tmp_path, empty_pictures):
    """Also on a wall that moves: energy is where the bead hit it, not where it was then."""
    rng = np.random.default_rng(4)
    place = [above(x=x, y=y) for x, y in rng.uniform(-0.02, 0.0, (6, 2))]
    place += [above(2e-3, x=0.03), above(x=-0.03, y=0.045)]
    corners, triangles = square(2, 0.025)
    moving = {"motion": Vibration((4e-3, 0, 0), 600.0)}
    mesh = Mesh(corners - [0.025, 0, 0], triangles, thickness=[0.5e-3] * 4 + [2e-3] * 4)
    disc = Disc((-0.03, 0.045, 0), (0, 0, 1), 0.01, 1e-3, **moving)
    walls = {"belt": flat(1e-3, x=0.01, width=0.04, **moving), "sheet": mesh, "end": disc}
    lmp, found = scene(model, walls, place, (1.0, 0.5, -5.0), friction=0.1)
    lmp.command("run 5500")
    rows, on = found.gather(), found.record().surface
    assert on.names == ["belt", "sheet", "end"]
    assert rows.size == 8 and set(rows["plate"]) == {0, 1, 2}
    found.report(tmp_path / "out")
    corners, columns = numbers(tmp_path / "out/energy.vtk")
    side = np.diff(corners, axis=1)
    area = 0.5 * np.linalg.norm(np.cross(side[:, 0], side[:, 1]), axis=1)
    assert area.sum() == pytest.approx(0.05**2 + 0.04 * 0.1 + np.pi * 0.01**2, rel=1e-4)
    assert columns["energy_J"].sum() == pytest.approx(lost(rows).sum(), rel=1e-6)
    assert columns["impacts"].sum() == 8
    (moved,) = rows[rows["plate"] == 0]
    ended = moved["time"] + moved["contact_time"]
    shift = 4e-3 * np.sin(1.2e3 * np.pi * ended)
    assert shift > 3.9e-3
    (hit,) = np.flatnonzero((columns["impacts"] > 0) & (corners[:, :, 0].min(axis=1) >= 0.0099))
    low, high = corners[hit].min(axis=0), corners[hit].max(axis=0)
    there = moved["x"] - shift, moved["y"]
    assert (low[:2] <= there).all() and (there <= high[:2]).all()


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
    assert cl.read_record(tmp_path / "own/record.h5").surface.names == ["part.stl"]
    np.save(tmp_path / "rows.npy", walls.gather())  # which knows no walls
    rows = cl.read_record(tmp_path / "rows.npy")
    cl.report(rows, tmp_path / "again", [mesh])
    own, same, again = ((tmp_path / name / "energy.vtk").read_text() for name in ("own", "same", "again"))
    assert own == same == again
    # The maps of the earlier report would be those of another run.
    assert main(["report", str(tmp_path / "rows.npy"), "--out", str(tmp_path / "again")]) == 0
    assert not (tmp_path / "again/energy.vtk").exists()
    assert "lacks materials and law; the surface of the walls" in capsys.readouterr().err
    with pytest.raises(ValueError, match="scale: the mesh is 50 m wide"):
        cl.report(rows, tmp_path / "again", [Mesh(corners, triangles, thickness=1e-3)])
    with pytest.raises(ValueError, match="meshes: got 2 for the 1 walls"):
        cl.report(rows, tmp_path / "again", [mesh, mesh])
    corners, triangles = square(1, 25.0)
    with pytest.raises(ValueError, match="not the mesh of wall 0: it has no triangle 4, which the record has hits on"):
        cl.report(rows, tmp_path / "again", [Mesh(1e-3 * corners, triangles, thickness=1e-3)])


def test_an_impact_is_recorded_without_scipy_and_matplotlib(model, tmp_path, monkeypatch):
    for name in ("scipy", "scipy.spatial", "matplotlib"):
        monkeypatch.setitem(sys.modules, name, None)
    lmp, walls = scene(model, None, ABOVE)
    assert walls.record().rows.size == 0
    lmp.command("run 700")
    walls.save(tmp_path / "run.h5")
    with pytest.raises(ImportError, match="a plot needs matplotlib") as caught:
        walls.report(tmp_path / "out")
    kept = tmp_path / "out/record.h5"
    assert f"`contactlaw report {kept} --out {tmp_path / 'out'}`" in caught.value.__notes__[0]
    assert cl.read_record(kept).rows.tolist() == cl.read_record(tmp_path / "run.h5").rows.tolist() != []
