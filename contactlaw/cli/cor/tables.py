"""Tables of ``contactlaw cor``: normal and oblique impacts, and the force over time of one."""

import argparse
import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.answers.uncertainty import Uncertainty
from contactlaw.cli.parts import bands, chosen, impacts, wording
from contactlaw.cli.parts.table import Column, Table
from contactlaw.equation.tangential import POINT
from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import within
from contactlaw.physical.plates import Foundation, Shell

SIZES = "radius", "thickness", "speed"
ERRORS = "speed_error", "radius_error", "thickness_error"
BANDLESS = "no_band", "angle", "history", "cylinder", "bowl", "foundation"  # options without a band
_MOST = 1_000_000  # impacts, which take half a minute to print: 100 MB of text
_SAMPLES = 256  # rows of a history
_OBLIQUE = (
    Column("angle", "deg", "angle", "deg", is_input=True),
    Column("friction", "", "friction", is_input=True),
    *impacts.COLUMNS[:3],
    Column("restitution", "", "COR", digits=".4f"),
    Column("tangential_restitution", "", "tangential"),
    Column("rotational_restitution", "", "rotational"),
    Column("impulse_ratio"),
    Column("sliding_speed", "m/s"),
    Column("spin", "rad/s", "spin", "rad/s"),
    Column("rebound_angle", "deg", "leaves at", "deg"),
    Column("friction_energy", "J"),
)
_HISTORY = (
    Column("time", "s"),
    Column("force", "N"),
    Column("compression", "m"),
    Column("impulse", "Ns"),
    Column("plate_displacement", "m"),
)


def axes(arguments: argparse.Namespace) -> dict[str, Sequence[float]]:
    """Lay out the lists of the grid; the last one changes fastest."""
    names = SIZES if arguments.angle is None else ("friction", *SIZES, "angle")
    return {name: getattr(arguments, name) for name in names}


def table(arguments: argparse.Namespace, model: ImpactModel) -> tuple[Table, Uncertainty | None]:
    """Answer every combination of the lists, with bands unless an option rules them out."""
    if arguments.history:
        return _history(arguments, model), None
    lists, mass = axes(arguments), arguments.mass
    count = math.prod(map(len, lists.values()))
    if count > _MOST:
        reason = f"every combination is {count} impacts, and {_MOST} is the most: give fewer values"
        raise ArgumentError(", ".join(lists), None, reason)
    grid = (values.ravel() for values in np.meshgrid(*lists.values(), indexing="ij"))
    sizes = dict(zip(lists, grid, strict=True))
    radius, thickness, speed = (sizes[name] for name in SIZES)
    wall = _wall(arguments, model, thickness)
    with wording.naming_impact(speed, radius, thickness, mass=mass):
        if arguments.angle is not None:
            columns, values = _OBLIQUE, _oblique(arguments, model, sizes, wall)
        else:
            hit = (model.solve if arguments.solve else model.lookup)(speed, radius, wall, mass=mass)
            columns, values = impacts.COLUMNS, asdict(hit) | {"yield_speed": _yield_speeds(arguments, model, sizes)}
    made = Table(columns, {**values, **sizes}, chosen.asked(arguments, model, mass=arguments.mass), values["flags"])
    without = any(getattr(arguments, name) not in (None, False) for name in BANDLESS)
    known = None if without else uncertainty(arguments, model, made)
    return bands.with_bands(made, known), known


def uncertainty(arguments: argparse.Namespace, model: ImpactModel, table: Table) -> Uncertainty:
    """Find the bands of the impacts of a table."""
    errors = {name: getattr(arguments, name) for name in ERRORS}
    radius, thickness, speed = (table.values[name] for name in SIZES)
    wall = _wall(arguments, model, thickness)
    with wording.naming_impact(speed, radius, thickness, mass=arguments.mass):
        return model.uncertainty(speed, radius, wall, **errors, mass=arguments.mass)


def _history(arguments: argparse.Namespace, model: ImpactModel) -> Table:
    """Integrate one impact, which needs no table of the model."""
    sizes = axes(arguments)
    for name, values in sizes.items():
        if len(values) > 1:
            raise ArgumentError(name, None, f"got {len(values)} values; --history takes one")
    radius, thickness, speed = (values[0] for values in sizes.values())
    samples = _SAMPLES if arguments.samples is None else arguments.samples
    with wording.naming_impact(speed, radius, thickness, mass=arguments.mass):
        wall = _wall(arguments, model, thickness)
        contact = model.force_history(speed, radius, wall, samples, "solve", mass=arguments.mass)
    forces = dict(zip((column.name for column in _HISTORY), contact, strict=True))
    asked = chosen.asked(arguments, model, speed=speed, radius=radius, thickness=thickness, mass=arguments.mass)
    return Table(_HISTORY, forces, asked, np.full(contact.time.size, int(contact.flags)))


def _wall(arguments: argparse.Namespace, model: ImpactModel, thickness: Any) -> Any:
    return chosen.wall(arguments, model.pair.given[1], thickness)


def _yield_speeds(arguments: argparse.Namespace, model: ImpactModel, sizes: dict[str, Array]) -> Array:
    """Find yield speeds [m/s]: NaN for walls where none is known, inf if that impact is outside the table."""
    many = len(arguments.speed)
    radius, plates = sizes["radius"][::many], _wall(arguments, model, sizes["thickness"][::many])
    if isinstance(plates, Foundation | Shell):
        return np.full(sizes["radius"].size, math.nan)

    def search(radius: Array, thickness: Array) -> Array:
        try:
            return np.asarray(model.yield_speed(radius, thickness, arguments.mass))
        except ValueError:
            if radius.size == 1:
                return np.array([math.inf])
            parts = zip(np.split(radius, radius.size), np.split(thickness, radius.size), strict=True)
            return np.concatenate([search(*part) for part in parts])

    return np.repeat(search(radius, np.array(plates, dtype=float)), many)


def _oblique(arguments: argparse.Namespace, model: ImpactModel, sizes: dict[str, Array], wall: Any) -> dict[str, Any]:
    """Integrate oblique impacts: a few of them need no table of the model."""
    within("angle", sizes["angle"], 0.0, 89.999, "degrees from the normal")
    inclined, radius = np.radians(sizes["angle"]), sizes["radius"]
    speed, sliding = sizes["speed"] * np.cos(inclined), sizes["speed"] * np.sin(inclined)
    hit = model.oblique(speed, sliding, radius, wall, sizes["friction"], method="solve", mass=arguments.mass)
    changed = sliding - np.asarray(hit.sliding_speed)
    return {
        **vars(hit),
        "spin": (1.0 - 1.0 / POINT) * changed / radius,
        "rebound_angle": np.degrees(np.arctan2(sliding - changed / POINT, hit.restitution * speed)),
    }
