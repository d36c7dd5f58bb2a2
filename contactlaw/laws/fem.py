"""fem: a law read off finite elements, for bodies of which either, both or neither may yield.

`validation.fem.campaign` presses spheres into blocks and lets them fall on plates, E*/sigma_Y from
11 to 2000 and compressions to a quarter of the radius; `validation.fem.fit` fits the numbers of
fem.json to its results. With d the compression, dm the largest one so far, q = sqrt(d):

    F = q^3 (1 + s q) / (1 + (q - 1) g(q))             loading; g = 0 below yield
    W = (1 - phi) (1 - v(q)) W_l / (1 + (q - 1) h(q))  what unloading from q = sqrt(dm) gives back
                                                       of the loading work W_l
    dr = dm (1 - 1/(1 + (q - 1) k(q)))                 residual compression
    F = Fm ((d - dr)/(dm - dr))^n                      unloading, with the n that gives back W

s is the stiffening of a finite sphere, whose centre approaches less than Hertz's half-spaces would
let it; phi is the share that a friction coefficient of 0.1 takes of the loading work; v is what an
impact loses beyond a slow contact: the bodies go on vibrating, and flow more where inertia adds to
the force. While w = sqrt(d/R) << 1, small-strain similarity makes g, h and k functions of q alone.
In deeper contacts flattened spheres and indented plates differ:

    g = t (sum of g_ij t^i w^j),    t = (q - 1)/(q + 2)

and likewise h, k, v/t and the plastic share 1 - exp(-sum) of the loss, with sums that are linear
in Poisson's ratio and, but for deep contacts, in the modulus of the body that yields, each for
three cases: the sphere yields, the plate, or both alike. v has one more term, for the waves within
the sphere that keep it vibrating; it is that of a sphere 6 times as stiff as the plate where the
sphere is stiffer than that. Where one body is stronger by a factor 1/z, the answer lies between
that of both alike and that of the weaker body alone, by a share that falls from 1 at z = 1 to 0 at
z = 0.36: the weaker body presses on the other with at most 3 times its own yield strength, and the
other yields at a mean pressure of 1.07 times its own. Poisson's ratios are weighted by each
body's share of the flow, a half at equal strengths, so that nothing jumps where another body
becomes the weaker one.

A body softer than the campaign's flows completely in contacts that are shallower than any of these.
Up to complete flow, similarity makes g, h and k functions of q; beyond, they are functions of w,
those of the softest body that was pressed (`Curves`).

Where a body hardens, its flow stress is A + B strain^n at a representative strain, c (w - b w_Y),
with w_Y the w at which flow begins, for a Poisson's ratio of 0.3; b w_Y is at most 0.995 of the w
at which it does. The slope c grows with n and with E*/sigma (`strains`). The curves at a depth are
those of ideal bodies of the strength there (`HardeningCurves`). `validation.fem.metals` has the
impacts to which c was fitted.

A body with losses gives back less of the work and is left compressed, which it recovers from later:

    W -> W exp(-a b(a)) (1 + l)/(1 + l r),    dm - dr -> (dm - dr) exp(-a c(a)),    a = 2 delta/pi

as in a Hertz impact of a body whose loss factor tan delta is the same at all frequencies
(`validation.fem.viscoelastic`), where r, the share W/W_l without losses, is 1. A share l of the
energy that is left at the largest compression is lost before. Bodies that flow have lost less when
they turn; they flow less, too, as if they were stronger by a factor exp(p a).

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

from contactlaw._bisect import bisect
from contactlaw.laws._branches import Array, Loading, Unloading, once
from contactlaw.laws._law import Law

RATIOS = (11.0, 2000.0)  # E*/sigma_Y of the campaign; beyond, `Curves` goes by similarity
_FLOWN = (20.0, 10.0)  # q at which flow is complete: the first for all sums but v, the second for v
_DEEPEST = (23.0, 0.2), (40.0, 0.1)  # two E*/sigma_Y, each with its deepest contacts, d/R
_USUAL = 0.3  # Poisson's ratio of the yield compression from which strains are counted
_LATEST = 0.995  # greatest share of the sqrt(d/R) of yield, before any strain, where strain begins
_TYPICAL = 0.1  # sqrt(d/R) at which bodies that harden are compared with each other
_RATIO, _EXPONENT = 300.0, 0.4  # E*/sigma there, and n, of usual ones
_WIDEST = 1.0  # sqrt(d/R) below which every body that yields has yielded
_SMALLEST = 1e-8  # d/R; below, the contact radius is under 1e-4 R and the stiffening negligible
_EARLIEST = 0.01  # [d_Y]; the law's range begins here at the latest: tables begin before yield
SHIFT = 2.0  # 2 in t = (q - 1)/(q + 2)
_LEAST_FRICTION = 5e-4  # phi of bodies that hardly slip
# reach of the fit about modulus share 0.5 and nu 0.3; constant beyond
_REACH_OF_SHARE, _REACH_OF_POISSON = 0.45, 0.1
# A body that yields only beyond this share of the deepest compression is taken as elastic: it would
# lose less than 1e-5 of the energy, and a law needs some room between its kinks.
_ELASTIC_BEYOND = 0.98
ALONE = 0.36  # z, ratio of the strengths, below which the stronger body does not yield
_POWERS = (6, 4)  # number of powers of t, one of them for the factor 1 - t, and of w


@functools.cache
def fitted() -> dict[str, Any]:
    """Read the fitted numbers."""
    text = files("contactlaw.laws").joinpath("fem.json").read_text("utf-8")
    found: dict[str, Any] = json.loads(text)
    return found


def friction_loss(given: Given, powers: list[float]) -> float:
    """Share phi of the loading work that friction of 0.1 takes of an elastic contact.

    A polynomial in Dundurs' second parameter (Johnson 1985, Eq. 5.3), by which surfaces that are
    pressed together slip on each other; equal bodies do not slip.
    """
    one, other = ((1.0 - 2.0 * nu) / (1.0 - nu) for nu in (given.poissons_ratio, given.plate_poissons_ratio))
    mismatch = 0.5 * ((1.0 - given.modulus_share) * one - given.modulus_share * other)
    return max(_LEAST_FRICTION, float(np.polynomial.polynomial.polyval(mismatch, powers)))


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
    """Numbers that the law takes from a pair, in the order of `PARAMETERS`."""

    sphere_ratio: float  # E*/sigma_Y; 0 for a body that does not yield
    plate_ratio: float
    modulus_share: float  # the sphere's, E1'/(E1' + E2')
    poissons_ratio: float
    plate_poissons_ratio: float
    sphere_hardening: float = 0.0  # B/A of the flow stress A + B strain^n
    plate_hardening: float = 0.0
    sphere_exponent: float = 1.0  # n
    plate_exponent: float = 1.0
    loss_factor: float = 0.0  # tan delta of both bodies together

    @property
    def hardens(self) -> bool:
        """Whether the strength of a body that yields grows with the depth of the contact."""
        return self.sphere_ratio * self.sphere_hardening + self.plate_ratio * self.plate_hardening > 0.0

    @property
    def relaxation(self) -> float:
        """Exponent a = 2 delta/pi with which the modulus grows with frequency."""
        return 2.0 / math.pi * math.atan(self.loss_factor)

    @property
    def ratio(self) -> float:
        """E*/sigma_Y of the weaker body; 0 where neither yields."""
        return max(self.sphere_ratio, self.plate_ratio)

    @property
    def weaker(self) -> str:
        """Body that yields first; "sphere" where both are alike, or neither yields."""
        return "plate" if self.plate_ratio > self.sphere_ratio else "sphere"

    def share_both(self, blend: float) -> float:
        """Share of the case that both yield alike: 1 at equal strengths, 0 if one yields alone.

        In between, it is the power `blend` of a line in the ratio of the strengths.
        """
        z = min(self.sphere_ratio, self.plate_ratio) / self.ratio
        return float((max(0.0, z - ALONE) / (1.0 - ALONE)) ** blend)

    def flow(self, blend: float) -> dict[str, float]:
        """Share of each body in the plastic flow: a half each at equal strengths.

        Poisson's ratios are weighted by these shares. With the weaker body's alone, the law would
        jump where the other body becomes the weaker one.
        """
        other = 0.5 * self.share_both(blend)
        plate = 1.0 - other if self.weaker == "plate" else other
        return {"sphere": 1.0 - plate, "plate": plate}

    def yield_scale(self, blend: float) -> float:
        """Yield compression over R, with the mean Poisson's ratio of the flow."""
        flow = self.flow(blend)
        mean = flow["sphere"] * self.poissons_ratio + flow["plate"] * self.plate_poissons_ratio
        return yield_scale(self.ratio, mean)

    def weights(self, blend: float, stiffest: float = 1.0) -> dict[tuple[str, str], float]:
        """Weights of the tables of coefficients, by which body yields and the term of the sum.

        If both yield alike they share the flow, so their moduli have no term. Beyond the modulus
        share `stiffest` the term of the waves in the sphere falls no more.
        """
        share_both, flow = self.share_both(blend), self.flow(blend)
        own = self.modulus_share if self.weaker == "sphere" else 1.0 - self.modulus_share
        ratios = {"sphere": self.poissons_ratio, "plate": self.plate_poissons_ratio}
        return {
            ("both", "usual"): share_both,
            (self.weaker, "usual"): 1.0 - share_both,
            (self.weaker, "share"): (1.0 - share_both) * np.clip(own - 0.5, -_REACH_OF_SHARE, _REACH_OF_SHARE),
            **{
                (body, "poissons_ratio"): flow[body] * np.clip(nu - 0.3, -_REACH_OF_POISSON, _REACH_OF_POISSON)
                for body, nu in ratios.items()
            },
            # a wave crosses the sphere in a share of the contact time that goes as sqrt(E*/E1')
            ("any", "vibration"): math.sqrt(1.0 - min(self.modulus_share, stiffest)),
        }


