"""What table and solver have in common: their methods, their constants and their errors.

`contactlaw.answers.tabulated.TableLookup` looks impacts up, `contactlaw.answers.solver.Solver`
integrates them; either can replace the other. Both are made from a `SphereOnPlate`.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn, Protocol

import numpy as np

from contactlaw._arrays import Array, Mask, Places
from contactlaw._errors import ArgumentError
from contactlaw.physical.history import ForceHistory
from contactlaw.physical.impacts import Impacts
from contactlaw.physical.rebound import Rebound


class Backend(Protocol):
    """Methods that give the outcomes of impacts of a sphere on plates."""

    def rebounds(self, impacts: Impacts) -> Rebound:
        """Everything about impacts."""
        ...

    def oblique(self, impacts: Impacts, psi: Array) -> tuple[Rebound, Array]:
        """Everything about the normal part, and the change of the sliding speed [mu V0].

        `psi` are the sliding speeds before [mu V0].
        """
        ...

    def histories(self, impacts: Impacts, samples: int) -> ForceHistory:
        """Contacts at even times from first touch to separation."""
        ...

    def yield_speeds(self, impacts: Impacts) -> Array:
        """Speeds [m/s] from which sphere or plate yields; inf where neither does."""
        ...


class OutsideTableError(ValueError):
    """An impact that the table does not reach.

    Attributes
    ----------
    impact : int
        Index of the impact in the arguments.
    reason : str
        Which limit of the table it exceeds, and by how much.
    mass : float or None
        Mass that answers at the contact [kg], if it was given.
    """

    def __init__(self, impact: int, reason: str, mass: float | None = None) -> None:
        super().__init__(impact, reason, mass)  # the arguments as given: pickle needs them
        self.impact, self.reason, self.mass = impact, reason, mass

    def __str__(self) -> str:
        heavy = "" if self.mass is None else f", mass={self.mass:g}"
        return (
            f"speed, radius, thickness{heavy}: impact {self.impact} is outside the table, "
            f'{self.reason}. ImpactModel(..., outside="solve") integrates the equation there, '
            '"clamp" takes the value at the table\'s border.'
        )


class UnsolvedError(RuntimeError):
    """An impact whose integration did not come to an end.

    Attributes
    ----------
    impact : int
        Index of the impact in the arguments.
    where, reason : str
        Its dimensionless numbers, and what happened.
    """

    def __init__(self, impact: int, where: str, reason: str) -> None:
        super().__init__(impact, where, reason)
        self.impact, self.where, self.reason = impact, where, reason

    def __str__(self) -> str:
        return f"the equation did not solve at {self.where} (element {self.impact}): {self.reason}"


def too_thin(lam: float, limit: float) -> str:
    """Say why an impact is outside a table whose largest lambda is exceeded."""
    return f"its inelasticity lambda = {_above(lam, limit)}: the plate is too thin for the bead"


def too_fast(chi: float, limit: float) -> str:
    """Say why an impact is outside a table whose largest overload is exceeded."""
    return f"its overload chi = {_above(chi, limit)}: the impact is too fast"


def _above(value: float, limit: float) -> str:
    """Write a value and its limit with four digits, or as many as tell them apart.

    Examples
    --------
    >>> _above(7.0, 6.0), _above(0.3300004, 0.33)
    ('7 is above 6', '0.3300004 is above 0.33')
    """
    pairs = ((f"{value:.{digits}g}", f"{limit:.{digits}g}") for digits in range(4, 18))
    return " is above ".join(next(pair for pair in pairs if pair[0] != pair[1]))


def refuse_to_yield(impacts: Impacts, beyond: Mask, limit: float) -> NoReturn:
    """Refuse the first plate on which lambda, at the yield speed, is beyond the table's largest."""
    n = int(np.argmax(beyond))
    heavy = "" if impacts.mass is None else f" and mass={impacts.mass[n]:g} kg"
    bead = f"a bead of {impacts.radius[n]:g} m{heavy}"
    thin = f"under {bead} the inelasticity at yield is above {limit:.4g}"
    raise ArgumentError("thickness", impacts.thickness[n], f"too thin for the table: {thin}")


@contextmanager
def renumbered(some: Places, mass: Array | None = None) -> Iterator[None]:
    """Make errors about one of some impacts name it by its number among all, and the mass given."""
    try:
        yield
    except (OutsideTableError, UnsolvedError) as error:
        impact, *rest = error.args
        if mass is not None and isinstance(error, OutsideTableError):
            rest[-1] = float(mass[impact])
        raise type(error)(int(some[impact]), *rest) from None
