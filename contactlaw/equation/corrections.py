"""How a real plate differs from a dashpot: in its mobility, and in the stiffness of the contact.

An infinite thin plate is a dashpot. A real plate radiates more the faster the force changes: first
by shear and rotary inertia, then by waves through the thickness. In a contact that ends before the
lower face has sent an echo it is a half-space. Over an impact this is a factor Phi on the plate's
mobility, and so on lambda. It depends on h = H/(c T), the thickness over the distance that a shear
wave covers in the contact time T:

    Phi = 1 + k1 h + ...                      h << 1
    Phi = k2 h^2 + (1 - h/h_c)^3 P(h/h_c)     h < h_c = c_L/(2 c), with a polynomial P
    Phi = k2 h^2                              h > h_c: no echo comes back in time

P is such that Phi/h^2 never rises: a thicker plate takes no more energy. The part of the plate's
deflection that is in phase with the force is smaller than that of Hertz's half-space, by F/(E2' H)
times a number that falls as -ln h. So the contact is stiffer: K grows by the factor exp(2.5 eta),
T_H shrinks by exp(-eta), with

    eta = (R/H) ((b + b_h g) x E1'/(E1' + E2') + b4 x^4),    x = sqrt(d/R)
    g = (h - h_0)/(h + h_0),  which is ln(h/h_0)/2 near h_0 and ends at 1

at the compression d = V0 T_H of an elastic impact, and with h of a contact with losses. Beyond
yield the force grows no faster than d, and x stays at x_s = 3 sqrt(d_Y/R), its value at about 17
times the yield speed. The last term is empirical: contacts as wide as the plate is thick are
stiffer still. Because the plate gives way less than a half-space it stores less energy, in
proportion to (R/H) x E1'/(E1' + E2'). Where x is above x_s, little of the compression is recovered,
and that energy is lost too: lambda grows by b_p (R/H) (x - x_s) E1'/(E1' + E2'). See
``validation/derivations/mobility.md``.

The contact time is that of an elastic impact, 3.2181 T_H without losses. With losses it is longer
by f = 1 + 0.175 lambda + 0.18 lambda^3 in Phi, and by f^2 in g, with lambda of a thin plate in g.

Legend: c, c_L speeds of shear and pressure waves, nu Poisson's ratio.
"""

import math
from typing import NamedTuple

import numpy as np

from contactlaw._jit import kernel

CONTACT_TIME = 3.2181  # [T_H], without losses; Johnson 1985, Eq. 11.24
SATURATION = 3.0  # x_s/sqrt(d_Y/R): beyond it x is constant in eta
WIDEST = 0.3  # x up to which x^4 in eta was fitted; constant beyond
DEEPEST = 0.317  # x up to which finite elements reach, d = R/10; the first term is constant beyond
# Contact radius over thickness, (R/H) x, from which on the first term of eta is constant. Finite
# elements reach 1. Without a bound exp(eta) overflows for soft beads at high speeds.
BROADEST = 10.0
# Factors of lambda and lambda^3 in f; the second is fitted to finite elements.
LENGTHENING, LENGTHENING_3 = 0.175, 0.18
# Largest lambda of f in g; f is constant beyond. From 2 on it would grow faster than contact times
# do, and lambda would rise with the thickness.
LONGEST = 1.25
H_0 = 0.02  # h_0
_RANGE = (0.0, 0.45)  # others are taken as the nearer end: c_L is infinite at nu = 0.5
# p2 to p5, each in powers of 1/h_c - _CENTRE; from ``python -m validation.derivations.mobility``
_CENTRE = 1.07
_NEAR = np.array(
    [
        [1.334, 5.703, -1.657, -51.933, 35.187],
        [39.05, -46.355, -99.302, 935.094, -1179.11],
        [-113.977, 392.865, -58.891, -3119.348, 5001.479],
        [77.375, -448.361, 404.135, 2605.629, -5256.22],
    ]
)


