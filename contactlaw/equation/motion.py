"""The equation of motion of a contact, made of a force, a plate and losses.

It is Eq. 1 of Peng et al. 2021 in its first-order form,

    du/dt = -f,    dd/dt = u - v(f),    d(0) = 0,  u(0) = u0 = y^(-5/4),

where v is the speed of the plate at the contact. The plate is a dashpot, as in the paper: v = beta f.
Real plates differ from it by a factor on the mobility beta (`contactlaw.equation.corrections`) and by
the memory of what a near edge sends back (`contactlaw.equation.near_edge`). A force that starts
like d^1.5 has no second derivative at d = 0, where a Runge-Kutta method would lose its order. So q
replaces d (dr = 0 while loading) and ds = dt/(2 q) replaces dt. This is exact, and for Hertz's law,
f = q^3, the equation becomes polynomial:

    dq/ds = u - v(f),    du/ds = -2 q f,    dt/ds = 2 q

Where a sphere would stay on its plate, see `contactlaw.equation.integrator`, v falls to 0 as the
energy that is left does.

Legend. The law's scale: compressions in d_Y, forces in F_Y, time in T_Y = sqrt(m d_Y/F_Y).

    d   compression                          u      speed of the sphere towards the plate
    f   contact force                        y      yield compression, d_Y/(V0 T_H)
    q   root compression, sqrt(d - dr)       dr     residual compression, Eq. 17
"""

from typing import NamedTuple

from contactlaw._jit import kernel
from contactlaw.equation import legs
from contactlaw.equation.force import BlendedLaw
from contactlaw.equation.legs import Leg

_SLOW = 1e8  # square of a speed over `least` from which on less than 1e-8 of v is missing


class ScaledContact(NamedTuple):
    """A contact in the law's scale: its force law and its plate."""

    law: BlendedLaw
    mobility: float  # beta, lambda y^(1/4)
    least: float  # square of the speed with which a sphere leaves that would stay


class ScaledState(NamedTuple):
    """A point on the path of a contact, in the law's scale, with the rates there."""

    q: float
    u: float
    t: float
    work: float  # of the waves, over the plate's mobility
    dq: float  # dq/ds
    du: float  # du/ds
    f: float


@kernel(inline=True)
def left(leg: Leg, q: float, u: float, f: float) -> float:
    """Square of the speed with which a sphere would leave if the plate were held from now on.

    The work of a force that falls as q^b is 2 f q^2/(b + 2).
    """
    return u * u + 4.0 * abs(f) * (q * q) / (leg.exponent + 2.0)


@kernel(inline=True)
def rates(contact: ScaledContact, leg: Leg, kind: int, q: float, u: float) -> tuple[float, float, float]:
    """dq/ds, du/ds and the force."""
    f = legs.force_on(leg, kind, contact.law, q)
    v = contact.mobility * f
    if kind == legs.POWER and u * u < _SLOW * contact.least:  # its exponent is not Hertz's: it may stay
        square = left(leg, q, u, f)
        v *= square / (square + contact.least)
    return u - v, -2.0 * q * f, f


@kernel
def start(contact: ScaledContact, leg: Leg, q: float, u: float, t: float, work: float) -> ScaledState:
    """State on a leg, with the rates there."""
    dq, du, f = rates(contact, leg, leg.kind, q, u)
    return ScaledState(q, u, t, work, dq, du, f)
