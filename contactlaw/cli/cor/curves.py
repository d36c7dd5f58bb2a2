"""COR over speed, a curve per bead and plate, to be drawn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw.answers.uncertainty import Band
from contactlaw.cli.parts import wording
from contactlaw.cli.parts.impacts import yield_speeds
from contactlaw.model import ImpactModel

Array = NDArray[np.float64]

_SAMPLES = 400  # speeds per curve: steps of half a millimetre on a slide
_MOST_CURVES, _MOST_PANELS = 8, 6  # more could not be distinguished in one figure


class CorCurve(NamedTuple):
    """COR over speed of one bead on one plate, in SI units."""

    radius: float
    thickness: float
    speed: Array
    restitution: Array
    flags: NDArray[np.int64]
    yield_speed: float  # inf if nothing yields
    at_yield: float  # COR at the yield speed; NaN if the curve does not reach it
    band: Band | None = None  # of the COR


def restitution_curves(
    model: ImpactModel,
    speeds: Sequence[float],
    radii: Sequence[float],
    thicknesses: Sequence[float],
    solve: bool = False,
    errors: dict[str, float] | None = None,
) -> list[CorCurve]:
    """COR from the least to the largest of some speeds, for each bead on each plate.

    Parameters
    ----------
    model : ImpactModel
        Model of the pair of materials.
    speeds, radii, thicknesses : sequence of float
        Impact speeds [m/s], bead radii [m] and plate thicknesses [m]. With a single speed, curves
        begin at a tenth of it.
    solve : bool, optional
        Whether to integrate the equation instead of using the table.
    errors : dict of str to float, optional
        Errors of speed and sizes, as `ImpactModel.uncertainty` takes them; without it curves have
        no bands.

    Returns
    -------
    list of CorCurve
        Sorted by radius, and by thickness for each radius.

    Raises
    ------
    ValueError
        If there are too many curves for one figure, or the model refuses an impact.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    >>> curve, = restitution_curves(model, [0.5, 20.0], [0.9e-3], [1e-3])
    >>> round(curve.yield_speed, 2), round(curve.at_yield, 3)
    (7.82, 0.9)
    """
    lines, panels = len(set(thicknesses)), len(set(radii))
    if lines == 1:
        lines, panels = panels, lines
    if lines > _MOST_CURVES or panels > _MOST_PANELS:
        raise ValueError(
            f"thickness, radius: {len(set(thicknesses))} plates and {len(set(radii))} beads are "
            f"too many for one picture, which takes {_MOST_CURVES} of one of them, or "
            f"{_MOST_CURVES} plates and {_MOST_PANELS} beads"
        )
    least, largest = min(speeds), max(speeds)
    v = _speeds(least if least < largest else 0.1 * largest, largest)
    plates = sorted(set(thicknesses))
    return [_curve(model, v, r, h, solve, errors) for r in sorted(set(radii)) for h in plates]


def _speeds(least: float, largest: float) -> Array:
    spaced = np.geomspace if is_logarithmic(least, largest) else np.linspace
    return spaced(least, largest, _SAMPLES)


def is_logarithmic(least: float, largest: float) -> bool:
    """Whether a range of speeds is so wide that it is spaced and drawn logarithmically.

    Examples
    --------
    >>> is_logarithmic(1.0, 10.0), is_logarithmic(0.1, 10.0)
    (False, True)
    """
    return largest >= 20.0 * least


def _curve(
    model: ImpactModel, v: Array, r: float, h: float, solve: bool, errors: dict[str, float] | None
) -> CorCurve:
    yields = float(yield_speeds(model, np.array([r]), np.array([h]))[0])
    reached = v[0] <= yields <= v[-1]
    if reached:
        v = np.sort(np.append(v, yields))
    with wording.naming_impact(v, r, h):
        rebound = (model.solve if solve else model.lookup)(v, r, h)
        band = None if errors is None else model.uncertainty(v, r, h, **errors).restitution
    e = np.asarray(rebound.restitution)
    at_yield = float(e[np.searchsorted(v, yields)]) if reached else math.nan
    return CorCurve(r, h, v, e, np.asarray(rebound.flags), yields, at_yield, band)
