"""A constant COR in an engine whose walls follow a force law: a law that gives it at any speed."""

from __future__ import annotations

import warnings

from contactlaw import ImpactModel, Pair
from contactlaw.laws import HERTZ, Law, Loading, Unloading
from contactlaw.table import Settings

LEAST = 0.2
# The engine integrates, and a half-space has lambda = 0.
_COARSE = Settings(largest_inelasticity=1e-2, inelasticity_nodes=5, log_overload_step=0.2)
_BEGIN = 1e-7  # [R*]: below such a compression it is elastic; 1 cm/s compresses 500 times as far


def constant_model(pair: Pair, restitution: float) -> ImpactModel:
    """Model whose COR on a half-space is the same at any speed.

    Loading follows Hertz, d^1.5. Unloading returns the share e^2 of that work if it is Hertz's over
    the share e^2 of the largest compression dm: F = dm^1.5 ((d - dr)/(dm - dr))^1.5 with what
    remains, dr = (1 - e^2) dm. (As the law is made, dr is 0 where it begins, hence -1/dm.)

    Parameters
    ----------
    pair : Pair
        Materials.
    restitution : float
        Coefficient of restitution [-].

    Raises
    ------
    ValueError
        If it is below 0.2, where 20 steps a contact no longer give it to 0.005, or above 1.

    Examples
    --------
    >>> import math
    >>> model = constant_model(Pair("gamma-alumina", "aluminium-6061-t6"), 0.63)
    >>> model.solve([0.05, 0.5], radius=1.5e-3, thickness=math.inf).restitution.round(5)
    array([0.63, 0.63])
    """
    if not LEAST <= restitution <= 1.0:
        raise ValueError(f"constant COR: must lie between {LEAST:g} and 1, got {restitution!r}")
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
        warnings.simplefilter("ignore")  # the table is coarse, for nobody asks it
        return ImpactModel(pair, law, _COARSE, outside="clamp")
