"""The report: accuracy of the laws, finite elements, claims and figures of the paper.

``page.html`` is the frame of its page, ``page.css`` the look.
"""

from __future__ import annotations

import datetime
import html
import re
import struct
from collections.abc import Iterable, Mapping
from pathlib import Path
from string import Template
from typing import NamedTuple

import markdown

import contactlaw as cl
from contactlaw import Validity
from validation import figures
from validation.accuracy import compare, trust
from validation.accuracy.trust import Score
from validation.bench import census
from validation.fem.census import pairs
from validation.figures import fig26_oblique
from validation.paper.verdicts import FAILS, HOLDS, LIMITED, MISPRINT, OPEN, Claim
from validation.typeset import typeset

_MANY = 20  # a figure with more numbers folds them away
_EACH = 100  # impacts per pair in the census
_FOLDER = Path(__file__).parent
_DERIVATIONS = {
    "errata": "errata",
    "turning-point": "turning_point",
    "fem-law": "fem_law",
    "mobility": "mobility",
    "losses": "losses",
    "edges": "edges",
}
_COLOURS = {
    HOLDS: "#007A5A",
    MISPRINT: "#B34E00",
    LIMITED: "#8F6400",
    FAILS: "#B34E00",
    OPEN: "#6E6E6E",
}
_NUMBER = " class='n'"
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
    drawn = {
        part: "".join(_figure(one) for one in pictures if one.part == part)
        for part in (figures.PRACTICE, figures.FINITE_ELEMENTS, figures.PAPER)
    }
    words = {
        "style": (_FOLDER / "page.css").read_text(encoding="utf-8"),
        "size": _SIZE,
        "count": f"{len(pictures)}",
        "pictures": f"{1e-6 * sum(len(one.png) for one in pictures):.1f}",
        **_practice(),
        "figures_practice": drawn[figures.PRACTICE],
        "mesh": _mesh(),
        "figures_fem": drawn[figures.FINITE_ELEMENTS],
        "summary": _summary(claims),
        "claims": _claims(claims),
        "figures_paper": drawn[figures.PAPER],
        "derivations": "".join(_derivation(*one) for one in _DERIVATIONS.items()),
        "version": cl.__version__,
        "today": datetime.datetime.now(datetime.UTC).date().isoformat(),
    }
    frame = Template((_FOLDER / "page.html").read_text(encoding="utf-8"))
    text = frame.substitute(words)
    return text.replace(_SIZE, f"{1e-3 * len(text.encode()):.0f}")


def _practice() -> dict[str, str]:
    """Fill the part for people who simulate."""
    overall = trust.overall()
    (everyday, others), (fem, pair), _ = overall.values()
    bounds = trust.EVERYDAY.bounds
    right = round(everyday.shares.restitution * everyday.answered)
    wrong = round((1.0 - others.shares.restitution) * others.answered)
    return {
        "everyday": f"For {right} of {everyday.impacts} everyday impacts to which it was not "
        f"fitted, its COR is within {_percent(bounds.restitution)} of finite elements; the root "
        f"mean square error is {_percent(everyday.rms, 2)}.",
        "pair": f"Over {pair.impacts} impacts the COR of <code>fem</code> is within "
        f"{_percent(abs(fem.largest), 1)} of finite elements; that of <code>myc</code>, the "
        f"paper's model unchanged, is within {_percent(abs(pair.largest), 1)}.",
        "others": f"It answers {others.answered} of the {everyday.impacts} everyday impacts, and "
        f"for {wrong} of these its COR is more than {_percent(bounds.restitution)} off; the root "
        f"mean square error is {_percent(others.rms)}. Where it exceeds a bound, all but "
        f"{others.silent} of its answers carry a flag of accuracy.",
        "kept": f"{everyday.impacts}",
        "overall": _scores("set of impacts", overall),
        "shares": _shares(overall),
        "bounds": _bounds(),
        "where": _scores("everyday impacts", trust.where()),
        "silent": f"{everyday.silent}",
        "misses": _misses(),
        "materials": _scores("bead on plate", trust.materials()),
        **_census(),
        "oblique": _oblique(),
    }


