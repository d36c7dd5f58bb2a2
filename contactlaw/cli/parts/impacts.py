"""Columns of impacts, and what was asked about them."""

from typing import Any

from contactlaw.cli.parts.table import Column
from contactlaw.equation.losses import Losses
from contactlaw.equation.outcome import FIELDS
from contactlaw.model import ImpactModel

_SHOWN: dict[str, Any] = {  # title, unit and number of these in one SI unit on a terminal
    "restitution": ("COR", "-", 1.0, "", ".4f"),
    "contact_time": ("time", "us", 1e6),
    "peak_force": ("force", "N"),
    **{f"{channel}_fraction": (channel, "%", 100.0, "", ".1f") for channel in Losses._fields},
}
COLUMNS = (
    Column("speed", "m/s", "speed", "m/s", is_input=True),
    Column("radius", "m", "radius", "mm", 1e3, is_input=True),
    Column("thickness", "m", "thickness", "mm", 1e3, is_input=True),
    *(Column(name, field.unit.strip("1"), *_SHOWN.get(name, ())) for name, field in FIELDS.items()),
    Column("yield_speed", "m/s"),
)
UNITS = {column.name: column.unit for column in COLUMNS}  # in SI, "" without one


def asked(model: ImpactModel, **sizes: float | None) -> dict[str, Any]:
    """Repeat what the user asked: names of the materials and of the law, and sizes in SI units."""
    law, (sphere, plate) = model.force_law, model.pair.given
    name = law.family if law.from_pair else law.name
    units = UNITS | {"mass": "kg"}
    numbers = {f"{n}_{units[n]}": float(size) for n, size in sizes.items() if size is not None}
    return {"sphere": sphere.name, "plate": plate.name, "law": name, **numbers}
