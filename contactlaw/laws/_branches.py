"""The formulas of a law, branch by branch: plain numpy functions, each smooth from kink to kink."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial

from contactlaw._arrays import Array as Array  # also for the laws

Formula = Callable[[Array], Array]

END = 1e5  # [d_Y]; a law without a range follows its formulas up to here; for more see `Law.of`
HERTZ = Polynomial([0.0, 0.0, 0.0, 1.0])  # F = q^3


def once(function: Formula) -> Formula:
    """Keep a function's values at the last array, by identity: a law asks for them several times.

    The array must not change meanwhile. The values are a copy, since a formula may write all of its
    values into one array.
    """
    last = values = np.empty(0)

    def kept(at: Array) -> Array:
        nonlocal last, values
        if at is not last:
            last, values = at, np.array(function(at))
        return values

    return kept


@dataclass(frozen=True)
class Loading:
    """A branch of the loading curve, smooth from its start to that of the next one.

    Parameters
    ----------
    start : float
        Compression at which it begins [d_Y]; 0 for the first.
    force : callable or Polynomial
        Force [F_Y]: a function of an array of compressions [d_Y], or a polynomial in the *root*
        compression q. The first branch has to be a polynomial: `HERTZ`, q^3, or one that begins so.
    """

    start: float
    force: Formula | Polynomial

    def at(self, d: Array) -> Array:
        """Force at compressions."""
        return self.force(np.sqrt(d)) if isinstance(self.force, Polynomial) else self.force(d)


@dataclass(frozen=True)
class Unloading:
    """A branch of the family of unloading curves, smooth from its start to that of the next one.

    Parameters
    ----------
    start : float
        Largest compression dm [d_Y] at which it begins. Below the first branch the contact is
        elastic. The first begins at yield, 1, unless loading is stiffer than Hertz's throughout.
    residual : callable
        Function of dm: compression left after unloading from dm, over (dm - 1)^order [d_Y].
    exponent : callable or float, optional
        n in F = Fm ((d - dr)/(dm - dr))^n, a number or a function of dm; 1.5 is Hertz's.
    loss : callable, optional
        Function of dm: loading work minus unloading work, over (dm - 1)^loss_order [F_Y d_Y]. Give
        it where computing the difference of the two works would lose digits, as next to yield. It
        is refused where it is not that difference to 1e-6 of the loading work.
    recovery : callable, optional
        Function of dm: share of the loading work that unloading gives back. It takes the place of
        the exponent, which follows from it.
    other : callable, optional
        Function of dm: share of the loading work that is lost, but not as plastic work; 0 by default.
    order, loss_order : float, optional
        Powers of dm - 1 with which residual and loss begin at yield, 0 by default: they are not
        divided, and the law follows them to 1e-13 of dm and of the loading work. Most laws of the
        package have 2.
    """

    start: float
    residual: Formula
    exponent: Formula | float = 1.5
    loss: Formula | None = None
    recovery: Formula | None = None
    other: Formula | None = None
    order: float = 0.0
    loss_order: float = 0.0