def _oblique() -> str:
    """Make a table of the measured oblique impacts of Fig. 26 beside the model."""
    heads = ("quantity", "reading", "angle [°]#", "measured#", "model#", "model off#")
    rows = [
        _row(
            (name, f"{source}"),
            (f"{angle:.2f}", _number(value), _number(model), _signed(model / value - 1.0)),
        )
        for name, source, angle, value, model in fig26_oblique.points()
    ]
    table = _table("oblique impacts, measured and by the model", heads, rows)
    return f"<details><summary>{len(rows)} points</summary>{table}</details>"


def _bounds() -> str:
    words = []
    for target, what in ((trust.EVERYDAY, "everyday impacts"), (trust.PAPER, "the other sets")):
        bounds = target.bounds
        words.append(
            f"for {what} {_percent(bounds.restitution)} in COR, {_percent(bounds.contact_time)} in "
            f"contact time, {_percent(bounds.peak_force)} in peak force, and plastic work within "
            f"{_percent(bounds.plastic_share)} of the initial energy"
        )
    return f"Bounds: {'; '.join(words)}."


def _percent(share: float, digits: int = 0) -> str:
    return f"{100.0 * share:.{digits}f} %"


def _signed(share: float) -> str:
    return f"{100.0 * share:+.1f} %".replace("-", "\N{MINUS SIGN}")


def _table(about: str, heads: Iterable[str], rows: Iterable[str]) -> str:
    """Make a table that scrolls where it is wider than the screen; heads of numbers end in #."""
    head = "".join(
        f"<th{_NUMBER if name.endswith('#') else ''}>{name.removesuffix('#')}</th>"
        for name in heads
    )
    return _scrolled(about, f"<table><tr>{head}</tr>{''.join(rows)}</table>")


def _scrolled(about: str, content: str) -> str:
    label = html.escape(about, quote=True)
    return f"<div class='wide' tabindex='0' role='region' aria-label='{label}'>{content}</div>"


def _row(cells: Iterable[str], numbers: Iterable[str]) -> str:
    return (
        "<tr>"
        + "".join(f"<td>{cell}</td>" for cell in cells)
        + "".join(f"<td{_NUMBER}>{cell}</td>" for cell in numbers)
        + "</tr>"
    )


def _scores(title: str, found: Mapping[str, list[Score]]) -> str:
    """Make a table of the scores of both laws, side by side."""
    kinds = ("right", "rms error", "largest error")
    heads = [title, *(f"<code>{law}</code>: {kind}#" for law in trust.LAWS for kind in kinds)]
    rows = []
    for name, scores in found.items():
        cells = {law: ["refused", *[""] * (len(kinds) - 1)] for law in trust.LAWS}
        for one in scores:
            right = f"{one.right} of {one.answered}"
            cells[one.law] = [right, _percent(one.rms, 1), _signed(one.largest)]
        rows.append(_row((name,), (cell for law in trust.LAWS for cell in cells[law])))
    return _table(f"laws beside finite elements, by {title}", heads, rows)


def _shares(found: Mapping[str, list[Score]]) -> str:
    fields = ("COR", "contact time", "peak force", "plastic work")
    heads = ("within its bound", "law", *(f"{field}#" for field in fields))
    rows = (
        _row((name, f"<code>{one.law}</code>"), (_percent(share, 1) for share in one.shares))
        for name, scores in found.items()
        for one in scores
    )
    return _table("shares of impacts within each bound", heads, rows)


def _misses() -> str:
    rows = (
        _row(
            (
                html.escape(one.what),
                ", ".join(f"{name} {_signed(error)}" for name, error in one.beyond.items()),
            ),
            (f"{one.fem:.3f}", f"{one.law:.3f}"),
        )
        for one in trust.misses()
    )
    heads = ("everyday impact", "errors beyond a bound", "COR by finite elements#", "COR by fem#")
    return _table("everyday impacts beyond a bound", heads, rows)


def _census() -> dict[str, str]:
    """Count what is answered and flagged."""
    found = {law: census.count(law, _EACH, tables=False) for law in trust.LAWS}
    rows = (
        _row(
            (f"<code>{law}</code>",),
            (
                _percent(share, 1)
                for share in (one.refused, one.outside, one.inaccurate, one.damaging, one.inside)
            ),
        )
        for law, one in found.items()
    )
    shares = ("refused", "outside its table", "accuracy in doubt", "may break or flow")
    heads = ("law", *(f"{share}#" for share in shares), "inside every limit#")
    flags = (
        _row(
            (f"<code>{flag.name}</code>", html.escape(cl.explain(flag)[0])),
            (_percent(one.flags.get(flag, 0.0), 1) for one in found.values()),
        )
        for flag in Validity
        if flag in Validity.ACCURACY & ~Validity.CLAMPED
    )
    return {
        "census": f"{found['fem'].impacts}",
        "pairs": f"{len(pairs())}",
        "answers": _table("what is answered, by law", heads, rows),
        "flags": _table(
            "flags of accuracy", ("flag", "what it says", *(f"{law}#" for law in found)), flags
        ),
    }


