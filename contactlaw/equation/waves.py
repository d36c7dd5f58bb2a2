"""How a plate differs from a dashpot: the next orders of what it gives way to a force.

An infinite thin plate is a dashpot. A real one radiates more the faster the force changes: shear
and rotary inertia first, then waves through the thickness, until in a contact that is over before
the lower face has answered it is a half-space. Over an impact all of that is a factor Phi on the
plate's mobility, and so on lambda. It depends on h = H/(c T), the thickness over the way of a shear
wave in the contact time T:

    Phi = 1 + k1 h + ...     h << 1
    Phi = k2 h^2             h > h_c = c_L/(2 c): no echo comes back in time

with k2 h^2 + (1 - x)^3 P(x), x = h/h_c < 1 and a polynomial P, from one limit to the other, which
lets Phi/h^2 never rise: a thicker plate takes no more. And in
phase with the force a plate gives way less than the half-space of Hertz's law, by F/(E2' H) times a
number that falls as -ln h: the contact is stiffer, K exp(2.5 eta), T = T_H exp(-eta), with

    eta = (R/H) ((b + b_h g) x E1'/(E1' + E2') + b4 x^4),    x = sqrt(d/R)
    g = (h - h_0)/(h + h_0),  which is ln(h/h_0)/2 near h_0 and ends at 1

at the compression d = V0 T_H of an elastic impact, with h over the contact time with losses; beyond
yield the force grows no faster than d, and x stays at x_s, as it was at a few times the yield
speed. The last term is empirical: contacts as wide as the plate is thick are stiffer still. Beyond
yield little of the compression comes back, so that it counts that a plate which gives way less than
a half-space stores less, too: in proportion to (R/H) x E1'/(E1' + E2'). Since that does not come
back either, it is in lambda, which grows by b_p (R/H) (x - x_s) E1'/(E1' + E2'). See
``validation/derivations/mobility.md``.

The contact time is that of an elastic impact: 3.2181 T without losses, longer by a factor
1 + 0.175 lambda + 0.18 lambda^3 as far as the frequencies count that it is made of, and by its
square in g, where lambda is that of a thin plate.

Legend: c, c_L speeds of shear and pressure waves, nu Poisson's ratio.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel

Array = NDArray[np.float64]

CONTACT_TIME = 3.2181  # [T_H], without losses; Johnson 1985, Eq. 11.24
SATURATION = 3.0  # V0 T_H over d_Y, by its root, from which on eta stays
WIDEST = 0.3  # x up to which its fourth power was fitted; it stays from there on
DEEPEST = 0.317  # x up to which finite elements reach, d = R/10; the first term stays likewise
# Contact radius over thickness, (R/H) x, from which on the first term of eta stays. Finite elements
# reach 1. Without a bound exp(eta) overflows for soft beads at high speeds.
BROADEST = 10.0
LONGER, LONGER_3 = 0.175, 0.18  # with lambda and its third power; the second by finite elements
# lambda up to which g follows that. From 2 on the third power outgrows contact times, and would let
# lambda rise with the thickness.
LONGEST = 1.25
USUAL = 0.02  # h_0
_RANGE = (0.0, 0.45)  # of nu; c_L has no bound towards 0.5
# p2 to p5, each by powers of 1/h_c - _CENTRE; from ``python -m validation.derivations.mobility``
_CENTRE = 1.07
_NEAR = np.array(
    [
        [1.334, 5.703, -1.657, -51.933, 35.187],
        [39.05, -46.355, -99.302, 935.094, -1179.11],
        [-113.977, 392.865, -58.891, -3119.348, 5001.479],
        [77.375, -448.361, 404.135, 2605.629, -5256.22],
    ]
)


class Waves(NamedTuple):
    """Next orders of a plate, as kernels take them. All zero: there are none."""

    eta: float  # first term of eta at R = H, h = h_0 and x = 1
    eta_h: float  # what h adds to it
    eta4: float  # last term
    beyond: float  # what lambda grows by at R = H and x = x_s + 1
    steepest: float  # 1/h_c
    bulk_factor: float  # k2
    p1: float  # P = 1 + p1 x + p2 x^2 + p3 x^3 + p4 x^4 + p5 x^5
    p2: float
    p3: float
    p4: float
    p5: float


THIN = Waves(*[0.0] * 11)
"""The plate of the paper, a dashpot at any frequency."""


def waves(
    poissons_ratio: float,
    eta: float = 0.0,
    eta_h: float = 0.0,
    eta4: float = 0.0,
    beyond: float = 0.0,
) -> Waves:
    """Next orders of plates with this Poisson's ratio; b, b_h, b_p by E1'/(E1' + E2'), and b4.

    Examples
    --------
    >>> one = waves(0.3)
    >>> [round(one.bulk_factor * h**2 + near_field(one, h), 2) for h in (0.0, 0.1, 1.0)]
    [1.0, 1.12, 6.1]
    """
    nu = min(max(poissons_ratio, _RANGE[0]), _RANGE[1])
    h_c = 0.5 * math.sqrt(2.0 * (1.0 - nu) / (1.0 - 2.0 * nu))
    k1 = 0.54268 * math.sqrt(6.0 * (1.0 - nu))
    d = nu - 0.3
    k2 = 6.0994 - 4.8895 * d + 6.5469 * d**2 + 7.4075 * d**3
    others = (_NEAR @ (1.0 / h_c - _CENTRE) ** np.arange(5)).tolist()
    return Waves(eta, eta_h, eta4, beyond, 1.0 / h_c, k2, 3.0 + k1 * h_c, *others)


@kernel(inline=True)
def is_thin(waves: Waves) -> bool:
    """Whether a plate is the paper's."""
    return waves.bulk_factor == 0.0


