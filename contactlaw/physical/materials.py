"""Materials in SI units, and the catalogue in which every number has a source."""

import difflib
import functools
import math
import os
import re
import tomllib
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from importlib.resources import files
from numbers import Real
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from contactlaw import quantities
from contactlaw._arrays import Array
from contactlaw._content import LARGEST_TEXT, content_of
from contactlaw._errors import ArgumentError
from contactlaw.physical.arguments import refuse_units, unknown
from contactlaw.physical.flow import CONSTRAINT, Flow, from_hardness
from contactlaw.physical.hardness import pascals

# Two bounds of ours that detect values in other units, but allow the softened beads of DEM.
_SOFTEST = 2e3  # [Pa]: above diamond in GPa (1100), below a hydrogel bead (1e4 Pa)
_FASTEST = 25e3  # [m/s]: bar wave speed sqrt(E / rho); diamond has 17e3, steel in g/cm3 162e3
# Two bounds far from any matter, beyond which products of these numbers leave the range of floats.
_DENSITIES = (1e-6, 1e20)  # [kg/m3]: air has 1.2, a neutron star 1e18
_WEAKEST = 1e-12  # yield strain sigma_Y/E
# A tenth of Young's modulus is the usual estimate of the ideal strength of solids. In the catalogue alumina granules
# have the largest yield strain, 0.039, and polymers up to 0.031. Beyond, the modulus was mostly softened; our choice.
_IDEAL_STRENGTH = 0.1
# Plastics without fibres have up to 5 GPa, with 30 % of glass 10; PTFE is the densest, with 2200
# kg/m3. Of metals only the alkalis are as soft and light; for porous ceramics give the kind.
_STIFFEST_POLYMER, _DENSEST_POLYMER = 10e9, 2300.0  # [Pa, kg/m3]
_STEEPEST_ALONE = 0.6  # n of a metal known by its hardness; annealed copper and brass have 0.5
_LEAST_HARDENING = 1e-6  # B over Young's modulus; below, it is in MPa
_STEEPEST_RATE = 0.5  # C; of published metals up to 0.1
_LARGEST_LOSS = 1.0  # tan delta; rubber at its glass transition has 1 to 2, and no one modulus
_FREQUENCIES = 1e-3, 1e9  # [Hz]; from slow tests to ultrasound and beads of micrometres
_LARGEST_ERROR = 1.0  # relative standard error; beyond, nothing is known
WRITE_LOSS = (
    "write loss_factor = [0.03, 1e4] with your numbers, in Python or in a file of materials; "
    "docs/materials.md has the lines of handbooks"
)

KINDS = ("metal", "ceramic", "glass", "polymer")
_LABELS = {
    "youngs_modulus": ("Young's modulus", " Pa"),
    "poissons_ratio": ("Poisson's ratio", ""),
    "density": ("density", " kg/m3"),
    "yield_strength": ("yield strength", " Pa"),
    "hardness": ("hardness", " Pa"),
    "hardening": ("hardening B [Pa] and n", ""),
    "rate": ("rate C and rate0 [1/s]", ""),
    "loss_factor": ("loss factor and its frequency [Hz]", ""),
}
# What an entry of the catalogue takes from the one that it is `like`: the same metal in another
# temper, in which these hardly differ.
# Short names of numbers, and the quantities of those that may be texts with a unit.
SHORT = {"E": "youngs_modulus", "nu": "poissons_ratio", "rho": "density", "yield": "yield_strength"}
_QUANTITIES = {
    "youngs_modulus": quantities.STRESS,
    "poissons_ratio": quantities.SHARE,
    "density": quantities.DENSITY,
    "yield_strength": quantities.STRESS,
    "hardness": quantities.STRESS,
}
_ALIKE = ("kind", "youngs_modulus", "poissons_ratio", "density")


T = TypeVar("T", float, Array)


