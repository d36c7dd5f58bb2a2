"""The report: accuracy of the laws, finite elements, claims and figures of the paper.

``page.html`` has its words and its frame, which jinja2 fills, and ``page.css`` the look.
"""

from __future__ import annotations

import datetime
import html
import re
import struct
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import markdown
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

import contactlaw as cl
from validation.accuracy import compare, trust
from validation.accuracy.trust import Score
from validation.figures.practice import oblique_points
from validation.paper.verdicts import FAILS, HOLDS, LIMITED, MISPRINT, OPEN, Claim
from validation.typeset import typeset

_FOLDER = Path(__file__).parent
_DERIVATIONS = "errata", "turning_point", "fem_law", "mobility", "losses", "edges"
_COLOURS = {HOLDS: "#007A5A", MISPRINT: "#B34E00", LIMITED: "#8F6400", FAILS: "#B34E00", OPEN: "#6E6E6E"}
_SIZE = "(size)"  # stands for the size of the page until it is known


class Picture(NamedTuple):
    """A figure with its caption and its numbers."""

    name: str
    part: str  # part of the report
    caption: str
    numbers: dict[str, float]
    png: bytes

    @property
    def file(self) -> str:
        """Name of the file beside the page."""
        return f"{self.name}.png"

    @property
    def title(self) -> str:
        """What stands before the colon of the caption: the number of the figure."""
        return self.caption.partition(": ")[0]

    @property
    def text(self) -> Markup:
        """The caption after its title."""
        return _formula(" ".join(self.caption.split()).partition(": ")[2])

    @property
    def alt(self) -> Markup:
        """What is drawn: the first paragraph of the caption; what it shows comes after it."""
        first = self.caption.split("\n\n")[0]
        return Markup(re.sub("<[^>]*>", "", _formula(" ".join(first.split()))).replace("'", "&#39;"))

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return struct.unpack(">II", self.png[16:24])


class Table(NamedTuple):
    """A table: what it is about, the heads of its columns, with # at those of numbers, its rows."""

    about: str
    heads: tuple[str, ...]
    rows: list[tuple[str, ...]]


def page(claims: tuple[Claim, ...], pictures: Iterable[Picture]) -> str:
    """Write the page.

    Parameters
    ----------
    claims : tuple of Claim
        What `validation.paper.claims.claims` returned.
    pictures : iterable of Picture
        Figures, which are files beside the page.

    Returns
    -------
    str
        HTML.
    """
    pictures = tuple(pictures)
    environment = Environment(loader=FileSystemLoader(_FOLDER), autoescape=True, undefined=StrictUndefined)
    environment.filters |= {"formula": _formula, "code": _code, "percent": _percent, "number": _number}
    text = environment.get_template("page.html").render(
        style=Markup((_FOLDER / "page.css").read_text(encoding="utf-8")),
        size=_SIZE,
        pictures=pictures,
        weight=f"{1e-6 * sum(len(one.png) for one in pictures):.1f}",
        **_practice(),
        mesh={name: float(found.max()) for name, found in compare.discretisation().items()},
        claims=claims,
        colours=_COLOURS,
        derivations={name.replace("_", "-"): _derivation(name) for name in _DERIVATIONS},
        version=cl.__version__,
        today=datetime.datetime.now(datetime.UTC).date().isoformat(),
    )
    return text.replace(_SIZE, f"{1e-3 * len(text.encode()):.0f}")


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
        "oblique": _oblique(),
    }


def _code(text: str) -> Markup:
    """Escape plain text, and set what stands in backticks as code."""
    if isinstance(text, Markup):
        return text
    return Markup(re.sub("`([^`]*)`", r"<code>\1</code>", html.escape(text, quote=False)))


def _formula(text: str) -> Markup:
    return Markup(typeset(_code(text)))


def _number(value: float | None) -> Markup:
    return Markup("-" if value is None else typeset(f"{value:.4g}"))


def _percent(share: float, digits: int = 0) -> str:
    return f"{100.0 * share:.{digits}f} %"


def _signed(share: float) -> str:
    return f"{100.0 * share:+.1f} %".replace("-", "\N{MINUS SIGN}")


def _oblique() -> Table:
    """Make a table of the measured oblique impacts of Fig. 26 beside the model."""
    return Table(
        "oblique impacts, measured and by the model",
        ("quantity", "reading", "angle [°]#", "measured#", "model#", "model off#"),
        [
            (name, f"{source}", f"{angle:.2f}", _number(value), _number(model), _signed(model / value - 1.0))
            for name, source, angle, value, model in oblique_points()
        ],
    )


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
    made = typeset(markdown.markdown(text, extensions=["tables"]))
    made = re.sub(r"(</?h)([1-3])", lambda found: f"{found[1]}{int(found[2]) + 2}", made)
    wide = "<div class='wide' tabindex='0' role='region' aria-label='table'>"
    return Markup(made.replace("<table>", f"{wide}<table>").replace("</table>", "</table></div>"))
