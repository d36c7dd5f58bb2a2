"""A force law whose COR is the same at any speed, for engines whose walls need a force law."""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, Any

from contactlaw import ArgumentError, ImpactModel, Pair
from contactlaw.laws import HERTZ, Law, Loading, Unloading
from contactlaw.table import Settings

if TYPE_CHECKING:
    from dem_demo.kit.run import Run

_LEAST = 0.2
# A coarse table is enough: the engine integrates the force, and half-spaces have lambda = 0.
_COARSE = Settings(largest_inelasticity=1e-2, rows=5, columns=20)
_BEGIN = 1e-7  # [R*], compression at which losses begin; 1 cm/s compresses 500 times as far


def constant_model(pair: Pair, restitution: float) -> ImpactModel:
    """Model whose COR on a half-space is the same at any speed.

    Loading follows Hertz, d^1.5. Unloading from the largest compression dm follows
    F = dm^1.5 ((d - dr)/(dm - dr))^1.5 to the residual compression dr = (1 - e^2) dm and returns
    the share e^2 of the work. (A law needs dr = 0 at yield, dm = 1: hence the term -1/dm.)

    Examples
    --------
    >>> import math
    >>> model = constant_model(Pair("gamma-alumina", "aluminium-6061-t6"), 0.63)
    >>> model.solve([0.05, 0.5], radius=1.5e-3, thickness=math.inf).restitution.round(5)
    array([0.63, 0.63])
    """
    if not _LEAST <= restitution <= 1.0:
        raise ArgumentError("constant_cor", restitution, f"must lie between {_LEAST:g} and 1")
    lost = 1.0 - restitution**2
    law = Law.of(
        name="constant_cor",
        source="a constant COR, to compare with",
        yield_coefficient=1.0 if lost else None,
        scale=_BEGIN if lost else None,
        loading=[Loading(0.0, HERTZ)],
        unloading=[Unloading(1.0, lambda dm: lost * (dm - 1.0 / dm))] if lost else [],
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the coarse table warns, but is not used
        return ImpactModel(pair, law, _COARSE, outside="clamp")


def thick_cor(run: Run[Any]) -> float:
    """COR on a thick block at the mean speed of the impacts, as one would type it for a wall."""
    speed = run.impacts["approach_speed"].mean() if run.impacts.size else run.scene.top_speed
    return round(max(_LEAST, float(run.model.restitution(speed, float(run.scene.radius.mean()), math.inf))), 3)