def sphere_mass(density: Any, radius: T) -> T:
    """Mass of a solid sphere [kg], from its density [kg/m3] and its radius [m]."""
    # products: numpy's third power takes five times as long
    mass: T = 4.0 / 3.0 * math.pi * density * (radius * radius * radius)
    return mass


class UnknownMaterialError(ValueError):
    """A name that the catalogue does not have; its arguments are the name and a tuple of names like it."""

    def __str__(self) -> str:
        name, near = self.args
        hint = f" did you mean {' or '.join(map(repr, near))}?" if near else ""
        return (
            f"unknown material {name!r}:{hint} contactlaw.materials() lists all; Material(...) defines "
            "your own, and read_materials(path) reads them"
        )


class NoYieldStrengthError(ValueError):
    """A law that needs a yield strength, and a material that has none; its arguments are their names."""

    @property
    def what(self) -> str:
        """What is wrong."""
        law, material = self.args
        return f"law {law!r} needs a yield strength, and material {material!r} has none (brittle, or no citable value)"

    def __str__(self) -> str:
        return (
            f'{self.what}: take law="fem", in which such a body is elastic and the other may '
            "yield, or give one in Pa with Material(..., yield_strength=...)"
        )


@dataclass(frozen=True, slots=True)
class Material:
    """An isotropic, elastic-plastic material.

    Parameters
    ----------
    name : str
        Name, used in messages and results.
    youngs_modulus : float
        Young's modulus [Pa], positive.
    poissons_ratio : float
        Poisson's ratio [-], above -1 and up to 0.5.
    density : float
        Density of the bead or plate itself [kg/m3], positive; for a porous bead with its pores.
    yield_strength : float, optional
        Uniaxial yield strength [Pa], positive; None if the material is brittle or the value
        unknown. Without it (and a metal's hardness) a body is elastic, and only ``law="fem"`` and
        ``"hertz"`` take it.
    source : str, optional
        Where the numbers come from.
    kind : str, optional
        ``"metal"``, ``"ceramic"``, ``"glass"`` or ``"polymer"``; None if that is not known: it is
        taken for a polymer then if it is as soft and light as one, up to 10 GPa and 2300 kg/m3.
    hardness : float or str, optional
        Indentation hardness [Pa], Vickers or Knoop, positive, or a text such as "62 HRC", "800 HV"
        or "200 HBW", which is stored in Pa; HRC and HB imply a metal
        (`contactlaw.physical.hardness` has the sources of the conversion); None if it is unknown.
        For a brittle material, which has no yield strength, it limits the contact pressure. For a
        metal it is three times the flow stress at 8 % of strain (Tabor 1951), used where no yield
        strength or only the exponent of hardening is given.
    hardening : (float, float) or float, optional
        B [Pa] and n [-] of the flow stress A + B strain^n, in which A is the yield strength,
        0 < n <= 1. Or n alone: the hardness gives B then, and A too if there is no yield strength.
        Only ``law="fem"`` takes hardening.
    rate : (float, float), optional
        C [-], 0 to 0.5, and rate0 [1/s], positive: the flow stress grows by the factor
        1 + C ln(rate/rate0) (Johnson & Cook 1983). Only ``law="fem"`` takes it.
    loss_factor : (float, float), optional
        tan delta [-], 0 to 1, and the frequency [Hz] at which it and Young's modulus were measured:
        that of an impact, 1/(2 contact times), or near it. From there the modulus is carried to
        each impact's frequency as that of a body whose loss factor is the same at all of them.
        Only ``law="fem"`` takes it.
    uncertainty : mapping of str to float, optional
        Relative standard errors of the numbers above, by their names, for
        `ImpactModel.uncertainty`: ``{"yield_strength": 0.15}`` is 15 %. That of ``hardening`` is
        of B, of ``rate`` of C, of ``loss_factor`` of tan delta; those of numbers that the material
        lacks are left out. The error of a number that is not named is not stated, and counts as 0.
    specified_minimum : bool, optional
        Whether the yield strength is a specified minimum, as standards and data sheets print it:
        real metal is stronger, and its COR may be higher. `contactlaw cor` says so.

    Raises
    ------
    ValueError
        If a value is not a finite real number in its range, or clearly not in SI units.

    Examples
    --------
    >>> from contactlaw import Material
    >>> steel = Material("steel", 207e9, 0.293, 7850, yield_strength=350e6)
    >>> round(steel.plane_modulus / 1e9, 1)
    226.4
    """

    name: str
    youngs_modulus: float
    poissons_ratio: float
    density: float
    yield_strength: float | None = None
    source: str = ""
    kind: str | None = None
    hardness: float | str | None = None
    hardening: tuple[float, float] | float | None = None
    rate: tuple[float, float] | None = None
    loss_factor: tuple[float, float] | None = None
    uncertainty: Mapping[str, float] = field(default_factory=dict, hash=False)
    specified_minimum: bool = False

    def __post_init__(self) -> None:
        """Check every value and store it as float."""
        if not isinstance(self.name, str) or not self.name.strip():
            raise ArgumentError("name", self.name, "must be a non-empty string")
        try:
            self._check()
        except ArgumentError as error:
            reason = f"{error.reason} (material {self.name!r})"
            raise ArgumentError(error.name, error.value, reason) from None

    def _check(self) -> None:
        if not isinstance(self.source, str):
            raise ArgumentError("source", self.source, "must be a string")
        if self.kind is not None and self.kind not in KINDS:
            raise ArgumentError("kind", self.kind, f"must be one of {', '.join(KINDS)}, or None")
        modulus = _positive("youngs_modulus", self.youngs_modulus, "Pa")
        density = _positive("density", self.density, "kg/m3")
        ratio = _finite("poissons_ratio", self.poissons_ratio, "-")
        if not (-1.0 < ratio <= 0.5):
            raise ArgumentError("poissons_ratio", ratio, "must be above -1 and up to 0.5")
        strength = self.yield_strength
        if strength is not None:
            strength = _positive("yield_strength", strength, "Pa")
        hardness = self.hardness
        if isinstance(hardness, str):
            if self.kind is None and "HV" not in hardness.upper():
                self._store(kind="metal")  # of which alone these scales are
            hardness = pascals(hardness)
        if hardness is not None:
            hardness = _positive("hardness", hardness, "Pa")
        _check_units(modulus, density)
        _check_strength("yield_strength", strength, modulus)
        _check_strength("hardness", hardness, modulus)
        self._store(
            youngs_modulus=modulus, poissons_ratio=ratio, density=density, yield_strength=strength, hardness=hardness
        )
        self._store(hardening=_hardening(self))
        self._store(rate=_rate(self), loss_factor=_loss_factor(self), uncertainty=_uncertainty(self))
        if self.specified_minimum not in (False, True):
            reason = "must be True or False: whether yield_strength is a specified minimum"
            raise ArgumentError("specified_minimum", self.specified_minimum, reason)
        self._store(specified_minimum=bool(self.specified_minimum) and strength is not None)

    def _store(self, **values: Any) -> None:
        """Store converted values, for which a frozen dataclass has no other way."""
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @property
    def flow(self) -> Flow | None:
        """Constants of the flow stress; None if the body is elastic.

        Examples
        --------
        >>> from contactlaw import Material
        >>> Material("lead", 16e9, 0.44, 11340, kind="metal", hardness=39e6).flow.strength
        13000000.0
        """
        strength, (hardening, exponent) = self.yield_strength, (0.0, 1.0)
        if isinstance(self.hardening, tuple):
            hardening, exponent = self.hardening
        elif isinstance(self.hardness, float) and (self.strength_from_hardness or self.hardening):
            exponent = self.hardening or exponent
            strength, hardening = from_hardness(self.hardness, self.youngs_modulus, strength, self.hardening)
        if strength is None:
            return None
        return Flow(strength, hardening, exponent, *(self.rate or ()))

    @property
    def strength(self) -> float | None:
        """Stress [Pa] at which flow begins: the yield strength, or what a metal's hardness says."""
        return None if self.flow is None else self.flow.strength

    @property
    def strength_from_hardness(self) -> bool:
        """Whether it is a metal of which no yield strength is known, but a hardness."""
        metal = self.kind == "metal" and self.hardness is not None
        return metal and self.yield_strength is None

    @property
    def plane_modulus(self) -> float:
        """Plane-strain modulus E / (1 - nu^2) [Pa], what one body adds to a Hertz contact."""
        return self.youngs_modulus / (1.0 - self.poissons_ratio**2)

    @property
    def loss_angle(self) -> float:
        """Angle delta by which strain lags behind stress [rad]; 0 without a loss factor."""
        return math.atan(self.loss_factor[0]) if self.loss_factor else 0.0

    @property
    def relaxation(self) -> float:
        """Exponent 2 delta/pi with which the modulus grows with frequency [-].

        Where tan delta is the same at all frequencies, the complex modulus is a power of i times
        the frequency (Lakes, Viscoelastic Materials, Cambridge 2009, section 2.6).
        """
        return 2.0 / math.pi * self.loss_angle

    def at_frequency(self, frequency: float) -> "Material":
        """Return the same material with its modulus at another frequency [Hz].

        Parameters
        ----------
        frequency : float
            Where Young's modulus shall be known; a material without a loss factor stays as it is.

        Examples
        --------
        >>> from contactlaw import Material
        >>> bead = Material("bead", 3e9, 0.35, 1200, loss_factor=(0.1, 1e3))
        >>> round(bead.at_frequency(1e4).youngs_modulus / 1e9, 3)
        3.472
        """
        if self.loss_factor is None:
            return self
        loss, known = self.loss_factor
        growth = (frequency / known) ** self.relaxation
        return replace(self, youngs_modulus=growth * self.youngs_modulus, loss_factor=(loss, frequency))

    @property
    def is_polymer(self) -> bool:
        """Whether it is a polymer, or of unknown kind and as soft and light as one.

        Examples
        --------
        >>> from contactlaw import Material
        >>> Material("POM", 2.9e9, 0.37, 1410, yield_strength=65e6).is_polymer
        True
        """
        if self.kind is not None:
            return self.kind == "polymer"
        return self.youngs_modulus <= _STIFFEST_POLYMER and self.density <= _DENSEST_POLYMER

    def require_yield_strength(self, law: str) -> float:
        """Return the yield strength, or say what is missing.

        Parameters
        ----------
        law : str
            Name of the contact law that needs it.

        Returns
        -------
        float
            Yield strength [Pa].

        Raises
        ------
        ValueError
            If the material has none.

        Examples
        --------
        >>> from contactlaw import material
        >>> material("gamma-alumina").require_yield_strength("myc")
        472500000.0
        """
        if self.strength is None:
            raise NoYieldStrengthError(law, self.name)
        if self.strength_from_hardness and law.partition("(")[0] != "fem":
            # a law without hardening takes the flow stress that the hardness stands for
            return from_hardness(float(self.hardness or 0.0), self.youngs_modulus, None, None)[0]
        return self.strength


