"""Radial return for a flow stress that hardens and depends on the rate, implicit in both.

With steps of a nanosecond the rate of a step's strain increment x moves the flow stress seven times
as much as the elastic part of the increment does: a fixed-point iteration gives a rate effect of
the wrong sign. So the increment solves

    s - 3 G x = (A + B (eps + x)^n) (1 + C ln(x/(dt rate0))),    rates below rate0 count as rate0

with s von Mises' stress of the elastic trial. The left side falls and the right side rises: there
is one root, between 0 and what the body would flow without any rise.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from contactlaw._jit import kernel
from contactlaw.physical.flow import Flow

_ACCURACY = 1e-13  # of the increment
_STEPS = 100


class FlowStress(NamedTuple):
    """Constants of the flow stress, see `contactlaw.physical.flow.Flow`."""

    strength: float  # A [Pa]; inf: elastic
    hardening: float  # B [Pa]
    exponent: float  # n
    rate: float  # C
    rate0: float  # [1/s]


ELASTIC = FlowStress(math.inf, 0.0, 1.0, 0.0, 1.0)


def flow_stress(flow: Flow | None) -> FlowStress:
    """Flow stress of a material, as kernels read it."""
    return ELASTIC if flow is None else FlowStress(*flow)


@kernel(inline=True)
def slow_stress(flow: FlowStress, strain: float) -> float:
    """Flow stress in a slow test; without hardening no power is taken."""
    if flow.hardening == 0.0:
        return flow.strength
    return flow.strength + flow.hardening * math.pow(strain, flow.exponent)


@kernel
def returned(flow: FlowStress, trial: float, strain: float, shear: float, dt: float) -> tuple[float, float]:
    """Plastic strain of a step and the stress after it; the trial is above the slow flow stress."""
    stress = slow_stress(flow, strain)
    low, high = 0.0, (trial - stress) / (3.0 * shear)
    if flow.hardening == 0.0 and flow.rate == 0.0:
        return high, stress
    x = high
    for _ in range(_STEPS):
        whole = strain + x
        slow, factor, by_rate = slow_stress(flow, whole), 1.0, 0.0
        if x > dt * flow.rate0:
            factor += flow.rate * math.log(x / (dt * flow.rate0))
            by_rate = slow * flow.rate / x
        over = trial - 3.0 * shear * x - slow * factor
        if over > 0.0:
            low = x
        else:
            high = x
        by_strain = flow.hardening * flow.exponent * math.pow(whole, flow.exponent - 1.0) * factor
        moved = x + over / (3.0 * shear + by_strain + by_rate)
        if not low < moved < high:
            moved = 0.5 * (low + high)
        if abs(moved - x) <= _ACCURACY * moved:
            break
        x = moved
    return x, trial - 3.0 * shear * x
