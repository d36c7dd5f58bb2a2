"""Reading what every record says of its run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py

from contactlaw.engines import layout
from dem_demo.kit.recorder import COMPLETE, PARTIAL


def closed(file: h5py.File, path: Path, name: str, schema: int) -> dict[str, Any]:
    """Attributes of a record of a scene; a `ValueError` if it is something else or is open."""
    attributes = dict(file.attrs)
    form, found, state = (attributes.get(name) for name in ("format", "schema", "state"))
    wanted = layout.FORMAT + name
    if (form, found) != (wanted, schema) or state not in (COMPLETE, PARTIAL):
        raise ValueError(
            f"{path}: not a closed file of format {wanted!r}, schema {schema}, but "
            f"format {form!r}, schema {found}, state {state}: run the {name} again"
        )
    return attributes


def common(attributes: dict[str, Any]) -> dict[str, Any]:
    """Collect what made a run, which every scene tells, by the names that a run has for it."""
    names = "law", "engine", "command", "created", "reason"
    versions = {
        name.removeprefix("version_"): text
        for name, text in attributes.items()
        if name.startswith("version_")
    }
    return {
        **{name: attributes[name] for name in names},
        "constant_cor": attributes.get("constant_cor"),
        "versions": versions,
    }
