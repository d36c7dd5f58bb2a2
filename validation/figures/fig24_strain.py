"""Fig. 24: which law, by the sphere's modulus over its yield strength.

The pair of the paper, its yield strength from 2 to 1/8 times the real one, and steel on glass and
on aluminium, all at the same inelasticity, so that the equation has one COR for each law. Finite
elements do not: a bead that is as soft for its strength as the paper's (26) has the COR of MYC, one
as stiff as metals (100 and more) that of Kogut & Etsion and Jackson & Green, who fitted metals.
Whether the sphere or the plate is the stiffer body hardly matters.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from validation.fem import compare
from validation.figures import _style

_LAWS = "myc", "stronge", "kogut_etsion", "jackson_green"
_SPEEDS = 3.5, 7.0  # V0/V_Y0
_KINDS = {"13": (0, 20), "26": (20, 40), "52": (40, 60), "100 and more": (60, 1e6)}  # E/sigma_Y
_MARKERS = {"glass": "o", "soda-lime-glass": "s", "aluminium-6061-t6": "^"}  # by plate


def draw() -> tuple[Figure, dict[str, float]]:
    """Draw finite elements and laws against E/sigma_Y, at two speeds."""
    figure = _style.figure(
        13.0,
        6.2,
        "Soft beads follow MYC, metals Kogut & Etsion and Jackson & Green",
        "COR at equal inelasticity, that of gamma-alumina on glass with R/H = 1; black: finite "
        "elements of steel and of alumina with other strengths; lines: the modified Zener equation",
    )
    numbers: dict[str, float] = {}
    for axes, speed in zip(figure.subplots(1, 2, sharey=True), _SPEEDS, strict=True):
        rows = compare.by_strain(speed)
        for name in _LAWS:
            colour, line, title = _style.law(name)
            alumina = [row for row in rows if row.plate == "glass"]
            axes.plot(
                [row.ratio for row in alumina], [row.laws[name] for row in alumina], line,
                color=colour, linewidth=2.2, label=title,
            )  # fmt: skip
            for kind, (low, high) in _KINDS.items():
                some = [row for row in rows if low < row.ratio < high]
                off = np.array([row.laws[name] / row.fem - 1.0 for row in some])
                numbers[f"{title}, {speed:g} V_Y0, E/sigma_Y {kind}: largest error"] = float(
                    off[np.abs(off).argmax()]
                )
        for plate, marker in _MARKERS.items():
            some = [row for row in rows if row.plate == plate]
            axes.plot(
                [row.ratio for row in some], [row.fem for row in some], marker, markersize=9,
                color=_style.INK, markerfacecolor=_style.INK if plate == "glass" else "white",
                label=f"{'alumina' if plate == 'glass' else 'steel'} on {plate}",
            )  # fmt: skip
        axes.set_xscale("log")
        axes.set_xticks([13, 26, 52, 100, 200], ["13", "26", "52", "100", "200"])
        axes.minorticks_off()
        axes.set(xlabel=r"E / $\sigma_Y$  of the sphere", title=f"{speed:g} V$_{{Y0}}$")
    figure.axes[0].set_ylabel("coefficient of restitution")
    figure.axes[0].legend(loc="lower right", ncols=2)
    return figure, numbers
