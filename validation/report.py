"""The report: claims, figures, errata and derivations on one page."""

from __future__ import annotations

import base64
import datetime
import html
import io
import re
from pathlib import Path

import markdown
from matplotlib.figure import Figure

import contactlaw as cl
from validation.typeset import typeset
from validation.verdicts import FAILS, HOLDS, LIMITED, MISPRINT, OPEN, Claim

_MANY = 20  # numbers of a figure, from which on they are folded away
_DERIVATIONS = Path(__file__).parent / "derivations"
_COLOURS = {
    HOLDS: "#009E73",
    MISPRINT: "#D55E00",
    LIMITED: "#B87E00",
    FAILS: "#D55E00",
    OPEN: "#6E6E6E",
}
_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #222; max-width: 62rem; margin: 2rem auto;
       padding: 0 1rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 2.5rem 0 .5rem; }
h2 { font-size: 1.2rem; margin: 2rem 0 .3rem; }
nav a { margin-right: 1.2rem; } a { color: #0072B2; }
img { max-width: 100%; border: 1px solid #eee; }
figure { margin: 2rem 0; } figcaption { color: #444; max-width: 50rem; }
table { border-collapse: collapse; font-size: .88rem; margin: .5rem 0; }
th, td { text-align: left; padding: .3rem .6rem; border-bottom: 1px solid #e5e5e5;
         vertical-align: top; }
th { border-bottom: 2px solid #999; } td.n { text-align: right; font-variant-numeric: tabular-nums;
     white-space: nowrap; }
pre { background: #f6f6f6; padding: .6rem .9rem; overflow-x: auto; font-size: .86rem; }
.verdict { color: white; border-radius: .7rem; padding: .05rem .55rem; white-space: nowrap;
           font-size: .82rem; }
.note { color: #555; }
"""


def png(figure: Figure) -> bytes:
    """Render a figure."""
    image = io.BytesIO()
    figure.savefig(image, format="png")
    return image.getvalue()


def page(claims: tuple[Claim, ...], figures: list[tuple[str, str, dict[str, float], bytes]]) -> str:
    """Write the page.

    Parameters
    ----------
    claims : tuple of Claim
        What `validation.claims.claims` returned.
    figures : list of tuple
        Name, caption, numbers and PNG of each.

    Returns
    -------
    str
        HTML that needs no other file.
    """
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    parts = [
        "<!doctype html><html lang='en'><head><meta charset='utf-8'>",
        "<title>contactlaw: the paper, reproduced and corrected</title>",
        f"<style>{_STYLE}</style></head><body>",
        "<h1>The paper, reproduced and corrected</h1>",
        f"<p>{_summary(claims)}</p>",
        "<nav><a href='#claims'>Claims</a><a href='#figures'>Figures</a>"
        "<a href='#errata'>Errata</a><a href='#turning-point'>Turning-point form</a>"
        "<a href='#fem'>The law fem</a><a href='#mobility'>Mobility</a></nav>",
        "<h1 id='claims'>Claims</h1>",
        _claims(claims),
        "<h1 id='figures'>Figures</h1>",
        *(_figure(*one) for one in figures),
        f"<div id='errata'>{_derivation('errata')}</div>",
        f"<div id='turning-point'>{_derivation('turning_point')}</div>",
        f"<div id='fem'>{_derivation('fem_law')}</div>",
        f"<div id='mobility'>{_derivation('mobility')}</div>",
        f"<p class='note'>contactlaw {cl.__version__}, {today}, python -m validation</p>",
        "</body></html>",
    ]
    return "\n".join(parts)


def _summary(claims: tuple[Claim, ...]) -> str:
    counts = ", ".join(
        f"{sum(claim.verdict == verdict for claim in claims)} {_pill(verdict)}"
        for verdict in _COLOURS
    )
    return (
        "Q. Peng, Y. Jin, X. Liu, Y. G. Wei, <i>Effect of plasticity on the coefficient of "
        "restitution of an elastoplastic sphere impacting an elastic plate</i>, Int. J. Solids "
        "Struct. 222-223 (2021) 111036. Its equations, figures and numbers, computed again by "
        "contactlaw and, where the paper used ABAQUS, by finite elements of our own, which are "
        f"stored. Figs. 3 to 10 are the paper's, the others ours. {len(claims)} claims; verdicts: "
        f"{counts}. "
        "The model itself stands; what is wrong is on paper: exponents, a factor, a slope."
    )


def _pill(verdict: str) -> str:
    return f"<span class='verdict' style='background:{_COLOURS[verdict]}'>{verdict}</span>"


def _formula(text: str) -> str:
    code = re.sub("`([^`]*)`", r"<code>\1</code>", html.escape(text, quote=False))
    return typeset(code)


def _number(value: float | None) -> str:
    return "-" if value is None else typeset(f"{value:.4g}")


def _claims(claims: tuple[Claim, ...]) -> str:
    rows = "".join(
        f"<tr><td>{html.escape(claim.where)}</td><td>{_formula(claim.statement)}"
        f"<br><span class='note'>{_formula(claim.note)}</span></td>"
        f"<td class='n'>{_number(claim.printed)}</td><td class='n'>{_number(claim.ours)}</td>"
        f"<td>{_formula(claim.tolerance)}</td><td>{_pill(claim.verdict)}</td></tr>"
        for claim in claims
    )
    heads = ("where", "claim", "printed", "ours", "agreement", "verdict")
    head = "".join(f"<th>{name}</th>" for name in heads)
    return f"<table><tr>{head}</tr>{rows}</table>"


def _figure(name: str, caption: str, numbers: dict[str, float], image: bytes) -> str:
    data = base64.b64encode(image).decode("ascii")
    title, _, text = _formula(" ".join(caption.split())).partition(": ")
    rows = "".join(
        f"<tr><td>{_formula(key)}</td><td class='n'>{_number(value)}</td></tr>"
        for key, value in numbers.items()
    )
    table = f"<table>{rows}</table>"
    if len(numbers) > _MANY:
        table = f"<details><summary>{len(numbers)} numbers</summary>{table}</details>"
    return (
        f"<figure id='{name}'><img alt='{title}' src='data:image/png;base64,{data}'>"
        f"<figcaption><b>{title}</b>: {text}{table}</figcaption></figure>"
    )


def _derivation(name: str) -> str:
    text = (_DERIVATIONS / f"{name}.md").read_text(encoding="utf-8")
    return typeset(markdown.markdown(text, extensions=["tables"]))
