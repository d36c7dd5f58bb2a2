"""What the rows of the record are: impacts, and contacts whose COR has no meaning."""

import math

import lammps_box as box
import numpy as np
import pytest

import contactlaw as cl
from contactlaw.engines.record import Kind
from contactlaw.walls import Mesh, Plate

R, MODEL = 1e-3, cl.ImpactModel(box.PAIR)
WIDE = box.flat(1e-3)


def kinds(walls, x, v, *, kick=None, when=0, slope=None, friction=0.2, steps=2000):
    """Kinds in the record of a bead at x with a velocity v, and the record.

    The kick is added to its velocity after step `when`. With a slope [degrees] there is gravity, and x
    points down the slope.
    """
    lmp, walls = box.scene(MODEL, walls, x, v, friction=friction, radius=R)
    if slope is not None:
        angle = math.radians(slope)
        lmp.command(f"fix gravity all gravity 9.81 vector {math.sin(angle)} 0 {-math.cos(angle)}")
    lmp.command(f"run {when + 1}")
    lmp.numpy.extract_atom("v")[0, 2] += kick or 0.0
    lmp.command(f"run {steps}")
    rows = walls.collisions()
    lmp.close()
    return [Kind(kind).name for kind in rows["kind"]], rows


LINE = np.linspace(-0.02, 0.02, 401)
CORNERS = np.array([(x, y, 0.0) for x in LINE for y in (-0.02, 0.02)])
STRIPS = Mesh(CORNERS, [(n, n + 1, n + 2) for n in range(2 * LINE.size - 2)], 1e-3)
DRUM = Mesh.cylinder((0, -0.02, 0), (0, 0.02, 0), 0.02, 1e-3, facets=72)
SHEET = box.flat(0.3e-3, width=0.05)  # whose edge is at x = 0


@pytest.mark.parametrize("friction", [0.0, 0.2])
@pytest.mark.parametrize("slide", [0.0, 5.0])
@pytest.mark.parametrize("speed", [1.0, 10.0])
@pytest.mark.parametrize(
    ("wall", "x", "z"),
    [
        (WIDE, 0.0, R),
        (WIDE, -0.05 - 0.2 * R, R),
        (STRIPS, 0.0, R),
        (DRUM, 0.0, 0.02 + 1.1 * R),
        (DRUM, 0.0, -0.02 + 1.1 * R),
    ],
)
def test_a_bead_that_hits_one_surface(wall, x, z, speed, slide, friction):
    """Plate, its edge, a sheet of narrow triangles, and a drum from outside and inside."""
    found, rows = kinds([wall], (x, 0.0, z + 1e-6), (slide, 0.0, -speed), friction=friction)
    assert found == ["IMPACT"]
    assert rows["restitution"] == pytest.approx(MODEL.restitution(speed, R, 1e-3), abs=0.01)
    if x == 0.0:
        turned = abs(z) > 0.01  # the facet's normal is not that of the place under the bead
        assert rows["sliding_speed"] == pytest.approx(slide, abs=0.5 if turned else 1e-9)


@pytest.mark.parametrize("slope", [10.0, 30.0, 60.0])
def test_a_bead_that_slides_over_an_edge(slope):
    """Its COR has no meaning: that of a bead in a chute was 317."""
    found, rows = kinds([SHEET], (-R, 0, R + 1e-9), (0.05, 0, -1e-4), slope=slope, steps=300_000)
    assert found[-1] == "OVER_EDGE" and rows["restitution"][-1] > 10.0
    assert rows["sliding_speed_after"][-1] > 0.0


@pytest.mark.parametrize("kick", [-0.5, 0.5])
@pytest.mark.parametrize("when", range(6, 60, 9))
def test_a_bead_that_is_struck_in_contact(when, kick):
    found, _ = kinds([WIDE], (0.0, 0.0, R + 1e-9), (1.0, 0.0, -1.0), kick=kick, when=when)
    assert found == ["STRUCK"]


def test_a_bead_that_leaves_faster_than_it_came_was_struck():
    """A neighbour's push of 0.8 % of its energy is less than what else counts as a strike."""
    block = box.flat(math.inf)
    found, rows = kinds([block], (0.0, 0.0, R + 1e-9), (0.0, 0.0, -0.01), kick=4e-5, when=150)
    assert found == ["STRUCK"] and 1.0 < rows["restitution"] < 1.005


def test_a_bead_in_a_groove_presses_on_both_sides():
    sides = [Plate((0, -0.05, 0), (x, 0, 0.03), (0, 0.1, 0), 1e-3) for x in (-0.02, 0.02)]
    found, _ = kinds(sides, (0.0, 0.0, 1.9 * R), (1e-3, 0.0, -1.0))
    assert found and "IMPACT" not in found


def test_a_bead_that_rests_and_is_taken_away():
    still = (-0.02, 0.0, R + 1e-9), (0, 0, -1e-3)
    found, rows = kinds([SHEET], *still, slope=0.0, kick=0.1, when=50_000, steps=60_000)
    assert found[-1] == "RESTING" and rows["restitution"][-1] > 100.0
