"""Impacts as users give them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array, Mask, Places
from contactlaw._errors import ArgumentError
from contactlaw.equation.edge import KINDS
from contactlaw.physical.arguments import broadcast, check
from contactlaw.physical.pair import Pair
from contactlaw.physical.plates import Thickness, Wall, wall_of

_ENDLESS = np.array([math.inf])  # distance from an edge, and radius of a hole, where there is none


class PlateEdge(NamedTuple):
    """The edge of the plate of each impact."""

    kind: str
    distance: Array  # [m]; inf where a plate has none
    hole_radius: Array  # [m]; inf where the edge is straight

    @staticmethod
    def of(kind: str, distance: Array, hole_radius: Array, thickness: Array) -> PlateEdge | None:
        """Check edges; half-spaces have none. None if no plate has one."""
        check_kind(kind)
        check(edge_distance=distance, hole_radius=hole_radius)
        if kind != "free" and (hole_radius < math.inf).any():
            reason = f"the rim of a hole is a free edge, not {kind!r}; leave it out"
            raise ArgumentError("hole_radius", None, reason)
        if not (distance < math.inf).any():
            return None
        return PlateEdge(kind, np.where(thickness < math.inf, distance, math.inf), hole_radius)


@dataclass(frozen=True, eq=False)
class Impacts:
    """Impacts that a user gave, as flat arrays, and the shape of the answer (None: scalars)."""

    speed: Array  # [m/s]
    radius: Array  # [m], R* of two spheres
    thickness: Array  # [m]
    shape: tuple[int, ...] | None
    edge: PlateEdge | None = None  # None for plates without edges
    mass: Array | None = None  # that answers at the contact [kg]; None for solid spheres
    wall: Wall | None = None  # None for sheets of the pair's material
    bending: Array | None = None  # R* over the radius on curved walls; None for flat ones
    frequency: Array | None = None  # w0 of what comes back from a curved wall or a foundation [1/s]

    @property
    def remember(self) -> Mask | None:
        """Impacts on plates from which something comes back; None if there are none."""
        if self.frequency is not None:
            return np.asarray(self.frequency > 0.0)
        return None if self.edge is None else np.asarray(self.edge.distance < math.inf)

    @property
    def forgetting(self) -> Impacts:
        """The same impacts on plates from which nothing comes back."""
        return replace(self, edge=None, frequency=None)

    @staticmethod
    def on_plates(
        speed: ArrayLike,
        radius: ArrayLike,
        thickness: Thickness | Wall,
        edge: str = "free",
        edge_distance: ArrayLike = math.inf,
        hole_radius: ArrayLike = math.inf,
        mass: ArrayLike | None = None,
    ) -> Impacts:
        """Broadcast and check what the user gave."""
        wall = wall_of(thickness)
        given = dict(wall.numbers) if mass is None else {**wall.numbers, "mass": mass}
        if edge_distance is not math.inf or hole_radius is not math.inf:
            given |= {"edge_distance": edge_distance, "hole_radius": hole_radius}
        v, r, *more, shape = broadcast(speed=speed, radius=radius, **given)
        known = dict(zip(given, more, strict=True))
        s, a = (known.pop(name, _ENDLESS) for name in ("edge_distance", "hole_radius"))
        plate = replace(wall, numbers={name: known.pop(name) for name in wall.numbers})
        h = plate.numbers.pop("thickness")
        check(speed=v, radius=r, thickness=h, **known)
        around = PlateEdge.of(edge, s, a, h)
        return Impacts(v, r, h, shape, around, **known, wall=plate if plate.numbers else None)

    def part(self, some: Places) -> Impacts:
        """Choose some of the impacts."""
        arrays: dict[str, Any] = {
            name: value[some] for name, value in vars(self).items() if isinstance(value, np.ndarray)
        }
        wall = None if self.wall is None else self.wall.part(some)
        edge = self.edge and PlateEdge(self.edge.kind, self.edge.distance[some], self.edge.hole_radius[some])
        return replace(self, shape=(some.size,), wall=wall, edge=edge, **arrays)


def check_kind(edge: str) -> None:
    """Refuse what is no kind of edge."""
    if not isinstance(edge, str) or edge not in KINDS:
        raise ArgumentError("edge", edge, f"must be one of {', '.join(KINDS)}")


def check_finite(pair: Pair, impacts: Impacts, *answers: Array) -> None:
    """Refuse answers, one number per impact, that are not finite."""
    for n in np.flatnonzero(~np.isfinite(sum(answers))):
        v, r, h = impacts.speed[n], impacts.radius[n], impacts.thickness[n]
        impact = f"{pair} at {v:g} m/s, radius {r:g} m, thickness {h:g} m"
        raise RuntimeError(f"{impact}: no finite answer; please report it")
