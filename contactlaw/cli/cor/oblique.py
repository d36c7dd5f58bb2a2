"""Oblique impacts of ``contactlaw cor --angle --friction``: tangential rebound and spin."""

import argparse
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from contactlaw._arrays import Array
from contactlaw.cli.parts import chosen, impacts, wording
from contactlaw.cli.parts.table import Column, Table
from contactlaw.equation.tangential import POINT
from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import within

_STEEPEST = 0.01  # [deg] stands for normal incidence, where the tangential restitution has a limit only
_LISTS = "angle", "speed", "thickness", "radius", "friction"
_COLUMNS = (
    Column("angle", "deg", "angle", "deg", is_input=True),
    Column("friction", "", "friction", is_input=True),
    *(column for column in impacts.COLUMNS if column.name in _LISTS),
    Column("restitution", "", "COR", digits=".4f"),
    Column("tangential_restitution", "", "tangential"),
    Column("rotational_restitution", "", "rotational"),
    Column("impulse_ratio"),
    Column("sliding_speed", "m/s"),
    Column("spin", "rad/s", "spin", "rad/s"),
    Column("rebound_angle", "deg", "leaves at", "deg"),
    Column("friction_energy", "J"),
)


def axes(arguments: argparse.Namespace) -> dict[str, Sequence[float]]:
    """Lay out the lists of the grid; angles change fastest."""
    within("angle", np.array(arguments.angle), 0.0, 89.999, "degrees from the normal")
    return {name: getattr(arguments, name) for name in reversed(_LISTS)}


def tabulate(arguments: argparse.Namespace, model: ImpactModel) -> Table:
    """Integrate all impacts, of which angles change fastest."""
    values = _hits(arguments, model, impacts.combinations(axes(arguments)))
    return Table(_COLUMNS, values, impacts.asked(model, mass=arguments.mass), values["flags"])


def curve(arguments: argparse.Namespace, model: ImpactModel, sizes: Mapping[str, Array]) -> dict[str, Any]:
    """Compute a curve of the tangential restitution."""
    hit = _hits(arguments, model, {**sizes, "angle": np.maximum(sizes["angle"], _STEEPEST)})
    return {"y": hit["tangential_restitution"], "flags": hit["flags"], "overload": hit["overload"]}


def _hits(arguments: argparse.Namespace, model: ImpactModel, sizes: Mapping[str, Array]) -> dict[str, Any]:
    """Columns of impacts, which are integrated: a few of them need no table of the model."""
    angle, total, thickness, radius, friction = (sizes[name] for name in _LISTS)
    speed, sliding = total * np.cos(np.radians(angle)), total * np.sin(np.radians(angle))
    with wording.naming_impact(speed, radius, thickness, mass=arguments.mass):
        wall = chosen.wall(arguments, model.pair.given[1], thickness)
        hit = model.oblique(speed, sliding, radius, wall, friction, method="solve", mass=arguments.mass)
    changed = sliding - np.asarray(hit.sliding_speed)
    return {
        **vars(hit),
        **sizes,
        "spin": (1.0 - 1.0 / POINT) * changed / radius,
        "rebound_angle": np.degrees(np.arctan2(sliding - changed / POINT, hit.restitution * speed)),
    }
