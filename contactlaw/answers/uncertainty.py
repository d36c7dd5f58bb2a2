"""How far a real impact may be from the answer, and which number makes it uncertain.

Each number that has an error is changed alone, by one standard error up and down, and the impact
integrated. Logarithms of an answer follow a parabola through these points in each number, and what
the numbers change adds up, so that quantiles are those of sums at random errors, which need no
integration. It does not add up in two cases. Where a body may or may not begin to yield, what flow
changes is a function of the overload, found by changing the strengths, and overloads add up. Which
body yields depends on the strengths of both: these are changed together as well.
"""

from __future__ import annotations

import dataclasses
import functools
import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from statistics import NormalDist
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array, Places
from contactlaw._errors import ArgumentError
from contactlaw.answers.derivatives import solver, with_number
from contactlaw.answers.law_errors import law_errors
from contactlaw.answers.solver import Solver
from contactlaw.physical.arguments import number, shaped, within
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.materials import Material
from contactlaw.physical.pair import Pair
from contactlaw.physical.rate import rates
from contactlaw.physical.rebound import Rebound

_FIELDS = "restitution", "contact_time", "peak_force", "overload"
_SIZES = "speed", "radius", "thickness"
_ROLES = "sphere", "plate"
_RTOL = 1e-8
_ENDS = -1.0, 1.0  # changes, in standard errors
_STRAIGHT = 1.5  # standard errors beyond which curves are straight
_NEAR, _FARTHEST = 3.0, 2.0  # ln(chi) of impacts that may or may not yield, over its spread, and
_DRAWS, _AT_ONCE = 2048, 256  # random errors, and impacts whose sums are in memory together
_QUANTILES = NormalDist().cdf(-1.0), NormalDist().cdf(1.0)  # 16 and 84 %
_LARGEST_ERROR = 1.0
_LEAST_COR = 1e-12  # the lower end of a range that reaches below zero
_LARGEST = {"poissons_ratio": 0.5, "rate": 0.5, "loss_factor": 1.0}  # a material refuses more
_STRENGTHS = "yield_strength", "hardness"
_BODIES = {("sphere",): "the bead", ("plate",): "the plate", ("sphere", "plate"): "both bodies"}