PARAMETERS = Given._fields
DEFAULTS = Given._field_defaults  # of the numbers of hardening and losses


class Curves:
    """Curves of the law for a pair, as functions of the root compression q.

    Parameters
    ----------
    given : Given
        Numbers of the pair.
    found : dict, optional
        Numbers of a fit; by default those of fem.json.
    """

    def __init__(self, given: Given, found: dict[str, Any] | None = None) -> None:
        found = found or fitted()
        self.onset: float | None = None
        self.ratio = given.ratio
        blend = float(found["blend"])
        self.scale = given.yield_scale(blend) if self.ratio else 1.0
        self._softer = max(1.0, self.ratio / RATIOS[1])
        self._width = math.sqrt(self.scale) * min(1.0, self.ratio / RATIOS[0])
        constant, slope = found["stiffening"]
        self.stiffening = (constant + slope * given.modulus_share) * math.sqrt(self.scale)
        self.friction = friction_loss(given, found["friction"])
        # shares of the work and of the compression that come back, and of the energy lost before
        a = given.relaxation
        work, span, self.lost_before = (a * float(np.polynomial.polynomial.polyval(a, x)) for x in found["losses"])
        self.returned, self.recovered = math.exp(-work), math.exp(-span)
        self._terms: dict[str, Array] = {}
        weights = given.weights(blend, found["stiffest"]) if self.ratio else {}
        for name, cases in found["curves"].items():
            terms = np.zeros((2, *_POWERS))
            for (case, part), weight in weights.items():
                powers = np.array(cases.get(case, {}).get(part, [[0.0]]))
                terms[int(part == "share"), : len(powers), : len(powers[0])] += weight * powers
            usual, moved = terms  # the term with the modulus has a factor 1 - t
            self._terms[name] = usual + moved - np.roll(moved, 1, axis=0)

    def _own(self, q: Array) -> Array:
        """Root compression in units of the root of d_Y that the strength at q stands for."""
        return q

    def _nearer(self, q: Array) -> Array | float:
        """Distance of the `_own` root compression from yield, over that of q."""
        return 1.0

    def _sum(self, name: str, q: Array) -> Array:
        """Sum of the powers of t and w of one of the functions."""
        known, w = self._similar_q(self._own(q), _FLOWN[name == "impact"]), self._width * q
        t = (known - 1.0) / (known + SHIFT)
        return np.asarray(np.polynomial.polynomial.polyval2d(t, w, self._terms[name]))

    def _similar_q(self, q: Array, flown: float) -> Array:
        """Map q of a body softer than the campaign's to the q at which its sums are known.

        Up to q = `flown` small-strain similarity makes the sums functions of q alone. Beyond, flow
        is complete: they are functions of w alone, those of the softest body of the campaign.
        """
        deep = (q / flown) ** 2
        return np.asarray(q * np.sqrt((1.0 + deep / self._softer**2) / (1.0 + deep)))

    def _over(self, name: str, q: Array) -> Array:
        """Compute 1 + (q - 1) t (sum of powers), the denominators of the law; 1 below yield."""
        above = np.maximum(q, 1.0)
        own = self._own(above)
        return 1.0 + (own - 1.0) ** 2 / (own + SHIFT) * self._sum(name, above)

    def force(self, q: Array) -> Array:
        """Force while the compression grows."""
        return np.asarray(q**3 * (1.0 + self.stiffening * q) / self._over("loading", q))

    def residual(self, q: Array) -> Array:
        """Residual compression after loading to q^2, over (q^2 - 1)^2; from yield on.

        That of bodies with losses is not divided, and begins before.
        """
        if self.recovered < 1.0:
            return np.asarray(q**2 * (1.0 - self.recovered / self._over("residual", q)))
        own = self._own(q)
        over = (self._sum("residual", q)) / (own + SHIFT)
        near = q**2 * over / ((1.0 + (own - 1.0) ** 2 * over) * (q + 1.0) ** 2)
        return near * self._nearer(q) ** 2

    def recovery(self, q: Array) -> Array:
        """Share of the loading work that unloading of bodies without losses gives back."""
        share = (1.0 - self.friction) / self._over("recovery", q)
        return np.asarray(share * (1.0 - self.impact(q)))

    def impact(self, q: Array) -> Array:
        """Share v of the work a slow contact gives back that an impact does not."""
        above = np.maximum(q, 1.0)
        own = self._own(above)
        return np.asarray(((own - 1.0) / (own + SHIFT)) ** 2 * self._sum("impact", above))

    def shares(self, q: Array) -> Array:
        """Shares of the loading work that unloading gives back, and that is plastic work."""
        recovery = self.recovery(q)
        lost = 1.0 - recovery / (1.0 - self.friction)
        plastic = lost * -np.expm1(-self._sum("plastic", np.maximum(q, 1.0)))
        less = 1.0 / (1.0 + self.lost_before * recovery)
        return np.array([recovery * less * self.returned * (1.0 + self.lost_before), plastic * less])


