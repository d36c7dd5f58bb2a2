"""What the sieve is made of: a feed of beads of two sizes, a deck, its motion."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from dem_demo.scene import GRAVITY, Floats
from dem_demo.sieve import defaults
from dem_demo.sieve.deck import Deck

if TYPE_CHECKING:
    from contactlaw import Material

_COLUMNS, _ROWS, _BEADS = 48, 29, 10_000  # cells, and the beads that cover them 1.5 times
_FEWEST = 8, 5  # cells
_SPACING = 2.2  # [largest radius]: sites of the feed, so far apart that no two beads touch
_LAYERS = 8  # of sites
_MIDDLE, _SPREAD = 0.3, 0.4  # [length]: where the feed falls, most of it at its middle
_DRIFT = 0.5  # times its speed: the feed's along the deck
LIFT = 2.0  # [amplitude] of the feed's lowest beads over the highest deck


@dataclass(frozen=True, slots=True, eq=False)
class Sieve:
    """A feed on a deck that vibrates, and how long it is watched.

    Parameters
    ----------
    radius : ndarray, shape (N,)
        Radii of the beads [m], each one of two.
    position : ndarray, shape (N, 3)
        Of their centres at the start [m]; z points up, the deck vibrates about z = 0.
    velocity : ndarray, shape (3,)
        Of the feed [m/s].
    deck : Deck
        The deck.
    thickness : float
        Of its sheet [m].
    sphere_material, plate_material : Material
        Materials of the beads and of the sheet.
    frequency, amplitude : float
        Of the deck's vibration [1/s], [m], at 45 degrees to it.
    friction : float
        Coulomb's coefficient, of beads on the deck and on each other.
    duration : float
        Simulated time [s].
    seed : int
        Seed that the feed was drawn with.
    """

    radius: Floats
    position: Floats
    velocity: Floats
    deck: Deck
    thickness: float
    sphere_material: Material
    plate_material: Material
    frequency: float
    amplitude: float
    friction: float
    duration: float
    seed: int

    @property
    def frame_rate(self) -> float:
        """Recorded frames per second [1/s]."""
        return defaults.FRAME_RATE

    @property
    def frames(self) -> int:
        """Frames after the first one, which shows the start."""
        return round(self.duration * self.frame_rate)

    @property
    def mass(self) -> Floats:
        """Masses of the beads [kg]."""
        from contactlaw.physical.materials import sphere_mass

        return sphere_mass(self.sphere_material.density, self.radius)

    @property
    def small(self) -> np.ndarray:
        """Which beads are undersize: they can pass an opening."""
        return 2.0 * self.radius < self.deck.opening

    @property
    def top_speed(self) -> float:
        """Largest speed [m/s] of a bead that falls on the deck, relative to it."""
        fall = float(self.position[:, 2].max())
        start = float(np.linalg.norm(self.velocity))
        deck = 2.0 * math.pi * self.frequency * self.amplitude
        return math.sqrt(start**2 + 2.0 * GRAVITY * fall) + deck

    @property
    def vibration(self) -> Floats:
        """Amplitude of the deck's motion [m], along x, y and z."""
        return self.amplitude * math.sqrt(0.5) * np.array([1.0, 0.0, 1.0])

    def deck_place(self, time: float) -> Floats:
        """Displacement of the deck at a time [m]."""
        return self.vibration * math.sin(2.0 * math.pi * self.frequency * time)


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
    """Make a sieve whose deck is as large as its beads need.

    Parameters
    ----------
    beads : int, optional
        Number of beads, of either size by chance.
    radius : tuple of float, optional
        Of the beads that pass the openings, and of those that do not [m].
    opening, thickness : float, optional
        Diameter of the openings, and thickness of the sheet [m].
    sphere, plate : str, optional
        Materials of beads and sheet.
    speed : float, optional
        At which the feed comes down [m/s].
    frequency, amplitude : float, optional
        Of the deck's vibration [1/s], [m].
    friction : float, optional
        Coulomb's coefficient.
    duration : float, optional
        Simulated time [s].
    seed : int, optional
        The same seed gives the same feed.

    Raises
    ------
    ValueError
        If a number is out of its range; the message begins with its name.

    Examples
    --------
    >>> small = sieve(beads=300)
    >>> small.deck.columns, small.deck.rows, int(small.small.sum())
    (8, 5, 153)
    """
    from contactlaw import material

    _check(beads, radius, opening, thickness, speed, frequency, amplitude, friction, duration, seed)
    share = math.sqrt(beads / _BEADS)
    deck = Deck(
        max(_FEWEST[0], round(_COLUMNS * share)), max(_FEWEST[1], round(_ROWS * share)), opening
    )
    rng = np.random.default_rng(seed)
    size = np.where(rng.random(beads) < 0.5, *radius)
    position = _feed(beads, radius[1], deck, rng)
    position[:, 2] += LIFT * amplitude
    velocity = speed * np.array([_DRIFT, 0.0, -1.0])
    return Sieve(
        size, position, velocity, deck, thickness, material(sphere), material(plate),
        frequency, amplitude, friction, duration, seed,
    )  # fmt: skip


def _feed(beads: int, radius: float, deck: Deck, rng: np.random.Generator) -> Floats:
    """Places of beads on a loose lattice over the deck, dense where the feed falls."""
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
    position[:, 2] += step * rng.random(columns * rows)[chosen // layers]  # no lattice to be seen
    return position


def _check(
    beads: int,
    radius: tuple[float, float],
    opening: float,
    thickness: float,
    speed: float,
    frequency: float,
    amplitude: float,
    friction: float,
    duration: float,
    seed: int,
) -> None:
    if not beads >= 1:
        raise ValueError(f"beads: at least one is needed, got {beads!r}")
    if seed < 0:
        raise ValueError(f"seed: must not be negative, got {seed!r}")
    for name, value, unit in (
        ("opening", opening, "m"),
        ("thickness", thickness, "m"),
        ("frequency", frequency, "1/s"),
    ):
        if not 0.0 < value < math.inf:
            raise ValueError(f"{name}: must be positive and finite [{unit}], got {value!r}")
    for name, value, unit in (
        ("speed", speed, "m/s"),
        ("amplitude", amplitude, "m"),
        ("friction", friction, "1"),
    ):
        if not 0.0 <= value < math.inf:
            raise ValueError(f"{name}: must be finite and not negative [{unit}], got {value!r}")
    if not 0.0 < radius[0] < 0.5 * opening < radius[1] < 2.0 * opening:
        raise ValueError(
            f"radius: needs MIN,MAX [m] of beads that pass the opening of {opening:g} m and of "
            f"others up to four times as wide, got {radius[0]!r},{radius[1]!r}"
        )
    frame = 1.0 / defaults.FRAME_RATE
    if not frame <= duration < math.inf:
        raise ValueError(
            f"duration: must be finite and at least one frame, {frame:g} s, got {duration!r}"
        )