@dataclass(frozen=True, eq=False)
class Band:
    """Range of one answer, in its unit: floats, or arrays of the shape of the impacts.

    Attributes
    ----------
    low, high
        Quantiles of 16 and 84 %: of three real impacts two are between them. They are -inf and
        inf for a law of your own, whose errors are not known.
    causes : dict of str to float or ndarray
        Half the width of the band that each cause alone makes: ``"yield strength of the bead"``,
        ``"thickness"``, ..., and ``"model"``, the law beside finite elements, which is inf for a
        law of your own.
    signs : dict of str to float or ndarray
        1 where more of a number raises the answer, -1 where it lowers it; without ``"model"``.
    """

    low: float | Array
    high: float | Array
    causes: dict[str, float | Array]
    signs: dict[str, float | Array]


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Ranges of the COR [-], the contact time [s] and the peak force [N] of impacts."""

    restitution: Band
    contact_time: Band
    peak_force: Band


class Change(NamedTuple):
    """A number that has an error."""

    name: str  # field of Material, or speed, radius, thickness
    error: float
    roles: tuple[str, ...] = ()  # bodies; none for a size

    @property
    def cause(self) -> str:
        """Name for a reader."""
        words = self.name.replace("youngs", "Young's").replace("poissons", "Poisson's")
        body = f" of {_BODIES[self.roles]}" if self.roles else ""
        return words.replace("_", " ") + body


_PROBE = Change("flow_stress", 1.0, ("sphere", "plate"))  # whole flow stress of both bodies
_PROBES = 1.2, 0.6, 0.4, 0.2, 0.1, 0.0, -0.1, -0.2, -0.4, -0.6, -0.9, -1.2  # its changes


class Variants:
    """Solvers of a pair whose materials are off by some standard errors, each made once."""

    def __init__(self, bodies: SphereOnPlate) -> None:
        self.bodies, self.given = bodies, dict(zip(_ROLES, bodies.pair.given, strict=True))
        alike = self.given["sphere"] == self.given["plate"]
        self.changes = [
            Change(name, error, roles)
            for roles in ([("sphere", "plate")] if alike else [("sphere",), ("plate",)])
            for name, error in self.given[roles[0]].uncertainty.items()
            if error
        ]
        self.solver = functools.cache(self._solver)

    def _solver(self, moved: tuple[tuple[Change, float], ...], *decades: float) -> Solver:
        """Solver for two decades of rates or more, so that other impacts often find it."""
        bodies = self.given.copy()
        for change, z in moved:
            for role in change.roles:
                bodies[role] = _changed(bodies[role], change, z)
        return solver(Pair(**bodies), self.bodies.law, 10.0 ** np.array(decades), _RTOL)

    def hit(self, impacts: Impacts, *moved: tuple[Change, float]) -> Rebound:
        """Integrate impacts with numbers that are off by some standard errors."""
        sizes = {name: getattr(impacts, name) for name in _SIZES}
        for change, z in moved:
            if not change.roles:
                sizes[change.name] = sizes[change.name] * math.exp(z * change.error)
        decades = 0.5 * np.log10(rates(sizes["speed"], sizes["radius"]))
        ends = 2.0 * math.floor(decades.min(initial=4.0)), 2.0 * math.ceil(decades.max(initial=0.0))
        found = self.solver(tuple(one for one in moved if one[0].roles), *ends)
        shape = (impacts.speed.size,)
        return found.rebounds(dataclasses.replace(impacts, **sizes, shape=shape))


def _changed(body: Material, change: Change, z: float) -> Material:
    """Body one number of which is off by some standard errors."""
    factor, value = math.exp(z * change.error), getattr(body, change.name, 1.0)
    if change.name == "hardening" and body.flow is not None:  # also where it is from a hardness
        value = body.flow.hardening
    first = value[0] if isinstance(value, tuple) else value
    try:
        most = _LARGEST.get(change.name, math.inf)
        return with_number(body, change.name, min(factor * first, most))
    except ValueError as error:
        reason = f"{change.name} is too large, for {factor:.3g} times the value: {error}"
        raise ArgumentError("uncertainty", change.error, reason) from None


class Uncertain:
    """Uncertainty of the answers of one model."""

    _bodies: SphereOnPlate

    @functools.cached_property
    def _variants(self) -> Variants:
        return Variants(self._bodies)

    def uncertainty(
        self,
        speed: ArrayLike,
        radius: ArrayLike,
        thickness: ArrayLike,
        *,
        speed_error: float = 0.0,
        radius_error: float = 0.0,
        thickness_error: float = 0.0,
        mass: ArrayLike | None = None,
    ) -> Uncertainty:
        """How far a real impact may be from the answer, and why.

        Parameters
        ----------
        speed, radius, thickness : array_like
            As in `solve`, which integrates all of it.
        speed_error, radius_error, thickness_error : float, optional
            Relative standard errors of speed and sizes [-], 0 to 1. Those of materials are their
            `Material.uncertainty`; without any, only the law is uncertain.
        mass : array_like, optional
            As in `solve`; it has no error.

        Returns
        -------
        Uncertainty
            Quantiles of 16 and 84 % of COR, contact time and peak force, and their causes.

        Raises
        ------
        ValueError
            As in `solve`; an error out of range, or so large that a material is none any more.

        Notes
        -----
        Errors are log-normal and independent, also those of A, B and C of one fit. But if both
        bodies are of one and the same material, equal in all numbers and in its name, a number
        errs alike in both. A Poisson's ratio stays up to 0.5. Numbers that were given in the name
        of a law are held fixed. Quantiles are within 10 % of half the band's width of those of
        random pairs, and within 15 % where a body may or may not begin to yield, for errors of
        strengths and moduli up to 30 %.

        Examples
        --------
        >>> import contactlaw as cl
        >>> steel = cl.Material(
        ...     "my steel", 200e9, 0.29, 7800, yield_strength=400e6, kind="metal",
        ...     uncertainty={"yield_strength": 0.15},
        ... )
        >>> model = cl.ImpactModel(cl.Pair(steel, "glass"))
        >>> cor = model.uncertainty(3.0, 1e-3, 5e-3, thickness_error=0.05).restitution
        >>> round(cor.low, 2), round(cor.high, 2)
        (0.62, 0.71)
        >>> {name: round(size, 3) for name, size in cor.causes.items()}
        {'yield strength of the bead': 0.043, 'thickness': 0.002, 'model': 0.003}
        """
        sizes = []
        for name, value in zip(_SIZES, (speed_error, radius_error, thickness_error), strict=True):
            error = number(f"{name}_error", value)
            remark = "(a relative standard error: 0.05 for 5 %)"
            within(f"{name}_error", np.array([error]), 0.0, _LARGEST_ERROR, remark)
            sizes += [Change(name, error)] if error else []
        impacts = self._bodies.given(speed, radius, thickness, mass=mass)
        return _uncertainty(self._variants, impacts, [*self._variants.changes, *sizes])


class _Curves:
    """How the logarithms of the answers of impacts change with each number."""

    def __init__(self, variants: Variants, impacts: Impacts, changes: list[Change]) -> None:
        self.variants, self.impacts, self.changes = variants, impacts, changes
        hit = variants.hit(self.impacts)
        self.base = _logs(hit)
        values = dict(zip(_FIELDS, np.exp(self.base), strict=True))
        pair, law = variants.bodies.pair, variants.bodies.law
        known = dataclasses.replace(hit, **values)
        errors = law_errors(law, pair, known, impacts.radius / impacts.thickness)
        self.by_law, self.cor_by_law = None, np.zeros(self.base.shape[1])
        if errors is not None:
            # that of a low COR is absolute, far more than the COR itself: it is no factor
            self.cor_by_law, none = errors[0], 0.0 * errors[:1]
            self.by_law = np.vstack([none, errors[1:], none]) / [*values.values()]
        ends = [[self.moved((one, z)) for z in _ENDS] for one in changes]
        self.ends = np.array(ends).reshape(len(changes), 2, *self.base.shape)
        # Impacts that may or may not reach the yield strength, and what flow does to their answers.
        reach = _NEAR * np.sqrt((self.ends[:, :, 3] ** 2).max(axis=1, initial=0.0).sum(axis=0))
        self.near = np.flatnonzero(np.abs(self.base[3]) < np.minimum(reach, _FARTHEST))
        if self.near.size:
            probed = [self.moved((_PROBE, z), some=self.near) for z in _PROBES]
            self.probed = np.array(probed) + self.base[:, self.near]

    def moved(self, *moved: tuple[Change, float], some: Places | None = None) -> Array:
        """Change of the logarithms of some impacts' answers with numbers."""
        if some is None:
            return _logs(self.variants.hit(self.impacts, *moved)) - self.base
        hit = self.variants.hit(self.impacts.part(some), *moved)
        return _logs(hit) - self.base[:, some]

    def by_flow(self, m: int, change: Array) -> Array:
        """Change of one of the impacts near yield by flow, with the logarithm of its overload."""
        at, answers = self.probed[:, 3, m], self.probed[:, :3, m].T

        def curve(x: Array | float) -> Array:
            return np.array([*(np.interp(x, at, one) for one in answers), np.zeros_like(x)])

        base = self.base[3, self.near[m]]
        return np.moveaxis(curve(base + change), 0, -1) - curve(base)

    def rows(self, z: Array) -> tuple[Array, Array]:
        """Weights of random errors (draws, rows), and rows of a sum of changes (rows, 4, n)."""
        ends = self.ends.copy()
        for m, n in enumerate(self.near.tolist()):
            ends[..., n] -= self.by_flow(m, ends[:, :, 3, n])
        close = np.clip(z, -_STRAIGHT, _STRAIGHT)
        weights = [*z[: len(ends)], *(close * (2.0 * z - close))[: len(ends)]]
        rows = [*0.5 * (ends[:, 1] - ends[:, 0]), *0.5 * (ends[:, 1] + ends[:, 0])]
        if self.by_law is not None:
            weights, rows = [*weights, z[-1]], [*rows, self.by_law]
        for m, n in self._strengths():
            for (i, a), (j, b) in itertools.product(enumerate(_ENDS), repeat=2):
                together = self.moved((self.changes[m], a), (self.changes[n], b))
                rows.append(together - self.ends[m, i] - self.ends[n, j])
                weights.append(np.maximum(a * z[m], 0.0) * np.maximum(b * z[n], 0.0))
        return np.array(weights).T, np.array(rows)

    def _strengths(self) -> Iterator[tuple[int, int]]:
        """Which changes are of the strength of the bead and of the plate, if both are."""
        known = [(one.roles, n) for n, one in enumerate(self.changes) if one.name in _STRENGTHS]
        each = ([n for roles, n in known if roles == (role,)][:1] for role in ("sphere", "plate"))
        return zip(*each, strict=False)

    def quantiles(self) -> tuple[Array, Array]:
        """Quantiles of the logarithms of the answers, less the logarithms themselves (4, n)."""
        z = _deviates(len(self.changes) + 1)
        weights, rows = self.rows(z)
        found = np.zeros((2, *self.base.shape))
        for first in range(0, self.base.shape[1] if len(rows) else 0, _AT_ONCE):
            here = rows[:, :, first : first + _AT_ONCE]
            sums = (here.reshape(len(rows), -1).T @ weights.T).reshape(*here[0].shape, _DRAWS)
            for m, n in enumerate(self.near.tolist()):
                if first <= n < first + _AT_ONCE:
                    sums[:, n - first] += self.by_flow(m, sums[3, n - first]).T
            part = self.base[0, first : first + _AT_ONCE, None]
            cor = np.exp(np.minimum(part + sums[0], 0.0))
            cor += np.outer(self.cor_by_law[first : first + _AT_ONCE], z[-1])
            sums[0] = np.log(np.clip(cor, _LEAST_COR, 1.0)) - part
            # quantiles of the overload are not asked for
            found[:, :3, first : first + _AT_ONCE] = np.quantile(sums[:3], _QUANTILES, axis=-1)
        return found[0], found[1]


