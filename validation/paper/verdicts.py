"""A claim and its verdict: the outcome of a comparison, not an opinion.

A claim holds if our number is within the tolerance of the printed one, or on the right side of a
printed bound; otherwise it has the verdict that its row states for this case.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Mapping
from typing import NamedTuple, SupportsFloat

HOLDS = "holds"
MISPRINT = "misprint"
LIMITED = "holds in part"
FAILS = "does not hold"
OPEN = "not reproducible here"

# Our number, "ours", what the note quotes as {name:format}, and "printed" where the paper has a formula.
Numbers = Mapping[str, SupportsFloat]


def scientific(number: float, digits: int = 6) -> str:
    r"""Write a number with a power of ten, in LaTeX, where it is very large or small.

    Examples
    --------
    >>> scientific(0.05), scientific(1e-12), scientific(1.93e-7)
    ('0.05', '$10^{-12}$', '$1.93 \\times 10^{-7}$')
    """
    mantissa, small, exponent = f"{number:.{digits}g}".partition("e")
    if not small:
        return mantissa
    factor = "" if mantissa == "1" else rf"{mantissa} \times "
    return f"${factor}10^{{{int(exponent)}}}$"


class Agreement(NamedTuple):
    """What counts as agreement, and the function of our number and the printed one that says so."""

    words: str
    holds: Callable[[float, float], bool]


def within(tolerance: float) -> Agreement:
    """Agreement within an absolute tolerance."""
    return Agreement(f"within {scientific(tolerance)}", lambda ours, printed: abs(ours - printed) <= tolerance)


def at_most_rounded(digits: int) -> Agreement:
    """Agreement with an upper bound after rounding to the decimals that are printed."""
    return Agreement(f"at most, to the {digits} decimals printed", lambda ours, printed: round(ours, digits) <= printed)


AT_MOST = Agreement("at most", lambda ours, printed: ours <= printed)
MORE_THAN = Agreement("more than", lambda ours, printed: ours > printed)


class Row(NamedTuple):
    """A claim of the paper, before it is judged."""

    name: str  # short, for tests and links
    where: str  # section, equation or figure
    statement: str  # what the paper says
    printed: float | None  # the paper's number; None if there is none, or if `ours` computes it
    agreement: Agreement | None  # None if the claim cannot be checked here
    ours: Callable[[], SupportsFloat | Numbers] | None  # computes our number; None: there is none
    note: str = ""  # correction, range or reason; `Numbers` take the places of their {names}
    otherwise: str = FAILS  # verdict if the claim does not hold as it is stated


class Claim(NamedTuple):
    """A claim with its verdict, one of those above; the other fields are those of `Row`."""

    name: str
    where: str
    statement: str
    printed: float | None
    ours: float | None
    tolerance: str
    verdict: str
    note: str


@functools.cache
def judge(row: Row) -> Claim:
    """Compute our number, compare it with the printed one, and fill in the note."""
    found = row.ours() if row.ours is not None else {}
    found = found if isinstance(found, Mapping) else {"ours": found}
    numbers = {name: float(number) for name, number in found.items()}
    printed, ours = numbers.get("printed", row.printed), numbers.get("ours")
    tolerance, verdict = "-", OPEN
    if row.agreement is not None:
        assert ours is not None and printed is not None, row.name
        tolerance = row.agreement.words
        verdict = HOLDS if row.agreement.holds(ours, printed) else row.otherwise
    # LaTeX has braces, too, but no colon in them; SI puts a space before the percent sign
    note = re.sub(r"\{(\w+):(.+?)\}", lambda place: format(numbers[place[1]], place[2]), row.note)
    note = re.sub(r"(?<=\d)%", " %", note)
    return Claim(row.name, row.where, row.statement, printed, ours, tolerance, verdict, note)
