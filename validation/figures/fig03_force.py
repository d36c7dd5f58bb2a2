"""Fig. 3: contact force against compression, loading and unloading from 5 d_Y, for all laws.

The paper compares MYC, Thornton and Stronge with finite elements and finds MYC within 6 %, Thornton
64 % low and Stronge 40 % high. Ours agree, each in its range: MYC from 0.5 to 10 d_Y (29 % high at
30), Stronge from 2 d_Y on, 38 to 44 % up to 10; Thornton's law is 41 % low at 2 d_Y, 57 % at 4.77,
which 7 V_Y0 reaches on a half-space, and 64 % at 10 d_Y. There Stronge's force is 3.3 times
Thornton's. Jackson and Green fitted metals, E*/sigma_Y above about 120; this pair has 23.
"""

from __future__ import annotations

import numpy as np

from contactlaw.style import INK, MUTED, PALE
from validation import figures
from validation.accuracy import compare
from validation.figures import chart
from validation.figures.chart import COMPRESSION, FORCE, Axis, Panel
from validation.paper.elements import FASTEST_COMPRESSION
from validation.paper.setting import PAIR, all_laws, force, largest, unloading

PART = figures.PAPER

_TOP = 5.0  # d_Y


def draw() -> chart.Drawn:
    """Draw loading and unloading of all laws, and their error while loading."""
    error = Axis("loading force against finite elements  [%]").between(-85, 85)
    figure, (left, right) = chart.sheet(
        (13.0, 6.0),
        "Which law? They differ by a factor of three, and MYC has the force",
        "gamma-alumina on glass, compression and force in units of the yield of the MYC law; left: "
        "loading (thick) and unloading (thin) from 5 d$_Y$, right: loading against finite elements",
        Panel(COMPRESSION.between(0, _TOP), FORCE.between(0, 17)),
        Panel(COMPRESSION.log(0.5, 1, 2, 5, 10, 30).between(0.4, 30), error),
        width_ratios=[1.35, 1.0],
    )
    d, far = np.linspace(0.0, _TOP, 501), np.geomspace(0.4, 30.0, 300)
    off = compare.loading_errors(far)
    for name, law in all_laws().items():
        chart.of_law(left, name, d, force(law, d))
        if law.yield_coefficient is not None:
            chart.of_law(left, name, *unloading(law, _TOP), named=False)
        chart.of_law(right, name, far, 100 * off[name])
    compression, load, _ = compare.indentation("5")
    compression, load = compression[load > 0.0], load[load > 0.0]
    left.plot(compression[::8], load[::8], "o", color=INK, markersize=4.5, label="finite elements")
    chart.key(left, "thin: unloading", "-", linewidth=1.2)
    left.legend(loc="upper left")
    right.axhspan(-6, 6, color=PALE, alpha=0.5, linewidth=0)
    right.axhline(0.0, color=INK, linewidth=1)
    for level, text in ((-64, "paper: \N{MINUS SIGN}64 %"), (40, "paper: +40 %")):
        right.axhline(level, color=INK, linewidth=1.0, linestyle=":")
        chart.note(right, 0.43, level - 2, text, va="top")
    chart.note(right, 0.43, 8, "paper: 6 %", va="bottom")
    right.axvline(FASTEST_COMPRESSION, color=MUTED, linewidth=1.0, linestyle=":")
    chart.note(right, 4.5, -83, "reached at\n7 V$_{Y0}$", MUTED, ha="right", va="bottom")
    near = compare.loading_errors(np.linspace(0.5, 10.0, 191))
    stronge = near["stronge"][30:]  # from 2 d_Y
    at = compare.loading_errors(np.array([2.0, FASTEST_COMPRESSION, 10.0, 30.0]))
    strength = PAIR.sphere.require_yield_strength("jackson_green")
    return figure, {
        "MYC, largest error from 0.5 to 10 d_Y": largest(near["myc"]),
        "MYC at 30 d_Y": at["myc"][3],
        "Stronge, least from 2 to 10 d_Y": stronge.min(),
        "Stronge, largest from 2 to 10 d_Y": stronge.max(),
        "Stronge at 2 d_Y": at["stronge"][0],
        "Stronge at 4.77 d_Y (7 V_Y0)": at["stronge"][1],
        "Thornton at 2 d_Y": at["thornton"][0],
        "Thornton at 4.77 d_Y (7 V_Y0)": at["thornton"][1],
        "Thornton at 10 d_Y": at["thornton"][2],
        "Stronge over Thornton at 4.77 d_Y": (1.0 + at["stronge"][1]) / (1.0 + at["thornton"][1]),
        "E*/sigma_Y of the pair": PAIR.effective_modulus / strength,
    }