@kernel(inline=True)
def _lengthening(lam: float) -> float:
    """Contact time over that without losses, as far as the frequencies count."""
    return 1.0 + LONGER * lam + LONGER_3 * (lam * lam * lam)


@kernel(inline=True)
def stiffening(waves: Waves, ratio: float, x: float, thin: float, h: float) -> float:
    """Stiffening eta of a contact by its plate, from R/H, x, and lambda and h before it."""
    longer = _lengthening(min(thin, LONGEST))
    usual = USUAL * (longer * longer)  # by finite elements; the end of a long contact counts
    g = 1.0 - 2.0 * usual / (h + usual)
    square = min(x * x, WIDEST * WIDEST)
    w = min(x, DEEPEST, BROADEST / ratio)
    return ratio * ((waves.eta + waves.eta_h * g) * w + waves.eta4 * (square * square))


@kernel(inline=True)
def near_field(waves: Waves, h: float) -> float:
    """Phi less its half-space part k2 h^2; 0 for an h that is infinite, or no number."""
    x = h * waves.steepest
    powers = 1.0 + x * (waves.p1 + x * (waves.p2 + x * (waves.p3 + x * (waves.p4 + x * waves.p5))))
    left = 1.0 - x
    return left * left * left * powers if x < 1.0 else 0.0


@kernel(inline=True)
def with_waves(waves: Waves, thin: float, h: float, bulk: float, plastic: float) -> float:
    """Inelasticity lambda, all orders in.

    From lambda of the thin plate, h for a loss-free contact, the product of the first with the
    square of the second, which stays finite on a half-space, and (R/H) (x - x_s) beyond yield.
    Only what acts as a dashpot lengthens the contact, near_field's share of lambda. The whole
    lambda of a thin plate does not: it would shorten the contact, and raise lambda, as a thick
    plate becomes thicker.
    """
    longer = 1.0 / _lengthening(thin * near_field(waves, h))
    far = waves.bulk_factor * bulk * (longer * longer)
    return thin * near_field(waves, h * longer) + far + waves.beyond * plastic