def _mesh() -> str:
    error = {name: float(found.max()) for name, found in compare.discretisation().items()}
    return (
        "At 26 m/s, elements of a hundredth of the bead's radius leave an estimated error of "
        f"{_percent(error['restitution'], 2)} in COR, {_percent(error['peak_force'], 2)} in peak "
        f"force and {_percent(error['contact_time'], 2)} in contact time."
    )


def _summary(claims: tuple[Claim, ...]) -> str:
    counts = ", ".join(
        f"{sum(claim.verdict == verdict for claim in claims)} {_pill(verdict)}"
        for verdict in _COLOURS
    )
    return (
        "Q. Peng, Y. Jin, X. Liu, Y. G. Wei, <i>Effect of plasticity on the coefficient of "
        "restitution of an elastoplastic sphere impacting an elastic plate</i>, Int. J. Solids "
        "Struct. 222-223 (2021) 111036. Its equations, figures and numbers, computed again by "
        "contactlaw and, where the paper used ABAQUS, by finite elements of our own. "
        f"{len(claims)} claims; verdicts: {counts}. The paper's model itself is right; its errors "
        "are in printed formulas: exponents, a factor, a slope."
    )


def _pill(verdict: str) -> str:
    return f"<span class='verdict' style='background:{_COLOURS[verdict]}'>{verdict}</span>"


def _formula(text: str) -> str:
    code = re.sub("`([^`]*)`", r"<code>\1</code>", html.escape(text, quote=False))
    return typeset(code)


def _number(value: float | None) -> str:
    return "-" if value is None else typeset(f"{value:.4g}")


def _claims(claims: tuple[Claim, ...]) -> str:
    rows = (
        f"<tr><td>{html.escape(claim.where)}<br>{_pill(claim.verdict)}</td>"
        f"<td class='text'>{_formula(claim.statement)}<br>"
        f"<span class='note'>{_formula(claim.note)}</span></td>"
        f"<td class='n'>{_number(claim.printed)}</td><td class='n'>{_number(claim.ours)}</td>"
        f"<td>{_formula(claim.tolerance)}</td></tr>"
        for claim in claims
    )
    heads = ("where, verdict", "claim", "printed#", "ours#", "agreement")
    return _table("claims of the paper", heads, rows)


def _figure(picture: Picture) -> str:
    title, _, text = _formula(" ".join(picture.caption.split())).partition(": ")
    rows = (_row((_formula(key),), (_number(one),)) for key, one in picture.numbers.items())
    table = _scrolled(f"numbers of {title}", f"<table>{''.join(rows)}</table>")
    if len(picture.numbers) > _MANY:
        table = f"<details><summary>{len(picture.numbers)} numbers</summary>{table}</details>"
    first = picture.caption.split("\n\n")[0]  # what is drawn; what it shows comes after it
    alt = re.sub("<[^>]*>", "", _formula(" ".join(first.split())))
    width, height = struct.unpack(">II", picture.png[16:24])
    image = (
        f"<a href='{picture.file}'><img src='{picture.file}' alt='{html.escape(alt, quote=True)}' "
        f"width='{width}' height='{height}' loading='lazy'></a>"
    )
    return (
        f"<figure id='{picture.name}'>{_scrolled(title, image)}"
        f"<figcaption><b>{title}</b>: {text}</figcaption>{table}</figure>"
    )


def _derivation(anchor: str, name: str) -> str:
    """Make a derivation from Markdown, with its headings two levels down."""
    text = (_FOLDER / "derivations" / f"{name}.md").read_text(encoding="utf-8")
    made = typeset(markdown.markdown(text, extensions=["tables"]))
    made = re.sub(r"(</?h)([1-3])", lambda found: f"{found[1]}{int(found[2]) + 2}", made)
    made = re.sub(
        "<table>.*?</table>", lambda found: _scrolled("table", found[0]), made, flags=re.DOTALL
    )
    return f"<div id='{anchor}'>{made}</div>"
