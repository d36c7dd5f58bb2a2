"""The scene of the sieve: a feed of beads of two sizes, and a vibrating deck."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contactlaw import ArgumentError
from dem_demo.kit.beads import GRAVITY, Floats
from dem_demo.kit.bed import Bed, Corners, check
from dem_demo.sieve import defaults
from dem_demo.sieve.deck import FORM, Deck, write_stl

if TYPE_CHECKING:
    import h5py

    from contactlaw.walls import Mesh

_COLUMNS, _ROWS, _BEADS = 48, 29, 10_000  # cells of a deck, and the beads that cover it 1.5 times
_FEWEST = 8, 5  # columns and rows of the smallest deck
_SPACING = 2.2  # [largest radius], distance of lattice sites: no two beads touch at the start
_LAYERS = 8  # least number of layers of lattice sites
_MIDDLE, _SPREAD = 0.3, 0.4  # [deck's length], centre and spread of the feed along x
_DRIFT = 0.5  # speed of the feed along the deck, over its speed downwards
_AROUND = 0.2  # [m], room around deck and feed in the simulation box
_DECK = "columns", "rows", "opening"
LIFT = 2.0  # [amplitude], extra height of the feed, above the deck's highest position


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sieve(Bed):
    """A feed of two sizes on a deck that vibrates about z = 0, at 45 degrees to it."""

    NAME, SCHEMA = "sieve", 2
    NUMBERS = "thickness", "frequency", "amplitude", "friction", "duration", "seed"
    FRAME_RATE = defaults.FRAME_RATE

    deck: Deck  # at rest
    frequency: float  # [1/s]
    amplitude: float  # [m]

    @property
    def small(self) -> np.ndarray:
        """Which beads are undersize: they can pass an opening."""
        return 2.0 * self.radius < self.deck.opening

    @property
    def types(self) -> NDArray[np.int64]:
        """Atom type of each bead: 1 for undersize beads, 2 for the others."""
        return np.where(self.small, 1, 2)

    @property
    def top_speed(self) -> float:
        """Largest speed [m/s] of a bead that falls on the deck, relative to it."""
        fall = float(self.position[:, 2].max())
        start = float(np.linalg.norm(self.velocity))
        deck = 2.0 * math.pi * self.frequency * self.amplitude
        return math.sqrt(start**2 + 2.0 * GRAVITY * fall) + deck

    @property
    def vibration(self) -> Floats:
        """Components of the deck's amplitude along x, y and z [m]."""
        return self.amplitude * math.sqrt(0.5) * np.array([1.0, 0.0, 1.0])

    @property
    def box(self) -> Corners:
        """Corners [m] of the space around the deck, as deep as a bead can fall."""
        bottom = -self.top_speed * self.duration - _AROUND
        top = float(self.position[:, 2].max()) + _AROUND
        return (-_AROUND, -_AROUND, bottom), (self.deck.length + _AROUND, self.deck.width + _AROUND, top)

    def deck_place(self, time: float) -> Floats:
        """Displacement of the deck at a time [m]."""
        return self.vibration * math.sin(2.0 * math.pi * self.frequency * time)

    def write_files(self, folder: Path) -> None:
        """Write the deck's STL file."""
        write_stl(folder / FORM, self.deck.triangles())

    def meshes(self, thickness: float, folder: Path) -> list[Mesh]:
        """Read the deck from its STL file, as a user would.

        Nothing holds the sheet at the rims of its openings. Where it is folded up to a wall, no
        kind of edge describes it: there the sheet gives way as one that goes on.
        """
        from contactlaw.walls import Mesh, Vibration

        motion = Vibration(tuple(self.vibration.tolist()), self.frequency)
        return [Mesh.read(folder / FORM, thickness, scale=1e-3, motion=motion, edges="free")]

    def write_walls(self, file: h5py.File) -> None:
        """Write the triangles and the dimensions of the deck."""
        from contactlaw.record.file import write

        deck = file.create_group("deck")
        corners = "corners (x, y, z) of each triangle at rest"
        write(deck, "triangles", self.deck.triangles(), "m", corners)
        deck.attrs.update({name: getattr(self.deck, name) for name in _DECK})

    @staticmethod
    def read_walls(file: h5py.File) -> Mapping[str, Any]:
        """Read the deck from its dimensions."""
        attributes = file["deck"].attrs
        return {"deck": Deck(**{name: attributes[name].item() for name in _DECK})}


