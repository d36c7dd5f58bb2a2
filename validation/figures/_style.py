"""The look of the demo's figures, with more colours and the marks of the paper's regions."""

from __future__ import annotations

from dem_demo.figures._style import (
    BLUE,
    GREEN,
    INK,
    MUTED,
    ORANGE,
    PALE,
    VERMILION,
    applied,
    figure,
)

SKY, PURPLE = "#56B4E9", "#CC79A7"  # Okabe and Ito (2008), as the others
LAWS = {
    "hertz": (MUTED, "--"),
    "myc": (BLUE, "-"),
    "thornton": (VERMILION, "-"),
    "stronge": (ORANGE, "-"),
    "kogut_etsion": (GREEN, "-."),
    "jackson_green": (PURPLE, "-."),
}
TITLES = {
    "hertz": "Hertz",
    "myc": "MYC",
    "thornton": "Thornton",
    "stronge": "Stronge",
    "kogut_etsion": "Kogut & Etsion",
    "jackson_green": "Jackson & Green",
}

__all__ = [
    "BLUE",
    "GREEN",
    "INK",
    "LAWS",
    "MUTED",
    "ORANGE",
    "PALE",
    "PURPLE",
    "SKY",
    "TITLES",
    "VERMILION",
    "applied",
    "figure",
]
