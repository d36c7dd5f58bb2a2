"""Cases that once went wrong in LAMMPS without an error: tiny triangles, periodic boxes, work."""

import math

import lammps_box as box
import numpy as np
import pytest
from lammps_box import R, above, attach, dropped, flat, restarted, scene, square

import contactlaw as cl
from contactlaw.engines.lammps import Mesh, Plate, Sphere, Tabulated

HERTZ = cl.ImpactModel(box.PAIR, law="hertz")


@pytest.mark.parametrize("n", [1, 80])
def test_a_floor_of_many_tiny_triangles_hides_no_wall(n):
    """A bead on hundreds of tiny triangles begins to touch a wall of such: both act on it."""
    half = 1e-3
    corners, triangles = square(n, half)
    upright = corners[:, [2, 1, 0]] + [half, 0, half]
    mesh = Mesh(np.vstack((corners, upright)), np.vstack((triangles, triangles + len(corners))), math.inf)
    start = half - R - 1e-6, 1e-5, R + 5e-7
    rows, now = dropped(HERTZ, [mesh], start, (1.0, 0, -12.0), steps=300)
    assert rows["restitution"] == pytest.approx([1.0, 1.0], abs=1e-9)
    assert now["v"][0] == pytest.approx([-1.0, 0.0, 12.0], abs=1e-8)


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_contact_goes_on_across_a_periodic_boundary(model, monkeypatch, friction):
    """Beyond the boundary is another triangle; the rebound is that from a single plate."""
    monkeypatch.setattr(box, "BOX", box.BOX.replace("boundary f f f", "boundary p p f"))
    places = [above(5e-6, 0.06 - 8 * n * 2e-7, 0.003 * n - 0.045) for n in range(30)]
    plate = Plate((-0.07, -0.07, 0), (0.14, 0, 0), (0, 0.14, 0), 1e-3)
    corners, triangles = square(12, 0.06)
    ends = []
    for wall in (plate, Mesh(corners, triangles, 1e-3)):
        lmp, walls = scene(model, [wall], places, (8.0, 0, -5.0), friction=friction)
        lmp.command("neigh_modify every 1 delay 0 check no")
        lmp.command("run 300")
        rows, own = walls.collisions(), box.state(lmp)
        assert len(rows) == len(places)
        ends.append(np.column_stack((np.sort(rows["restitution"]), own["v"], own["omega"])))
    assert ends[1] == pytest.approx(ends[0], rel=1e-9, abs=1e-8)


@pytest.mark.parametrize(("before", "after"), [(0.3, 0.0), (0.0, 0.3)])
def test_a_restart_with_another_friction_is_refused_in_mid_contact(model, tmp_path, before, after):
    """With another friction the history of the beads has another layout."""
    upright = Plate((R + 2e-7, -0.05, 0), (0, 0.1, 0), (0, 0, 0.03), 2e-3)
    plates = [flat(1e-3), upright]
    lmp, _ = scene(model, plates, above(1e-6), (1.0, 0, -5.0), friction=before)
    lmp.commands_string(f"run 20\nwrite_restart {tmp_path / 'box'}")
    again = restarted(tmp_path / "box")
    with pytest.raises(ValueError, match="plates, friction: beads are in contact with other"):
        attach(again, model, plates, friction=after)
    attach(again, model, plates, friction=before)


def test_nobody_writes_into_walls_that_have_been_checked():
    table = Tabulated([0.0, 1.0], [[0, 0, 0], [0, 0, 1]])
    mesh = Mesh(*square(1, 0.01), 1e-3)
    here = np.zeros(3)
    plate, ball = Plate(here, (1, 0, 0), (0, 1, 0), 1e-3), Sphere(here, 1.0, 1e-3)
    assert type(plate.corner) is type(ball.centre) is tuple
    for array in (table.times, mesh.vertices, mesh.triangles, mesh.thickness):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 2
