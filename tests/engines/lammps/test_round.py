"""Round walls in LAMMPS: energy of a bead that slides in a drum, curvature, and walls that swing back."""

import math

import numpy as np
import pytest
from lammps_box import MASS, PAIR, PLATE, R, dropped, flat, scene, state

import contactlaw as cl
from contactlaw.engines.lammps import Cone, Cylinder, Disc, Mesh, Plate, Ring, Sphere
from contactlaw.softsphere import time_step
from contactlaw.stepping.step import WIDTH

HERTZ, MYC = (cl.ImpactModel(PAIR, law=law) for law in ("hertz", "myc"))
DRUM, ORIGIN, UP = 8 * R, (0, 0, 0), (0, 0, 1)
ALONG = (0, -0.02, 0), (0, 0.02, 0)  # ends of an axis


@pytest.mark.parametrize("friction", [0.0, 0.5], ids=["slides", "rolls"])
def test_a_bead_that_moves_to_and_fro_keeps_its_energy(friction):
    """Ten periods take 1e-4 of the energy of the fall at most; 72 facets took 28 % in two.

    The bead begins where its weight presses it, since one that bounces meanwhile slides now and then.
    """
    g, steep = 1e3, math.sqrt(0.75)  # 30 degrees
    stiffness = 4 / 3 * HERTZ.pair.effective_modulus * math.sqrt(R * math.sqrt(8 / 7))
    lowest = DRUM - R + (MASS * g * steep / stiffness) ** (2 / 3)
    start, drum = np.array([0.5 * lowest, 0.0, -steep * lowest]), Cylinder(*ALONG, DRUM, math.inf)
    lmp, _ = scene(HERTZ, [drum], start, (0, 0, 0), gravity=g, dt=4e-7, friction=friction)
    changes, heights = [], []
    for _ in range(53):  # parts of ten periods
        inertia = 1.4 if friction else 1.0
        lmp.command(f"run {round(20 * math.pi * math.sqrt(inertia * lowest / g) * 1.0174 / 53 / 4e-7)}")
        x, v, omega = (lmp.numpy.extract_atom(name)[0] for name in ("x", "v", "omega"))
        changes.append(0.5 * v @ v + 0.2 * R**2 * omega @ omega + g * (x[2] - start[2]))
        heights.append(x[2])
    assert np.ptp(heights) > 0.9 * (1 - steep) * lowest
    assert np.abs(changes).max() < 1e-4 * g * (1 - steep) * lowest


A = 4 * R
LEAN = math.radians(60)  # half of a cone's angle of opening
SLOPE = np.array([-math.cos(LEAN), 0.0, math.sin(LEAN)])  # normal inside of the cone
RISE = np.array([math.sin(LEAN), 0.0, math.cos(LEAN)])  # along its side
CONE = Cone(ORIGIN, (0, 0, 0.01), 0, 0.01 * math.tan(LEAN), math.inf)
# A wall, a point on it, the normal to the bead, and K of Hertz's F = K d^1.5 over that on a plane: by the
# elliptic integrals of Johnson, Contact Mechanics (1985), eqs 4.26 to 4.32, for R/A = 0.25.
CURVED = {
    "in a cylinder": (Cylinder(*ALONG, A, math.inf), (0, 0, -A), UP, 1.0764222),
    "on a cylinder": (Cylinder(*ALONG, A, math.inf), (0, 0, A), UP, 0.9467225),
    "in a sphere": (Sphere(ORIGIN, A, math.inf), (0, 0, -A), UP, 0.75**-0.5),
    "on a sphere": (Sphere(ORIGIN, A, math.inf, polar=(0, 2)), (0, 0, A), UP, 1.25**-0.5),
    "in a cone": (CONE, A / math.tan(LEAN) * RISE, SLOPE, 1.0764222),
}


@pytest.mark.parametrize("name", CURVED)
def test_the_force_is_that_of_hertz_between_curved_bodies(name):
    """K is that of R*, the geometric mean of the radii: 0.2 % below that of the exact ellipse."""
    wall, point, n, stiffness = CURVED[name]
    n = np.array(n)
    (row,), _ = dropped(HERTZ, [wall], np.array(point) + (R + 1e-6) * n, -3.0 * n, dt=5e-8)
    plane = (4 / 3 * HERTZ.pair.effective_modulus * math.sqrt(R)) ** 0.4 * (1.25 * MASS * 9.0) ** 0.6
    assert row["peak_force"] == pytest.approx(plane * stiffness**0.4, rel=1e-3)
    assert row["restitution"] == pytest.approx(1.0, abs=1e-9)
    # flagged where R* is more than 16 % off
    assert bool(row["flags"] & cl.Validity.CURVED_WALL) == (abs(stiffness**2 - 1) > 0.16)


@pytest.mark.parametrize(("radius", "x"), [(0.8 * R, 1e-5), (0.999999 * R, 1e-9)])
def test_a_bead_larger_than_its_drum_is_refused(radius, x):
    lmp, _ = scene(MYC, [Cylinder(*ALONG, radius, 1e-3)], (x, 0, 0))
    with pytest.raises(RuntimeError, match=f"radius: inside a round wall of {radius:.7g} m, which a bead of 0.0009 m"):
        lmp.command("run 100")


