"""Materials on the command line and in heads of files: a name, or numbers of one's own."""

import dataclasses
import re
from collections.abc import Iterable, Mapping
from typing import Any

from contactlaw._errors import ArgumentError
from contactlaw.cli.parts import wording
from contactlaw.physical.arguments import unknown
from contactlaw.physical.materials import SHORT, Material, find, spelled_out


def check_keys(keys: Iterable[str], known: Iterable[str]) -> None:
    """Refuse a key that is not among those known."""
    for key in {*keys} - {*known}:
        raise ValueError(unknown(key, known))


def material_of(option: str, value: Any, own: Mapping[str, Material]) -> Material:
    """Material of an option or of a key in a head.

    It is the name of one of the catalogue or of the user's own, numbers, or a name and what
    differs; in a head also a table of numbers, with what they are `like`. Numbers that are replaced
    lose their errors.
    """
    try:
        table = _words(value) if isinstance(value, str) and "=" in value else value
        if not isinstance(table, dict):
            return find(table, own)
        check_keys(table, [*SHORT, "like", *(field.name for field in dataclasses.fields(Material))])
        numbers = spelled_out(table)
        like = numbers.pop("like", "")
        if not like:
            if missing := [key for key in ("E", "nu", "rho") if SHORT[key] not in numbers]:
                raise ValueError(f"{value!r} lacks {' and '.join(missing)}, as in {wording.OWN}")
            return Material(**{"name": value if isinstance(value, str) else option} | numbers)
        body = find(like, own)
        if "hardness" in numbers and body.hardening is None:  # it replaces the yield strength
            numbers = {"yield_strength": None} | numbers
        if "yield_strength" in numbers:
            numbers = {"specified_minimum": False} | numbers
        errors = {key: error for key, error in body.uncertainty.items() if key not in numbers}
        return dataclasses.replace(body, **numbers | {"uncertainty": errors | numbers.get("uncertainty", {})})
    except ValueError as error:
        raise ArgumentError(option, None, wording.sentence(error, {})) from error


def _words(text: str) -> dict[str, Any]:
    """Numbers of a text, and what they are `like`: the words before the first."""
    if bare := re.search(r"\b((?:E|yield|hardness)\s*=\s*\d{1,6}\.?\d*)\s*(?=$|[,;]|\w+\s*=)", text):
        raise ValueError(f"{bare[1]} has no unit, as in {wording.OWN}")
    words = re.findall(r"(\w+)\s*=\s*(.*?)[\s,;]*(?=\w+\s*=|$)", text)
    table = dict(words)
    if len(table) < len(words):
        raise ValueError(f"{text!r} has a key twice: leave one out")
    return {"like": re.split(r"\w+\s*=", text)[0].strip(" \t\n,;")} | table
