"""Round walls in LAMMPS: energy of a bead that slides in a drum, curvature, and what is refused."""

import math

import numpy as np
import pytest
from lammps_box import ALIKE, MASS, PAIR, PLATE, R, attach, dropped, flat, make, scene, state
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import contactlaw as cl
from contactlaw.engines.lammps import Cone, Cylinder, Disc, Mesh, Ring, Sphere
from contactlaw.softsphere import time_step
from contactlaw.stepping.step import WIDTH

HERTZ, MYC = (cl.ImpactModel(PAIR, law=law) for law in ("hertz", "myc"))
DRUM = 8 * R


@pytest.mark.parametrize("friction", [0.0, 0.5], ids=["slides", "rolls"])
def test_a_bead_that_moves_to_and_fro_keeps_its_energy(friction):
    """Ten periods take 1e-4 of the energy of the fall at most; 72 facets took 28 % in two.

    The bead begins where its weight presses it, since one that bounces meanwhile slides now and then.
    """
    g, steep = 1e3, math.sqrt(0.75)  # 30 degrees
    stiffness = 4 / 3 * HERTZ.pair.effective_modulus * math.sqrt(R * math.sqrt(8 / 7))
    lowest = DRUM - R + (MASS * g * steep / stiffness) ** (2 / 3)
    start = np.array([0.5 * lowest, 0.0, -steep * lowest])
    lmp = make(start, (0, 0, 0), gravity=g, dt=4e-7)
    attach(lmp, HERTZ, [Cylinder((0, -0.05, 0), (0, 0.05, 0), DRUM, math.inf)], friction=friction)
    period = 2 * math.pi * math.sqrt((1.4 if friction else 1.0) * lowest / g) * 1.0174
    changes, heights = [], []
    for _ in range(53):  # which are no whole parts of a period
        lmp.command(f"run {round(10 * period / 53 / 4e-7)}")
        x, v, omega = (lmp.numpy.extract_atom(name)[0] for name in ("x", "v", "omega"))
        changes.append(0.5 * v @ v + 0.2 * R**2 * omega @ omega + g * (x[2] - start[2]))
        heights.append(x[2])
    assert np.ptp(heights) > 0.9 * (1 - steep) * lowest
    assert np.abs(changes).max() < 1e-4 * g * (1 - steep) * lowest


A = 4 * R
LEAN = math.radians(60)  # half of a cone's angle of opening
SLOPE = np.array([-math.cos(LEAN), 0.0, math.sin(LEAN)])  # normal inside of the cone
RISE = np.array([math.sin(LEAN), 0.0, math.cos(LEAN)])  # along its side
# A wall, a point on it, the normal to the bead, and R over the wall's radii, negative where hollow.
CURVED = {
    "in a cylinder": (Cylinder((0, -0.02, 0), (0, 0.02, 0), A, math.inf), (0, 0, -A), (0, 0, 1), (-0.25, 0)),
    "on a cylinder": (Cylinder((0, -0.02, 0), (0, 0.02, 0), A, math.inf), (0, 0, A), (0, 0, 1), (0.25, 0)),
    "in a sphere": (Sphere((0, 0, 0), A, math.inf), (0, 0, -A), (0, 0, 1), (-0.25, -0.25)),
    "on a sphere": (Sphere((0, 0, 0), A, math.inf, polar=(0, 2)), (0, 0, A), (0, 0, 1), (0.25, 0.25)),
    "in a cone": (
        Cone((0, 0, 0), (0, 0, 0.01), 0, 0.01 * math.tan(LEAN), math.inf),
        A / math.tan(LEAN) * RISE,
        SLOPE,
        (-0.25, 0),
    ),
    "on a disc": (Disc((0, 0, 0), (0, 0, 1), 0.01, math.inf), (0, 0, 0), (0, 0, 1), (0, 0)),
    "on a ring": (Ring((0, 0, 0), (0, 0, 1), 1e-3, 0.01, math.inf), (5e-3, 0, 0), (0, 0, 1), (0, 0)),
}


