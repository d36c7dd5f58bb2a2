"""Tables of ``contactlaw cor``: normal and oblique impacts, and the force over time of one."""

import math
from argparse import Namespace
from collections.abc import Callable, Mapping, Sequence
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

ERRORS = "speed_error", "radius_error", "thickness_error"
_MOST = 1_000_000  # impacts, which take half a minute to print: 100 MB of text
_SAMPLES = 256  # rows of a history
_OBLIQUE = (
    Column("angle", "deg", "angle", "deg", is_input=True),
    Column("friction", "", "friction", is_input=True),
    *impacts.COLUMNS[:4],
    Column("tangential_restitution", "", "tangential"),
    Column("rotational_restitution", "", "rotational"),
    Column("impulse_ratio"),
    Column("sliding_speed", "m/s"),
    Column("spin", "rad/s", "spin", "rad/s"),
    Column("rebound_angle", "deg", "leaves at", "deg"),
    Column("friction_energy", "J"),
)
_HISTORY: tuple[Column, ...] = (
    Column("time", "s"),
    Column("force", "N"),
    Column("compression", "m"),
    Column("impulse", "Ns"),
    Column("plate_displacement", "m"),
)


def axes(arguments: Namespace) -> dict[str, Sequence[float]]:
    """Lay out the lists of the grid; the last one changes fastest."""
    sizes = "radius", "thickness", "speed"
    names = sizes if arguments.angle is None else ("friction", *sizes, "angle")
    return {name: getattr(arguments, name) for name in names}


def table(arguments: Namespace, model: ImpactModel) -> tuple[Table, Uncertainty | None]:
    """Answer every combination of the lists, with bands unless an option rules them out."""
    lists = axes(arguments)
    count = math.prod(map(len, lists.values()))
    limit, subject = (1, "--history") if arguments.history else (_MOST, "a table")
    if count > limit:
        names = ", ".join(name for name, values in lists.items() if len(values) > 1)
        raise ArgumentError(names, None, f"every combination is {count} impacts; {subject} takes at most {limit}")
    grid = np.meshgrid(*lists.values(), indexing="ij")
    sizes: dict[str, Any] = {name: values.ravel() for name, values in zip(lists, grid, strict=True)}
    values: dict[str, Any]
    same = {"mass": arguments.mass}
    if arguments.history:
        samples = _SAMPLES if arguments.samples is None else arguments.samples
        contact = answer(model.force_history, arguments, model, sizes, samples=samples, method="solve")
        values = {name: np.ravel(forces) for name, forces in contact._asdict().items()}
        columns, values["flags"] = _HISTORY, np.repeat(contact.flags, samples)
        same |= {name: size[0] for name, size in sizes.items()}
    elif arguments.angle is not None:
        columns, values = _OBLIQUE, _oblique(arguments, model, sizes)
    else:
        ask = model.solve if arguments.solve else model.lookup
        columns, values = impacts.COLUMNS, vars(answer(ask, arguments, model, sizes))
    made = Table(columns, {**values, **sizes}, chosen.asked(arguments, model, **same), values["flags"])
    known = None if arguments.no_band else uncertainty(arguments, model, sizes)
    return bands.with_bands(made, known), known


def answer(
    ask: Callable[..., Any], arguments: Namespace, model: ImpactModel, sizes: Mapping[str, Array], **more: Any
) -> Any:
    """Ask the model about impacts, which an error names; `more` is what else the question takes."""
    impact: dict[str, Any] = {name: sizes[name] for name in ("speed", "radius", "thickness")}
    with wording.naming_impact(**impact, mass=arguments.mass):
        impact["thickness"] = chosen.wall(arguments, model.pair.given[1], impact["thickness"])
        return ask(**impact, mass=arguments.mass, **more)


def uncertainty(arguments: Namespace, model: ImpactModel, sizes: Mapping[str, Array]) -> Uncertainty:
    """Find the bands of impacts."""
    errors = {name: getattr(arguments, name) for name in ERRORS}
    found: Uncertainty = answer(model.uncertainty, arguments, model, sizes, **errors)
    return found


def _oblique(arguments: Namespace, model: ImpactModel, sizes: dict[str, Array]) -> dict[str, Any]:
    """Integrate oblique impacts: a few of them need no table of the model."""
    within("angle", sizes["angle"], 0.0, 89.999, "degrees from the normal")
    inclined, radius, friction = np.radians(sizes["angle"]), sizes["radius"], sizes["friction"]
    speed, sliding = sizes["speed"] * np.cos(inclined), sizes["speed"] * np.sin(inclined)
    more = {"sliding_speed": sliding, "friction": friction, "method": "solve"}
    hit = answer(model.oblique, arguments, model, sizes | {"speed": speed}, **more)
    changed = sliding - hit.sliding_speed
    return {
        **vars(hit),
        "spin": (1.0 - 1.0 / POINT) * changed / radius,
        "rebound_angle": np.degrees(np.arctan2(sliding - changed / POINT, hit.restitution * speed)),
    }
