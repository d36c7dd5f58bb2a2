"""fem: a law read off finite elements, for bodies of which either, both or neither may yield.

`validation.fem.campaign` presses spheres into blocks and lets them fall on plates, E*/sigma_Y from
11 to 2000 and compressions to a quarter of the radius; `validation.fem.fit` puts what came of it
into the numbers of fem.json. With d the compression, dm the largest one so far, q = sqrt(d):

    F = q^3 (1 + s q) / (1 + (q - 1) g(q))             loading; g = 0 below yield
    W = (1 - phi) (1 - v(q)) W_l / (1 + (q - 1) h(q))  what unloading from q = sqrt(dm) gives back
                                                       of the loading work W_l
    dr = dm (1 - 1/(1 + (q - 1) k(q)))                 what remains of dm
    F = Fm ((d - dr)/(dm - dr))^n                      unloading, with the n that gives back W

s is the stiffening of a finite sphere, whose centre comes less near than Hertz's half-spaces let
it; phi is what friction of 0.1 takes of any contact, v what an impact loses beyond a slow contact:
the bodies go on vibrating, and flow more where inertia adds to the force. As long as the contact is
small beside the sphere, w = sqrt(d/R) << 1, small-strain similarity makes g, h and k functions of q
alone; where it is not, flattened spheres and indented plates part:

    g = t (sum of g_ij t^i w^j),    t = (q - 1)/(q + 2)

and likewise h, k, v/t and the plastic share 1 - exp(-sum) of the loss, with sums that are linear
in Poisson's ratio and, but for deep contacts, in the modulus of the body that yields, each for
three cases: the sphere yields, the plate, or both alike. v has one term more, of how fast the
sphere's own waves are: what it goes on vibrating with. Where one body is stronger by a factor
1/z, the answer lies between that of both alike and that of the weaker body alone, by a share that
falls from 1 at z = 1 to 0 at z = 0.36: the weaker body presses on the other with no more than 3 of
its strengths, and the other yields at a mean pressure of 1.07 of its own. Poisson's ratios count by
each body's share of the flow, a half at equal strengths, so that nothing jumps where another body
becomes the weaker one.

A body softer than the campaign's flows completely before its contact is as deep as any of these:
up to there similarity makes g, h and k functions of q, beyond it functions of w, those of the
softest body that was pressed (`Curves`).

Legend: compressions in units of the yield compression d_Y of the weaker body, or of R where
none yields; forces in K d_Y^1.5.
"""

from __future__ import annotations

import functools
import json
import math
from importlib.resources import files
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from contactlaw.laws._branches import Loading, Unloading
from contactlaw.laws._law import Law

Array = NDArray[np.float64]

RATIOS = (11.0, 2000.0)  # E*/sigma_Y of the campaign; beyond, `Curves` goes by similarity
_FLOWN = (20.0, 10.0)  # q at which flow is complete, in indentations and in v
_DEEPEST = (23.0, 0.2), (40.0, 0.1)  # E*/sigma_Y, and its deepest contacts, d/R
_SMALLEST = 1e-8  # d/R; below, the contact's radius is under 1e-4 R and no stiffening to be seen
_EARLIEST = 0.01  # d_Y, where that is more: a table begins before yield
SHIFT = 2.0  # of t
_LEAST_FRICTION = 5e-4  # of bodies that hardly slip
_SHARES, _RATIOS = 0.45, 0.1  # about 0.5 and 0.3; beyond, what holds there
# Of the deepest compression; a body that yields later is elastic: what is left to lose is less than
# 1e-5 of the energy, and a law needs some room between its kinks.
_LATE = 0.98
ALONE = 0.36  # z, below which the stronger body does not yield
_POWERS = (5, 4)  # of t and w
_GAUSS = np.polynomial.legendre.leggauss(40)


@functools.cache
def numbers() -> dict[str, Any]:
    """Read what the fit has found."""
    text = files("contactlaw.laws").joinpath("fem.json").read_text("utf-8")
    found: dict[str, Any] = json.loads(text)
    return found


