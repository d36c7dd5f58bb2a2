"""Indentations in which either body yields, to which the law ``"fem"`` is fitted.

By small-strain similarity, only the compression over that at yield matters while the contact is
small beside the sphere. So each E*/sigma_Y has only depths that add information: strong materials
those near yield, soft metals those up to a tenth of the radius. They are listed in the file.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

import contactlaw as cl
from validation.fem import journal, store
from validation.fem.indentation import indent
from validation.fem.solver import SETTINGS

_ACROSS = 11  # elements in sqrt(R d), fewer than in the contact's radius
_MODULUS = 1e11  # E* [Pa]; the results do not depend on it
_DENSITY = 5000.0  # [kg/m3], likewise
_RADIUS = 1e-3  # [m]
NAME = "campaign_indentation"
SAMPLES = 48  # points of a stored curve
YIELDING = ("sphere", "plate", "both")


@dataclass(frozen=True)
class Press:
    """One indentation: E*/sigma_Y of both bodies (inf: elastic), and the depth over the radius."""

    sphere: float
    plate: float
    depth: float
    share: float = 0.5  # E1'/(E1' + E2')
    poissons_ratio: float = 0.3  # the same in both bodies
    friction: float = 0.1
    across: float = _ACROSS
    slowness: float = 1.0

    @property
    def pair(self) -> cl.Pair:
        """Materials."""
        moduli = _MODULUS / (1.0 - self.share), _MODULUS / self.share
        bodies = [
            cl.Material(
                name,
                modulus * (1.0 - self.poissons_ratio**2),
                self.poissons_ratio,
                _DENSITY,
                yield_strength=_MODULUS / ratio if ratio < math.inf else None,
            )
            for name, modulus, ratio in zip(("sphere", "plate"), moduli, (self.sphere, self.plate), strict=True)
        ]
        return cl.Pair(*bodies)


def stored() -> list[Press]:
    """Read the inputs of the stored indentations."""
    data = store.read(NAME).data
    # the file has sigma_Y/E*, 0 for elastic bodies, in place of an infinite E*/sigma_Y
    with np.errstate(divide="ignore"):
        inputs = {body: 1.0 / data[f"{body}_yield_strain"] for body in ("sphere", "plate")}
    inputs |= {name: data[name] for name in Press.__annotations__ if name in data}
    rows = zip(*(values.tolist() for values in inputs.values()), strict=True)
    return [Press(**dict(zip(inputs, row, strict=True))) for row in rows]


def press(job: Press) -> dict[str, Any]:
    """Compute an indentation; forces over K R^1.5, compressions over R."""
    size = math.sqrt(job.depth) / job.across
    found = indent(
        job.pair,
        _RADIUS,
        job.depth * _RADIUS,
        size=min(size, 0.1),
        friction=job.friction,
        yields=job.sphere < math.inf,
        plate_yields=job.plate < math.inf,
        slowness=job.slowness,
    )
    d = found.compression / _RADIUS
    f = found.force / (4.0 / 3.0 * _MODULUS * _RADIUS**2)
    top = int(d.argmax())
    end = top + int(np.argmax(np.append(f[top:] <= 1e-4 * f[top], True)))
    loading = float(np.trapezoid(np.append(0.0, f[: top + 1]), np.append(0.0, d[: top + 1])))
    left = float(np.interp(0.0, [f[end], f[end - 1]], [d[end], d[end - 1]])) if end < d.size else 0.0
    down = np.append(f[top:end], 0.0), np.append(d[top:end], left)
    share = np.linspace(0.0, 1.0, SAMPLES)
    return {
        "force": float(f[top]),
        "contact_radius": float(found.contact_radius[top]) / _RADIUS,
        "loading_work": loading,
        "unloading_work": -float(np.trapezoid(*down)),
        "plastic_work": found.plastic * loading,
        "kinetic": found.kinetic,
        "residual": left,
        "size": size,
        "elements": len(found.system.sphere.elements) + len(found.system.plate.elements),
        # at even steps of the root of compression, then of the compression while unloading
        "loading": np.interp(share**2 * d[top], d[: top + 1], f[: top + 1]).tolist(),
        "unloading": np.interp(left + share * (d[top] - left), down[1][::-1], down[0][::-1]).tolist(),
    }


def indentations(processes: int) -> None:
    """Press the hemispheres of the stored campaign into blocks again."""
    data, attributes = store.read(NAME)
    rows = journal.complete(NAME, press, stored(), processes)
    data |= {name: np.array([row[name] for row in rows]) for name in rows[0]}
    settings = {name: attributes[name] for name in ("mesh", "estimated_error")} | SETTINGS
    store.write(NAME, str(attributes["about"]), data, dict.fromkeys(data, "-"), **settings)
    journal.forget(NAME)