def material(name: str) -> Material:
    """Return a material of the catalogue.

    Parameters
    ----------
    name : str
        Name or alias; upper case, spaces and underscores are accepted.

    Returns
    -------
    Material
        The material, with the source of each number in ``source``.

    Raises
    ------
    ValueError
        If the catalogue has no such material; the message lists near matches.

    Examples
    --------
    >>> from contactlaw import material
    >>> material("AISI 304").name
    'stainless-steel-304'
    """
    return find(name, {})


def resolve(argument: str, value: Material | str) -> Material:
    """Material of an argument that takes one, or its name in the catalogue."""
    if isinstance(value, Material):
        return value
    if isinstance(value, str):
        return material(value)
    raise TypeError(f"{argument}: expected a Material or a name from contactlaw.materials(), got {value!r}")


def find(name: str, own: Mapping[str, Material]) -> Material:
    """Return a material by name or alias: one of the user's own, otherwise of the catalogue."""
    if not isinstance(name, str):
        raise ArgumentError("name", name, "must be a string such as 'glass'")
    known = _catalogue() | {_key(alias): body for alias, body in own.items()}
    key = _key(name)
    if key not in known:
        # Names that contain the word, similar ones and those that it contains; each material once.
        near = [one for one in known if key and key in one]
        near += difflib.get_close_matches(key, known, n=3)
        near += [one for one in known if f"-{one}-" in f"-{key}-"]
        raise UnknownMaterialError(name, tuple(dict.fromkeys(known[one].name for one in near)))
    return known[key]