def _logs(hit: Rebound) -> Array:
    return np.log(np.maximum([getattr(hit, name) for name in _FIELDS], 1e-300))


@functools.lru_cache(maxsize=16)
def _deviates(count: int) -> Array:
    """Draw normal deviates (count, draws): for each number a permutation of the same quantiles."""
    known = [NormalDist().inv_cdf((n + 0.5) / _DRAWS) for n in range(_DRAWS)]
    return np.random.default_rng(0).permuted(np.tile(known, (count, 1)), axis=1)


def _uncertainty(variants: Variants, impacts: Impacts, changes: list[Change]) -> Uncertainty:
    """Bands of the answers of impacts by changes of numbers, and by the law."""
    curves = _Curves(variants, impacts, changes)
    logs = curves.base
    most = np.array([0.0, math.inf, math.inf, math.inf])[:, None]  # the COR is 1 at most

    def shifted(by: Array) -> Array:
        return np.asarray(np.exp(np.minimum(logs + by, most)))

    def width(ends: Array) -> Array:
        return 0.5 * (shifted(np.maximum(ends.max(axis=0), 0.0)) - shifted(np.minimum(ends.min(axis=0), 0.0)))

    low, high = map(shifted, curves.quantiles())
    causes = {one.cause: width(ends) for one, ends in zip(changes, curves.ends, strict=True)}
    signs = {one.cause: np.sign(ends[1] - ends[0]) for one, ends in zip(changes, curves.ends, strict=True)}
    if curves.by_law is not None:
        causes["model"] = width(np.array([-curves.by_law, curves.by_law]))
        causes["model"][0] = curves.cor_by_law
    else:
        causes["model"] = np.full_like(low, math.inf)
        low, high = -causes["model"], causes["model"]
    bands = (
        Band(
            shaped(low[n], impacts.shape),
            shaped(high[n], impacts.shape),
            *({cause: shaped(size[n], impacts.shape) for cause, size in of.items()} for of in (causes, signs)),
        )
        for n in range(3)
    )
    return Uncertainty(*bands)