def friction_loss(given: Given, powers: list[float]) -> float:
    """Share phi of the loading work that friction of 0.1 takes of an elastic contact.

    A polynomial in Dundurs' second parameter (Johnson 1985, Eq. 5.3), by which surfaces that are
    pressed together slip on each other; equal bodies do not slip.
    """
    one, other = (
        (1.0 - 2.0 * nu) / (1.0 - nu) for nu in (given.poissons_ratio, given.plate_poissons_ratio)
    )
    mismatch = 0.5 * ((1.0 - given.modulus_share) * one - given.modulus_share * other)
    return max(_LEAST_FRICTION, float(np.polynomial.polynomial.polyval(mismatch, powers)))


def _within(value: float, most: float) -> float:
    return min(max(value, -most), most)


def _sized(powers: list[list[float]]) -> Array:
    """Powers of t and w, filled up with zeros."""
    found = np.array(powers)
    return np.pad(found, [(0, most - n) for most, n in zip(_POWERS, found.shape, strict=True)])


def yield_scale(ratio: float, poissons_ratio: float) -> float:
    """Yield compression over R: (pi C/2)^2 (sigma_Y/E*)^2, C = 1.295 exp(0.736 nu).

    Where von Mises' stress first reaches sigma_Y under Hertz's pressure (Jackson & Green,
    J. Tribol. 127 (2005) 343).
    """
    c = 1.295 * math.exp(0.736 * poissons_ratio)
    return (0.5 * math.pi * c / ratio) ** 2


def deepest(ratio: float) -> float:
    """Largest compression over R that the law was made for, at an E*/sigma_Y (0: elastic)."""
    (low, deep), (high, shallow) = _DEEPEST
    return float(np.exp(np.interp(ratio, [low, high], np.log([deep, shallow]))))


class Given(NamedTuple):
    """What the law takes from a pair; in the order of `PARAMETERS`."""

    sphere_ratio: float  # E*/sigma_Y; 0 for a body that does not yield
    plate_ratio: float
    modulus_share: float  # the sphere's, E1'/(E1' + E2')
    poissons_ratio: float
    plate_poissons_ratio: float

    @property
    def ratio(self) -> float:
        """E*/sigma_Y of the weaker body; 0 where neither yields."""
        return max(self.sphere_ratio, self.plate_ratio)

    @property
    def weaker(self) -> str:
        """Body that yields first; "sphere" where both are alike, or neither yields."""
        return "plate" if self.plate_ratio > self.sphere_ratio else "sphere"

    def both(self, blend: float) -> float:
        """Share of both alike in the answer, from 1 at equal strengths to 0 where one body yields.

        In between it falls with the power `blend` of the ratio of the strengths.
        """
        z = min(self.sphere_ratio, self.plate_ratio) / self.ratio
        return float((max(0.0, z - ALONE) / (1.0 - ALONE)) ** blend)

    def flow(self, blend: float) -> dict[str, float]:
        """Share of each body in the plastic flow: a half each at equal strengths.

        What depends on which body yields goes by these shares. By the weaker body alone it would
        jump where the other one becomes the weaker.
        """
        other = 0.5 * self.both(blend)
        plate = 1.0 - other if self.weaker == "plate" else other
        return {"sphere": 1.0 - plate, "plate": plate}

    def yield_scale(self, blend: float) -> float:
        """Yield compression over R, with the mean Poisson's ratio of the flow."""
        flow = self.flow(blend)
        mean = flow["sphere"] * self.poissons_ratio + flow["plate"] * self.plate_poissons_ratio
        return yield_scale(self.ratio, mean)

    def weights(self, blend: float) -> dict[tuple[str, str], float]:
        """Weights of the tables of powers, by who yields and what of the sum they are.

        Of bodies alike the moduli do not matter, since they share the flow.
        """
        both, flow = self.both(blend), self.flow(blend)
        own = self.modulus_share if self.weaker == "sphere" else 1.0 - self.modulus_share
        ratios = {"sphere": self.poissons_ratio, "plate": self.plate_poissons_ratio}
        return {
            ("both", "usual"): both,
            (self.weaker, "usual"): 1.0 - both,
            (self.weaker, "share"): (1.0 - both) * _within(own - 0.5, _SHARES),
            **{
                (body, "poissons_ratio"): flow[body] * _within(nu - 0.3, _RATIOS)
                for body, nu in ratios.items()
            },
            # a wave's way through the sphere, over the contact time, goes as sqrt(E*/E1')
            ("any", "vibration"): math.sqrt(1.0 - self.modulus_share),
        }