def _key(name: str) -> str:
    return re.sub(r"[\s_-]+", "-", name.strip().lower())


def materials() -> tuple[str, ...]:
    """Return the names of all materials of the catalogue, sorted.

    Examples
    --------
    >>> from contactlaw import materials
    >>> "gamma-alumina" in materials()
    True
    """
    return tuple(sorted({body.name for body in _catalogue().values()}))


def read_materials(path: str | os.PathLike[str]) -> dict[str, Material]:
    r"""Read materials of your own from a file in the format of the catalogue.

    Parameters
    ----------
    path : path-like
        A TOML file with a table for each material: numbers as in `Material`, in SI units or as
        texts with a unit, its ``kind`` and, if you like, ``aliases``, ``grade``, ``source``,
        ``uncertainty`` and ``specified_minimum``. ``E``, ``nu``, ``rho`` and ``yield`` are short
        names. Another entry, of the file or of the catalogue, gives modulus, ratio and density with
        ``like``.

    Returns
    -------
    dict of str to Material
        By name and by alias.

    Raises
    ------
    OSError, ValueError
        If there is no such file; if it is no TOML, or a table lacks a number or has an unknown one.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from contactlaw import read_materials
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "mine.toml"
    ...     _ = file.write_text("[hard-304]\nlike = 'stainless-steel-304'\nhardness = '32 HRC'")
    ...     read_materials(file)["hard-304"].density
    8000.0
    """
    try:
        text = content_of(Path(path), LARGEST_TEXT, pipe=True).decode("utf-8-sig")
        return _read(tomllib.loads(text), _tables())
    except (ValueError, TypeError, AttributeError, KeyError, RecursionError) as error:
        raise ArgumentError("materials", None, f"{os.fspath(path)}: {error}") from error