class Strains(NamedTuple):
    """Representative strains of the flow stresses: slope (w - start), with w = sqrt(d/R)."""

    sphere: float  # slope
    plate: float
    start: float

    def ratios(self, given: Given, w: Any) -> tuple[Any, Any]:
        """E*/sigma of sphere and plate at a depth, or at an array of them."""
        beyond = max(w - self.start, 0.0)
        sphere = given.sphere_hardening * (self.sphere * beyond) ** given.sphere_exponent
        plate = given.plate_hardening * (self.plate * beyond) ** given.plate_exponent
        return given.sphere_ratio / (1.0 + sphere), given.plate_ratio / (1.0 + plate)

    def typical(self, given: Given) -> Given:
        """Bodies without hardening, with the strengths that these have at a typical depth."""
        return Given(*self.ratios(given, _TYPICAL), *given[2:5], loss_factor=given.loss_factor)


def strains(given: Given, found: dict[str, Any]) -> tuple[Strains, Strains]:
    """Strains of usual bodies, by which these are compared, and of these.

    Bodies flow less where they share the flow, and more where E*/sigma is large and the flow has
    spread. The larger n is, the more the largest strains count.
    """
    slope, late, both, by_exponent, by_ratio = found["strain"]
    usual = Strains(slope, slope, late * math.sqrt(yield_scale(given.ratio, _USUAL)))
    typical = usual.typical(given)
    slope *= (1.0 - both * typical.share_both(float(found["blend"]))) * (typical.ratio / _RATIO) ** by_ratio
    sphere, plate = (
        slope * math.exp(by_exponent * (n - _EXPONENT)) for n in (given.sphere_exponent, given.plate_exponent)
    )
    return usual, usual._replace(sphere=sphere, plate=plate)