PARAMETERS = Given._fields


class _Works(NamedTuple):
    """What the law says of contacts at some largest compressions, one array for each."""

    force: Array
    loading: Array  # work
    recovery: Array  # of it, as a share
    plastic: Array
    residual: Array  # over (q^2 - 1)^2; 0 where nothing yields
    span: Array  # what comes back of the compression


class Curves:
    """What the law says for a pair, as functions of the root compression q.

    Parameters
    ----------
    given : Given
        Numbers of the pair.
    found : dict, optional
        Those of a fit; by default what the package ships.
    """

    def __init__(self, given: Given, found: dict[str, Any] | None = None) -> None:
        found = found or numbers()
        self.ratio = given.ratio
        blend = float(found["blend"])
        self.scale = given.yield_scale(blend) if self.ratio else 1.0
        self._softer = max(1.0, self.ratio / RATIOS[1])
        self._width = math.sqrt(self.scale) * min(1.0, self.ratio / RATIOS[0])
        constant, slope = found["stiffening"]
        self.stiffening = (constant + slope * given.modulus_share) * math.sqrt(self.scale)
        self.friction = friction_loss(given, found["friction"])
        self._terms: dict[str, Array] = {}
        if not self.ratio:
            return
        weights = given.weights(blend)
        for name, cases in found["curves"].items():
            terms = np.zeros((2, *_POWERS))
            for (case, part), weight in weights.items():
                powers = cases.get(case, {}).get(part)
                if powers is not None:
                    terms[int(part == "share")] += weight * _sized(powers)
            usual, moved = terms  # which counts by 1 - t
            self._terms[name] = np.pad(usual + moved, [(0, 1), (0, 0)])
            self._terms[name][1:] -= moved

    def _sum(self, name: str, q: Array) -> Array:
        """Sum of the powers of t and w of one of the functions."""
        known, w = self._known(q, _FLOWN[name == "impact"]), self._width * q
        t = (known - 1.0) / (known + SHIFT)
        return np.asarray(np.polynomial.polynomial.polyval2d(t, w, self._terms[name]))

    def _known(self, q: Array, flown: float) -> Array:
        """Where the sums are known for what a body softer than the campaign's does at q.

        Up to q = `flown` small-strain similarity makes the sums functions of q alone. Beyond, flow
        is complete: they are functions of w alone, those of the softest body of the campaign.
        """
        deep = (q / flown) ** 2
        return np.asarray(q * np.sqrt((1.0 + deep / self._softer**2) / (1.0 + deep)))

    def _over(self, name: str, q: Array) -> Array:
        """Compute 1 + (q - 1) t (sum of powers), the denominators of the law; 1 below yield."""
        if not self.ratio:
            return np.ones_like(q)
        above = np.maximum(q, 1.0)
        return 1.0 + (above - 1.0) ** 2 / (above + SHIFT) * self._sum(name, above)

    def force(self, q: Array) -> Array:
        """Force while the compression grows."""
        return np.asarray(q**3 * (1.0 + self.stiffening * q) / self._over("loading", q))

    def work(self, q: Array) -> Array:
        """Integrate the force: exactly up to yield, by Gauss' rule in ln q beyond."""
        start = np.minimum(q, 1.0) if self.ratio else q
        elastic = 0.4 * start**5 + self.stiffening / 3.0 * start**6
        half = 0.5 * np.log(q / start)
        u = half[..., None] * (1.0 + _GAUSS[0])
        at = start[..., None] * np.exp(u)
        return np.asarray(elastic + half * ((2.0 * at**2 * self.force(at)) @ _GAUSS[1]))

    def residual(self, q: Array) -> Array:
        """Compression that is left of q^2, over (q^2 - 1)^2; from yield on."""
        over = (self._sum("residual", q)) / (q + SHIFT)
        return q**2 * over / ((1.0 + (q - 1.0) ** 2 * over) * (q + 1.0) ** 2)

    def recovery(self, q: Array) -> Array:
        """Share of the loading work that unloading gives back."""
        share = (1.0 - self.friction) / self._over("recovery", q)
        return np.asarray(share * (1.0 - self.impact(q)))

    def impact(self, q: Array) -> Array:
        """Share of what a slow contact would give back that an impact does not."""
        if not self.ratio:
            return np.zeros_like(q)
        above = np.maximum(q, 1.0)
        return np.asarray(((above - 1.0) / (above + SHIFT)) ** 2 * self._sum("impact", above))

    def plastic(self, q: Array, recovery: Array) -> Array:
        """Plastic work over the loading work, where that share of it is given back."""
        if not self.ratio:
            return np.zeros_like(q)
        lost = 1.0 - recovery / (1.0 - self.friction)
        return np.asarray(lost * -np.expm1(-self._sum("plastic", np.maximum(q, 1.0))))

    def works(self, q: Array) -> _Works:
        """All of it at once, each function computed but once."""
        recovery = self.recovery(q)
        return _Works(
            force=self.force(q),
            loading=self.work(q),
            recovery=recovery,
            plastic=self.plastic(q, recovery),
            residual=self.residual(q) if self.ratio else np.zeros_like(q),
            span=q**2 / self._over("residual", q),
        )


