"""Materials on the command line: a name, or numbers of one's own."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Mapping

from contactlaw.cli.parts import quantities, wording
from contactlaw.cli.parts.quantities import Quantity, value
from contactlaw.physical.materials import Material, find

_NUMBER = re.compile(r"(\w+)\s*=\s*(.*?)[\s,;]*(?=\w+\s*=|$)")


def _of(*parts: Quantity) -> Callable[[str], object]:
    """Reader of as many numbers as quantities, or of the last ones; of one number alone."""

    def read(text: str) -> object:
        words = text.strip("()[] ").split(",")
        if len(words) > len(parts):
            raise ValueError(f"got {text!r}, expected {' and '.join(one.name for one in parts)}")
        known = parts[-len(words) :]
        found = tuple(value(word, one) for word, one in zip(words, known, strict=True))
        return found if len(parts) > 1 and len(found) > 1 else found[0]

    return read


def _hardness(text: str) -> object:
    return text if "H" in text.upper() else value(text, quantities.STRESS)  # HRC, HV, HB


_SHARE = quantities.SHARE
_READERS: dict[str, tuple[str, Callable[[str], object]]] = {
    "E": ("youngs_modulus", _of(quantities.STRESS)),
    "nu": ("poissons_ratio", _of(_SHARE)),
    "rho": ("density", _of(quantities.DENSITY)),
    "yield": ("yield_strength", _of(quantities.STRESS)),
    "hardness": ("hardness", _hardness),
    "hardening": ("hardening", _of(quantities.STRESS, _SHARE)),
    "rate": ("rate", _of(_SHARE, quantities.RATE)),
    "loss": ("loss_factor", _of(_SHARE, quantities.FREQUENCY)),
    "kind": ("kind", str),
    "name": ("name", str),
}  # fmt: skip


def material_of(option: str, text: str, own: Mapping[str, Material]) -> Material:
    """Material of an option: a name of the catalogue or of the user's own, or numbers.

    Examples
    --------
    >>> bead = material_of("sphere", "E=2.8GPa nu=0.35 rho=1.41g/cm3 loss=0.05,10kHz", {})
    >>> bead.density, bead.loss_factor
    (1410.0, (0.05, 10000.0))
    """
    try:
        if "=" not in text:
            return find(text, own)
        given: dict[str, object] = {"name": text}
        for key, word in _NUMBER.findall(text):
            if key not in _READERS:
                near = difflib.get_close_matches(key, _READERS, n=1)
                hint = f"did you mean {near[0]}? " if near else ""
                raise ValueError(f"unknown {key!r}; {hint}known: {', '.join(_READERS)}")
            field, read = _READERS[key]
            given[field] = read(word)
        if missing := [key for key in ("E", "nu", "rho") if _READERS[key][0] not in given]:
            raise ValueError(f"{text!r} lacks {' and '.join(missing)}, as in {wording.OWN}")
        return Material(**given)  # type: ignore[arg-type]
    except ValueError as error:
        raise wording.Refused(f"--{option}: {wording.sentence(error, ())}") from error
