"""One COR for a wall, from the impacts that happen there, and what it gets wrong."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from contactlaw._arrays import Array, Integers
from contactlaw._errors import ArgumentError
from contactlaw.physical.arguments import check
from contactlaw.physical.validity import Validity, count_flags

Keep = Literal["energy", "momentum"]

_BEADS = 0.95  # share of the impacts whose error `rebound_error` bounds; our choice
_ROUNDING = 1e-12  # share of the energy; a smaller loss counts as none


@dataclass(frozen=True)
class Constant:
    """One COR in place of many, and the errors that it makes.

    The impacts are taken as they are. Where beads bounce again and again, a simulation with another
    COR has other impacts: take those of its own record, and repeat.

    Attributes
    ----------
    restitution
        The COR that keeps the energy, or the momentum [-].
    spread
        Standard deviation of the CORs of the impacts [-].
    energy_error
        Energy that the wall dissipates in total with this COR, over that with each impact's own
        COR, minus 1 [-]; 0 where the energy is kept.
    rebound_error
        Relative error of the rebound height that 95 % of the impacts do not exceed [-]; infinite
        where more of them do not rebound at all, but with the constant would.
    mean, mean_energy_error
        The plain mean of the CORs, and the `energy_error` of that [-].
    impacts
        Number of impacts.
    flags
        Number of impacts that exceed each `Validity` limit; limits that none exceeds are left out.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> best = model.constant([0.1, 1.0, 10.0], radius=0.9e-3, thickness=0.5e-3)
    >>> abs(best.energy_error) < 1e-9, round(best.mean_energy_error, 4)
    (True, -0.2477)
    >>> f"single beads rebound to within {best.rebound_error:.0%} of their height"
    'single beads rebound to within 44% of their height'
    """

    restitution: float
    spread: float
    energy_error: float
    rebound_error: float
    mean: float
    mean_energy_error: float
    impacts: int
    flags: dict[Validity, int]


def constant(speed: Array, radius: Array, weights: Array, e: Array, flags: Integers, keep: Keep) -> Constant:
    """Find the COR that replaces those of many impacts, see `contactlaw.ImpactModel.constant`.

    `e` and `flags` are the COR and the flags of each impact.
    """
    if keep not in ("energy", "momentum"):
        raise ArgumentError("keep", keep, "must be 'energy' or 'momentum'")
    if speed.size == 0:
        raise ArgumentError("speed", None, "got no impact, at least one is needed")
    check(weights=weights)
    if not weights.any():
        raise ArgumentError("weights", None, "all of them are 0, at least one has to be positive")
    share = weights / weights.max()
    mass = share * (radius / radius.max()) ** 3
    momentum = mass * (speed / speed.max())
    energy = momentum * (speed / speed.max())

    kept, power = (energy, 2) if keep == "energy" else (momentum, 1)
    best = float(np.average(e**power, weights=kept)) ** (1.0 / power)
    mean = float(np.average(e, weights=share))
    return Constant(
        restitution=best,
        spread=float(np.sqrt(np.average((e - mean) ** 2, weights=share))),
        energy_error=_energy_error(best, e, energy),
        rebound_error=_rebound_error(best, e, share),
        mean=mean,
        mean_energy_error=_energy_error(mean, e, energy),
        impacts=speed.size,
        flags=count_flags(flags),
    )


def _energy_error(one: float, e: Array, energy: Array) -> float:
    lost = float(np.average(1.0 - e**2, weights=energy))
    too_much = float(np.average(e**2, weights=energy)) - one**2
    return too_much / lost if lost > _ROUNDING else 0.0


def _rebound_error(one: float, e: Array, share: Array) -> float:
    height, off = e**2, np.abs(one**2 - e**2)
    with np.errstate(all="ignore"):
        errors = np.nan_to_num(off / height, posinf=np.inf)  # no error where neither rebounds
    return float(np.quantile(errors, _BEADS, weights=share, method="inverted_cdf"))