def _tables() -> dict[str, Any]:
    text = files("contactlaw.physical").joinpath("catalogue.toml").read_text("utf-8")
    return tomllib.loads(text)


@functools.cache
def _catalogue() -> dict[str, Material]:
    """Read the catalogue once: materials by name and by alias."""
    return _read(_tables(), {})


def spelled_out(table: dict[str, Any]) -> dict[str, Any]:
    """Write short names in full, and numbers with a unit in SI units; HRC, HV and HB stay.

    Examples
    --------
    >>> spelled_out({"E": "210 GPa", "hardness": "62 HRC"})
    {'youngs_modulus': 210000000000.0, 'hardness': '62 HRC'}
    """
    long = {SHORT.get(key, key): value for key, value in table.items()}
    if len(long) < len(table):
        raise ValueError(f"{', '.join(SHORT)}: give the short name or the long one, not both")
    return {
        key: quantities.value(value, _QUANTITIES[key])
        if key in _QUANTITIES and isinstance(value, str) and not (key == "hardness" and "H" in value.upper())
        else value
        for key, value in long.items()
    }


def _read(tables: dict[str, Any], others: dict[str, Any]) -> dict[str, Material]:
    """Materials by name and by alias; an entry may be `like` one of other tables."""
    references = others.pop("references", {}) | tables.pop("references", {})
    owner: dict[str, str] = {}
    for name, table in tables.items():
        if not isinstance(table, dict):
            raise ValueError(f"{name} = {table!r} is no material: write [{name}], then its numbers")
        aliases = table.get("aliases", [])
        if not isinstance(aliases, list) or not all(isinstance(one, str) for one in aliases):
            raise ValueError(f"[{name}]: aliases must be a list of names, got {aliases!r}")
        for one in (name, *aliases):
            # an alias may spell the name of its own entry in another way
            if (key := _key(one)) in owner and not (one != name and key == _key(name)):
                raise ValueError(f"[{name}]: leave out {one!r}, a name of [{owner[key]}] already")
            owner[key] = name
        tables[name] = spelled_out(table)
    known = {_key(one): table for name, table in (others | tables).items() for one in (name, *table.get("aliases", ()))}
    found = {name: _from_table(name, tables[name], known, references) for name in tables}
    return found | {one: found[name] for name in tables for one in tables[name].get("aliases", ())}


