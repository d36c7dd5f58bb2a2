"""Bead on bead."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw.evaluation import table_for, tabulated
from contactlaw.laws import DEFAULT, Law
from contactlaw.physical.arguments import broadcast, check, shaped
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.physical.scaling import law_of, scales, sphere_on_sphere

Array = NDArray[np.float64]


def restitution_sphere_sphere(
    sphere: Material | str,
    other: Material | str,
    speed: ArrayLike,
    radius: ArrayLike,
    other_radius: ArrayLike,
    *,
    law: str | Law = DEFAULT,
) -> float | Array:
    """Coefficient of restitution of bead on bead: the bulk limit.

    Parameters
    ----------
    sphere, other : Material or str
        Materials of the two spheres; the weaker one yields.
    speed : array_like
        Normal approach speed [m/s].
    radius, other_radius : array_like
        Radii [m].
    law : str or Law, optional
        Normal force law, as in `ImpactModel`.

    Returns
    -------
    float or ndarray of float64

    Raises
    ------
    ValueError
        As `ImpactModel` and `ImpactModel.restitution` do.

    Notes
    -----
    The plate's law with lambda = 0, R* = R1 R2/(R1 + R2) and m* = m1 m2/(m1 + m2): no wave carries
    energy off.

    Examples
    --------
    >>> import contactlaw as cl
    >>> bead = "gamma-alumina"
    >>> cl.restitution_sphere_sphere(bead, bead, [20.0, 80.0], 1e-3, 1e-3).round(4)
    array([0.9616, 0.6966])
    """
    pair = Pair(sphere, other)
    v, r, o, shape = broadcast(speed=speed, radius=radius, other_radius=other_radius)
    check(speed=v, radius=r, other_radius=o)
    if (pair.plate.yield_strength or math.inf) < (pair.sphere.yield_strength or math.inf):
        pair, r, o = Pair(pair.plate, pair.sphere), o, r
    chosen = law_of(pair, law)
    units = scales(sphere_on_sphere(pair, chosen, r, o), v)
    found, _ = tabulated(chosen, table_for(chosen, None).packed, units, "raise")
    return shaped(found.restitution, shape)
