"""Columns of impacts."""

from typing import Any

from contactlaw.cli.parts.table import Column
from contactlaw.equation.losses import Losses
from contactlaw.equation.outcome import FIELDS

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
)
