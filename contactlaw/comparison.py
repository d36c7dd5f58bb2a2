"""Measured CORs beside the model: its band, chi-squared, and how likely that is by chance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array, Integers
from contactlaw._errors import ArgumentError
from contactlaw.answers.uncertainty import Band
from contactlaw.fitting.errors import chi_squared, correlated
from contactlaw.fitting.measurements import Measurements
from contactlaw.laws import DEFAULT, Law
from contactlaw.model import ImpactModel
from contactlaw.physical.pair import Pair

_NEEDED = "radius", "thickness", "restitution", "restitution_error"
_LEAST_ERROR = 1e-6  # of a COR


@dataclass(frozen=True, eq=False)
class Comparison:
    """Measured CORs beside those of a model; arrays have a value for each rebound.

    Attributes
    ----------
    data : Measurements
        The rebounds that have a COR.
    restitution : ndarray
        COR of the model [-].
    band : Band
        Its range by the errors of materials, sizes and law, as in `ImpactModel.uncertainty`.
    flags : ndarray of int
        `Validity` limits that each impact exceeds.
    chi_squared : float
        Sum of squares of the differences over all known errors, of data and model. Errors of a
        material or a size are alike at all rebounds, and those of the law at similar ones.
    probability : float
        Share of cases in which chance alone makes `chi_squared` as large; small if the model
        differs by more than the errors explain.
    if_exact : float
        `chi_squared` as if the law had no error of its own. The law with the least is the nearest.
    rms : float
        Root mean square of measured minus modelled COR [-], weighted by the errors of the data.
    unknown : tuple of str
        Causes that `chi_squared` is without: a strength that is a specified minimum, if impacts
        yield, and a law whose error is not known.
    """

    data: Measurements
    restitution: Array
    band: Band
    flags: Integers
    chi_squared: float
    probability: float
    if_exact: float
    rms: float
    unknown: tuple[str, ...]


def compare(
    pair: Pair,
    data: Measurements | Mapping[str, ArrayLike],
    law: str | Law = DEFAULT,
    *,
    speed_error: float = 0.0,
    radius_error: float = 0.0,
    thickness_error: float = 0.0,
) -> Comparison:
    """Compare measured CORs with a model to which they were not fitted.

    Parameters
    ----------
    pair : Pair
        Materials of bead and plate, with their `Material.uncertainty`.
    data : Measurements or mapping
        Rebounds as for `fit`, with radius, thickness, COR and its standard error.
    law : str or Law, optional
        As in `ImpactModel`.
    speed_error, radius_error, thickness_error : float, optional
        Relative standard errors of speeds and sizes [-], alike at all rebounds.

    Returns
    -------
    Comparison

    Raises
    ------
    ValueError
        Data that lack a size, a COR or its error; otherwise as in `ImpactModel`.

    Examples
    --------
    >>> import contactlaw as cl
    >>> data = {"speed": 3.9, "radius": 2.5e-3, "thickness": float("inf"),
    ...         "restitution": 0.98, "restitution_error": 0.005}
    >>> found = cl.compare(cl.Pair("alumina", "soda-lime-glass"), data)
    >>> found.restitution.round(3), round(found.chi_squared, 1), round(found.probability, 1)
    (array([0.985]), 0.6, 0.4)
    """
    from scipy.special import chdtrc

    data = Measurements.of(data, (), pair.sphere.density)
    for name in _NEEDED:
        if getattr(data, name) is None:
            hint = "; of heights or times their own, bounce_error or time_error" * (name == "restitution_error")
            raise ArgumentError(name, None, f"has to be given for each rebound, to compare it with the model{hint}")
    data = Measurements(**{name: getattr(data, name) for name in ("speed", *_NEEDED, "line")})
    data = data.part(np.isfinite(np.asarray(data.restitution)))
    speed, radius, thickness, measured, error = (np.array(getattr(data, name)) for name in ("speed", *_NEEDED))
    model = ImpactModel(pair, law)
    hit = model.solve(speed, radius, thickness)
    errors = {"speed_error": speed_error, "radius_error": radius_error, "thickness_error": thickness_error}
    band = model.uncertainty(speed, radius, thickness, **errors).restitution
    off, own = measured - hit.restitution, np.maximum(error, _LEAST_ERROR)
    shared = np.array([sign * np.asarray(band.causes[cause]) for cause, sign in band.signs.items()])
    shared = shared.reshape(-1, off.size).T
    if_exact = chi_squared(off, own, shared)
    by_law = np.asarray(band.causes["model"])
    knows_law = bool(np.isfinite(by_law).all())
    if knows_law:
        shared = np.hstack([shared, by_law[:, None] * correlated(speed, radius / thickness)])
    chi_2 = chi_squared(off, own, shared)
    chance, rms = float(chdtrc(off.size, chi_2)), float(np.sqrt(np.average(off**2, weights=error**-2.0)))
    unknown = ["model"] * (not knows_law)
    if np.any(hit.overload > 1.0):
        bodies = {"the bead": pair.sphere, "the plate": pair.plate}
        unknown += [f"yield strength of {role}" for role, body in bodies.items() if body.specified_minimum]
    cor, flags = np.asarray(hit.restitution), np.asarray(hit.flags)
    return Comparison(data, cor, band, flags, chi_2, chance, if_exact, rms, (*unknown,))
