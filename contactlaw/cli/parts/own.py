"""Materials on the command line: a name, or numbers of one's own."""

import dataclasses
import difflib
import re
from collections.abc import Iterable, Mapping
from typing import Any

from contactlaw._errors import ArgumentError
from contactlaw.cli.parts import wording
from contactlaw.physical.materials import SHORT, WRITE_LOSS, Material, UnknownMaterialError, find, number_of

_NUMBER = re.compile(r"(\w+)\s*=\s*(.*?)[\s,;]*(?=\w+\s*=|$)")


_TEXTS = "kind", "name"
_FIELDS = SHORT | {name: name for name in ("hardness", *_TEXTS)}

# Numbers without a unit below which another one was meant: foam is lighter, and gel softer.
_BARE = re.compile(r"[\d.eE+-]+")
_LIKELY = {
    "E": (1e6, "Pa; MPa or GPa"),
    "rho": (20.0, "kg/m3; g/cm3"),
    "yield": (1e4, "Pa; MPa"),
    "hardness": (1e6, "Pa; HRC, HV or HB"),
}


def unknown(name: str, known: Iterable[str]) -> str:
    """Say that a name is not among those known, and which of them is like it.

    Examples
    --------
    >>> unknown("thicknes", ["radius", "thickness"])
    "unknown 'thicknes'; did you mean thickness? known: radius, thickness"
    """
    names = [*known]
    near = difflib.get_close_matches(name, names, n=1)
    return f"unknown {name!r}; {f'did you mean {near[0]}? ' if near else ''}known: {', '.join(names)}"


def material_of(option: str, text: str, own: Mapping[str, Material]) -> Material:
    """Material of an option: a name of the catalogue or of the user's own, numbers, or a name and what differs."""
    try:
        if "=" not in text:
            return find(text, own)
        given: dict[str, object] = {}
        first = re.split(r"\w+\s*=", text, maxsplit=1)[0].strip(" \t\n,;")
        for key, word in _NUMBER.findall(text):
            if key == "loss_factor":
                raise ValueError(f"loss_factor has a frequency, too: {WRITE_LOSS}")
            if key not in _FIELDS:
                raise ValueError(unknown(key, _FIELDS))
            field = _FIELDS[key]
            if field in given:
                raise ValueError(f"{text!r} has {key} twice: leave one out")
            given[field] = found = word if key in _TEXTS else number_of(field, word)
            least, likely = _LIKELY.get(key, (0.0, ""))
            if isinstance(found, float) and found < least and _BARE.fullmatch(word):
                wording.print_warning(f"{key}={word} is {word} {likely}?")
        if first:
            try:
                return changed(find(first, own), given)
            except UnknownMaterialError:
                raise ValueError(f"{first!r} has no key: write KEY=..., one of {', '.join(_FIELDS)}") from None
        if missing := [key for key in ("E", "nu", "rho") if _FIELDS[key] not in given]:
            raise ValueError(f"{text!r} lacks {' and '.join(missing)}, as in {wording.OWN}")
        return Material(**{"name": text} | given)  # type: ignore[arg-type]
    except ValueError as error:
        raise ArgumentError(option, None, wording.sentence(error, {})) from error


def changed(body: Material, given: dict[str, Any]) -> Material:
    """Body with other numbers, whose errors are those given; a hardness replaces its yield strength."""
    if "hardness" in given and body.hardening is None:
        given = {"yield_strength": None} | given
    if "yield_strength" in given:
        given = {"specified_minimum": False} | given
    errors = {key: error for key, error in body.uncertainty.items() if key not in given}
    return dataclasses.replace(body, **given | {"uncertainty": errors | given.get("uncertainty", {})})