@functools.lru_cache(maxsize=64)  # a fit makes one for every trial
def law(*given: float) -> Law:
    """Law of a pair, from the numbers of `PARAMETERS`."""
    return law_of(Given(*given), numbers())


def law_of(given: Given, found: dict[str, Any]) -> Law:
    """Law of a pair from the numbers of a fit."""
    curves = Curves(given, found)
    if curves.ratio and curves.scale > _LATE * deepest(curves.ratio):
        # so strong that it would yield where the law ends
        curves = Curves(given._replace(sphere_ratio=0.0, plate_ratio=0.0), found)

    known: list[tuple[Array, _Works]] = []  # of one array, which four formulas are asked about

    def works(dm: Array) -> _Works:
        if not (known and known[0][0] is dm):
            known[:] = [(dm, curves.works(np.sqrt(dm)))]
        return known[0][1]

    def exponent(dm: Array) -> Array:
        at = works(dm)
        return at.force * at.span / (at.recovery * at.loading) - 1.0

    def loss(dm: Array) -> Array:
        at = works(dm)
        return (1.0 - at.recovery) * at.loading

    def other(dm: Array) -> Array:
        at = works(dm)
        return (1.0 - at.recovery - at.plastic) * at.loading

    first = Polynomial([0.0, 0.0, 0.0, 1.0, curves.stiffening])
    start = min(_SMALLEST / curves.scale, _EARLIEST)
    end = deepest(curves.ratio) / curves.scale
    loading = [Loading(0.0, first)]
    # a table begins at `start`, where it must not meet contacts without any loss
    unloading = [Unloading(0.1 * start, np.zeros_like, exponent, loss=loss, other=other)]
    if curves.ratio:
        loading.append(Loading(1.0, lambda d: curves.force(np.sqrt(d))))
        unloading.append(
            Unloading(1.0, lambda dm: works(dm).residual, exponent, loss, other, order=2.0)
        )
    return Law.of(
        name="fem",
        parameters=given._asdict(),
        source="finite elements of contactlaw, validation.fem.campaign",
        yield_coefficient=curves.scale * (curves.ratio / math.pi) ** 2 if curves.ratio else None,
        loading=loading,
        unloading=unloading,
        scale=curves.scale,
        range=(start, end),
        waves=tuple(found["plate"]),
    )
