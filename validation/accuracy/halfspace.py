"""The law ``"fem"`` on half-spaces, beside published closed forms."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw import Validity
from contactlaw.physical.rebound import Rebound
from validation.paper import closed_form

Array = NDArray[np.float64]

JOHNSON = -0.25  # d ln e/d ln V in full plasticity, where the mean pressure is the hardness
_CAPS = 1.65, 2.8  # pressure over sigma_Y: largest at first yield, and mean in full plasticity
_SPEED_RATIOS = 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0
_RATIOS = 100.0, 400.0, 2000.0  # E*/sigma_Y


def thornton(cap: float) -> Array:
    """COR at `_SPEED_RATIOS` by the closed form of Thornton (1997), for a cap of the pressure.

    The closed form is not fitted and does not test the law: it leaves out that the pressure grows
    from 1.65 sigma_Y at first yield to a mean of about 3, and falls on a flattened sphere.

    Examples
    --------
    >>> bool((thornton(1.65) < thornton(2.8)).all())
    True
    """
    # the speed at which the pressure reaches the cap grows with the cap to the power 5/2
    ratio = np.array(_SPEED_RATIOS) * (_CAPS[0] / cap) ** 2.5
    return closed_form.thornton(ratio)


class Fall(NamedTuple):
    """One impact on a half-space."""

    yielding: str
    ratio: float  # E*/sigma_Y
    speed_ratio: float  # V0/V_Y0
    restitution: float  # by the law, in which waves in the half-space take energy too
    slope: float  # d ln e/d ln V of the COR without the loss to these waves
    flags: Validity


def falls() -> list[Fall]:
    """Solve impacts on half-spaces by the law; those flagged DEEP_CONTACT are left out.

    Both bodies are of one modulus and density, elastic and perfectly plastic.

    Examples
    --------
    >>> all(one.slope < 0.0 for one in falls())
    True
    """
    found = []
    for yielding in ("sphere", "plate", "both"):
        for ratio in _RATIOS:
            pair = _bodies(yielding, ratio)
            v = np.array(_SPEED_RATIOS) * pair.yield_speed
            low, at, high = (_fallen(pair, v * factor) for factor in (0.97, 1.0, 1.03))
            slope = np.log(_slow(high) / _slow(low)) / math.log(1.03 / 0.97)
            for n, speed_ratio in enumerate(_SPEED_RATIOS):
                flags = Validity(int(np.asarray(at.flags)[n]))
                if flags & Validity.DEEP_CONTACT:
                    continue
                cor = float(np.asarray(at.restitution)[n])
                found.append(Fall(yielding, ratio, speed_ratio, cor, float(slope[n]), flags))
    return found


def _slow(hit: Rebound) -> Array:
    """COR without the loss to waves."""
    return np.asarray(np.sqrt(hit.restitution**2 + hit.wave_fraction))


def _bodies(yielding: str, ratio: float) -> cl.Pair:
    """Two bodies of steel's moduli and density, either or both with a strength."""
    modulus, nu = 200e9, 0.3
    effective = 0.5 * modulus / (1.0 - nu**2)
    return cl.Pair(
        *(
            cl.Material(
                name, modulus, nu, 7850.0, yield_strength=effective / ratio if yielding in (name, "both") else None
            )
            for name in ("sphere", "plate")
        )
    )


def _fallen(pair: cl.Pair, speed: Array) -> Rebound:
    return cl.ImpactModel(pair, "fem").solve(speed, 1e-3, math.inf)


def lines() -> list[str]:
    """Write the comparison as text."""
    found = [
        "half-spaces at V0/V_Y0: COR of law fem, (d ln e/d ln V without waves; full plasticity, "
        f"Johnson 1985: {JOHNSON:g}),",
        "  Thornton's closed form (1997): nothing fitted, no waves, pressure capped at c sigma_Y",
        f"    {'':22s}" + "".join(f"{v:>15g}" for v in _SPEED_RATIOS),
    ]
    for cap in _CAPS:
        known = "".join(f"{e:7.3f}{'':8s}" for e in thornton(cap))
        found.append(f"    {f'Thornton, c = {cap:g}':22s}{known}".rstrip())
    every = falls()
    for yielding, ratio in dict.fromkeys((one.yielding, one.ratio) for one in every):
        values = "".join(
            f"{one.restitution:7.3f} {f'({one.slope:+.2f})':7s}"
            for one in every
            if (one.yielding, one.ratio) == (yielding, ratio)
        )
        found.append(f"    {f'{yielding}, E*/sigma_Y {ratio:g}':22s}{values}")
    return found
