"""The formulas of a law, branch by branch: plain numpy functions, each smooth from kink to kink."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

Array = NDArray[np.float64]
Formula = Callable[[Array], Array]

END = 1e5  # [d_Y], of a law without a range; beyond, it goes on by its tangent, see `Law.of`
HERTZ = Polynomial([0.0, 0.0, 0.0, 1.0])  # F = q^3


@dataclass(frozen=True)
class Loading:
    """A branch of the loading curve, smooth from its start to that of the next one.

    Parameters
    ----------
    start : float
        Compression at which it begins [d_Y]; 0 for the first.
    force : callable or Polynomial
        Force [F_Y]: a function of arrays of the compression [d_Y], or a polynomial in the *root*
        compression, as the first branch has to be: Hertz's `HERTZ`, q^3, or one that begins so.
    """

    start: float
    force: Formula | Polynomial


@dataclass(frozen=True)
class Unloading:
    """A branch of the family of unloading curves, smooth from its start to that of the next one.

    Parameters
    ----------
    start : float
        Largest compression at which it begins [d_Y]. Below the first branch the contact is elastic.
        The first one begins at yield, 1, unless loading is stiffer than Hertz's from the start.
    residual : callable
        Compression left after unloading from dm, over (dm - 1)^order [d_Y].
    exponent : callable or float, optional
        n in F = Fm ((d - dr)/(dm - dr))^n; 1.5 is Hertz's.
    loss : callable, optional
        Loading work less unloading work over (dm - 1)^loss_order [F_Y d_Y], where the difference
        of the two would lose its digits.
    other : callable, optional
        What of the loss is not plastic work [F_Y d_Y]; none by default.
    order, loss_order : float, optional
        How residual and loss begin at dm = 1; 2 for most laws. With 0 no factor is taken out, and
        the law follows them to 1e-13 of dm and of the loading work.
    cap : tuple of callable, optional
        Compressions, lower and upper, between which the way back is the loading curve, which is
        lower there than the unloading curve; the upper one is None if that is so from dm on.
    """

    start: float
    residual: Formula
    exponent: Formula | float = 1.5
    loss: Formula | None = None
    other: Formula | None = None
    order: float = 0.0
    loss_order: float = 0.0
    cap: tuple[Formula, Formula | None] | None = None


def bisect(above: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Place, or places, between which a condition that holds at `low` ends."""
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    for _ in range(60):
        middle = 0.5 * (low + high)
        holds = above(middle)
        low, high = np.where(holds, middle, low), np.where(holds, high, middle)
    return low
