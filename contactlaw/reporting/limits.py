"""Words that the reports of all scenes share: sizes of plates, and limits of the model."""

from collections.abc import Sequence
from typing import NamedTuple

from contactlaw import Validity, explain
from contactlaw._arrays import Integers
from contactlaw._readable import drawn
from contactlaw.physical.validity import count_flags

label = drawn  # the name of a plate, also for the demo


class Limit(NamedTuple):
    """A limit of the model, what it means, and the number of impacts that exceed it."""

    name: str
    meaning: str
    impacts: int


def exceeded(flags: Integers) -> list[Limit]:
    """List the limits that impacts exceed."""
    return [Limit(_words(flag), explain(flag)[0], count) for flag, count in count_flags(flags).items()]


def _words(flag: Validity) -> str:
    return str(flag.name).lower().replace("_", " ")


def limits_lines(found: Sequence[Limit]) -> list[str]:
    """Lines of the summary that name the limits which impacts exceed, and their meaning."""
    if not found:
        return ["Limits of the model: all impacts on plates are inside"]
    width = max(len(f"{limit.impacts} {limit.name}") for limit in found)
    return ["Limits of the model: impacts outside, and what that means"] + [
        f"  {f'{limit.impacts} {limit.name}':{width}}  {limit.meaning}" for limit in found
    ]
