"""Materials on the command line: a name, or numbers of one's own."""

from __future__ import annotations

import difflib
import functools
import re
from collections.abc import Callable, Mapping

from contactlaw._errors import ArgumentError
from contactlaw.cli.parts import quantities, wording
from contactlaw.cli.parts.quantities import value
from contactlaw.physical.materials import Material, find

_NUMBER = re.compile(r"(\w+)\s*=\s*(.*?)[\s,;]*(?=\w+\s*=|$)")


def _hardness(text: str) -> object:
    return text if "H" in text.upper() else value(text, quantities.STRESS)  # HRC, HV, HB


_READERS: dict[str, tuple[str, Callable[[str], object]]] = {
    "E": ("youngs_modulus", functools.partial(value, quantity=quantities.STRESS)),
    "nu": ("poissons_ratio", functools.partial(value, quantity=quantities.SHARE)),
    "rho": ("density", functools.partial(value, quantity=quantities.DENSITY)),
    "yield": ("yield_strength", functools.partial(value, quantity=quantities.STRESS)),
    "hardness": ("hardness", _hardness),
    "kind": ("kind", str),
    "name": ("name", str),
}

# Numbers without a unit below which another one was meant: foam is lighter, and gel softer.
_BARE = re.compile(r"[\d.eE+-]+")
_LIKELY = {
    "E": (1e6, "Pa; MPa or GPa"), "rho": (20.0, "kg/m3; g/cm3"), "yield": (1e4, "Pa; MPa"),
    "hardness": (1e6, "Pa; HRC, HV or HB"),
}  # fmt: skip


def material_of(option: str, text: str, own: Mapping[str, Material]) -> Material:
    """Material of an option: a name of the catalogue or of the user's own, or numbers."""
    try:
        if "=" not in text:
            return find(text, own)
        given: dict[str, object] = {}
        if first := re.split(r"\w+\s*=", text, maxsplit=1)[0].strip(" \t\n,;"):
            raise ValueError(f"{first!r} has no key: write KEY=..., one of {', '.join(_READERS)}")
        for key, word in _NUMBER.findall(text):
            if key not in _READERS:
                near = difflib.get_close_matches(key, _READERS, n=1)
                hint = f"did you mean {near[0]}? " if near else ""
                raise ValueError(f"unknown {key!r}; {hint}known: {', '.join(_READERS)}")
            field, read = _READERS[key]
            if field in given:
                raise ValueError(f"{text!r} has {key} twice: leave one out")
            given[field] = found = read(word)
            least, likely = _LIKELY.get(key, (0.0, ""))
            if isinstance(found, float) and found < least and _BARE.fullmatch(word):
                wording.print_warning(f"{key}={word} is {word} {likely}?")
        if missing := [key for key in ("E", "nu", "rho") if _READERS[key][0] not in given]:
            raise ValueError(f"{text!r} lacks {' and '.join(missing)}, as in {wording.OWN}")
        return Material(**{"name": text} | given)  # type: ignore[arg-type]
    except ValueError as error:
        raise ArgumentError(option, None, wording.sentence(error, ())) from error
