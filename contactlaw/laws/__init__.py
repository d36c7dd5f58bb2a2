"""Normal force laws in scaled form, one file each, chosen by name.

A law knows no unit: compressions are in units of the yield compression d_Y, forces in units of
F_Y = K d_Y^1.5, so that every law follows Hertz, F = d^1.5, up to d = 1. Forces are functions of
the root compression q, sqrt(d) while loading and sqrt(d - residual) while unloading: it is to
Hertz the radius of contact, and a force that is smooth in it is what the solver needs. A new law
is a new module here that defines ``LAW``; nothing else has to be touched.

A law whose scaled form depends on more than the compression defines ``PARAMETERS`` instead, their
names, and a function ``law`` of them. Their values are part of its name, ``"kogut_etsion(0.3)"``,
so that each set has a table of its own wherever tables are kept by the name of their law.
"""

from __future__ import annotations

import difflib
import functools
import importlib
import math
import pkgutil
import re
from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType
from typing import Any, NamedTuple

_RANGES = {"modulus_ratio": (2.0, 1e6), "poissons_ratio": (0.0, 0.5)}  # of laws' parameters
_BRACKETS = re.compile(r"[a-z_]+\([-+.,0-9e]+\)")


class Functions(NamedTuple):
    """A law as kernels take it: numba-jitted functions and plain numbers. See `Law`."""

    loading: Callable[[float], float]
    residual: Callable[[float], float]
    unloading_curve: Callable[[float], tuple[float, float]]
    unloading: Callable[[float, float, float], float]
    dissipation: Callable[[float], float]
    kinks: tuple[float, ...]  # of the loading curve; the last is inf, so there always is one


@dataclass(frozen=True, eq=False)
class Law:
    """A normal force law, as numba-jitted functions of scaled compressions.

    Parameters
    ----------
    name : str
        What users call it; the name of its module.
    source : str
        Where the formulas come from.
    yield_coefficient : float or None
        c in d_Y = c pi^2 sigma_Y^2 R* / E*^2; None for a law that never yields.
    loading_kinks : tuple of float
        Compressions [d_Y], rising, at which the loading curve changes its formula.
    unloading_kinks : tuple of float
        Largest compressions [d_Y], rising, at which the family of unloading curves does.
    loading : callable
        ``loading(q)``: force [F_Y] while the compression d = q^2 grows.
    residual : callable
        ``residual(dm)``: compression [d_Y] left after unloading from the largest one, dm.
    unloading_curve : callable
        ``unloading_curve(dm)``: the two numbers a, b that single out the unloading curve from
        dm, computed once per impact.
    unloading : callable
        ``unloading(q, a, b)``: force [F_Y] at d = residual(dm) + q^2 below dm; reloading follows
        the same curve.
    dissipation : callable
        ``dissipation(dm)``: loading work minus unloading work [F_Y d_Y] of a contact that
        reached dm.
    yield_strains : tuple of float, optional
        Least and largest sigma_Y/E of a sphere for which finite elements favour the law once it has
        yielded well.
    """

    name: str
    source: str
    yield_coefficient: float | None
    loading_kinks: tuple[float, ...]
    unloading_kinks: tuple[float, ...]
    loading: Callable[[float], float]
    residual: Callable[[float], float]
    unloading_curve: Callable[[float], tuple[float, float]]
    unloading: Callable[[float, float, float], float]
    dissipation: Callable[[float], float]
    yield_strains: tuple[float, float] = (0.0, math.inf)

    @property
    def kinks(self) -> tuple[float, ...]:
        """All compressions [d_Y] at which an impact's outcome is not smooth; the first is 1."""
        return tuple(sorted({*self.loading_kinks, *self.unloading_kinks}))

    @property
    def functions(self) -> Functions:
        """The law as the solver's kernels take it."""
        return Functions(
            self.loading,
            self.residual,
            self.unloading_curve,
            self.unloading,
            self.dissipation,
            (*self.loading_kinks, math.inf),
        )


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
        Some of ``"modulus_ratio"``, E*/sigma_Y, and ``"poissons_ratio"``, that of the sphere.

    Examples
    --------
    >>> import contactlaw.laws
    >>> contactlaw.laws.parameters("kogut_etsion")
    ('poissons_ratio',)
    >>> contactlaw.laws.parameters("kogut_etsion(0.3)")
    ()
    """
    return () if "(" in str(name) else tuple(getattr(_module(name), "PARAMETERS", ()))


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
    module = _module(name)
    wanted = getattr(module, "PARAMETERS", None)
    if wanted is None and "(" in name:
        raise ValueError(f"law: {name!r} takes no numbers; name it as {name.partition('(')[0]!r}")
    if wanted is None:
        found: Law = module.LAW
        return found
    values = _values(name, wanted, numbers)
    made: Law = module.law(*values)
    return made


def _module(name: str) -> ModuleType:
    bare = str(name).partition("(")[0]
    if bare not in names() or ("(" in str(name) and not _BRACKETS.fullmatch(name)):
        near = difflib.get_close_matches(bare, names(), n=1)
        hint = f"did you mean {near[0]!r}? " if near and near[0] != name else ""
        raise ValueError(f"law: unknown law {name!r}; {hint}known laws: {', '.join(names())}")
    return importlib.import_module(f"{__name__}.{bare}")


def _values(name: str, wanted: tuple[str, ...], numbers: dict[str, float]) -> list[float]:
    given: list[Any] | None = name[:-1].partition("(")[2].split(",") if "(" in name else None
    if given is None and numbers.keys() >= set(wanted):
        given = [numbers[parameter] for parameter in wanted]
    form = f"{name.partition('(')[0]}({','.join(wanted)})"
    if given is None or len(given) != len(wanted):
        raise ValueError(f"law: {name!r} needs its numbers, got none or others: name it as {form}")
    values = []
    for parameter, value in zip(wanted, given, strict=True):
        low, high = _RANGES[parameter]
        try:
            number = float(f"{float(value):.6g}")  # as in the name, which a table is found by
        except (TypeError, ValueError):
            number = math.nan
        if not low <= number <= high:
            raise ValueError(
                f"law: {parameter} must lie between {low:g} and {high:g}, got {value!r} in {form}"
            )
        values.append(number)
    return values