def flowing(given: Given, found: dict[str, Any]) -> Given:
    """Bodies as they flow: those with losses flow less, as stronger ones would."""
    weaker = math.exp(-found["pressure"] * given.relaxation)
    return given._replace(sphere_ratio=weaker * given.sphere_ratio, plate_ratio=weaker * given.plate_ratio)


def comparable(given: Given) -> list[Given]:
    """Bodies whose strengths are compared in the law: it has corners where one becomes weaker."""
    if not given.hardens:
        return [given]
    return [given, *(one.typical(given) for one in strains(given, fitted()))]


class RelativeStrength:
    """Strength of bodies that harden, over that at the typical depth.

    Each body counts by its share of the flow.
    """

    def __init__(self, given: Given, found: dict[str, Any]) -> None:
        self.given, self.taken = given, strains(given, found)[1]
        self.typical, blend = self.taken.typical(given), found["blend"]
        self.flow = list(self.typical.flow(blend).values())
        self.root = math.sqrt(self.typical.yield_scale(blend))  # sqrt(d_Y/R) at the typical strength
        # A body of a low Poisson's ratio yields before its strain begins. The steep rise of its
        # strength there would stop the flow again, so that its strain begins before yield, too.
        latest = _LATEST * self.root * self.at(0.0)
        self.corner = math.log(self.taken.start / latest)  # the law has a corner where this changes its sign
        self.taken = self.taken._replace(start=min(self.taken.start, latest))

    def at(self, w: Any) -> Any:
        """Strength at w = sqrt(d/R) over that at the typical depth."""
        now = self.taken.ratios(self.given, w)
        shares = zip(self.flow, self.typical, now, strict=False)
        return math.prod((then / now) ** share for share, then, now in shares if share)


