"""Flow stress of a metal: yield strength, hardening and rate, and what a hardness says about them.

Johnson and Cook's flow stress without temperature (Proc. 7th Int. Symp. Ballistics, 1983, 541),

    sigma = (A + B eps^n) (1 + C ln(rate/rate0)),    rates below rate0 count as rate0.
"""

import math
from typing import NamedTuple

# Tabor, The Hardness of Metals (1951): the pressure under an indenter is three times the flow
# stress at 8 % of strain.
CONSTRAINT, _TABOR = 3.0, 0.08


class Flow(NamedTuple):
    """Constants of a body's flow stress.

    Examples
    --------
    >>> round(Flow(350e6, 275e6, 0.36, 0.022, 1.0).stress(0.01, 100.0) / 1e6, 1)
    443.2
    """

    strength: float  # A [Pa]
    hardening: float = 0.0  # B [Pa]
    exponent: float = 1.0  # n
    rate: float = 0.0  # C
    rate0: float = 1.0  # [1/s]

    def factor(self, rate: float) -> float:
        """Flow stress at a rate [1/s] over that at rate0."""
        return 1.0 + self.rate * math.log(max(rate / self.rate0, 1.0))

    def stress(self, strain: float, rate: float = 0.0) -> float:
        """Flow stress [Pa] at an equivalent plastic strain and its rate [1/s]."""
        return (self.strength + self.hardening * math.pow(strain, self.exponent)) * self.factor(rate)


def from_hardness(
    hardness: float, youngs_modulus: float, strength: float | None, exponent: float | None
) -> tuple[float, float]:
    """Strength A and hardening B [Pa] that a hardness [Pa] stands for.

    Without an exponent the body is taken for one that does not harden, and so its strength for that
    at 8 % of strain: the answer is an upper bound of the COR. With an exponent and no strength the
    flow stress is a power of the whole strain, which begins on the elastic line.

    Examples
    --------
    >>> strength, hardening = from_hardness(600e6, 120e9, None, 0.3)
    >>> round(strength / 1e6, 1), round((strength + hardening * 0.08**0.3) / 1e6, 1)
    (38.1, 200.0)
    """
    at_tabor = hardness / CONSTRAINT
    if exponent is None:
        return at_tabor, 0.0
    if strength is None:
        # K eps^n = E eps at the yield strain
        factor = at_tabor / _TABOR**exponent
        yield_strain = (factor / youngs_modulus) ** (1.0 / (1.0 - exponent))
        strength = min(youngs_modulus * yield_strain, at_tabor)
    return strength, (at_tabor - strength) / _TABOR**exponent
