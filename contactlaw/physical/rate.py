"""How much stronger a pair is at the rate of an impact than in a slow test: one factor per impact.

A flowing contact's strength is that at a representative rate, a share of (V0/R)(V_Y/V0)^0.3, with
V_Y the speed from which a slow pair yields on a half-space: at the deepest point, which decides
about the rebound, the flow has nearly come to rest, the more so the farther it has spread. Both the
yield strength and the hardening of a body grow by its factor 1 + C ln(rate/rate0). Where both bodies
have one, the pair's factor is that of the larger C and the lower rate0, so that it stands for one
rate wherever one of the bodies grows stronger, and each has its own factor at that rate.
"""

import dataclasses
import math

import numpy as np

from contactlaw._arrays import Array
from contactlaw.equation.numbers import RATE_POWER
from contactlaw.laws import Law
from contactlaw.laws.fem import fitted
from contactlaw.physical.flow import Flow
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair

SHARE: float = fitted()["rate"]  # representative rate over (V0/R)(V_Y/V0)^0.3
# Values of (V0/R)(V_Y/V0)^0.3 [1/s] up to which tables reach, 100 m/s at 10 micrometres of a pair
# that yields from 0.14 m/s on, and up to which laws do.
FASTEST, REACH = 1.4e6, 1e9


def flow_with_rate(pair: Pair, law: Law) -> Flow | None:
    """Flow whose factor is that of a pair in a law; None if no impact strengthens it."""
    return leading(pair) if "sphere_ratio" in law.from_pair else None


def rates(speed: Array, radius: Array) -> Array:
    """Rates (V0/R) V0^-0.3 of impacts, which times V_Y^0.3 of a pair are in 1/s."""
    return np.asarray(speed**RATE_POWER / radius)


def per_rate(pair: Pair) -> float:
    """V_Y^0.3 of a pair, which takes `rates` to 1/s."""
    return float(pair.yield_speed ** (1.0 - RATE_POWER))


def factors(pair: Pair, speed: Array, radius: Array) -> Array:
    """Strength of a pair at the rates of impacts over that of a slow test [-]."""
    flow = leading(pair)
    if flow is None:
        return np.ones_like(speed)
    relative = SHARE / flow.rate0 * per_rate(pair) * rates(speed, radius)
    return np.asarray(1.0 + flow.rate * np.log(np.maximum(relative, 1.0)))


def largest_factor(flow: Flow, fastest: float = FASTEST) -> float:
    """Largest factor of a pair at rates up to a value [1/s], by default that of tables."""
    return flow.factor(SHARE * fastest)


def strengthened(pair: Pair, factor: float) -> Pair:
    """Pair without rate, with the strengths that its bodies have where the factor is this one.

    A factor of 1 stands for rate0, or the lower one of two.
    """
    flow = leading(pair)
    rate = rate_at(flow, factor) if flow else 0.0
    return Pair(*(_strengthened(body, rate) for body in pair.bodies))


def rate_at(flow: Flow, factor: float) -> float:
    """Rate [1/s] at which a flow is stronger by a factor."""
    return flow.rate0 * math.exp((factor - 1.0) / flow.rate)


def flows(pair: Pair) -> list[Flow]:
    """Flows of the bodies that impacts strengthen; none if no impact of a table strengthens any."""
    known = [body.flow for body in pair.bodies if body.flow is not None]
    if max((largest_factor(flow) for flow in known), default=1.0) == 1.0:
        return []
    return [flow for flow in known if largest_factor(flow, REACH) > 1.0]


def leading(pair: Pair) -> Flow | None:
    """Flow of a body, with the largest C and the lowest rate0 of both."""
    known = flows(pair)
    slopes, starts = [one.rate for one in known], [one.rate0 for one in known]
    return known[0]._replace(rate=max(slopes), rate0=min(starts)) if known else None


def scaled(body: Material, factor: float) -> Material:
    """Body whose whole flow stress is larger by a factor, also where it is from a hardness."""
    flow = body.flow
    if flow is None:
        return body
    hardening = (factor * flow.hardening, flow.exponent) if flow.hardening else None
    return dataclasses.replace(body, yield_strength=factor * flow.strength, hardening=hardening)


def _strengthened(body: Material, rate: float) -> Material:
    if body.flow is None or not body.flow.rate:
        return body
    return dataclasses.replace(scaled(body, body.flow.factor(rate)), rate=None, uncertainty={})