def _from_table(name: str, table: dict[str, Any], tables: dict[str, Any], references: dict[str, str]) -> Material:
    taken = (*_LABELS, "kind", "specified_minimum")
    known = (*taken, "grade", "aliases", "like", "source", "uncertainty")
    for key in table.keys() - known:
        raise ValueError(f"[{name}]: {unknown(key, known)}")
    table = _with_like(name, table, tables)
    source = table["source"]
    if missing := [field for field in _ALIKE[1:] if field not in table]:
        raise ValueError(f"[{name}]: give {', '.join(missing)}, in SI units")
    # Hardening and rate are of the same fit as the yield strength A.
    fitted = {"hardening", "rate"} & set(table)
    source = {field: source.get("yield_strength", "") for field in fitted} | source
    values = {field: table[field] for field in taken if field in table}
    errors = {  # an error has a reason in the catalogue
        number: error if isinstance(error, list) else [error, ""] for number, error in table["uncertainty"].items()
    }
    body = Material(name, **values, uncertainty={number: error for number, (error, _) in errors.items()})
    parts = [table.get("grade", name)]
    for number, (label, unit) in _LABELS.items():
        if number not in source:
            continue  # as the hardness of a material that has a yield strength
        stored = getattr(body, number)
        numbers = stored if isinstance(stored, tuple) else () if stored is None else (stored,)
        shown = ",".join(f" {value:g}{unit}" for value in numbers)
        parts.append(f"{label}{shown}: {_cited(source[number], references)}")
        if number in errors:
            error, reason = errors[number][0], _cited(errors[number][1], references)
            parts.append(f"standard error of it {100.0 * error:g} %: {reason}")
    return replace(body, source="; ".join(parts))


def _with_like(name: str, table: dict[str, Any], tables: dict[str, Any]) -> dict[str, Any]:
    """Add what an entry takes from the one that it is `like`; sources are by number."""
    if not isinstance(errors := table.get("uncertainty", {}), dict):
        raise ValueError(f"[{name}]: uncertainty must be a table as {{yield_strength = 0.15}}, got {errors!r}")
    source = _sources(table)
    if "like" in table:
        if (other := tables.get(_key(str(table["like"])))) is None or other is table:
            raise ValueError(f"[{name}]: like = {table['like']!r} is no {'other ' * bool(other)}entry")
        other = _with_like(table["like"], other, tables)
        table = {field: other[field] for field in _ALIKE if field in other} | table
        theirs = other["source"]
        source = {field: theirs[field] for field in _ALIKE if field in theirs} | source
        errors = {field: e for field, e in other["uncertainty"].items() if field in _ALIKE} | errors
    return table | {"source": source, "uncertainty": errors}


def _sources(table: dict[str, Any]) -> dict[str, str]:
    """Take the sources of an entry by their numbers; a text is the source of all of them."""
    given = table.get("source", {})
    return dict.fromkeys(table.keys() & _LABELS.keys(), given) if isinstance(given, str) else given