class HardeningCurves(Curves):
    """Curves of bodies that harden: at each depth those of the strength that they have there.

    That is the flow stress at a representative strain, c (w - b w_Y) with w = sqrt(d/R) and w_Y its
    value where flow begins; less where both bodies share the flow. Which body flows, and how both
    share the flow, is taken at one typical depth, so that no curve has a kink where the stronger
    body becomes the weaker one.
    """

    def __init__(self, given: Given, found: dict[str, Any] | None = None) -> None:
        found = found or fitted()
        strength = RelativeStrength(given, found)
        super().__init__(strength.typical, found)
        self.onset = Given(*given[:5]).yield_scale(found["blend"])
        root, taken = strength.root, strength.taken
        # yield begins where the compression passes that of the strength there
        first: float = bisect(lambda w: w < root * strength.at(w), 0.0, _WIDEST)
        self.scale = first**2
        self.stiffening *= first / root
        self._width *= first / root
        self._rise = first / (first - taken.start)  # of ln(strain) with ln(w) at yield
        self._hardening = []
        # B/A, n and the slope of the strain of sphere and plate
        for share, times, n, slope in zip(strength.flow, given[5:7], given[7:9], taken[:2], strict=True):
            part = times * (slope * (first - taken.start)) ** n
            self._hardening.append((share, part / (1.0 + part), n))

    def _log_own(self, q: Array) -> Array:
        """Logarithm of the `_own` compression, accurate next to yield, where it is zero."""
        beyond = np.maximum(q - 1.0, 0.0)
        own, strain = np.log1p(beyond), np.log1p(self._rise * beyond)
        for share, part, n in self._hardening:
            own = own - share * np.log1p(part * np.expm1(n * strain))
        return own

    def _own(self, q: Array) -> Array:
        return np.exp(self._log_own(q))

    def _nearer(self, q: Array) -> Array:
        limit = 1.0 - self._rise * sum(share * part * n for share, part, n in self._hardening)
        beyond = q > 1.0
        way = np.where(beyond, q - 1.0, 1.0)
        return np.where(beyond, np.expm1(self._log_own(q)) / way, limit)


@functools.lru_cache(maxsize=64)  # a fit to measurements makes a law for every trial
def law(*given: float) -> Law:
    """Law of a pair, from the numbers of `PARAMETERS`."""
    return law_of(Given(*given), fitted())


def law_of(given: Given, found: dict[str, Any]) -> Law:
    """Law of a pair from the numbers of a fit."""
    return Law.of(**formulas(given, found))


def formulas(given: Given, found: dict[str, Any]) -> dict[str, Any]:
    """Formulas of a pair's law, as `Law.of` takes them."""
    named = given[: 10 if given.loss_factor else 9 if given.hardens else 5]
    given = flowing(given, found)
    curves = (HardeningCurves if given.hardens else Curves)(given, found)
    if curves.ratio and curves.scale > _ELASTIC_BEYOND * deepest(curves.ratio):
        # the bodies are so strong that they would yield only where the law ends
        curves = Curves(given._replace(sphere_ratio=0.0, plate_ratio=0.0), found)

    shares = once(lambda dm: curves.shares(np.sqrt(dm)))
    work: Any = {"recovery": lambda dm: shares(dm)[0], "other": lambda dm: 1.0 - sum(shares(dm))}
    first = Polynomial([0.0, 0.0, 0.0, 1.0, curves.stiffening])
    start = min(_SMALLEST / curves.scale, _EARLIEST)
    end = deepest(curves.ratio) / curves.scale
    loading = [Loading(0.0, first)]

    def residual(dm: Array) -> Array:
        return curves.residual(np.sqrt(dm))

    left, order = (residual, 0.0) if curves.recovered < 1.0 else (np.zeros_like, 2.0)
    # tables begin at `start`; the loss begins below, so that no contact in a table is lossless
    unloading = [Unloading(0.1 * start, left, **work)]
    if curves.ratio:
        loading.append(Loading(1.0, lambda d: curves.force(np.sqrt(d))))
        unloading.append(Unloading(1.0, residual, order=order, **work))
    return {
        "name": "fem",
        "parameters": dict(zip(PARAMETERS, named, strict=False)),
        "source": "finite elements of contactlaw, validation.fem.campaign",
        "yield_coefficient": curves.scale * (curves.ratio / math.pi) ** 2 if curves.ratio else None,
        "loading": loading,
        "unloading": unloading,
        "scale": curves.scale,
        "range": (start, end),
        "waves": tuple(found["plate"]),
        "onset": curves.onset,
    }
