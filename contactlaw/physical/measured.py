"""A force law from a measured indentation, in SI units."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw.laws import HERTZ, Law, Loading, Unloading
from contactlaw.laws.myc import C_YIELD
from contactlaw.laws.myc import residual as myc_residual
from contactlaw.physical.arguments import broadcast, scalars
from contactlaw.physical.pair import Pair
from contactlaw.physical.scaling import yield_scales

_DEGREE = 3  # degree of the polynomials in ln d that smooth the points; our choice
_FEWEST = 4  # least number of points beyond yield
_WORST = 0.2  # largest relative distance of a point from the smoothed curve; our choice


def measured_law(
    pair: Pair,
    radius: float,
    compression: ArrayLike,
    force: ArrayLike,
    residual: ArrayLike | None = None,
    *,
    name: str = "measured",
    source: str = "",
) -> Law:
    """Make a law from the points of a slow indentation, for `ImpactModel(pair, law=...)`.

    Up to yield, d_Y = 0.68 pi^2 sigma_Y^2 R/E*^2, the law is Hertz's. Beyond, ln F is a polynomial
    in ln d that leaves Hertz's curve along its tangent, by least squares; beyond the last point the
    force continues along the tangent in d.

    Parameters
    ----------
    pair : Pair
        Materials of sphere and plate; the sphere has a yield strength.
    radius : float
        Radius of the sphere that was pressed [m].
    compression, force : array_like
        Points of the loading curve [m], [N], rising; those below yield are ignored, and at least
        four have to be beyond.
    residual : array_like, optional
        Compression left after unloading from each point [m]; by default as in law ``"myc"``.
    name, source : str, optional
        Name of the law, and where the points come from.

    Returns
    -------
    Law
        For spheres of any radius: a slow indentation scales with it.

    Raises
    ------
    ValueError
        If there are too few points beyond yield, or they lie on no curve that such a law can have.

    Notes
    -----
    Unloading follows F = Fm ((d - dr)/(dm - dr))^1.5. The last point is a kink of the law; force
    histories from its table are within 3e-4 of their peak.

    Examples
    --------
    A law from five points of a bead of gamma-alumina, and the COR of an impact with it:

    >>> import contactlaw as cl
    >>> pair = cl.Pair("gamma-alumina", "glass")
    >>> law = cl.measured_law(
    ...     pair,
    ...     radius=0.9e-3,
    ...     compression=[12e-6, 20e-6, 30e-6, 45e-6, 70e-6],
    ...     force=[18.4, 38.1, 67.5, 111.0, 183.0],
    ... )
    >>> model = cl.ImpactModel(pair, law=law)
    >>> round(model.restitution(speed=20.0, radius=0.9e-3, thickness=1e-3), 2)
    0.8
    """
    if not isinstance(pair, Pair):
        raise TypeError(f"pair: expected a contactlaw.Pair, got {pair!r}")
    (r,) = scalars(radius=radius)
    d_y, f_y = yield_scales(pair, C_YIELD, r.item())
    points = {"compression": compression, "force": force}
    if residual is not None:
        points["residual"] = residual
    *columns, _ = broadcast(**points)
    rows = np.column_stack(columns)
    if not (np.isfinite(rows).all() and (np.diff(rows[:, :2], axis=0, prepend=0.0) > 0.0).all()):
        reason = "have to be positive and finite, and to rise together"
        raise ArgumentError("compression, force", None, reason)
    rows = rows[rows[:, 0] > d_y]
    if len(rows) < _FEWEST:
        beyond = f"beyond yield, {d_y:.3g} m for this radius"
        reason = f"{len(rows)} points lie {beyond}; at least {_FEWEST} are needed"
        raise ArgumentError("compression", None, reason)
    d, f = rows[:, 0] / d_y, rows[:, 1] / f_y
    loading = _smoothed("force", np.log(d), np.log(f) - 1.5 * np.log(d), 2.0)
    last = float(d[-1])

    def load(at: Array) -> Array:
        s = np.log(at)
        return np.asarray(at**1.5 * np.exp(s**2 * loading(s)))

    def share(dm: Array) -> Array:
        """Residual compression over (dm - 1)^2."""
        if residual is None:
            return myc_residual(dm)
        return np.asarray(left(np.log(np.minimum(dm, last))) / dm)

    if residual is not None:
        over = rows[:, 2] / d_y / ((d - 1.0) ** 2 / d)
        left = _smoothed("residual", np.log(d), over, 0.0)
    step = 1e-5 * last
    before, end, after = load(np.array([last - step, last, last + step]))
    slope = (after - before) / (2.0 * step)
    return Law.of(
        name=name,
        source=source or f"measured, radius {r.item():g} m, {len(rows)} points beyond yield",
        yield_coefficient=C_YIELD,
        loading=[Loading(0.0, HERTZ), Loading(1.0, load), Loading(last, Polynomial([end - slope * last, 0.0, slope]))],
        unloading=[Unloading(1.0, share, order=2.0), Unloading(last, share, order=2.0)],
    )


def _smoothed(name: str, s: Array, values: Array, power: float) -> Polynomial:
    """Fit the polynomial P for which s^power P(s) follows the values."""
    degree = min(_DEGREE, s.size - 2)
    basis = s[:, None] ** (power + np.arange(degree + 1))
    found = Polynomial(np.linalg.lstsq(basis, values, rcond=None)[0])
    off = np.abs(basis @ found.coef - values)
    if off.max() > _WORST * max(1.0, float(np.abs(values).max())):
        n = int(np.argmax(off))
        reason = f"point {n} beyond yield is off any smooth curve; is it a mistake?"
        raise ArgumentError(name, None, reason)
    return found