def _cited(text: str, references: dict[str, str]) -> str:
    """Write out the references in a text, each the name of one in braces."""
    return re.sub(r"\{(\w+)\}", lambda one: references.get(one[1], one[0]), text)


def _finite(field: str, value: object, unit: str) -> float:
    refuse_units(field, value, "" if unit == "-" else unit.replace("m3", "m**3"))
    # bool is a Real to Python, but True is no measurement.
    if not isinstance(value, Real) or isinstance(value, bool):
        raise ArgumentError(field, value, f"must be a number in [{unit}]")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ArgumentError(field, value, f"must be finite [{unit}]")
    return number


def _positive(field: str, value: object, unit: str) -> float:
    number = _finite(field, value, unit)
    if not (number > 0.0):
        raise ArgumentError(field, value, f"must be positive [{unit}]")
    return number


def _two(field: str, given: Any, expected: str) -> Any:
    """Check that a value is two numbers."""
    numbers = given.tolist() if isinstance(given, np.ndarray) else given
    if not isinstance(numbers, tuple | list) or len(numbers) != 2:
        raise ArgumentError(field, numbers, f"must be {expected}")
    return numbers


def _hardening(body: Material) -> tuple[float, float] | float | None:
    """Check the hardening of a material; None if it has none."""
    given, refused = body.hardening, functools.partial(ArgumentError, "hardening")
    if given is None:
        return None
    if not isinstance(given, tuple | list | np.ndarray):
        exponent = _finite("hardening", given, "-")
        if not (0.0 < exponent < 1.0):
            raise refused(given, "n must be above 0 and below 1")
        if body.yield_strength is None and exponent > _STEEPEST_ALONE:
            most = f"with a hardness and no yield_strength, n must be up to {_STEEPEST_ALONE:g}"
            raise refused(given, f"{most}: flow would begin at next to no stress; give both")
        if not isinstance(body.hardness, float):
            remedy = "give (B, n) with B in Pa, or the hardness, from which B follows"
            raise refused(given, f"is the exponent alone: {remedy}")
        if body.yield_strength is not None and body.hardness < CONSTRAINT * body.yield_strength:
            least = f"three times the yield strength {body.yield_strength:g} Pa"
            raise refused(None, f"a hardness of {body.hardness:g} Pa is below {least}, as if it softened")
        return exponent
    given = _two("hardening", given, "(B, n), B in Pa, or n alone")
    if body.yield_strength is None:
        raise refused(given, "needs a yield_strength A in Pa, of A + B strain^n")
    hardening = _finite("hardening", given[0], "Pa")
    if not (0.0 <= hardening < body.youngs_modulus):
        raise refused(given, f"B must be from 0 to below the modulus, {body.youngs_modulus!r} Pa")
    if 0.0 < hardening < _LEAST_HARDENING * body.youngs_modulus:
        raise refused(given, "B is next to nothing: give it in Pa")
    exponent = _finite("hardening", given[1], "-")
    if not (0.0 < exponent <= 1.0):
        raise refused(given, "n must be above 0 and up to 1")
    return (hardening, exponent) if hardening else None


def _rate(body: Material) -> tuple[float, float] | None:
    """Check what a material's strength has of the rate; None if it has nothing."""
    if body.rate is None:
        return None
    given = _two("rate", body.rate, "(C, rate0), rate0 in 1/s")
    refused = functools.partial(ArgumentError, "rate", given)
    if body.strength is None:
        raise refused("needs a yield_strength in Pa: an elastic body has no flow stress")
    slope = _finite("rate", given[0], "-")
    if not (0.0 <= slope <= _STEEPEST_RATE):
        raise refused(f"C must be from 0 to {_STEEPEST_RATE:g}")
    rate0 = _positive("rate", given[1], "1/s")
    return (slope, rate0) if slope else None


