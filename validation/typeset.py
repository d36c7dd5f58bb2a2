"""Formulas in plain text, made readable in HTML: Greek letters, indices, powers, names of code."""

from __future__ import annotations

import re

_GREEK = {
    "lambda": "\N{GREEK SMALL LETTER LAMDA}",
    "alpha": "\N{GREEK SMALL LETTER ALPHA}",
    "chi": "\N{GREEK SMALL LETTER CHI}",
    "eta": "\N{GREEK SMALL LETTER ETA}",
    "nu": "\N{GREEK SMALL LETTER NU}",
    "pi": "\N{GREEK SMALL LETTER PI}",
    "rho": "\N{GREEK SMALL LETTER RHO}",
    "sigma": "\N{GREEK SMALL LETTER SIGMA}",
    "tau": "\N{GREEK SMALL LETTER TAU}",
    "dtau": "d\N{GREEK SMALL LETTER TAU}",
    "Gamma": "\N{GREEK CAPITAL LETTER GAMMA}",
}
_SIGNS = {
    "sqrt(": "\N{SQUARE ROOT}(",
    "&lt;=": "\N{LESS-THAN OR EQUAL TO}",
    "&gt;=": "\N{GREATER-THAN OR EQUAL TO}",
}
_WORD = re.compile(
    rf"(?<![A-Za-z_.])({'|'.join(_GREEK)})(?=[0-9_^<& ,.;:)(/*+='-]|$)", re.MULTILINE
)
_INDEX = re.compile(r"(?<![A-Za-z_])([A-Za-z]|sigma|lambda)_([A-Za-z]+0?|\d)(?![A-Za-z_])")
_POWER = re.compile(r"\^(\(([^()]*)\)|[-\d.]*\d)")
_TEN = re.compile(r"\b(\d[\d.]*)e([-+])0?(\d+)\b")
_NAME = re.compile(r"\b[a-z]{2,}(?:[._][a-z]{2,})*_[a-z]{2,}(?:[._][a-z]{2,})*\b")
_MICROSECONDS = re.compile(r"(?<=\d )us\b")
_NUMBERED = re.compile(r"\b(rho|nu|V|E|x|c)([0-3])(?![\d.])('?)")
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
    text = _POWER.sub(lambda found: f"<sup>{found[2] or found[1]}</sup>", text)
    text = _INDEX.sub(r"\1<sub>\2</sub>", text)
    text = _NUMBERED.sub(r"\1<sub>\2</sub>\3", text)
    text = _WORD.sub(lambda found: _GREEK[found[1]], text)
    text = _NAME.sub(r"<code>\g<0></code>", text)
    text = _TEN.sub(_power_of_ten, text)
    text = _MICROSECONDS.sub("\N{MICRO SIGN}s", text)
    for plain, sign in _SIGNS.items():
        text = text.replace(plain, sign)
    return text


def _power_of_ten(found: re.Match[str]) -> str:
    factor = "" if found[1] == "1" else f"{found[1]} \N{MULTIPLICATION SIGN} "
    return f"{factor}10<sup>{found[2].strip('+')}{found[3]}</sup>"
