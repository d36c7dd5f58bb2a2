"""What a report says of a run: its impacts, and the energy that they took, wall by wall."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array, Integers, Rows
from contactlaw._errors import ArgumentError
from contactlaw._readable import drawn
from contactlaw.answers.constant import Constant, constant
from contactlaw.physical.kind import only_impacts
from contactlaw.record.file import Record
from contactlaw.reporting.surface import EnergyMap, energy_map
from contactlaw.spectrum import Spectrum
from contactlaw.table.lookup import R_MAX, R_MIN, V_MAX, V_MIN
from contactlaw.walls.motion import FARTHEST

CAUSES = "wave", "plastic", "other", "friction"
_CAUSED = tuple(f"{cause}_energy" for cause in CAUSES)
# Least and largest values; of contacts that are no impacts only the energies are checked.
_LIMITS = {
    "approach_speed": (V_MIN, V_MAX),
    "restitution": (-1.0, 2.0),
    "sliding_speed": (-V_MAX, V_MAX),
    "radius": (R_MIN, R_MAX),
    "mass": (1e-40, 1e40),
    "thickness": (R_MIN, math.inf),
    **dict.fromkeys("xyz", (-FARTHEST, FARTHEST)),
    **dict.fromkeys(_CAUSED, (-1e50, 1e50)),
}
_NEEDED = *_LIMITS, "kind", "plate", "triangle", "flags"
_MOST = 12  # rows of walls; of more walls, those that take the least energy share the last row
OTHERS = "other walls"


class WallRow(NamedTuple):
    """What happened on one wall."""

    name: str  # number of the wall, its thickness, and its materials where the run has several
    rows: Rows  # contacts on it
    impacts: Rows  # those of them that are impacts
    best: Constant | None  # one COR for all of the impacts; None without any


def shares(rows: Rows, friction: bool) -> Array:
    """Find where the energy of impacts went: shares kept and lost by each of `CAUSES`, with sum 1.

    Without friction it is the kinetic energy of the normal motion, with friction that of the
    contact point, m v_n^2/2 + m v_s^2/7 with the sliding speed v_s: an impact changes no other.
    Without impacts the shares are 0.
    """
    if not rows.size:
        return np.zeros(1 + len(CAUSES))
    total = 0.5 * (rows["mass"] * rows["approach_speed"] ** 2).sum()
    if friction:
        total += (rows["mass"] * rows["sliding_speed"] ** 2).sum() / 7.0
    lost = by_cause(rows) / total
    return np.append(1.0 - lost.sum(), lost)


def by_cause(rows: Rows) -> Array:
    """Energy that contacts took from the beads by each of the causes [J]."""
    return np.array([np.nansum(rows[f"{cause}_energy"]) for cause in CAUSES])


@dataclass(frozen=True, eq=False)
class Run:
    """The impacts of a run, whose record has all columns of `contactlaw.engines.record.IMPACT`."""

    record: Record

    def __post_init__(self) -> None:
        """Refuse a record from which no report can be made."""
        rows = self.record.rows
        missing = [name for name in _NEEDED if name not in (rows.dtype.names or ())]
        if missing:
            raise ArgumentError(
                "record",
                None,
                f"has no column {', '.join(missing)}: a report needs all columns that the engines "
                "record, with an ImpactModel and this version of contactlaw; simulate again",
            )
        on_walls, impacts = rows["plate"] >= 0, self.record.impact
        for name, (least, most) in _LIMITS.items():
            values = rows[name]
            unknown = np.isnan(values) if name in _CAUSED else ~impacts
            wrong = on_walls & ~((least <= values) & (values <= most) | unknown)
            if wrong.any():
                row = int(np.argmax(wrong))
                remedy = f"leave the row out; it must lie between {least:g} and {most:g}"
                raise ArgumentError("record", None, f"{name} of row {row} is {float(values[row])!r}: {remedy}")

    @cached_property
    def on_walls(self) -> Record:
        """Contacts on walls, also those that are no impacts."""
        return self.record.part(self.record.rows["plate"] >= 0)

    @property
    def rows(self) -> Rows:
        """Rows of `on_walls`."""
        return self.on_walls.rows

    @property
    def left_out(self) -> str:
        """Which contacts are no impacts, and how many; empty if all are impacts."""
        return self.on_walls.left_out

    @property
    def impacts(self) -> Rows:
        """Impacts on walls; COR and speed of other contacts mean nothing."""
        return self.on_walls.impacts

    @cached_property
    def subject(self) -> str:
        """What the run is: the materials and the engine, as far as they are known."""
        spheres, walls = self._materials
        pair = f"{', '.join(sorted(spheres))} on {', '.join(sorted(walls))}" if spheres else "materials not recorded"
        engine = self.record.made.get("engine")
        return f"{pair}, in {engine}" if engine else pair

    @cached_property
    def walls(self) -> list[WallRow]:
        """Walls by number and thickness; the least of very many are counted as one."""
        names, which = self._named
        return [_wall(name, self.rows[which == n]) for n, name in enumerate(names)]

    @cached_property
    def waves(self) -> tuple[Spectrum | None, str]:
        """Power that `walls` take, by frequency; without it the reason why it is not known."""
        if np.unique(self.rows["time"]).size < 2:
            return None, "there are no contacts at two times"
        rows = self.rows.copy()
        rows["plate"] = self._named[1]
        try:
            found = replace(self.on_walls, rows=rows).spectrum()
        except (ValueError, RuntimeError) as error:
            return None, str(error)
        return (found, "") if found.power.any() else (None, "no wave runs away in half-spaces")

    @cached_property
    def _named(self) -> tuple[list[str], Integers]:
        """Names of walls, and the number of its wall for each row."""
        rows = self.rows
        found = np.empty(rows.size, [("plate", "i8"), ("thickness", "f8"), ("bodies", "i8")])
        found["plate"], found["thickness"] = rows["plate"], rows["thickness"]
        found["bodies"] = self.on_walls.which
        keys, which = np.unique(found, return_inverse=True)
        names = [self._name(*key) for key in keys.tolist()]
        if len(names) > _MOST:
            order = np.argsort(-np.bincount(which, taken(rows)))
            rank = np.empty(len(names), int)
            rank[order] = np.minimum(np.arange(len(names)), _MOST - 1)
            names = [names[n] for n in order[: _MOST - 1]] + [OTHERS]
            which = rank[which]
        return names, which

    def _name(self, plate: int, thickness: float, bodies: int) -> str:
        """Name a wall, with the materials in which the walls of this run differ."""
        sphere, wall = self.record.bodies[bodies].materials if bodies >= 0 else (None, None)
        spheres, walls = self._materials
        of = f" of {wall.name}" if wall and len(walls) > 1 else " thick" * math.isfinite(thickness)
        beads = f", beads of {sphere.name}" if sphere and len(spheres) > 1 else ""
        names = self.record.surface.names if self.record.surface else ()
        name = names[plate] if plate < len(names) and names[plate] else f"wall {plate}"
        return f"{name}, {drawn(thickness, digits=4)}{of}{beads}"

    @cached_property
    def _materials(self) -> tuple[set[str], set[str]]:
        """Names of the materials of beads, and of walls, that meet."""
        pairs = [self.record.bodies[n].materials for n in set(self.on_walls.which.tolist()) - {-1}]
        return {sphere.name for sphere, _ in pairs}, {wall.name for _, wall in pairs}

    @cached_property
    def map(self) -> EnergyMap | None:
        """Energy on the surface of the walls, if that is known."""
        surface = self.record.surface
        if surface is None or not (surface.triangle >= 0).any():
            return None
        return energy_map(surface, taken(self.record.rows))


def taken(rows: Rows) -> Array:
    """Energy that each contact took from the bead [J], by all causes."""
    found: Array = np.nansum([rows[f"{cause}_energy"] for cause in CAUSES], axis=0)
    return found


def _wall(name: str, rows: Rows) -> WallRow:
    hits = rows[only_impacts(rows["kind"])[0]]
    size = np.cbrt(hits["mass"])  # in place of the radius: beads may differ in density, too
    best = None
    if hits.size:
        best = constant(hits["approach_speed"], size, np.ones(hits.size), hits["restitution"], hits["flags"], "energy")
    return WallRow(name, rows, hits, best)
