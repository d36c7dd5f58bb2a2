"""The scene of the sieve: a feed of beads of two sizes, and a vibrating deck.

The defaults are within the limits of the law but for the rims of the openings, and simulated within minutes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contactlaw import ArgumentError
from dem_demo.kit.scene import GRAVITY, Facts, Floats, Scene, check
from dem_demo.sieve.deck import FORM, Deck

if TYPE_CHECKING:
    from contactlaw.walls import Mesh
    from dem_demo.kit.run import Run

_COLUMNS, _ROWS, _BEADS = 48, 29, 10_000  # cells of a deck, and the beads that cover it 1.5 times
_FEWEST = 8, 5  # columns and rows of the smallest deck
_SPACING = 2.2  # [largest radius], distance of lattice sites: no two beads touch at the start
_LAYERS = 8  # least number of layers of lattice sites
_MIDDLE, _SPREAD = 0.3, 0.4  # [deck's length], centre and spread of the feed along x
_DRIFT = 0.5  # speed of the feed along the deck, over its speed downwards
_AROUND = 0.2  # [m], room around deck and feed in the simulation box
LIFT = 2.0  # [amplitude], extra height of the feed, above the deck's highest position


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sieve(Scene):
    """A feed of two sizes on a deck that vibrates about z = 0, at 45 degrees to it."""

    NAME, FRAME_RATE, WALL = "sieve", 500.0, "deck"
    PAGE = {  # noqa: RUF012
        "heading": "Beads on a vibrating sieve",
        "lede": "The deck is a mesh from an STL file. Under the law the rebound of each impact "
        "follows from speed, bead, plate and the nearest opening, as does where its energy goes. "
        "For comparison, the same feed with one coefficient of restitution (COR) for all impacts.",
        "others": "; <code>deck.stl</code>",
    }

    deck: Deck  # at rest
    frequency: float  # [1/s]
    amplitude: float  # [m]
    softening: float  # by which the modulus of all contacts is divided; 1: true contacts

    @property
    def small(self) -> NDArray[np.bool_]:
        """Which beads are undersize: they can pass an opening."""
        return np.asarray(2.0 * self.radius < self.deck.opening)

    @property
    def top_speed(self) -> float:
        """Largest speed [m/s] of a bead that falls on the deck, relative to it."""
        fall = float(self.position[:, 2].max())
        start = float(np.linalg.norm(self.velocity[0]))
        deck = 2.0 * math.pi * self.frequency * self.amplitude
        return math.sqrt(start**2 + 2.0 * GRAVITY * fall) + deck

    @property
    def vibration(self) -> Floats:
        """Components of the deck's amplitude along x, y and z [m]."""
        return self.amplitude * math.sqrt(0.5) * np.array([1.0, 0.0, 1.0])

    @property
    def box(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Corners [m] of the space around the deck, as deep as a bead can fall."""
        bottom = -self.top_speed * self.duration - _AROUND
        top = float(self.position[:, 2].max()) + _AROUND
        return (-_AROUND, -_AROUND, bottom), (self.deck.length + _AROUND, self.deck.width + _AROUND, top)

    def mesh(self, thickness: float, folder: Path) -> Mesh:
        """Read the deck from its STL file, as a user would.

        Nothing holds the sheet at the rims of its openings. Where it is folded up to a wall, no
        kind of edge describes it: there the sheet gives way as one that goes on.
        """
        from contactlaw.walls import Mesh, Vibration

        motion = Vibration(tuple(self.vibration.tolist()), self.frequency)
        return Mesh.read(folder / FORM, thickness, scale=1e-3, motion=motion, edges="free")

    def title(self) -> tuple[str, str]:
        """Feed and deck; motion of the deck."""
        deck = self.deck
        return (
            f"{self.beads}, on a deck of {self.sheet}, {deck.length * 1e3:.0f} x {deck.width * 1e3:.0f} mm, "
            f"openings of {deck.opening * 1e3:g} mm, {len(deck.triangles())} triangles",
            f"{self.duration * self.frequency:.3g} periods of {self.frequency:g} Hz, "
            f"amplitude {self.amplitude * 1e3:g} mm",
        )

    def facts(self, run: Run[Any]) -> Facts:
        """Loss by the openings, height of the beads, and how many have passed."""
        above = run.position[-1, :, 2] > -self.amplitude
        height = float(run.position[-1, above, 2].mean()) * 1e3 if above.any() else 0.0
        passed = run.position[-1, self.small, 2] < -self.amplitude - 0.5 * self.deck.opening
        found = [
            ("mean height of beads on the deck", f"{height:.1f} mm"),
            ("undersize beads that have passed", f"{passed.sum() / max(1, passed.size):.1%}"),
        ]
        # A constant COR does not depend on the openings, which leaves nothing to compare.
        if run.making.constant_cor is None and run.impacts.size:
            found.insert(0, ("impacts lose, by the openings", f"{self.loss_by_openings(run):+.1%}"))
        return found

    def loss_by_openings(self, run: Run[Any]) -> float:
        """Energy that the impacts lose, over that without openings, less 1.

        The same impacts are compared: their recorded COR, with the law's on an endless sheet.
        """
        rows = run.impacts
        endless = run.model.restitution(rows["approach_speed"], rows["radius"], self.plates[0])
        energy = rows["mass"] * rows["approach_speed"] ** 2
        return float(energy @ (1.0 - rows["restitution"] ** 2) / (energy @ (1.0 - endless**2)) - 1.0)


def sieve(
    *,
    beads: int = _BEADS,
    radius: tuple[float, float] = (2e-3, 3e-3),  # at most 1.5 times the thickness
    opening: float = 5e-3,  # the smaller beads pass
    thickness: float = 2e-3,
    sphere: str = "bearing-steel-52100",
    plate: str = "aluminium-6061-t6",
    speed: float = 1.0,
    frequency: float = 50.0,
    amplitude: float = 1e-3,  # at 50 Hz an acceleration of 10 g
    friction: float = 0.3,
    softening: float = 300.0,
    duration: float = 0.06,  # three periods
    seed: int = 1,
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
    return Sieve(
        radius=size,
        position=position,
        velocity=np.tile(speed * np.array([_DRIFT, 0.0, -1.0]), (beads, 1)),
        deck=deck,
        plates=(thickness,),
        sphere_material=material(sphere),
        plate_material=material(plate),
        frequency=frequency,
        amplitude=amplitude,
        friction=friction,
        softening=softening,
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
