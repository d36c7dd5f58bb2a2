"""The report: accuracy of the laws, finite elements, claims and figures of the paper.

``page.html`` has its words and its frame, which jinja2 fills, and ``page.css`` the look.
"""

from __future__ import annotations

import datetime
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import markdown
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from l2m4m import LaTeX2MathMLExtension
from markupsafe import Markup

import contactlaw as cl
from validation import figures
from validation.accuracy import compare, trust
from validation.accuracy.trust import Score
from validation.paper.verdicts import FAILS, HOLDS, LIMITED, MISPRINT, OPEN, Claim, scientific

_FOLDER = Path(__file__).parent
_DERIVATIONS = "errata", "turning_point", "fem_law", "mobility", "losses", "edges"
_COLOURS = {HOLDS: "#007A5A", MISPRINT: "#B34E00", LIMITED: "#8F6400", FAILS: "#B34E00", OPEN: "#6E6E6E"}


class Picture(NamedTuple):
    """A figure with its caption and its numbers."""

    name: str
    part: str  # part of the report
    caption: str  # the first paragraph says what is drawn, the second what it shows
    numbers: dict[str, float]

    @property
    def file(self) -> str:
        """Name of the file beside the page."""
        return f"{self.name}.png"

    @property
    def title(self) -> str:
        """What stands before the colon of the caption: the number of the figure."""
        return self.caption.partition(": ")[0]

    @property
    def text(self) -> str:
        """The caption after its title."""
        return " ".join(self.caption.split()).partition(": ")[2]

    @property
    def alt(self) -> str:
        """What is drawn, without formulas."""
        return " ".join(self.caption.split("\n\n")[0].split())


class Table(NamedTuple):
    """A table: what it is about, the heads of its columns, with # at those of numbers, its rows."""

    about: str
    heads: tuple[str, ...]
    rows: list[tuple[str, ...]]


def page(parts: Sequence[str], claims: tuple[Claim, ...], pictures: Sequence[Picture]) -> str:
    """Write the page.

    Parameters
    ----------
    parts : sequence of str
        Parts of the report, of `figures.PARTS`.
    claims : tuple of Claim
        What `validation.paper.claims.claims` returned; none without the part on the paper.
    pictures : sequence of Picture
        Figures of these parts, which are files beside the page.

    Returns
    -------
    str
        HTML.
    """
    environment = Environment(loader=FileSystemLoader(_FOLDER), autoescape=True, undefined=StrictUndefined)
    environment.filters |= {"text": _text, "percent": _percent, "number": _number}
    return environment.get_template("page.html").render(
        style=Markup((_FOLDER / "page.css").read_text(encoding="utf-8")),
        parts=parts,
        pictures=pictures,
        **(_practice() if figures.PRACTICE in parts else {}),
        mesh={name: float(found.max()) for name, found in compare.discretisation().items()},
        claims=claims,
        colours=_COLOURS,
        derivations={name.replace("_", "-"): _derivation(name) for name in _DERIVATIONS},
        version=cl.__version__,
        today=datetime.datetime.now(datetime.UTC).date().isoformat(),
    )


def _practice() -> dict[str, Any]:
    """Fill the part for people who simulate."""
    overall = trust.overall()
    (everyday, others), (fem, myc), _ = overall.values()
    return {
        "everyday": everyday,
        "others": others,
        "pair": fem,
        "paper": myc,
        "bounds": trust.EVERYDAY.bounds,
        "right": round(everyday.shares.restitution * everyday.answered),
        "wrong": round((1.0 - others.shares.restitution) * others.answered),
        "targets": ((trust.EVERYDAY, "everyday impacts"), (trust.PAPER, "the other sets")),
        "overall": _scores("set of impacts", overall),
        "shares": _shares(overall),
        "where": _scores("everyday impacts", trust.where()),
        "misses": _misses(),
        "materials": _scores("bead on plate", trust.materials()),
    }


def _html(text: str) -> str:
    """Make HTML of Markdown, with formulas in LaTeX between dollar signs as MathML."""
    return markdown.markdown(text, extensions=["tables", LaTeX2MathMLExtension()])  # type: ignore[no-any-return]


def _text(text: str) -> Markup:
    """Make HTML of a paragraph of Markdown, without the paragraph."""
    return Markup(_html(text).removeprefix("<p>").removesuffix("</p>").strip())


def _number(value: float | None) -> Markup:
    return Markup("-") if value is None else _text(scientific(value, 4))


def _percent(share: float, digits: int = 0) -> str:
    return f"{100.0 * share:.{digits}f} %"


def _signed(share: float) -> str:
    return f"{100.0 * share:+.1f} %".replace("-", "\N{MINUS SIGN}")


def _scores(title: str, found: Mapping[str, list[Score]]) -> Table:
    """Make a table of the scores of both laws, side by side."""
    kinds = ("right", "rms error", "largest error")
    rows = []
    for name, scores in found.items():
        cells = {law: ("refused", "", "") for law in trust.LAWS}
        for one in scores:
            right = f"{one.right} of {one.answered}"
            cells[one.law] = right, _percent(one.rms, 1), _signed(one.largest)
        rows.append((name, *(cell for law in trust.LAWS for cell in cells[law])))
    heads = (f"`{law}`: {kind}#" for law in trust.LAWS for kind in kinds)
    return Table(f"laws beside finite elements, by {title}", (title, *heads), rows)


def _shares(found: Mapping[str, list[Score]]) -> Table:
    return Table(
        "shares of impacts within each bound",
        ("within its bound", "law", "COR#", "contact time#", "peak force#", "plastic work#"),
        [
            (name, f"`{one.law}`", *(_percent(share, 1) for share in one.shares))
            for name, scores in found.items()
            for one in scores
        ],
    )


def _misses() -> Table:
    return Table(
        "everyday impacts beyond a bound",
        ("everyday impact", "errors beyond a bound", "COR by finite elements#", "COR by fem#"),
        [
            (
                one.what,
                ", ".join(f"{name} {_signed(error)}" for name, error in one.beyond.items()),
                f"{one.fem:.3f}",
                f"{one.law:.3f}",
            )
            for one in trust.misses()
        ],
    )


def _derivation(name: str) -> Markup:
    """Make a derivation from Markdown, with its headings two levels down."""
    text = (_FOLDER / "derivations" / f"{name}.md").read_text(encoding="utf-8")
    made = re.sub(r"(</?h)([1-3])", lambda found: f"{found[1]}{int(found[2]) + 2}", _html(text))
    wide = "<div class='wide' tabindex='0' role='region' aria-label='table or formula'>"
    made = re.sub(r"<(table|math display=.block.).*?</(table|math)>", rf"{wide}\g<0></div>", made, flags=re.DOTALL)
    return Markup(made)
