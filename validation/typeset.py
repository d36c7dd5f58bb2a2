"""Formulas in plain text, made readable in HTML: Greek letters, indices, powers, names of code.

Nothing in the text marks where a formula begins, so that no parser of AsciiMath or LaTeX can take
it.
"""

from __future__ import annotations

import html
import re
from collections.abc import Callable

_GREEK = "alpha|chi|delta|eta|kappa|lambda|nu|omega|pi|rho|sigma|tau|Gamma|Omega|Phi"


def _letter(found: re.Match[str]) -> str:
    return html.unescape(f"{found[1]}&{found[2]};")


# In this order: an index or a power ends the word that may be a letter's name.
_RULES: tuple[tuple[str, str | Callable[[re.Match[str]], str]], ...] = (
    (r"\^(?:\(([^()]*)\)|([-\d.]*\d))", r"<sup>\1\2</sup>"),  # v^(4/5), w^-1.5
    (r"(?<![A-Za-z_])([A-Za-z]|sigma|lambda|delta)_([A-Za-z]+0?|\d)(?![A-Za-z_])", r"\1<sub>\2</sub>"),
    (r"\b(rho|nu|V|E|G|x|c)([0-3])(?![\d.])", r"\1<sub>\2</sub>"),  # rho2, E1', V0
    (rf"(?<![A-Za-z_.])(d?)({_GREEK})(?=[0-9_^<& ,.;:)(/*+='-]|$)", _letter),  # and dtau
    (r"\b[a-z]{2,}(?:[._][a-z]{2,})*_[a-z]{2,}(?:[._][a-z]{2,})*\b", r"<code>\g<0></code>"),
    (r"\b(?!1e)(\d[\d.]*)e(?:\+|(-))0?(\d+)\b", "\\1 \N{MULTIPLICATION SIGN} 10<sup>\\2\\3</sup>"),
    (r"\b1e(?:\+|(-))0?(\d+)\b", r"10<sup>\1\2</sup>"),  # 1e-09
    (r"(?<=\d )us\b", "\N{MICRO SIGN}s"),  # microseconds
    (r"sqrt\(", "\N{SQUARE ROOT}("),
    ("&lt;=", "\N{LESS-THAN OR EQUAL TO}"),
    ("&gt;=", "\N{GREATER-THAN OR EQUAL TO}"),
)
_VERBATIM = re.compile(r"((?<!<pre>)<code>.*?</code>|<[^>]*>)", re.DOTALL)


def typeset(text: str) -> str:
    """Put formulas into HTML; what stands in inline code and in tags stays as it is.

    Examples
    --------
    >>> from validation.typeset import typeset
    >>> typeset("v^(4/5) d_Y, V_Y0 in <code>d_Y</code>")
    'v<sup>4/5</sup> d<sub>Y</sub>, V<sub>Y0</sub> in <code>d_Y</code>'
    >>> typeset("E H^3/12 to 1e-09, from edge_distance on")
    'E H<sup>3</sup>/12 to 10<sup>-9</sup>, from <code>edge_distance</code> on'
    """
    parts = _VERBATIM.split(text)
    return "".join(part if k % 2 else _formulas(part) for k, part in enumerate(parts))


def _formulas(text: str) -> str:
    for pattern, readable in _RULES:
        text = re.sub(pattern, readable, text, flags=re.MULTILINE)
    return text
