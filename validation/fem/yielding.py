"""Indentations in which either body or both yield, and the known results to compare them with.

- A block that yields under an elastic sphere: Tabor's mean pressure of about 3 yield strengths
  (D. Tabor, The Hardness of Metals, Oxford 1951).
- A sphere that yields, flattened by a rigid block: the mean pressure falls as the contact widens
  (R. L. Jackson, I. Green, J. Tribology 127 (2005) 343).
- A mirror, rigid and without friction: the force on a sphere of 2R pressed d/2 into it is that of
  two equal spheres of 2R pressed together by d, and, as long as the contact is small, that of a
  sphere of R pressed d into a block of its own material, since only the sum of the curvatures
  counts there. In the last, half of the plastic work is the block's; what is missing of it grows
  with a/R, which is half as large in `pair_narrow` at the same d/d_Y.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import contactlaw as cl
from validation.fem.indentation import Indentation, indent
from validation.paper.setting import PAIR, RADIUS, YIELD_COMPRESSION

Array = NDArray[np.float64]

_MODULUS, _RATIO, _DENSITY = 200e9, 0.3, 8000.0  # those of steel; only E/sigma_Y matters
_STIFFER = 1e4  # the mirror, in modulus and density: its waves are no faster
SOFT = cl.Material("soft", _MODULUS, _RATIO, _DENSITY, yield_strength=250e6)
MIRROR = cl.Material("mirror", _STIFFER * _MODULUS, _RATIO, _STIFFER * _DENSITY)
_WEAK = replace(SOFT, yield_strength=0.5 * SOFT.require_yield_strength("fem"))
EQUAL, MIRRORED = cl.Pair(SOFT, SOFT), cl.Pair(SOFT, MIRROR)
BOTH = cl.Pair(PAIR.sphere, cl.material("aluminium-6061-t6"))  # for CalculiX: both flow
BOTH_DEPTH, BOTH_SIZE = 10.0 * YIELD_COMPRESSION, 0.03  # [m], [R]
HARDENING = cl.Pair(replace(SOFT, hardening=(500e6, 0.3)), cl.Material("block", 200e9, 0.3, 8000.0))
HARDENING_DEPTH, HARDENING_SIZE = 0.03 * RADIUS, 0.03  # [m], [R]
FULLY_PLASTIC = 0.15  # a/R from which the flow is full: E* a/(sigma_Y R) is 66, on the mirror more
_SMALL = 2e-3 * RADIUS  # depth of a small contact: a/R is 0.045 [m]
_BLOCK: dict[str, Any] = {
    "pair": EQUAL,
    "depth": 0.03 * RADIUS,
    "yields": False,
    "plate_yields": True,
    "friction": 0.0,
    "slowness": 2.0,
}
_FLAT: dict[str, Any] = {"pair": MIRRORED, "depth": 0.08 * RADIUS, "friction": 0.0, "slowness": 2.0}
_PAIR: dict[str, Any] = {"pair": EQUAL, "depth": _SMALL, "plate_yields": True, "size": 0.004, "friction": 0.0}
_MIRROR: dict[str, Any] = {
    "pair": MIRRORED,
    "radius": 2.0 * RADIUS,
    "depth": 0.5 * _SMALL,
    "size": 0.002,
    "friction": 0.0,
}
_NARROW = {"pair": cl.Pair(_WEAK, _WEAK), "depth": 0.25 * _SMALL, "size": 0.002}
_ELASTIC = {"yields": False, "plate_yields": False}
JOBS: dict[str, dict[str, Any]] = {
    "block": {**_BLOCK, "size": 0.01},
    "block_coarse": {**_BLOCK, "size": 0.02},
    "flat": {**_FLAT, "size": 0.01},
    "flat_coarse": {**_FLAT, "size": 0.02},
    "pair": _PAIR,
    "pair_narrow": {**_PAIR, **_NARROW},
    "pair_elastic": {**_PAIR, **_ELASTIC},
    "mirror": _MIRROR,
    "mirror_elastic": {**_MIRROR, **_ELASTIC},
    "both": {"pair": BOTH, "depth": BOTH_DEPTH, "size": BOTH_SIZE, "plate_yields": True},
}


def press(name: str, **changed: Any) -> Indentation:
    """Compute one of the indentations, or a coarser one.

    Examples
    --------
    >>> block = press("block", size=0.1, slowness=0.1)
    >>> float(block.system.sphere.work[0]), bool(block.system.plate.work[0] > 0.0)
    (0.0, True)
    """
    return indent(**{"radius": RADIUS, **JOBS[name], **changed})


def pressures(radius: Array, force: Array, element: float) -> tuple[Array, Array]:
    """Contact radii [m] and mean pressures F/(pi a^2) [Pa] when a node joins the contact.

    The radius of a contact is known to a node. When the next one joins, the edge is there, to less
    than half an element: the pressure of one instant is wrong by up to element/a of itself, either
    way, and the mean of many by much less.

    Parameters
    ----------
    radius, force : ndarray
        Largest radius at which the surfaces press [m] and force [N], loading.
    element : float
        Smallest element [m].

    Examples
    --------
    >>> a, p = pressures(np.array([1.0, 1.0, 2.0, 2.0]), np.array([1.0, 3.0, 12.0, 20.0]), 1.0)
    >>> a, p * np.pi
    (array([2.]), array([3.]))
    """
    reached = np.maximum.accumulate(radius)
    # a surface that widens takes its nodes along, by far less than an element
    joins = np.flatnonzero(np.diff(reached) > 0.5 * element) + 1
    a = radius[joins]
    return a, force[joins] / (math.pi * a**2)


def flattened(radius_ratio: ArrayLike) -> Array:
    """Mean pressure on a fully plastic sphere over its yield strength, by Jackson and Green.

    Parameters
    ----------
    radius_ratio : array_like
        Radius of the contact over the sphere's.

    Examples
    --------
    >>> flattened([0.01, 0.3]).round(2)
    array([2.84, 2.42])
    """
    ratio = np.asarray(radius_ratio, dtype=float)
    pressure: Array = 2.84 * (1.0 - np.exp(-0.82 * ratio**-0.7))
    return pressure


def hertz(compression: Array) -> Array:
    """Force [N] on two bodies of `EQUAL`, or on their image in the mirror; total approach [m]."""
    force: Array = 2.0 / 3.0 * SOFT.plane_modulus * math.sqrt(RADIUS) * compression**1.5
    return force