def sieve(
    *,
    beads: int = defaults.BEADS,
    radius: tuple[float, float] = defaults.RADIUS,
    opening: float = defaults.OPENING,
    thickness: float = defaults.THICKNESS,
    sphere: str = defaults.SPHERE,
    plate: str = defaults.PLATE,
    speed: float = defaults.SPEED,
    frequency: float = defaults.FREQUENCY,
    amplitude: float = defaults.AMPLITUDE,
    friction: float = defaults.FRICTION,
    duration: float = defaults.DURATION,
    seed: int = defaults.SEED,
) -> Sieve:
    """Make a sieve with a deck in proportion to the number of beads.

    Examples
    --------
    >>> small = sieve(beads=300)
    >>> small.deck.columns, small.deck.rows, int(small.small.sum())
    (8, 5, 153)
    """
    from contactlaw import material

    check(
        Sieve,
        beads=beads,
        seed=seed,
        duration=duration,
        positive={"opening": (opening, "m"), "thickness": (thickness, "m"), "frequency": (frequency, "1/s")},
        not_negative={"speed": (speed, "m/s"), "amplitude": (amplitude, "m"), "friction": (friction, "1")},
    )
    if not 0.0 < radius[0] < 0.5 * opening < radius[1] < 2.0 * opening:
        raise ArgumentError(
            "radius",
            None,
            f"needs MIN,MAX [m] of beads that pass the opening of {opening:g} m and of others up "
            f"to four times as wide, got {radius[0]!r},{radius[1]!r}",
        )
    share = math.sqrt(beads / _BEADS)
    deck = Deck(max(_FEWEST[0], round(_COLUMNS * share)), max(_FEWEST[1], round(_ROWS * share)), opening)
    rng = np.random.default_rng(seed)
    size = np.where(rng.random(beads) < 0.5, *radius)
    position = _feed(beads, radius[1], deck, rng)
    position[:, 2] += LIFT * amplitude
    velocity = speed * np.array([_DRIFT, 0.0, -1.0])
    return Sieve(
        radius=size,
        position=position,
        velocity=velocity,
        deck=deck,
        thickness=thickness,
        sphere_material=material(sphere),
        plate_material=material(plate),
        frequency=frequency,
        amplitude=amplitude,
        friction=friction,
        duration=duration,
        seed=seed,
    )


def _feed(beads: int, radius: float, deck: Deck, rng: np.random.Generator) -> Floats:
    """Positions of the beads: sites of a loose lattice, most of them near `_MIDDLE`."""
    step, inside = _SPACING * radius, np.array([deck.length, deck.width]) - 2.0 * radius
    columns, rows = (inside // step).astype(int)
    layers = max(_LAYERS, math.ceil(1.5 * beads / (columns * rows)))
    site = np.indices((columns, rows, layers)).reshape(3, -1).T + 0.5
    along = site[:, 0] / columns
    weight = np.exp(-(((along - _MIDDLE) / _SPREAD) ** 2))
    chosen = rng.choice(len(site), beads, replace=False, p=weight / weight.sum())
    spare = 0.5 * (_SPACING - 2.0) * radius
    corner = radius + 0.5 * np.r_[inside - step * np.array([columns, rows]), 0.0]
    position: Floats = corner + step * site[chosen] + rng.uniform(-spare, spare, (beads, 3))
    position[:, 2] += step * rng.random(columns * rows)[chosen // layers]  # hides the lattice
    return position
