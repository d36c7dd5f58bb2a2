"""The scene of the drum: beads, and a turning shell with two ends of thin sheet metal."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contactlaw import ArgumentError
from dem_demo.kit.scene import GRAVITY, Bed, Corners, Facts, Floats, check

if TYPE_CHECKING:
    from contactlaw.walls import Cylinder, Disc
    from dem_demo.kit.run import Run

_SPACING = 2.2  # [largest radius], distance of lattice sites: no two beads touch at the start
_FULL = 0.4  # [drum's radius], height of the highest lattice sites over the axis
_AROUND = 0.01  # [m], room around the drum in the simulation box
_SEAM = 1.05  # [bead's radius]; nearer to a seam, a bead touches shell and end at once
_ARCS, _GAP = 12, 0.03  # the shell is drawn as so many arcs, with gaps [rad] that turn with it
_ROOM = 1.12  # half width of the picture over the drum's radius


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Drum(Bed):
    """Beads in a drum, which turns about the y axis and begins at y = 0."""

    NAME, FRAME_RATE, WALL, FLAT = "drum", 200.0, "drum", "at a seam of shell and end"
    FILM_RATE = 12.0
    DRIVE = "torque", "mN m", 4, -1e3
    PAGE = {  # noqa: RUF012
        "heading": "Beads in a turning drum",
        "lede": "Shell and ends of the drum are sheet metal. Under the law the rebound of each "
        "impact follows from speed, bead and plate, as does where its energy goes. For comparison, "
        "the same beads with one coefficient of restitution (COR) for all impacts.",
        "alt": "The drum, seen along its axis",
        "others": "",
    }

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
        start = float(self.velocity[0] @ self.velocity[0])
        return math.sqrt(start + 4.0 * GRAVITY * self.drum) + self.spin * self.drum

    @property
    def box(self) -> Corners:
        """Corners [m] of the space around the drum."""
        side = self.drum + _AROUND
        return (-side, -_AROUND, -side), (side, self.length + _AROUND, side)

    def meshes(self, thickness: float, folder: Path) -> list[Cylinder | Disc]:
        """Make the shell and the two ends.

        At a seam of shell and end neither plate can move, and each holds the other against turning:
        their edges lie halfway between supported and clamped ones.
        """
        from contactlaw.walls import Cylinder, Disc, Rotation

        motion = Rotation(axis=(0, 1, 0), speed=self.spin)
        ends = (0.0, 0.0, 0.0), (0.0, self.length, 0.0)
        shell = Cylinder(*ends, self.drum, thickness, motion=motion, edges="supported")
        discs = [Disc(end, (0, 1, 0), self.drum, thickness, motion=motion, edges="supported") for end in ends]
        return [shell, *discs]

    @property
    def small(self) -> NDArray[np.bool_]:
        """Which beads are smaller than half of them."""
        return np.asarray(self.radius <= np.median(self.radius))

    @property
    def window(self) -> tuple[float, float, float, float]:
        """Left, right, bottom and top [m] of what is drawn."""
        side = _ROOM * self.drum
        return -side, side, -side, side

    @property
    def slice(self) -> tuple[float, float]:
        """Middle and half of the width [m] along y of what is drawn: all of the drum."""
        return 0.5 * self.length, 0.5 * self.length

    def outline(self, time: float) -> list[Floats]:
        """Arcs of the shell at a time [s]: about y, z turns towards x."""
        arc = math.tau / _ARCS
        angle = np.add.outer(np.arange(_ARCS) * arc, np.linspace(0.5 * _GAP, arc - 0.5 * _GAP, 10)) + self.spin * time
        return list(self.drum * np.stack((np.sin(angle), np.cos(angle)), axis=-1))

    def on_faces(self, rows: NDArray[np.void]) -> NDArray[np.bool_]:
        """Mask of contacts with one wall, not at a seam of shell and end."""
        on_shell = np.minimum(rows["y"], self.length - rows["y"])
        away = np.where(rows["plate"] == 0, on_shell, self.drum - np.hypot(rows["x"], rows["z"]))
        return np.asarray(away > _SEAM * rows["radius"])

    def title(self) -> tuple[str, str]:
        """Beads and drum; motion of the drum."""
        return (
            f"{self.beads}, in a drum of {self.sheet}, {2e3 * self.drum:g} mm wide and {1e3 * self.length:g} mm long",
            f"{self.duration * self.turns:.3g} revolutions at {self.turns:g} per second",
        )

    def facts(self, run: Run[Any]) -> Facts:
        """Height of the beads."""
        height = 1e3 * (self.drum + float(run.position[-1, :, 2].mean()))
        return [("mean height of the beads at the end", f"{height:.1f} mm")]


def drum(
    *,
    beads: int = 100,
    radius: tuple[float, float] = (1.4e-3, 2.1e-3),  # at most 1.4 times the thickness
    drum: float = 0.04,
    length: float = 0.04,
    thickness: float = 1.5e-3,
    sphere: str = "soda-lime-glass",
    plate: str = "stainless-steel-304",
    speed: float = 0.5,
    turns: float = 2.0,  # from 2.5 on beads would cling to the shell
    friction: float = 0.5,
    softening: float = 300.0,
    duration: float = 0.25,  # half a turn
    seed: int = 1,
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
        velocity=np.tile([0.0, 0.0, -speed], (beads, 1)),
        thickness=thickness,
        drum=drum,
        length=length,
        turns=turns,
        sphere_material=material(sphere),
        plate_material=material(plate),
        friction=friction,
        softening=softening,
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