def stiffness(one, two):
    """K of Hertz's F = K d^1.5 over that on a plane, from the curvatures over the bead's.

    Johnson, Contact Mechanics (1985), eqs 4.26 to 4.32, with a by b the axes of the ellipse.
    """
    mean, ratio = 1 / math.sqrt((1 + one) * (1 + two)), max((1 + one) / (1 + two), (1 + two) / (1 + one))
    if ratio == 1.0:
        return math.sqrt(mean)

    def excess(k):
        m = 1 - k * k
        return (ellipe(m) / k**2 - ellipk(m)) / (ellipk(m) - ellipe(m)) - ratio

    k = brentq(excess, 1e-3, 1 - 1e-7)
    m, long, short = 1 - k * k, ellipk(1 - k * k), ellipe(1 - k * k)
    size = (4 / (math.pi * m) * k**1.5 * math.sqrt((short / k**2 - long) * (long - short))) ** (1 / 3)
    return math.sqrt(mean) * (2 / math.pi * math.sqrt(k) / size * long) ** -1.5


@pytest.mark.parametrize("name", CURVED)
def test_the_force_is_that_of_hertz_between_curved_bodies(name):
    """K is that of R*, the geometric mean of the radii: 0.2 % below that of the exact ellipse."""
    wall, point, n, curvatures = CURVED[name]
    n = np.array(n)
    (row,), _ = dropped(HERTZ, [wall], np.array(point) + (R + 1e-6) * n, -3.0 * n, dt=5e-8)
    flat = 4 / 3 * HERTZ.pair.effective_modulus * math.sqrt(R)
    expected = (flat * stiffness(*curvatures)) ** 0.4 * (1.25 * MASS * 9.0) ** 0.6
    assert row["peak_force"] == pytest.approx(expected, rel=1e-3)
    assert row["restitution"] == pytest.approx(1.0, abs=1e-9)
    plane = flat**0.4 * (1.25 * MASS * 9.0) ** 0.6
    assert (abs(expected / plane - 1) > 0.02) == any(curvatures)
    change = 1 / math.sqrt((1 + curvatures[0]) * (1 + curvatures[1])) - 1
    assert bool(row["flags"] & cl.Validity.CURVED_WALL) == (abs(change) > 0.16)


@pytest.mark.parametrize("a", [8 * R, 2 * R])
def test_the_step_for_a_plate_is_allowed(a):
    """Although a contact in a hollow wall is shorter."""
    dt = time_step(MYC, speed=5.0, radius=R, thickness=1e-3)
    (row,), _ = dropped(MYC, [Sphere((0, 0, a), a, 1e-3)], (0, 0, R + 1e-5), dt=dt)
    (fine,), _ = dropped(MYC, [Sphere((0, 0, a), a, 1e-3)], (0, 0, R + 1e-5), dt=0.2 * dt, steps=2000)
    assert row["contact_time"] < MYC.solve(5.0, R, 1e-3).contact_time
    assert row["restitution"] == pytest.approx(fine["restitution"], abs=1e-3)


def test_a_bead_larger_than_its_drum_is_refused():
    lmp, _ = scene(MYC, [Cylinder((0, -0.02, 0), (0, 0.02, 0), 0.8 * R, 1e-3)], (1e-5, 0, 0))
    with pytest.raises(
        RuntimeError, match="radius: inside a round wall of 0.00072 m, which a bead of 0.0009 m does not"
    ):
        lmp.command("run 100")
    pipe = Cylinder((0, 0, -0.01), (0, 0, 0), 0.995 * R, 1e-3)
    lmp, _ = scene(MYC, [pipe], (3e-6, 0, R), dt=1e-7)  # it gets in over the rim
    with pytest.raises(RuntimeError, match="radius: inside a round wall of 0.0008955 m"):
        lmp.command("run 6000")
    parcels, _ = scene(MYC, [Cylinder((0, -0.02, 0), (0, 0.02, 0), 0.999999 * R, 1e-3)], (1e-9, 0, 0), parcel=3.0)
    with pytest.raises(RuntimeError, match="radius: inside a round wall of 0.0008999991 m"):
        parcels.command("run 100")
    beside = Cylinder((0, -0.02, -0.8 * R), (0, 0.02, -0.8 * R), 0.8 * R, 1e-3)
    assert len(dropped(MYC, [beside], (0, 0, R + 1e-5))[0]) == 1  # but it may hit it from outside