def _loss_factor(body: Material) -> tuple[float, float] | None:
    """Check the loss factor of a material; None if it loses nothing."""
    if body.loss_factor is None:
        return None
    given = _two("loss_factor", body.loss_factor, f"(tan delta, frequency), the frequency in Hz: {WRITE_LOSS}")
    refused = functools.partial(ArgumentError, "loss_factor", given)
    loss = _finite("loss_factor", given[0], "-")
    if not (0.0 <= loss <= _LARGEST_LOSS):
        raise refused(f"tan delta must be from 0 to {_LARGEST_LOSS:g}")
    frequency = _positive("loss_factor", given[1], "Hz")
    if not (_FREQUENCIES[0] <= frequency <= _FREQUENCIES[1]):
        limits = f"its frequency must be from {_FREQUENCIES[0]:g} to {_FREQUENCIES[1]:g} Hz"
        raise refused(f"{limits}: give that of an impact, 1/(2 contact times), or one near")
    return (loss, frequency) if loss else None


def _uncertainty(body: Material) -> dict[str, float]:
    """Check the relative standard errors of a material's numbers."""
    given, refused = body.uncertainty, functools.partial(ArgumentError, "uncertainty")
    if not isinstance(given, Mapping):
        raise refused(given, 'must be a mapping as {"yield_strength": 0.15}, relative')
    found = {}
    for name, value in given.items():
        if name not in _LABELS:
            raise refused(None, unknown(str(name), _LABELS))
        is_number = isinstance(value, Real) and not isinstance(value, bool)
        if not (is_number and 0.0 <= value <= _LARGEST_ERROR):
            reason = f"{name} must be a relative standard error from 0 to {_LARGEST_ERROR:g}, as 0.1 for 10 %"
            if name == "yield_strength" and str(value) in ("inf", "minimum"):
                reason += "; leave it out, and write specified_minimum = true (True in Python)"
            raise refused(value, reason)
        if getattr(body, name) is not None:
            found[name] = float(value)
    return found


def _check_units(modulus: float, density: float) -> None:
    if not (modulus >= _SOFTEST):
        reason = f"below {_SOFTEST:g} Pa, softer than any bead: give it in Pa (not GPa)"
        raise ArgumentError("youngs_modulus", modulus, reason)
    if not (_DENSITIES[0] <= density <= _DENSITIES[1]):
        limits = f"{_DENSITIES[0]:g} and {_DENSITIES[1]:g} kg/m3"
        raise ArgumentError("density", density, f"must lie between {limits}")
    speed = math.sqrt(modulus / density)
    if not (speed <= _FASTEST):
        wave = f"give a wave speed of {speed:.3g} m/s, faster than in any solid"
        remedy = "give density in kg/m3 (not g/cm3) and youngs_modulus in Pa"
        raise ArgumentError("density, youngs_modulus", (density, modulus), f"{wave}: {remedy}")


def warn_of_softened(body: Material) -> None:
    """Warn, at the caller's caller's, of a body that is stronger than any solid of its modulus."""
    strength = max(body.strength or 0.0, float(body.hardness or 0.0) / CONSTRAINT)
    if strength > _IDEAL_STRENGTH * body.youngs_modulus:
        warnings.warn(
            f"material {body.name!r}: a strength of {strength:.4g} Pa is above a tenth of youngs_modulus "
            f"{body.youngs_modulus:.4g} Pa, and no solid is so strong. Give the true modulus; for longer time steps "
            "WallContacts and attach have softening=. Of rubber leave the strength out",
            stacklevel=3,
        )


def _check_strength(field: str, strength: float | None, modulus: float) -> None:
    if strength is not None and not (strength < modulus):
        reason = (
            f"must be below youngs_modulus {modulus!r}: give both in Pa, and the true modulus, as softening= "
            "is there for longer time steps"
        )
        raise ArgumentError(field, strength, reason)
    if strength is not None and not (strength >= _WEAKEST * modulus):
        limit = f"must be at least {_WEAKEST:g} of youngs_modulus {modulus!r}"
        raise ArgumentError(field, strength, f"{limit}, no solid is weaker: give both in Pa")
