"""Where the modified Zener model may be trusted."""

from __future__ import annotations

import enum
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw._jit import kernel
from contactlaw.laws import Law
from contactlaw.physical.arguments import broadcast, check, shaped
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair

Array = NDArray[np.float64]

_THINNEST = 1.8  # R/H; Peng et al. 2021, section 4.4 and Fig. 8: H >= 0.556 R
_YIELDED = 2.0  # V0/V_Y0; our choice, between 1.5 and 3.5 of our finite elements
_FASTEST = 7.0  # V0/V_Y0; Peng et al. 2021, section 4.1: their finite elements reach no further
_AHEAD = 1.5  # way of the fastest waves that matter over that of the contact's own; see below
_TRANSITS = 6.0  # contact time over H/c_L; Koller & Kolsky 1987 and Boettcher et al. 2017: 6 to 8


class Validity(enum.IntFlag):
    """Limits of the model that an impact exceeds; 0 is inside all of them.

    What the model leaves out altogether (oblique impact, friction, adhesion, viscosity, strain
    rate, coatings) raises no flag. In finite elements of normal impacts friction of 0.1 lowers the
    COR by 0.006 to 0.007.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> model.lookup(speed=5.0, radius=0.9e-3, thickness=0.3e-3).flags
    <Validity.THIN_PLATE: 1>
    """

    THIN_PLATE = 1
    """R/H > 1.8: the plate's deflection is no longer small (Peng et al. 2021, section 4.4). At
    R/H = 2.5 the COR is up to 7.4 % above finite elements up to 7 V_Y0, 19 % at 14 V_Y0."""
    FAST_IMPACT = 2
    """V0 > 7 V_Y0: beyond the paper's finite elements. At 10 and 14 V_Y0 the COR is within 3 % of
    ours up to R/H = 1, and 5 and 9 % too high at R/H = 1.8."""
    THICK_PLATE = 4
    """Contact shorter than 6 thickness transits of the pressure wave: bending has no time to
    develop. The inelasticity is small there and the COR near its bulk value all the same."""
    SOFT_PLATE = 8
    """The plate's yield strength is below the sphere's: the plate yields first, the law has the
    sphere yield."""
    CLAMPED = 16
    """Outside the table; the value is that of the table's border (``outside="clamp"``)."""
    OTHER_LAW = 32
    """V0 > 2 V_Y0, and finite elements favour another contact law for the sphere's yield strain
    sigma_Y/E: ``"myc"`` from 1/40 to 1/20 (the paper's alumina has 1/26), ``"jackson_green"`` and
    ``"kogut_etsion"`` below 1/60, as metals have. There, at 7 V_Y0, the COR of ``"myc"`` is 7 to
    11 % too low, and theirs from 1 % too low on thick plates to 6 % too high on thin ones; at 1/26
    theirs is 10 to 12 % too high. From 1/60 to 1/40 each errs by 4 to 6 %, and above 1/20 none
    holds: at 1/13 all are 30 % too high or more."""


class Limits(NamedTuple):
    """What the limits of a pair and its law are, for kernels."""

    slowness: float  # of the pressure wave in the plate [s/m]
    always: int  # flags of every impact
    yielded: int  # flags of an impact beyond `_YIELDED`


def limits(pair: Pair, law: Law) -> Limits:
    """Limits of the model for a pair."""
    nu = pair.plate.poissons_ratio
    # E (1 - nu)/((1 + nu)(1 - 2 nu)) is infinite for an incompressible plate: no transit time then
    slowness = math.sqrt(
        pair.plate.density / pair.plate.youngs_modulus * (1 + nu) * (1 - 2 * nu) / (1 - nu)
    )
    strength = pair.plate.yield_strength
    soft = strength is not None and strength < (pair.sphere.yield_strength or 0.0)
    least, largest = law.yield_strains
    strain = (pair.sphere.yield_strength or 0.0) / pair.sphere.youngs_modulus
    other = not least <= strain <= largest
    return Limits(slowness, soft * int(Validity.SOFT_PLATE), other * int(Validity.OTHER_LAW))


@kernel
def flags_of(
    limits: Limits, radius: float, thickness: float, yield_ratio: float, contact_time: float
) -> int:
    """Flag an impact."""
    flags = limits.always
    if radius > _THINNEST * thickness:
        flags |= _THIN_PLATE
    if thickness < math.inf and contact_time < _TRANSITS * thickness * limits.slowness:
        flags |= _THICK_PLATE
    if yield_ratio < _Y_YIELDED:
        flags |= limits.yielded
        if yield_ratio < _Y_FASTEST:
            flags |= _FAST_IMPACT
    return flags


# V0/V_Y0 = (5/4)^(1/2) y^(-5/4): a half-space impact at V_Y0 has w_m = y = (5/4)^(2/5)
_Y_YIELDED, _Y_FASTEST = ((math.sqrt(1.25) / ratio) ** 0.8 for ratio in (_YIELDED, _FASTEST))
_THIN_PLATE, _FAST_IMPACT, _THICK_PLATE = (
    int(flag) for flag in (Validity.THIN_PLATE, Validity.FAST_IMPACT, Validity.THICK_PLATE)
)


def edge_distance(plate: Material, thickness: ArrayLike, contact_time: ArrayLike) -> float | Array:
    """Distance to the nearest edge from which no bending wave returns during the contact [m].

    The model's plate is infinite; a wave that comes back from an edge would return energy to the
    sphere. Bending waves of the contact's own frequency w = pi/contact_time travel at the group
    speed c_g = 2 (D w^2/(rho2 H))^(1/4), there and back. Faster ones, which the start of the
    contact sends out, run ahead of them: the distance is 1.5 times c_g contact_time/2.

    Parameters
    ----------
    plate : Material
        Material of the plate.
    thickness : array_like
        Thickness of the plate [m].
    contact_time : array_like
        Duration of the contact [s], as in `Rebound.contact_time`.

    Returns
    -------
    float or ndarray of float64
        Distance [m]; ``inf`` for a half-space, which has no bending waves.

    Raises
    ------
    ValueError
        If a number is not positive.

    Notes
    -----
    Dispersion of thin plates, as in Cremer, Heckl, Structure-Borne Sound, chapter II. The factor
    is that of finite elements (gamma-alumina on glass, R/H = 1.5, at the yield speed, a free edge):
    beyond the distance given here the edge changes the COR by less than 0.2 %; at 1/1.5 of it by
    2.3 %, at 0.8/1.5 by 9 %.

    Examples
    --------
    >>> import contactlaw as cl
    >>> round(cl.edge_distance(cl.material("glass"), 1e-3, 6e-6), 4)
    0.0082
    """
    h, time, shape = broadcast(thickness=thickness, contact_time=contact_time)
    check(thickness=h, contact_time=time)
    # c_g t/2 with w = pi/t, and D/(rho2 H) = E2' H^2/(12 rho2)
    wave_speed = math.sqrt(plate.plane_modulus / plate.density)
    return shaped(_AHEAD * np.sqrt(math.pi * time * wave_speed * h / math.sqrt(12.0)), shape)
