"""Normal force laws in scaled form, one file each, chosen by name.

A law knows no unit: compressions are in units of the yield compression d_Y, forces in units of
F_Y = K d_Y^1.5, so that a law that follows Hertz up to yield is F = d^1.5 up to d = 1. A file holds
plain numpy formulas, the kinks between which they are smooth, and their source; `Law.of` turns them
into the array that everything else reads. A new law is a new module here that defines ``LAW``, which
the package finds by itself; CONTRIBUTING lists what tests and figures want to know of it. Files that
begin with ``_`` are no laws.

A law whose scaled form depends on more than the compression defines ``PARAMETERS``, the names of
its numbers, and a function ``law`` of them; ``DEFAULTS`` holds the values of the last of them that
may be left out. A `Law` holds their values by name. Users may also type
the values in brackets, ``"kogut_etsion(0.3)"``, which only `law` reads.

Users give laws of their own to `contactlaw.ImpactModel`: `Law.of` makes them from formulas,
`contactlaw.measured_law` from measured points.
"""

import dataclasses
import difflib
import functools
import importlib
import math
import pkgutil
import re
from types import ModuleType

from contactlaw._errors import ArgumentError
from contactlaw.laws._branches import HERTZ, Loading, Unloading
from contactlaw.laws._law import Law, Strengths

__all__ = ["DEFAULT", "HERTZ", "Law", "Loading", "Strengths", "Unloading", "exact", "law", "names", "parameters"]

DEFAULT = "fem"
"""The law if none is named; it meets the targets of ``validation.accuracy.acceptance``."""

_LARGEST = {  # value of each parameter that a law may have; the least is 0
    "modulus_ratio": 1e6,
    "poissons_ratio": 0.5,
    "sphere_ratio": 1e13,  # no Material reaches 1e13: its sigma_Y is at least 1e-12 E
    "plate_ratio": 1e13,
    "modulus_share": 1.0,
    "plate_poissons_ratio": 0.5,
    "sphere_hardening": 1e12,
    "plate_hardening": 1e12,
    "sphere_exponent": 1.0,
    "plate_exponent": 1.0,
    "loss_factor": 1.0,
}
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
    modules = (module.name for module in pkgutil.iter_modules(__path__))
    return tuple(sorted(name for name in modules if not name.startswith("_")))


def parameters(name: str) -> tuple[str, ...]:
    """Names of the numbers, beside d_Y, that a law takes from the pair of materials.

    Parameters
    ----------
    name : str
        A law, as `law` takes it. With the values in brackets it takes none from the pair.

    Returns
    -------
    tuple of str
        Some of ``"modulus_ratio"``, the sphere's E*/sigma_Y; ``"sphere_ratio"`` and
        ``"plate_ratio"``, E*/sigma_Y of each body, 0 if it does not yield; ``"modulus_share"``,
        the sphere's E1'/(E1' + E2'); ``"poissons_ratio"`` (sphere), ``"plate_poissons_ratio"``;
        ``"sphere_hardening"``, ``"sphere_exponent"`` and the plate's, B/A and n of the flow stress
        A + B strain^n; ``"loss_factor"``, tan delta of the two bodies.

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
        One of `names`. The values of a law's `parameters` may follow in brackets.
    **numbers : float
        Values of its `parameters` if the name has none, rounded to six digits; others are ignored.

    Raises
    ------
    ValueError
        If no law has this name (the message lists all), or a number is missing or out of range.

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
    wanted = every = getattr(module, "PARAMETERS", ())
    defaults: dict[str, float] = getattr(module, "DEFAULTS", {})
    if len(every) - len(defaults) <= len(typed) <= len(every):
        wanted = every[: len(typed)]
    numbers = {**defaults, **numbers}
    if typed and not wanted:
        raise ArgumentError("law", name, f"takes no numbers: name it as {family!r}")
    if not wanted:
        plain: Law = module.LAW
        return plain
    form = f"{family}({','.join(wanted)})"
    values = typed or [str(numbers[parameter]) for parameter in wanted if parameter in numbers]
    if len(values) != len(wanted):
        raise ArgumentError("law", name, f"needs a value for each parameter: name it as {form}")
    made: Law = module.law(*(_rounded(*pair, form) for pair in zip(wanted, values, strict=True)))
    return made if typed else dataclasses.replace(made, from_pair=every)


def own(law: Law) -> Law:
    """Refuse a law of one's own that has the name of one of the package: it would get its errors."""
    family = law.family
    # families without parameters have one law, LAW; laws of the others are told by their parameters
    if family in names() and law != getattr(_module(family), "LAW", law.parameters and law):
        raise ArgumentError("law", family, "a law of contactlaw has this name: give yours another")
    return law


def exact(name: str, **numbers: float) -> Law:
    """Make a law from unrounded parameters, to differentiate by them; its name shows six digits.

    Parameters
    ----------
    name : str
        Name of a law with `parameters`, without their values.
    **numbers : float
        Values of the parameters; others are ignored.

    Examples
    --------
    >>> from contactlaw.laws import exact
    >>> near = [exact("kogut_etsion", poissons_ratio=nu) for nu in (0.3, 0.3 + 1e-9)]
    >>> near[0].name == near[1].name, near[0].yield_coefficient == near[1].yield_coefficient
    (True, False)
    """
    module = _module(name)
    numbers = {**getattr(module, "DEFAULTS", {}), **numbers}
    made: Law = module.law(*(numbers[parameter] for parameter in module.PARAMETERS))
    return made


def _typed(name: str) -> tuple[str, list[str]]:
    """Split a name as ``"kogut_etsion(0.3)"`` into the family and the numbers in brackets."""
    family, bracket, numbers = str(name).partition("(")
    if family not in names() or (bracket and not _BRACKETS.fullmatch(bracket + numbers)):
        near = difflib.get_close_matches(family, names(), n=1)
        hint = f"did you mean {near[0]!r}? " if near and near[0] != name else "a record of your law needs one of the "
        raise ArgumentError("law", name, f"unknown law; {hint}known laws: {', '.join(names())}")
    return family, numbers[:-1].split(",") if bracket else []


def _module(family: str) -> ModuleType:
    return importlib.import_module(f"{__name__}.{family}")


def _rounded(parameter: str, value: float | str, form: str) -> float:
    """Round a law's parameter to the six digits that its name shows, and check its range."""
    most = _LARGEST[parameter]
    try:
        number = float(f"{float(value):.6g}")
    except (TypeError, ValueError):
        number = math.nan
    if not 0.0 <= number <= most:
        reason = f"{parameter} must lie between 0 and {most:g}, not {value!r}"
        raise ArgumentError("law", form, reason)
    return number