ENDS = [Disc((0, y, 0), (0, 1, 0), DRUM, math.inf) for y in (-5e-3, 5e-3)]
SCENES = {
    "drum with ends": ([Cylinder((0, -5e-3, 0), (0, 5e-3, 0), DRUM, math.inf), *ENDS], (2e-3, 0, 0), (1, 9, 0)),
    "hopper": ([Cone((0, 0, -5e-3), (0, 0, 5e-3), 0.5e-3, 8e-3, math.inf)], (1e-3, 0, 2e-3), (0, 2, 0)),
    "bowl in a ball": (
        [Sphere((0, 0, 8e-3), 8e-3, math.inf, polar=(2.4, math.pi)), Sphere((0, 0, 4e-3), 9e-3, math.inf)],
        (3e-3, 1e-3, 4e-3),
        (1.0, 0.1, 0),
    ),
    "hole in a ball": (
        [Ring((0, 0, 0), (0, 0, 1), 0.8 * R, 8e-3, math.inf), Sphere((0, 0, 0), 9e-3, math.inf)],
        (0.6e-3, 1e-4, 2e-3),
        (0, 0, 0),
    ),
}


@pytest.mark.parametrize("name", SCENES)
def test_an_elastic_bead_keeps_its_energy_anywhere(name):
    """It hits faces, corners, rims, all sides of a hole that is smaller.

    In a cone R* changes along the contact's way, for which the force has no potential.
    """
    walls, place, velocity = SCENES[name]
    lmp, attached = scene(HERTZ, walls, place, velocity, gravity=5e3, dt=5e-8)
    energies = []
    for _ in range(40):
        lmp.command("run 10000")
        now = state(lmp)
        x, v = now["x"][0], now["v"][0]
        if not now["d2_contactlaw"][0, PLATE::WIDTH].any():
            energies.append(0.5 * v @ v + 5e3 * x[2])
    assert len(energies) > 30 and len(attached.collisions()) > 10
    assert np.ptp(energies) < (1e-3 if name == "hopper" else 1e-8) * np.mean(np.abs(energies))


@pytest.mark.parametrize("softening", [1.0, 5.0])
@pytest.mark.parametrize("a", [6 * R, 20 * R])
@pytest.mark.parametrize("thickness", [0.5e-3, cl.Layers([("glass", 0.3e-3), ("steel-s235", 0.3e-3)])])
def test_a_curved_wall_swings_back_as_in_solve(thickness, a, softening):
    walls = {"cylinder": Cylinder((-1, 0, a), (1, 0, a), a, thickness), "sphere": Sphere((0, 0, a), a, thickness)}
    for kind, wall in walls.items():
        (row,), _ = dropped(MYC, [wall], (0, 0, R + 1e-5), dt=4e-8, steps=4000, softening=softening)
        expected = MYC.solve(5.0, R, cl.Shell(thickness, a, kind)).restitution
        assert row["restitution"] == pytest.approx(expected, abs=1e-3)
        assert expected > MYC.solve(5.0, R, thickness).restitution + (0.02 if a < 10 * R else 0.001)


LINED = cl.Layers([("glass", 0.2e-3), ("steel-s235", 0.4e-3)])
CORNERS = [(-0.05, -0.05, 0), (0.06, -0.05, 0), (0, 0.05, 0)]
FLAT = {
    "plate": flat,
    "mesh": lambda thickness: Mesh(CORNERS, [[0, 1, 2]], thickness),
    "disc": lambda thickness: Disc((0, 0, 0), (0, 0, 1), 0.05, thickness),
    "ring": lambda thickness: Ring((2e-3, 0, 0), (0, 0, 1), 1e-3, 0.05, thickness),
}


def bounce(wall, softening=1.0):
    (row,), _ = dropped(MYC, [wall], (0, 0, R + 1e-5), dt=4e-8, steps=4000, softening=softening)
    return row