GROOVE = [
    Plate((0, -0.05, 0), (sign * 0.03 * math.cos(0.9), 0, 0.03 * math.sin(0.9)), (0, 0.1, 0), math.inf)
    for sign in (1, -1)
]
SCENES = {
    "hopper": ([Cone((0, 0, -5e-3), (0, 0, 5e-3), 0.5e-3, 8e-3, math.inf)], (1e-3, 0, 2e-3), (0, 2, 0)),
    "hole in a ball": (
        [Ring(ORIGIN, UP, 0.8 * R, 8e-3, math.inf), Sphere(ORIGIN, 9e-3, math.inf)],
        (0.6e-3, 1e-4, 2e-3),
        (0, 0, 0),
    ),
    "groove": (GROOVE, (3e-6, 0, R / math.cos(0.9) + 2e-5), (0.9, 0, -3.0)),
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


LINED = cl.Layers([("glass", 0.2e-3), ("steel-s235", 0.4e-3)])
CORNERS = [(-0.05, -0.05, 0), (0.06, -0.05, 0), (0, 0.05, 0)]
H, NEAR, FAR = 0.5e-3, 6 * R, 20 * R
BED, LINED_BED = cl.Foundation(H, 1e12), cl.Foundation(LINED, 1e12)
# Walls, the plates of which `solve` has the COR (of two the mean), and how far the COR may be off.
SWINGING = {
    "cylinder": (Cylinder((-1, 0, NEAR), (1, 0, NEAR), NEAR, LINED), [cl.Shell(LINED, NEAR, "cylinder")], 1e-3),
    "sphere": (Sphere((0, 0, NEAR), NEAR, H), [cl.Shell(H, NEAR, "sphere")], 1e-3),
    # R* of facets is between those inside and outside, of which the mean has no first-order error
    "flat shell": (flat(cl.Shell(H, FAR, "sphere")), [cl.Shell(H, a, "sphere") for a in (FAR, -FAR)], 4e-4),
    "facets": (
        Mesh.cylinder((-0.02, 0, FAR), (0.02, 0, FAR), FAR, H),
        [cl.Shell(H, a, "cylinder") for a in (FAR, -FAR)],
        4e-4,
    ),
    "mesh on a bed": (Mesh(CORNERS, [[0, 1, 2]], BED), [BED], 1e-3),
    "disc on a lined bed": (Disc(ORIGIN, UP, 0.05, LINED_BED), [LINED_BED], 1e-3),
}


def bounce(wall, softening, model=MYC):
    (row,), _ = dropped(model, [wall], (0, 0, R + 1e-5), dt=4e-8, steps=4000, softening=softening)
    return row


@pytest.mark.parametrize("softening", [1.0, 5.0])
@pytest.mark.parametrize("name", SWINGING)
def test_a_wall_that_swings_back_gives_the_rebound_of_solve(name, softening):
    wall, plates, bound = SWINGING[name]
    expected = np.mean([MYC.solve(5.0, R, plate).restitution for plate in plates])
    assert bounce(wall, softening)["restitution"] == pytest.approx(expected, abs=bound)
    assert expected > MYC.solve(5.0, R, plates[0].thickness).restitution + 0.01


@pytest.mark.parametrize("softening", [1.0, 5.0])
@pytest.mark.parametrize("stiffness", [1e13, 3e13, 1e14])
def test_a_stiff_foundation_adds_no_energy(stiffness, softening):
    """Six exponentials alone would do so from 20 swings in a contact on: COR of 1.0008."""
    bed = cl.Foundation(0.3e-3, stiffness)
    row = bounce(flat(bed), softening, HERTZ)
    assert row["restitution"] < 1.0
    assert row["restitution"] == pytest.approx(HERTZ.solve(5.0, R, bed).restitution, abs=6e-4)


def test_the_step_for_a_plate_is_allowed_in_a_hollow_wall_whose_contact_is_shorter():
    wall = Sphere((0, 0, 2 * R), 2 * R, 1e-3)
    (row,), _ = dropped(MYC, [wall], (0, 0, R + 1e-5), dt=time_step(MYC, 5.0, R, 1e-3))
    assert row["restitution"] == pytest.approx(bounce(wall, 1.0)["restitution"], abs=1e-3)


STEEL = cl.material("steel-s235").plane_modulus * 1e-9 / 12
THIN_LINER = cl.Layers([("glass", 2e-5), ("steel-s235", 1e-3)])
FLAGGED = [
    (cl.Foundation(THIN_LINER, 1e10), cl.Validity.LINER),
    (cl.Layers([("glass", 1e-3), ("pmma", 1e-3)]), cl.Validity.LINER),
    (cl.Orthotropic("glass", STEEL, STEEL, STEEL, mass=2.5, pitch=0.1), cl.Validity.RIBS),
    (cl.Orthotropic("glass", STEEL, STEEL, STEEL, mass=2.5, pitch=1e-3), 0),
]


@pytest.mark.parametrize("softening", [1.0, 5.0])
@pytest.mark.parametrize(("plate", "flag"), FLAGGED)
def test_layers_and_ribs_are_flagged_as_in_solve(plate, flag, softening):
    for flags in (bounce(flat(plate), softening)["flags"], MYC.solve(5.0, R, plate).flags):
        assert flags & (cl.Validity.LINER | cl.Validity.RIBS) == flag
