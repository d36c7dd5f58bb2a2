"""A force law: its family, parameters, source and kinks, and the array that kernels read."""

from __future__ import annotations

import functools
import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw.equation import force as _force
from contactlaw.equation.force import UnloadingCurve
from contactlaw.laws._branches import END, Loading, Unloading
from contactlaw.laws._expansion import Resolution, check_formulas, check_unloading, check_yield, expanded, packed


class Strengths(NamedTuple):
    """Laws of a pair that grows stronger with the rate of an impact."""

    data: Array  # at any strength, in the layout of `contactlaw.equation.force`
    knots: tuple[float, ...]  # ln of the strength, from 0: between them outcomes are smooth


@dataclass(frozen=True, eq=False)
class Law:
    """A normal force law, as data: see `contactlaw.equation.force` for the array's layout.

    Two laws are equal if their arrays and their yield coefficients are.

    Parameters
    ----------
    family : str
        Name of the law, without its parameters.
    source : str
        Where the formulas come from.
    yield_coefficient : float or None
        c in d_Y = c pi^2 sigma_Y^2 R* / E*^2; None for a law that never yields.
    loading_kinks : tuple of float
        Compressions [d_Y], rising, at which the loading curve changes its formula.
    data : ndarray of float64
        Loading and unloading curves, in the layout of `contactlaw.equation.force`.
    parameters : mapping of str to float, optional
        Numbers that single it out of its family, by name.
    yield_strains : tuple of float, optional
        Least and largest sigma_Y/E of a sphere for which finite elements favour the law once it has
        yielded well.
    from_pair : tuple of str, optional
        Names of those parameters that come from the pair of materials.
    scale : float, optional
        d_Y/R* of a law made for one pair, whichever body yields. 1 if neither yields: the law's
        compressions are then in R*. None: d_Y follows from `yield_coefficient`.
    onset : float, optional
        Compression over R* at which flow begins, where that is before d_Y: bodies that harden flow
        so little at first that the law has none of it. None: flow begins at d_Y.
    range : tuple of float, optional
        Compressions [d_Y] from which on the law differs from Hertz's, and up to which it holds.
    waves : tuple of float, optional
        b, b_h, b4 and b_p, the plate's corrections beyond a thin-plate dashpot, see
        `contactlaw.equation.corrections`. None: the plate is that dashpot.
    strengths : Strengths, optional
        The laws of impacts that make the pair stronger; None if none does.
    """

    family: str
    source: str
    yield_coefficient: float | None
    loading_kinks: tuple[float, ...]
    data: Array
    parameters: Mapping[str, float] = field(default_factory=dict)
    yield_strains: tuple[float, float] = (0.0, math.inf)
    from_pair: tuple[str, ...] = ()
    scale: float | None = None
    range: tuple[float, float] = (1.0, math.inf)
    waves: tuple[float, float, float, float] | None = None
    onset: float | None = None
    strengths: Strengths | None = None

    @staticmethod
    def of(
        *,
        name: str,
        source: str,
        yield_coefficient: float | None,
        loading: Sequence[Loading],
        unloading: Sequence[Unloading] = (),
        parameters: Mapping[str, float] | None = None,
        yield_strains: tuple[float, float] = (0.0, math.inf),
        scale: float | None = None,
        range: tuple[float, float] = (1.0, math.inf),
        waves: tuple[float, float, float, float] | None = None,
        onset: float | None = None,
    ) -> Law:
        """Make a law from its formulas.

        Parameters
        ----------
        name : str
            Its `family`.
        source, yield_coefficient, parameters, yield_strains, scale, range, waves, onset
            As in `Law`.
        loading : sequence of Loading
            Branches of the loading curve. They have to meet, and to rise.
        unloading : sequence of Unloading, optional
            Branches of the unloading curves. Without any the law is elastic.

        Returns
        -------
        Law
            It follows the formulas to 1e-12, relatively, up to the end of its range, or to 1e5 d_Y
            where it has none. Beyond, the force goes on along its tangent over the compression, the
            residual compression keeps its share of the largest one, and the exponent its value.

        Raises
        ------
        ValueError
            If a formula gives a negative or no finite number, is not smooth between its kinks,
            branches do not meet, a loop would gain energy, or the law does not follow Hertz's curve
            up to yield; the message says where.

        Examples
        --------
        A sphere whose contact pressure is cut off at yield, and which unloads as Hertz's:

        >>> import contactlaw as cl
        >>> from contactlaw.laws import HERTZ, Law, Loading, Unloading
        >>> law = Law.of(
        ...     name="cut off",
        ...     source="an example",
        ...     yield_coefficient=0.68,
        ...     loading=[Loading(0.0, HERTZ), Loading(1.0, lambda d: 1.5 * d - 0.5)],
        ...     unloading=[Unloading(1.0, residual=lambda dm: (dm - 1.0) ** 2 / dm)],
        ... )
        >>> round(law.loading(2.0), 4), round(law.residual(3.0), 4)
        (5.5, 1.3333)
        """
        family, parameters = name, parameters or {}
        name = _written(family, parameters)
        check_yield(name, yield_coefficient, loading, unloading)
        end = range[1] if range[1] < math.inf else END
        check_formulas(name, loading, unloading, end)
        curve, rows = expanded(name, loading, unloading, end, Resolution())
        check_unloading(name, curve, unloading)
        return Law(
            family=family,
            parameters=parameters,
            source=source,
            yield_coefficient=yield_coefficient,
            loading_kinks=tuple(float(branch.start) for branch in loading[1:]),
            data=packed(curve, rows),
            yield_strains=yield_strains,
            scale=scale,
            range=range,
            waves=waves,
            onset=onset,
        )

    @property
    def name(self) -> str:
        """Family, with six digits of the parameters in brackets."""
        return _written(self.family, self.parameters)

    @property
    def yields(self) -> bool:
        """Whether a body yields at some compression."""
        return self.yield_coefficient is not None

    @property
    def is_hertz(self) -> bool:
        """Whether loading follows Hertz's curve up to yield."""
        return bool(_force.is_hertz(self._law))

    @property
    def thin_plate(self) -> bool:
        """Whether the law takes the plate as thin, a dashpot, as the paper does."""
        return self.waves is None

    @property
    def _law(self) -> _force.BlendedLaw:
        """Law as kernels take it."""
        return _force.alone(self.data)

    @property
    def at_any_strength(self) -> Array:
        """The data of this law, or of all its strengths."""
        return self.data if self.strengths is None else self.strengths.data

    @functools.cached_property
    def key(self) -> str:
        """Hash of the data, by which tables are found."""
        content = self.data.tobytes()
        if self.strengths is not None:
            content += self.strengths.data.tobytes() + repr(self.strengths[1:]).encode()
        return hashlib.sha256(content).hexdigest()[:16]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Law):
            return NotImplemented
        return (self.key, self.yield_coefficient) == (other.key, other.yield_coefficient)

    def __hash__(self) -> int:
        return hash((self.key, self.yield_coefficient))

    def follows(self, other: Law) -> bool:
        """Whether another law equals this one up to rounding."""
        if self.key == other.key or self.strengths is not None or other.strengths is not None:
            return self.key == other.key
        mine, theirs = self._samples(), other._samples()
        return len(mine) == len(theirs) and bool(np.allclose(mine, theirs, rtol=1e-11, atol=1e-14))

    def _samples(self) -> list[float]:
        """Kinks, and values along the curves, by which laws are compared."""
        values = [*self.loading_kinks]
        for d in (*self.loading_kinks, *np.geomspace(0.5, 1e4, 25).tolist()):
            values += _force.deepest(self._law, d)
        return values

    def loading(self, q: float) -> float:
        """Force [F_Y] at the compression q^2 [d_Y] while it grows."""
        return _force.loading(self._law, q)

    def residual(self, dm: float) -> float:
        """Compression [d_Y] left after unloading from the largest one, dm."""
        return float(_force.deepest(self._law, dm).residual)

    def unloading_curve(self, dm: float) -> UnloadingCurve:
        """Find the unloading curve from dm."""
        return _force.unloading(self._law, dm)

    def unloading(self, q: float, curve: UnloadingCurve) -> float:
        """Force [F_Y] at d = residual(dm) + q^2 below dm; reloading follows the same curve."""
        return _force.unloading_force(self._law, curve, q)

    def dissipation(self, dm: float) -> float:
        """Energy [F_Y d_Y] that a contact loses that was loaded to dm."""
        return float(_force.deepest(self._law, dm).loss)


def _written(family: str, parameters: Mapping[str, float]) -> str:
    values = ",".join(f"{value:.6g}" for value in parameters.values())
    return f"{family}({values})" if values else family
