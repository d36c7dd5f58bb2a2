"""The scene of the drum: beads, and a turning shell with two ends of thin sheet metal."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contactlaw import ArgumentError
from dem_demo.drum import defaults
from dem_demo.kit.beads import GRAVITY, Floats
from dem_demo.kit.bed import Bed, Corners, check

if TYPE_CHECKING:
    import h5py

    from contactlaw.walls import Mesh

_FACETS = 120  # facets around the shell
_SPACING = 2.2  # [largest radius], distance of lattice sites: no two beads touch at the start
_FULL = 0.4  # [drum's radius], height of the highest lattice sites over the axis
_AROUND = 0.01  # [m], room around the drum in the simulation box


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Drum(Bed):
    """Beads in a drum, which turns about the y axis and begins at y = 0."""

    NAME, SCHEMA = "drum", 2
    NUMBERS = "thickness", "drum", "length", "turns", "friction", "duration", "seed"
    FRAME_RATE = defaults.FRAME_RATE

    drum: float  # its radius [m]
    length: float  # [m]
    turns: float  # [1/s]

    @property
    def spin(self) -> float:
        """Angular speed of the drum [rad/s]."""
        return math.tau * self.turns

    @property
    def top_speed(self) -> float:
        """Largest speed [m/s] of a bead that falls across the drum, relative to its shell."""
        start = float(self.velocity @ self.velocity)
        return math.sqrt(start + 4.0 * GRAVITY * self.drum) + self.spin * self.drum

    @property
    def box(self) -> Corners:
        """Corners [m] of the space around the drum."""
        side = self.drum + _AROUND
        return (-side, -_AROUND, -side), (side, self.length + _AROUND, side)

    def meshes(self, thickness: float, folder: Path) -> list[Mesh]:
        """Make the shell and the two ends.

        At a seam of shell and end neither plate can move, and each holds the other against turning:
        their edges lie halfway between supported and clamped ones.
        """
        from contactlaw.walls import Mesh, Rotation

        motion = Rotation(axis=(0, 1, 0), speed=self.spin)
        ends = (0.0, 0.0, 0.0), (0.0, self.length, 0.0)
        shell = Mesh.cylinder(*ends, self.drum, thickness, facets=_FACETS, motion=motion, edges="supported")
        discs = [Mesh.disc(end, (0, 1, 0), self.drum, thickness, motion=motion, edges="supported") for end in ends]
        return [shell, *discs]

    def write_walls(self, file: h5py.File) -> None:
        """Write nothing: numbers say all."""

    @staticmethod
    def read_walls(file: h5py.File) -> Mapping[str, Any]:
        """Read nothing: numbers say all."""
        return {}


def drum(
    *,
    beads: int = defaults.BEADS,
    radius: tuple[float, float] = defaults.RADIUS,
    drum: float = defaults.DRUM,
    length: float = defaults.LENGTH,
    thickness: float = defaults.THICKNESS,
    sphere: str = defaults.SPHERE,
    plate: str = defaults.PLATE,
    speed: float = defaults.SPEED,
    turns: float = defaults.TURNS,
    friction: float = defaults.FRICTION,
    duration: float = defaults.DURATION,
    seed: int = defaults.SEED,
) -> Drum:
    """Make a drum, and put beads into it on a loose lattice.

    Examples
    --------
    >>> drum(beads=10).position.shape
    (10, 3)
    """
    from contactlaw import material

    check(
        Drum,
        beads=beads,
        seed=seed,
        duration=duration,
        positive={"drum": (drum, "m"), "length": (length, "m"), "thickness": (thickness, "m")},
        not_negative={"speed": (speed, "m/s"), "turns": (turns, "1/s"), "friction": (friction, "1")},
    )
    if not 0.0 < radius[0] <= radius[1] < 0.5 * min(drum, length):
        raise ArgumentError(
            "radius",
            None,
            "needs MIN,MAX [m], ascending and below half of the drum's radius and length, "
            f"{0.5 * min(drum, length):g} m, got {radius[0]!r},{radius[1]!r}",
        )
    rng = np.random.default_rng(seed)
    size: Floats = rng.uniform(*radius, beads)
    return Drum(
        radius=size,
        position=_places(beads, radius[1], drum, length, rng),
        velocity=np.array([0.0, 0.0, -speed]),
        thickness=thickness,
        drum=drum,
        length=length,
        turns=turns,
        sphere_material=material(sphere),
        plate_material=material(plate),
        friction=friction,
        duration=duration,
        seed=seed,
    )


def _places(beads: int, radius: float, drum: float, length: float, rng: np.random.Generator) -> Floats:
    """Positions of the beads: random sites of a lattice within the drum, jittered."""
    step, inside = _SPACING * radius, drum - radius
    along = max(1, int((length - 2.0 * radius) // step))
    across = np.arange(-inside, inside + 1e-9, step)
    y = 0.5 * length + step * (np.arange(along) - 0.5 * (along - 1))
    site = np.stack(np.meshgrid(across, y, across, indexing="ij"), axis=-1).reshape(-1, 3)
    spare = 0.5 * (_SPACING - 2.0) * radius
    fits = np.hypot(site[:, 0], site[:, 2]) < inside - 1.5 * spare
    site = site[fits & (site[:, 2] < _FULL * drum)]
    if beads > len(site):
        raise ArgumentError(
            "beads",
            None,
            f"{beads} do not fit into the drum, {len(site)} do; take a larger --drum or --length, "
            "or smaller beads (--radius)",
        )
    chosen = site[rng.choice(len(site), beads, replace=False)]
    return np.asarray(chosen + rng.uniform(-spare, spare, (beads, 3)))
