"""Normal force laws in scaled form, one file each, chosen by name.

A law knows no unit: compressions are in units of the yield compression d_Y, forces in units of
F_Y = K d_Y^1.5, so that every law follows Hertz, F = d^1.5, up to d = 1. A file is plain numpy: its
formulas, the kinks between which they are smooth, and their source; `Law.of` makes the data of
them that everything else reads. A new law is a new module here that defines ``LAW``; nothing else
has to be touched. Files that begin with ``_`` are no laws.

A law whose scaled form depends on more than the compression defines ``PARAMETERS`` instead, their
names, and a function ``law`` of them. A `Law` holds their values by name; users may type them in
brackets, ``"kogut_etsion(0.3)"``, which `law` alone reads.

Users bring laws of their own to `contactlaw.ImpactModel`: of formulas by `Law.of`, of measured
points by `contactlaw.measured_law`.
"""

from __future__ import annotations

import dataclasses
import difflib
import functools
import importlib
import math
import pkgutil
import re
from types import ModuleType

from contactlaw.laws._branches import HERTZ, Loading, Unloading
from contactlaw.laws._law import Law

__all__ = ["DEFAULT", "HERTZ", "Law", "Loading", "Unloading", "exact", "law", "names", "parameters"]

DEFAULT = "fem"
"""The law where none is named; it holds what was asked of it in ``validation.fem.acceptance``."""

_RANGES = {
    "modulus_ratio": (2.0, 1e6),
    "poissons_ratio": (0.0, 0.5),
    "sphere_ratio": (0.0, 1e13),  # above that of any Material, whose sigma_Y is at least 1e-12 E
    "plate_ratio": (0.0, 1e13),
    "modulus_share": (0.0, 1.0),
    "plate_poissons_ratio": (0.0, 0.5),
}  # of laws' parameters
_BRACKETS = re.compile(r"\([-+.,0-9e]+\)")


@functools.cache
def names() -> tuple[str, ...]:
    """Names of all laws, sorted.

    Examples
    --------
    >>> import contactlaw.laws
    >>> "myc" in contactlaw.laws.names()
    True
    """
    found = (module.name for module in pkgutil.iter_modules(__path__))
    return tuple(sorted(name for name in found if not name.startswith("_")))


def parameters(name: str) -> tuple[str, ...]:
    """Names of the numbers, beside d_Y, that a law takes from the pair of materials.

    Parameters
    ----------
    name : str
        As `law` takes it; none are missing where it gives them.

    Returns
    -------
    tuple of str
        Some of ``"modulus_ratio"``, E*/sigma_Y, and ``"poissons_ratio"``, those of the sphere;
        ``"sphere_ratio"`` and ``"plate_ratio"``, E*/sigma_Y, 0 for a body that does not yield;
        ``"modulus_share"``, the sphere's E1'/(E1' + E2').

    Examples
    --------
    >>> import contactlaw.laws
    >>> contactlaw.laws.parameters("kogut_etsion")
    ('poissons_ratio',)
    >>> contactlaw.laws.parameters("kogut_etsion(0.3)")
    ()
    """
    family, typed = _typed(name)
    return () if typed else tuple(getattr(_module(family), "PARAMETERS", ()))


def law(name: str, **numbers: float) -> Law:
    """Look up a law by its name.

    Parameters
    ----------
    name : str
        One of `names`; for a law with `parameters` with or without their values in brackets.
    **numbers : float
        Their values, where the name has none; six digits count. A law takes what it needs.

    Raises
    ------
    ValueError
        If there is no such law, the message lists those there are; or if a number is missing.

    Examples
    --------
    >>> from contactlaw.laws import law
    >>> law("myc").yield_coefficient
    0.68
    >>> law("kogut_etsion", poissons_ratio=0.3).name
    'kogut_etsion(0.3)'
    """
    family, typed = _typed(name)
    module = _module(family)
    wanted: tuple[str, ...] = getattr(module, "PARAMETERS", ())
    if typed and not wanted:
        raise ValueError(f"law: {name!r} takes no numbers; name it as {family!r}")
    if not wanted:
        found: Law = module.LAW
        return found
    form = f"{family}({','.join(wanted)})"
    given = typed or [str(numbers[parameter]) for parameter in wanted if parameter in numbers]
    if len(given) != len(wanted):
        raise ValueError(f"law: {name!r} needs its numbers, got none or others: name it as {form}")
    made: Law = module.law(*(_rounded(*one, form) for one in zip(wanted, given, strict=True)))
    return made if typed else dataclasses.replace(made, from_pair=wanted)


def exact(name: str, **numbers: float) -> Law:
    """Law with all digits of its numbers, to differentiate by them; its name shows six.

    Parameters
    ----------
    name : str
        Of a law with `parameters`, without their values.
    **numbers : float
        Their values. A law takes what it needs.

    Examples
    --------
    >>> from contactlaw.laws import exact
    >>> near = [exact("kogut_etsion", poissons_ratio=nu) for nu in (0.3, 0.3 + 1e-9)]
    >>> near[0].name == near[1].name, near[0].yield_coefficient == near[1].yield_coefficient
    (True, False)
    """
    module = _module(name)
    made: Law = module.law(*(numbers[parameter] for parameter in module.PARAMETERS))
    return made


def _typed(name: str) -> tuple[str, list[str]]:
    """Family of a law, and the numbers that a user has typed in brackets behind it."""
    family, bracket, numbers = str(name).partition("(")
    if family not in names() or (bracket and not _BRACKETS.fullmatch(bracket + numbers)):
        near = difflib.get_close_matches(family, names(), n=1)
        hint = f"did you mean {near[0]!r}? " if near and near[0] != name else ""
        raise ValueError(f"law: unknown law {name!r}; {hint}known laws: {', '.join(names())}")
    return family, numbers[:-1].split(",") if bracket else []


def _module(family: str) -> ModuleType:
    return importlib.import_module(f"{__name__}.{family}")


def _rounded(parameter: str, value: float | str, form: str) -> float:
    """Parameter of a law, to the six digits that its name shows."""
    low, high = _RANGES[parameter]
    try:
        number = float(f"{float(value):.6g}")
    except (TypeError, ValueError):
        number = math.nan
    if not low <= number <= high:
        raise ValueError(
            f"law: {parameter} must lie between {low:g} and {high:g}, got {value!r} in {form}"
        )
    return number
