"""Scenes that engines run alike: beads of two sizes and materials over walls, by LAMMPS through `attach`.

To add an engine, run a `Scene` with it and compare what is left with the `Outcome` of `by_attach`.
"""

from typing import Any, NamedTuple

import lammps_box as box
import numpy as np

import contactlaw as cl
from contactlaw.walls import Cone, Cylinder, Disc, Mesh, Plate, Rotation, Sphere, Tabulated, Translation, Vibration

DT, GRAVITY = 1e-7, 9.81
MODELS = {kind: cl.ImpactModel(cl.Pair(bead, "glass")) for kind, bead in enumerate(("gamma-alumina", "steel-s235"), 1)}
# The strength of this plate grows with the rate of strain: such laws are the largest.
METAL = {kind: cl.ImpactModel(cl.Pair(model.pair.sphere, "aluminium-2024-t351")) for kind, model in MODELS.items()}


class Scene(NamedTuple):
    """Walls, beads that fall on them, and contacts."""

    walls: Any
    place: Any
    velocity: Any
    radius: Any
    kind: Any  # atom types
    friction: float = 0.3
    softening: float = 1.0
    steps: int = 2500

    @property
    def density(self):
        return [MODELS[kind].pair.sphere.density for kind in self.kind]


class Outcome(NamedTuple):
    """Record by bead and time; mean loads of the walls; places, velocities and spins at the end."""

    rows: Any
    loads: Any
    x: Any
    v: Any
    omega: Any


def _beads(half, height, speed, n=24):
    rng = np.random.default_rng(11)
    place = np.stack(np.meshgrid(*(np.linspace(-half, half, 5),) * 2, indexing="ij"), -1).reshape(-1, 2)[:n]
    velocity = rng.uniform(-1.0, 1.0, (n, 3)) + [0.0, 0.0, -speed]
    radius = rng.choice([0.6e-3, 0.9e-3], n)
    return np.column_stack((place, np.full(n, height))), velocity, radius, 2 - np.arange(n) % 2


def floor(thickness=1e-3, height=0.0, **more):
    """A plate below all beads."""
    return Plate((-0.02, -0.02, height), (0.04, 0, 0), (0, 0.04, 0), thickness, **more)


def _deck():
    """A shaken sheet of triangles with a hole."""
    corners, triangles = box.square(8, 0.02)
    away = abs(corners[triangles].mean(axis=1)[:, :2]).max(axis=1)
    return Mesh(corners, triangles[away > 5e-3], 0.8e-3, edges="free", motion=Vibration((0, 0, 1e-3), 50.0))


_FALL = _beads(8e-3, 1.1e-3, 4.0)
_TABLE = Tabulated([0.0, 1e-4, 3e-4], [[0, 0, 0], [0, 0, 5e-5], [0, 0, -5e-5]])
SCENES = {
    "plates": Scene([floor(edges="free"), Plate((9e-3, -0.02, 0), (0, 0.04, 0), (0, 0, 0.02), 2e-3)], *_FALL),
    "deck": Scene([_deck(), floor(2e-3, -1e-3, edges="clamped")], *_FALL, steps=3000),
    "drum": Scene(
        [
            Cylinder((0, -0.02, 9e-3), (0, 0.02, 9e-3), 9e-3, 1e-3, motion=Rotation((0, 1, 0), 50.0, (0, 0, 9e-3))),
            Disc((0, 7e-3, 9e-3), (0, 1, 0), 9e-3, 1e-3),
        ],
        *_beads(3e-3, 2.5e-3, 8.0),
    ),
    "bowl": Scene(
        [Sphere((0, 0, 9e-3), 9e-3, 1e-3), Cone((0, 0, 9e-3), (0, 0, 0), 12e-3, 6e-3, 1e-3)],
        *_beads(2e-3, 2.5e-3, 10.0),
    ),
    "moving": Scene(
        [
            floor(cl.Layers([("glass", 0.3e-3), ("steel-s235", 0.4e-3)]), motion=_TABLE),
            Plate((6e-3, -0.02, 1e-4), (0.01, 0, 0), (0, 0.04, 0), 1e-3, METAL, Vibration((0, 0, 5e-5), 2000.0)),
            Plate(
                (-0.019, -0.02, 1e-4),
                (0.013, 0, 0),
                (0, 0.04, 0),
                1e-3,
                {1: MODELS[1], 2: None},
                Translation((0.5, 0, 0.05)),
            ),
        ],
        *_FALL,
    ),
    "shells": Scene(
        [
            Plate((-0.02, -0.02, 0), (0.02, 0, 0), (0, 0.04, 0), cl.Shell(0.5e-3, 0.05, "sphere")),
            Plate((0, -0.02, 0), (0.02, 0, 0), (0, 0.04, 0), cl.Foundation(0.5e-3, 1e11)),
        ],
        *_FALL,
    ),
    "softened": Scene([floor()], *_FALL, softening=4.0),
}


def by_attach(scene):
    """By LAMMPS."""
    bead = {"radius": scene.radius, "density": scene.density, "gravity": GRAVITY, "dt": DT}
    lmp = box.make(scene.place, scene.velocity, types=2, kind=scene.kind, **bead)
    walls = box.attach(lmp, MODELS, scene.walls, friction=scene.friction, softening=scene.softening)
    lmp.command(f"run {scene.steps}")
    now, rows = box.state(lmp), np.sort(walls.collisions(), order=["bead", "time"])
    loads = np.column_stack(walls.loads()[1:])
    lmp.close()
    return Outcome(rows, loads, now["x"], now["v"], now["omega"])