@pytest.mark.parametrize("softening", [1.0, 5.0])
@pytest.mark.parametrize("name", FLAT)
def test_a_wall_on_a_foundation_swings_back_as_in_solve(name, softening):
    for thickness, stiffness in ((0.5e-3, 1e12), (LINED, 1e12), (0.5e-3, 3e13)):
        bed = cl.Foundation(thickness, stiffness)
        assert bounce(FLAT[name](bed), softening)["restitution"] == pytest.approx(
            MYC.solve(5.0, R, bed).restitution, abs=1e-3
        )
    for nothing in (cl.Foundation(0.5e-3, 0.0), cl.Shell(0.5e-3, math.inf)):
        assert bounce(FLAT[name](nothing), softening)[ALIKE] == bounce(FLAT[name](0.5e-3), softening)[ALIKE]


@pytest.mark.parametrize("softening", [1.0, 5.0])
def test_a_stiff_foundation_adds_no_energy(softening):
    """Six exponentials alone would do so from 20 swings in a contact on: COR of 1.0008."""
    for stiffness in (1e13, 3e13, 1e14):
        bed = cl.Foundation(0.3e-3, stiffness)
        (row,), _ = dropped(HERTZ, [flat(bed)], (0, 0, R + 1e-5), dt=4e-8, steps=4000, softening=softening)
        assert row["restitution"] < 1.0
        assert row["restitution"] == pytest.approx(HERTZ.solve(5.0, R, bed).restitution, abs=6e-4)


@pytest.mark.parametrize("softening", [1.0, 5.0])
@pytest.mark.parametrize("kind", ["cylinder", "sphere", "mesh"])
def test_facets_of_a_curved_wall_swing_back_with_the_flat_radius(kind, softening):
    """Their R* is between those inside and outside, of which the mean has no first-order error."""
    a, h = 20 * R, 0.5e-3
    wall = flat(cl.Shell(h, a, kind)) if kind != "mesh" else Mesh.cylinder((-0.02, 0, a), (0.02, 0, a), a, h)
    both = [cl.Shell(h, radius, "cylinder" if kind == "mesh" else kind) for radius in (a, -a)]
    expected = np.mean([MYC.solve(5.0, R, one).restitution for one in both])
    assert bounce(wall, softening)["restitution"] == pytest.approx(expected, abs=4e-4)
    assert expected > MYC.solve(5.0, R, h).restitution + 0.01


@pytest.mark.parametrize("softening", [1.0, 5.0])
def test_layers_and_ribs_are_flagged_as_in_solve(softening):
    steel = cl.material("steel-s235").plane_modulus * 1e-9 / 12
    tops = ("glass", 1e-3, "steel-s235"), ("glass", 2e-5, "steel-s235"), ("glass", 1e-3, "pmma")
    plates = [cl.Layers([(top, thick), (below, 1e-3)]) for top, thick, below in tops]
    plates += [cl.Orthotropic("glass", steel, steel, steel, mass=2.5, pitch=pitch) for pitch in (1e-3, 0.1)]
    found, seen = [], cl.Validity.LINER | cl.Validity.RIBS
    for plate in [*plates, cl.Foundation(plates[1], 1e10)]:
        hit = MYC.solve(5.0, R, plate)
        found.append(cl.Validity(bounce(flat(plate), softening)["flags"]) & seen)
        assert found[-1] == hit.flags & seen
    assert [bool(one) for one in found] == [False, True, True, False, True, True]


BED = cl.Foundation(1e-3, 1e12)
REFUSED = {
    "a round wall is a shell": lambda: Cylinder((-1, 0, 0), (1, 0, 0), A, BED),
    "only bare sheets have edges": lambda: flat(BED, edges="free"),
    "beads touch 'pmma'": lambda: flat(cl.Shell(cl.Layers([("pmma", 1e-3)]), A)),
    "stiffness.*-1": lambda: flat(cl.Foundation(1e-3, -1.0)),
    "stiffness: .*one number": lambda: flat(cl.Foundation(1e-3, [1.0, 2.0])),
    "radius: .*0.0": lambda: FLAT["mesh"](cl.Shell(1e-3, 0.0)),
    "thickness: got -1": lambda: flat(cl.Shell(-1.0, A)),
}


@pytest.mark.parametrize("said", REFUSED)
def test_what_time_steps_cannot_hold_is_refused(said):
    with pytest.raises(ValueError, match=said):
        scene(MYC, [REFUSED[said]()])
