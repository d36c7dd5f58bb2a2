"""Spheres that hit layered plates and curved shells: ``python -m validation.fem.walls``.

Elastic impacts, some seconds each, beside the law `fem`. Layers are taken as the thickness of a
plate of the top layer's material that answers with the same speed; shells are meshed as they are,
and nothing of finite elements knows of R*, of bending or of Bessel functions. All bodies have
Poisson's ratio 0.3 in the plate. Error is the COR of the model less that of finite elements.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import contactlaw as cl
from validation.fem.impact import impact
from validation.fem.mesh import Layer

RADIUS, SPEED = 1e-3, 2.0  # [m, m/s]
BALL = cl.Material("ball", 70e9, 0.22, 2500, kind="ceramic")
_BODIES = {"steel": (200e9, 7850), "aluminium": (70e9, 2700), "ceramic": (380e9, 3900), "stone": (40e9, 2500)}
_BODIES |= {"polymer": (3e9, 1200), "soft polymer": (1e9, 1000)}
BODIES = {name: cl.Material(name, e, 0.3, rho, kind="ceramic") for name, (e, rho) in _BODIES.items()}
Plate = tuple[tuple[str, float], ...]  # layers from the top: material, thickness [mm]
_SHARES = (1.0, 0.03), (1.0, 0.1), (0.5, 0.1), (1.0, 0.25), (1.0, 0.5), (0.5, 0.5), (3.0, 0.2)
_TOPS = (
    ("aluminium", "steel"),
    ("ceramic", "steel"),
    ("stone", "steel"),
    ("polymer", "steel"),
    ("soft polymer", "steel"),
)
LINERS: tuple[Plate, ...] = tuple(
    ((top, share * whole), (below, (1.0 - share) * whole))
    for top, below in (*_TOPS, ("steel", "aluminium"), ("steel", "polymer"))
    for whole, share in (_SHARES if below == "steel" else _SHARES[3:])
)
CORES: tuple[Plate, ...] = tuple((("steel", 0.4), (core, 0.4), ("steel", 0.4)) for core in ("aluminium", "polymer"))
SHELLS = tuple((thickness, wall) for thickness in (0.5, 0.8) for wall in (10.0, -10.0, 15.0, -15.0))  # [mm]


class Compared(NamedTuple):
    """One impact, and the model beside it."""

    restitution: float  # of finite elements
    error: float  # of the COR
    liner: float  # thickness of the top layer over the radius of the contact
    flags: cl.Validity


def layered(plate: Plate, size: float = 0.02) -> Compared:
    """Compare an impact on layers; the elements are at most of this size [RADIUS]."""
    whole = cl.Layers([(BODIES[name], 1e-3 * thick) for name, thick in plate])
    top = whole.material
    layers = tuple(
        Layer(thick, body.density / top.density, body.youngs_modulus / top.youngs_modulus)
        for body, thick in whole.layers
    )
    pair = cl.Pair(BALL, top)
    hit = cl.ImpactModel(pair).solve(SPEED, RADIUS, whole)
    contact = math.sqrt(RADIUS * float(hit.peak_compression))
    depth = sum(layer.thickness for layer in layers)
    fine = min(size, contact / RADIUS / 5.0)
    found = impact(pair, SPEED, RADIUS, depth, yields=False, size=fine, layers=layers).restitution
    return Compared(found, float(hit.restitution) - found, whole.top / contact, cl.Validity(int(hit.flags)))


def curved(thickness: float, wall: float, size: float = 0.02) -> Compared:
    """Compare an impact on a spherical shell of steel; lengths in mm, negative outside."""
    pair, sizes = cl.Pair(BALL, BODIES["steel"]), (1e-3 * thickness, 1e-3 * wall)
    hit = cl.ImpactModel(pair).solve(SPEED, RADIUS, cl.Shell(*sizes, "sphere"))
    size = min(size, math.sqrt(float(hit.peak_compression) / RADIUS) / 5.0)
    found = impact(pair, SPEED, RADIUS, sizes[0], yields=False, size=size, wall=sizes[1], shell=True).restitution
    return Compared(found, float(hit.restitution) - found, math.inf, cl.Validity(int(hit.flags)))


def main() -> None:
    """Print a table."""

    def rows() -> Iterator[tuple[str, Compared]]:
        for plate in LINERS + CORES:
            yield ", ".join(f"{thick:.3g} mm {name}" for name, thick in plate), layered(plate)
        for one in SHELLS:
            yield "{} mm of steel, curved by {} mm".format(*one), curved(*one)

    for name, one in rows():
        liner = "" if one.liner == math.inf else f", liner of {one.liner:.1f} contact radii"
        print(
            f"{name}: COR {one.restitution:.3f}, of the model {one.error:+.4f}{liner} {one.flags.name or ''}",
            flush=True,
        )


if __name__ == "__main__":
    main()
