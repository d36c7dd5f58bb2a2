"""A claim and its verdict: the outcome of a comparison, not an opinion.

A claim holds if our number is within the tolerance of the printed one, or on the right side of a
printed bound; otherwise it has the verdict that is given for this case.
"""

from __future__ import annotations

from dataclasses import dataclass

HOLDS = "holds"
MISPRINT = "misprint"
LIMITED = "holds in part"
FAILS = "does not hold"
OPEN = "not reproducible here"


@dataclass(frozen=True)
class Claim:
    """A claim of the paper and its verdict.

    Parameters
    ----------
    name : str
        Short name, for tests and links.
    where : str
        Section, equation or figure.
    statement : str
        What the paper says.
    printed, ours : float or None
        The paper's number and ours; None where there is none.
    tolerance : str
        What counts as agreement.
    verdict : str
        `HOLDS`, `MISPRINT`, `LIMITED`, `FAILS` or `OPEN`.
    note : str
        Correction, range or reason.
    """

    name: str
    where: str
    statement: str
    printed: float | None
    ours: float | None
    tolerance: str
    verdict: str
    note: str = ""


def near(
    name: str,
    where: str,
    statement: str,
    printed: float,
    ours: float,
    within: float,
    note: str = "",
    otherwise: str = FAILS,
) -> Claim:
    """Agreement within an absolute tolerance."""
    verdict = HOLDS if abs(ours - printed) <= within else otherwise
    return Claim(name, where, statement, printed, ours, f"within {within:g}", verdict, note)


def at_most(
    name: str,
    where: str,
    statement: str,
    bound: float,
    ours: float,
    note: str = "",
    otherwise: str = FAILS,
    digits: int | None = None,
) -> Claim:
    """Agreement with an upper bound; with `digits`, after rounding to as many decimals."""
    verdict = HOLDS if (ours if digits is None else round(ours, digits)) <= bound else otherwise
    tolerance = "at most" if digits is None else f"at most, to the {digits} decimals printed"
    return Claim(name, where, statement, bound, ours, tolerance, verdict, note)


def more_than(
    name: str,
    where: str,
    statement: str,
    bound: float,
    ours: float,
    note: str = "",
    otherwise: str = FAILS,
) -> Claim:
    """Agreement with a lower bound."""
    verdict = HOLDS if ours > bound else otherwise
    return Claim(name, where, statement, bound, ours, "more than", verdict, note)


def undecided(
    name: str,
    where: str,
    statement: str,
    printed: float | None,
    why: str,
    ours: float | None = None,
) -> Claim:
    """Make a claim that cannot be checked here, with the reason and our nearest number."""
    return Claim(name, where, statement, printed, ours, "-", OPEN, why)
