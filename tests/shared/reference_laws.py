"""Every registered law once more, by mpmath, from the formulas that its module states.

It shares no code with contactlaw. Compressions in d_Y, forces in F_Y, works in F_Y d_Y, all exact
to far more digits than a double has, next to yield too.
"""

import functools
from dataclasses import dataclass
from typing import Any

from mpmath import diff, exp, findroot, inf, linspace, log, mp, mpf, pi, quad, sqrt

mp.dps = 60
END = 100_000  # compression from which a law continues along its tangent


@dataclass
class Branch:
    """Force from a compression on, and its integral where there is a closed one."""

    start: Any
    force: Any
    integral: Any = None

    def work(self, low, high):
        if self.integral is not None:
            return self.integral(high) - self.integral(low)
        # over ln d, in which the force is as smooth at 1e5 as at 1
        ends = linspace(log(low), log(high), 2 + int(log(high / low)))
        with mp.workdps(25):
            return quad(lambda s: self.force(exp(s)) * exp(s), ends, method="gauss-legendre")


def power(start, factor, exponent):
    factor, exponent = mpf(factor), mpf(exponent)
    return Branch(start, lambda d: factor * d**exponent, lambda d: factor * d ** (exponent + 1) / (exponent + 1))


def line(start, at, force, slope):
    """Straight line through a point."""
    return Branch(start, lambda d: force + slope * (d - at), lambda d: force * d + slope * (d - at) ** 2 / 2)


HERTZ = power(mpf(0), 1, "1.5")


def root(of, low, high):
    """Place at which a function changes its sign."""
    return findroot(of, (mpf(low), mpf(high)), solver="anderson", tol=mpf(10) ** (10 - 2 * mp.dps))


@dataclass
class Reference:
    """A law: branches of its loading curve, residual and exponent as functions of dm."""

    coefficient: Any  # d_Y over pi^2 sigma_Y^2 R*/E*^2
    branches: list
    residual_at: Any = None
    exponent_at: Any = None
    corners: tuple = ()  # largest compressions at which unloading changes its formula, yield first

    def __post_init__(self):
        if self.residual_at is None:
            return  # elastic at every compression
        last = self.branches[-1]
        self.branches = [*self.branches, line(mpf(END), mpf(END), last.force(mpf(END)), diff(last.force, mpf(END)))]

    @property
    def loading_kinks(self):
        return [float(branch.start) for branch in self.branches[1:] if branch.start < END]

    @property
    def outcome_kinks(self):
        return sorted({*self.loading_kinks, *map(float, self.corners)})

    def loading(self, d):
        return next(b for b in self.branches[::-1] if d >= b.start).force(d)

    def work(self, d):
        ends = [*(branch.start for branch in self.branches[1:]), inf]
        return sum(
            branch.work(branch.start, min(end, d))
            for branch, end in zip(self.branches, ends, strict=True)
            if d > branch.start
        )

    def residual(self, dm):
        if dm > END:
            return self.residual_at(mpf(END)) * dm / END
        return self.residual_at(dm)

    def exponent(self, dm):
        return self.exponent_at(min(dm, mpf(END)))

    def unloading(self, d, dm):
        """Force of unloading from dm."""
        left = self.residual(dm)
        return self.loading(dm) * (max(d - left, mpf(0)) / (dm - left)) ** self.exponent(dm)

    def loss(self, dm):
        """Loading work less unloading work."""
        return self.work(dm) - self.loading(dm) * (dm - self.residual(dm)) / (self.exponent(dm) + 1)


@functools.cache
def of(name):
    """Reference of a law, by its name with its numbers."""
    family, _, numbers = name.rstrip(")").partition("(")
    return globals()[family](*(mpf(number) for number in numbers.split(",") if number))


def hertz():
    return Reference(None, [HERTZ])


def myc():
    """Peng et al. 2021, Eqs. 16-18."""
    p = mpf("2.14") / mpf("0.68")
    return Reference(
        mpf("0.68"),
        [HERTZ, line(p, p, p ** mpf("1.5"), mpf("1.5") * sqrt(p))],
        lambda dm: dm - sqrt(2 * dm - 1),
        lambda dm: mpf("1.5"),
        (1,),
    )


def thornton():
    """Hertz's law comes back with the flattened radius R_p/R* = dm^1.5/fm.

    f = sqrt(R_p/R*) (dm - dr)^1.5, so that (dm - dr)^3 = fm^2/(R_p/R*) = fm^3/dm^1.5.
    """
    return Reference(
        mpf("0.25"),
        [HERTZ, line(mpf(1), mpf(1), mpf(1), mpf("1.5"))],
        lambda dm: dm - (3 * dm - 1) / 2 / sqrt(dm),
        lambda dm: mpf("1.5"),
        (1,),
    )


def etsion(coefficient, branches):
    """Etsion, Kligerman, Kadin 2005, with the exponent mended next to yield."""

    def share(dm):
        return (1 - dm ** -mpf("0.28")) * (1 - dm ** -mpf("0.69"))

    def least(dm):
        return mpf("1.5") * (1 - share(dm))

    def printed(dm):
        return mpf("1.5") * dm ** -mpf("0.0331")

    kink = root(lambda dm: least(dm) - printed(dm), "1.1", 2)
    return Reference(
        coefficient, branches, lambda dm: dm * share(dm), lambda dm: least(dm) if dm < kink else printed(dm), (1, kink)
    )


def kogut_etsion(nu):
    """Kogut and Etsion, with the printed branches joined where they meet."""
    first = mpf("1.03") ** (1 / mpf("0.075"))
    second = (mpf("1.40") / mpf("1.03")) ** (1 / mpf("0.162"))
    return etsion(
        (mpf("1.4") * (mpf("0.454") + mpf("0.41") * nu)) ** 2,
        [HERTZ, power(first, "1.03", "1.425"), power(second, "1.40", "1.263")],
    )


def jackson_green(ratio, nu):
    """Jackson and Green, whose second form begins where it meets Hertz's curve."""
    e_y, c = 1 / ratio, mpf("1.295") * exp(mpf("0.736") * nu)
    b = mpf("0.14") * exp(23 * e_y)

    def force(d):
        radius = pi * c * e_y / 2 * sqrt(d) * (d / mpf("1.9")) ** (b / 2)
        hardness = mpf("2.84") * (1 - exp(-mpf("0.82") * radius ** -mpf("0.7")))
        plastic = 4 * hardness / c * (1 - exp(-(d ** (mpf(5) / 9)) / 25)) * d
        return exp(-(d ** (mpf(5) / 12)) / 4) * d ** mpf("1.5") + plastic

    meeting = root(lambda d: force(d) - d ** mpf("1.5"), "1.21", 10)
    return etsion(c**2 / 4, [HERTZ, Branch(meeting, force)])