class PlateCorrections(NamedTuple):
    """Corrections of a plate to the thin-plate dashpot, for kernels; all are 0 for the dashpot."""

    eta: float  # first term of eta at R = H, h = h_0 and x = 1
    eta_h: float  # factor of g in that term
    eta4: float  # last term of eta
    plastic_growth: float  # growth of lambda beyond yield at R = H and x = x_s + 1
    steepest: float  # 1/h_c
    bulk_factor: float  # k2
    p1: float  # P = 1 + p1 x + p2 x^2 + p3 x^3 + p4 x^4 + p5 x^5
    p2: float
    p3: float
    p4: float
    p5: float


THIN = PlateCorrections(*[0.0] * 11)
"""The plate of the paper, a dashpot at any frequency."""


def plate_corrections(
    poissons_ratio: float, eta: float = 0.0, eta_h: float = 0.0, eta4: float = 0.0, plastic_growth: float = 0.0
) -> PlateCorrections:
    """Corrections for plates of this Poisson's ratio.

    `eta`, `eta_h` and `plastic_growth` are b, b_h and b_p times E1'/(E1' + E2'), `eta4` is b4.

    Examples
    --------
    >>> one = plate_corrections(0.3)
    >>> [round(one.bulk_factor * h**2 + near_field(one, h), 2) for h in (0.0, 0.1, 1.0)]
    [1.0, 1.12, 6.1]
    """
    nu = min(max(poissons_ratio, _RANGE[0]), _RANGE[1])
    h_c = 0.5 * math.sqrt(2.0 * (1.0 - nu) / (1.0 - 2.0 * nu))
    k1 = 0.54268 * math.sqrt(6.0 * (1.0 - nu))
    d = nu - 0.3
    k2 = 6.0994 - 4.8895 * d + 6.5469 * d**2 + 7.4075 * d**3
    others = (_NEAR @ (1.0 / h_c - _CENTRE) ** np.arange(5)).tolist()
    return PlateCorrections(eta, eta_h, eta4, plastic_growth, 1.0 / h_c, k2, 3.0 + k1 * h_c, *others)


@kernel(inline=True)
def is_thin(corrections: PlateCorrections) -> bool:
    """Whether a plate is the paper's dashpot, without corrections."""
    return corrections.bulk_factor == 0.0


@kernel(inline=True)
def _lengthening(lam: float) -> float:
    """Factor f by which losses lengthen the contact in Phi."""
    return 1.0 + LENGTHENING * lam + LENGTHENING_3 * (lam * lam * lam)


@kernel(inline=True)
def eta_of(corrections: PlateCorrections, ratio: float, x: float, thin: float, h: float) -> float:
    """Stiffening eta of a contact by its plate, from R/H, x, and lambda and h without eta."""
    longer = _lengthening(min(thin, LONGEST))
    usual = H_0 * (longer * longer)  # f squared fits finite elements: late times count more
    g = 1.0 - 2.0 * usual / (h + usual)
    square = min(x * x, WIDEST * WIDEST)
    w = min(x, DEEPEST, BROADEST * (1.0 / ratio))
    return ratio * ((corrections.eta + corrections.eta_h * g) * w + corrections.eta4 * (square * square))


@kernel(inline=True)
def near_field(corrections: PlateCorrections, h: float) -> float:
    """Phi minus its half-space part k2 h^2; 0 if h is infinite or NaN."""
    x = h * corrections.steepest
    powers = 1.0 + x * (
        corrections.p1 + x * (corrections.p2 + x * (corrections.p3 + x * (corrections.p4 + x * corrections.p5)))
    )
    left = 1.0 - x
    return left * left * left * powers if x < 1.0 else 0.0


@kernel(inline=True)
def with_corrections(corrections: PlateCorrections, thin: float, h: float, bulk: float, plastic: float) -> float:
    """Inelasticity lambda with all corrections.

    `thin` is lambda of the thin plate, `h` is taken without losses, `bulk` is thin h^2, which stays
    finite on a half-space, and `plastic` is (R/H) (x - x_s) beyond yield. Only the part of
    lambda that acts as a dashpot, thin near_field, lengthens the contact. With the whole lambda of
    a thin plate the contact would shorten, and lambda rise, as a thick plate becomes thicker.
    """
    longer = 1.0 / _lengthening(thin * near_field(corrections, h))
    far = corrections.bulk_factor * bulk * (longer * longer)
    return thin * near_field(corrections, h * longer) + far + corrections.plastic_growth * plastic
