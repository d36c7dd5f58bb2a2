"""Figures of the paper, drawn again, and two of ours beside them."""

from __future__ import annotations

import math

import numpy as np

from contactlaw.style import BLUE, GREEN, INK, MUTED, ORANGE, PALE, SKY, VERMILION
from validation import figures
from validation.accuracy import compare
from validation.figures import chart
from validation.figures.chart import (
    COMPRESSION,
    FORCE,
    INELASTICITY,
    RESTITUTION,
    SLENDERNESS,
    SPEED,
    SPEEDS,
    Axis,
    Panel,
)
from validation.paper import closed_form, turning_point
from validation.paper.closed_form import elastic_compression, mueller, peng, yield_speed_ratio, zener
from validation.paper.elements import FASTEST_COMPRESSION, contact_time_errors
from validation.paper.evidence import eq_10, fitted_border
from validation.paper.setting import (
    ETA,
    FASTEST,
    PAIR,
    SHARE,
    THINNEST,
    all_laws,
    borderline,
    force,
    impacts,
    largest,
    unloading,
)

PART = figures.PAPER


_TOP = 5.0  # d_Y


def fig03_force() -> chart.Drawn:
    r"""Fig. 3: contact force against compression, loading and unloading from 5 yield compressions, for all laws.

    Of Stronge's law, which the package does not offer, loading alone.

    The paper compares MYC, Thornton and Stronge with finite elements and finds MYC within 6 %,
    Thornton 64 % low and Stronge 40 % high. Ours agree, each in its range: MYC from 0.5 to 10 $d_Y$
    (29 % high at 30), Stronge from 2 $d_Y$ on, 38 to 44 % up to 10; Thornton's law is 41 % low at 2
    $d_Y$, 57 % at 4.77, which 7 $V_{Y0}$ reaches on a half-space, and 64 % at 10 $d_Y$. There Stronge's
    force is 3.3 times Thornton's. Jackson and Green fitted metals, $E^*/\sigma_Y$ above about 120; this
    pair has 23.
    """
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
    chart.of_law(left, "stronge", d, closed_form.stronge(d))
    chart.of_law(right, "stronge", far, 100 * off["stronge"])
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
    at = compare.loading_errors(np.array([2.0, FASTEST_COMPRESSION, 10.0, 30.0]))
    strength = PAIR.sphere.require_yield_strength("jackson_green")
    return figure, {
        "MYC, largest error from 0.5 to 10 yield compressions": largest(near["myc"]),
        "MYC at 30 yield compressions": at["myc"][3],
        "Stronge, least from 2 to 10 yield compressions": near["stronge"][30:].min(),
        "Stronge, largest from 2 to 10 yield compressions": near["stronge"].max(),
        "Stronge at 4.77 yield compressions (7 yield speeds)": at["stronge"][1],
        "Thornton at 2 yield compressions": at["thornton"][0],
        "Thornton at 4.77 yield compressions (7 yield speeds)": at["thornton"][1],
        "Thornton at 10 yield compressions": at["thornton"][2],
        "Stronge over Thornton at 4.77 yield compressions": (1.0 + at["stronge"][1]) / (1.0 + at["thornton"][1]),
        "effective modulus over strength of the pair": PAIR.effective_modulus / strength,
    }


INTERCEPT = 1.25**-0.6


def fig04_compression() -> chart.Drawn:
    r"""Fig. 4: the largest compression of elastic impacts against the inelasticity, with the paper's line, Eq. 6.

    The intercept $(5/4)^{-3/5}$ is exact. The slope 1.00 is not what a fit gives: it is 0.908 at
    $\lambda = 0$ (derived: $0.6 J (5/4)^{-3/5}$ with $J = 1.7302$), 0.929 by least squares over 0 to 2,
    and tends to 1 only for very thin plates. One quadratic term makes the curve exact to 0.004 % up
    to 0.6.
    """
    figure, (left, right) = chart.sheet(
        (11.0, 5.6),
        "The slope of Eq. 6 is 0.91 to 0.93, not 1.00",
        "largest compression of an elastic impact on Hertz's scale; right: error of the two formulas for $w_m$",
        Panel(INELASTICITY.between(0, 2), Axis(r"largest compression  $w_m^{-1.5}$")),
        Panel(INELASTICITY.between(0, 2), Axis(r"error of $w_m$  [%]")),
    )
    lam = np.linspace(0.0, 2.0, 81)
    exact = elastic_compression(lam)
    quadratic = INTERCEPT * turning_point.loading(lam) ** -1.5
    printed, mended = closed_form.eq_6(lam) / exact - 1, quadratic ** (-2 / 3) / exact - 1
    some = slice(None, None, 5)
    left.plot(lam[some], exact[some] ** -1.5, "s", color=BLUE, markersize=7, label="solver", clip_on=False)
    left.plot(lam, lam + INTERCEPT, color=VERMILION, label="Eq. 6, slope 1.00")
    left.plot(lam, quadratic, color=GREEN, label="derived slope + quadratic")
    left.legend(loc="upper left")
    right.plot(lam, 100 * printed, color=VERMILION)
    right.plot(lam, 100 * mended, color=GREEN)
    start = elastic_compression(1e-4) ** -1.5 - INTERCEPT
    return figure, {
        "least-squares slope over 0 to 2": (lam * (exact**-1.5 - INTERCEPT)).sum() / (lam**2).sum(),
        "slope at 0": start / 1e-4,
        "largest error of Eq. 6 in $w_m$": largest(printed),
        "largest error of the quadratic up to 0.6": largest(mended[lam <= 0.6]),
    }


_SECTIONS = {0.2: BLUE, 0.5: SKY, 1.0: GREEN, 1.4: ORANGE, 1.8: VERMILION}
_ISOLINES = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9)  # COR


def fig05_surface() -> chart.Drawn:
    """Fig. 5: the COR over speed and thickness (A), and against Mueller's elastic formula (B).

    The COR falls with speed and with R/H everywhere. Above the yield speed Mueller's formula, which
    leaves out plastic flow, is far too high: by 31 % at 7 $V_{Y0}$ on a plate of R/H = 0.5.
    """
    figure, (left, right) = chart.sheet(
        (13.0, 6.0),
        "The COR falls with speed and as the plate gets thinner",
        "gamma-alumina on glass, modified Zener model; A: contours of COR, dashed: yield speed; "
        "B: COR against speed, dashes: Mueller's elastic formula",
        Panel(SPEED, SLENDERNESS, "A"),
        Panel(SPEED.between(0, FASTEST), RESTITUTION.between(0.3, 1.01), "B"),
    )
    v, ratio = np.linspace(0.05, FASTEST, 200), np.linspace(0.0, THINNEST, 120)
    e = np.asarray(impacts(v, ratio[:, None]).restitution)
    chart.contours(left, v, ratio, e, RESTITUTION.label, levels=np.arange(0.3, 1.001, 0.05))
    inks = [INK if level > 0.65 else "white" for level in _ISOLINES]
    lines = left.contour(v, ratio, e, levels=_ISOLINES, colors=inks, linewidths=1)
    left.clabel(lines, fmt="%.1f", fontsize=10)
    left.plot(yield_speed_ratio(ETA * ratio**2), ratio, "--", color=INK)
    for one, colour in _SECTIONS.items():
        right.plot(v, impacts(v, one).restitution, color=colour, label=f"R/H = {one:g}")
        right.plot(v, mueller(ETA * one**2 * v**0.2), "--", color=colour, linewidth=1.2)
        yields = float(yield_speed_ratio(ETA * one**2))
        right.plot(yields, impacts(yields, one).restitution, "v", color=colour, markersize=9)
    chart.key(right, "Mueller, elastic", "--", linewidth=1.2)
    chart.key(right, "yield speed", "v", markersize=9)
    right.legend(loc="lower left", ncols=2)
    over = mueller(ETA * 0.25 * FASTEST**0.2) / impacts(FASTEST, 0.5).restitution - 1
    return figure, {
        "COR at R/H = 1.8 and 7 yield speeds": e[-1, -1],
        "Mueller over the model at R/H = 0.5, 7 yield speeds, less 1": over,
        "largest rise of COR with speed or R/H": max(np.diff(e, axis=k).max() for k in (0, 1)),
    }


def fig06_yield_speed() -> chart.Drawn:
    r"""Fig. 6: speed from which the bead yields, against R/H: the solver and Eq. 14.

    Eq. 14 is within 1.2 % of the solver up to R/H = 1.8 to the digits that the paper prints, 1.21
    %, with $\eta$ corrected. There the plate raises the yield speed by 22 %; with $\pi^{3/5}$ and the
    exponent 4/5 in $\eta$ Eq. 14 would be 9 % low, with $\eta$ as printed ($\pi^3$, 4/5) more than twice too
    high.
    """
    figure, (left, right) = chart.sheet(
        (11.0, 5.4),
        "A thin plate gives way, and the bead yields later",
        "gamma-alumina on glass; yield speed relative to that of the half-space",
        Panel(SLENDERNESS.between(0, 2.2), Axis("yield speed  V$_Y$ / V$_{Y0}$")),
        Panel(SLENDERNESS.between(0, 2.2), Axis("error of Eq. 14  [%]")),
    )
    ratio = np.linspace(0.0, 2.2, 89)
    exact = yield_speed_ratio(ETA * ratio**2)
    printed = closed_form.eq_14(ETA * ratio**2)
    misprint = closed_form.eq_14(ETA * SHARE**0.4 * ratio**2)
    error = printed / exact - 1
    left.plot(ratio[::8], exact[::8], "s", color=BLUE, markersize=7, label="solver", clip_on=False)
    left.plot(ratio, printed, color=VERMILION, label=r"Eq. 14, $\eta$ corrected")
    left.plot(ratio, misprint, ":", color=MUTED, label=r"Eq. 14, exponent 4/5 in $\eta$")
    left.legend(loc="upper left")
    right.plot(ratio, 100 * error, color=VERMILION)
    right.axvline(THINNEST, color=MUTED, linestyle=":")
    chart.note(right, THINNEST - 0.04, 0.05, "the paper's thinnest", MUTED, ha="right")
    right.axhline(1.2, color=INK, linewidth=1, linestyle=":")
    chart.note(right, 0.05, 1.21, "paper: 1.2 %", va="bottom")
    at = int(np.argmin(np.abs(ratio - THINNEST)))
    as_printed = closed_form.eq_14(eq_10(3.0, 0.8) * THINNEST**2)
    return figure, {
        "largest error of Eq. 14 up to R/H = 1.8": largest(error[ratio <= THINNEST]),
        "yield speed over that of the half-space at R/H = 1.8": exact[at],
        r"Eq. 14 with $\pi^{3/5}$ and 4/5 in $\eta$ at R/H = 1.8, error": misprint[at] / exact[at] - 1,
        r"Eq. 14 with $\eta$ as printed at R/H = 1.8, error": as_printed / exact[at] - 1,
    }


def fig07_inelasticity() -> chart.Drawn:
    """Fig. 7: COR against inelasticity: the elastic models, and impacts of the paper's pair.

    Below yield all impacts lie on one curve (Zener's); Mueller's formula is within 2.5 % of it up
    to an inelasticity of 0.5, Raman's within 9.3 %. Above yield the impacts leave that curve: at small ones
    (R/H = 0.2) all three elastic models are 30 % high at 7 $V_{Y0}$. Crosses are finite elements.
    """
    figure, (axes,) = chart.sheet(
        (11.0, 6.2),
        "Elastic models hold below yield only",
        "COR against Zener's inelasticity; points: gamma-alumina on glass, R/H 0.05 to 2.2, "
        "at multiples of the yield speed V$_{Y0}$, modified Zener model; crosses: finite elements",
        Panel(INELASTICITY.between(0, 0.6), RESTITUTION.between(0.25, 1.01)),
    )
    lam, ratio = np.linspace(0.0, 0.6, 241), np.linspace(0.05, 2.2, 20)
    axes.plot(lam, zener(lam), color=INK, linewidth=2.4, label="Zener (solved)")
    axes.plot(lam, mueller(lam), "--", color=VERMILION, label="Mueller, Eq. 3")
    axes.plot(lam, closed_form.raman(lam), "-.", color=ORANGE, label="Raman's form, exact slope")
    for v, colour in SPEEDS.items():
        one, words = impacts(v, ratio), f"{v:g} V$_{{Y0}}$"
        axes.plot(one.inelasticity, one.restitution, "o", color=colour, markersize=5, label=words)
        chart.matrix(axes, "restitution", v)
    chart.cross(axes, [], [], label="finite elements")
    axes.legend(ncols=3, loc="upper right")
    thick, near = impacts(FASTEST, 0.2), lam[lam <= 0.5]
    numbers = {
        f"{name} over the model at 7 yield speeds, R/H = 0.2, less 1": form(thick.inelasticity) / thick.restitution - 1
        for name, form in (("Zener", zener), ("Mueller", mueller), ("Raman's form", closed_form.raman))
    }
    return figure, {
        **numbers,
        "largest error of Mueller up to an inelasticity of 0.5": largest(mueller(near) / zener(near) - 1),
        "largest error of Raman's form up to an inelasticity of 0.5": largest(
            closed_form.raman(near) / zener(near) - 1
        ),
    }


_CLOSED = (0.25, 0.75, 1.25, 1.8)  # where there are finite elements


def fig08_speed() -> chart.Drawn:
    """Fig. 8: COR against speed for several thicknesses: the solver and the closed forms.

    Eq. 22 as printed jumps to 1 at the yield speed and is up to 55 % off. With the elastic COR at
    yield as a factor it is continuous and within 4 %.
    """
    figure, panels = chart.by_thickness(
        (13.0, 5.2),
        "Eq. 22 as printed jumps at yield; one factor mends it",
        "COR against speed, gamma-alumina on glass",
        _CLOSED,
        SPEED.between(0, FASTEST + 0.3),
        RESTITUTION.between(0.3, 1.02),
    )
    v = np.linspace(0.05, FASTEST, 400)
    errors: dict[str, float] = {}
    case = compare.comparison("matrix")
    for ratio, axes in panels:
        e = np.asarray(impacts(v, ratio).restitution)
        for name, words, line, colour, form in (
            ("printed", "Eq. 22, printed", ":", MUTED, closed_form.eq_22(v, ratio, ETA)),
            ("continuous", "Eq. 22, continuous", "--", VERMILION, peng(v, ratio, ETA)),
        ):
            axes.plot(v, form, line, color=colour, label=words)
            errors[name] = max(errors.get(name, 0.0), largest(form / e - 1))
        axes.plot(v[::16], e[::16], "o", color=BLUE, markersize=4.5, label="solver")
        here = np.isclose(case.slenderness, ratio)
        axes.plot(
            case.speed_ratio[here],
            case.fem["restitution"][here],
            "x",
            color=INK,
            markersize=8,
            markeredgewidth=2,
            label="finite elements",
        )
    figure.axes[0].legend(loc="lower left")
    return figure, {f"largest error, {name}": error for name, error in errors.items()}


def fig09a_phase() -> chart.Drawn:
    """Fig. 9A: which loss rules where, over speed and R/H.

    Region I is elastic; in II the bending wave takes more than plastic flow, in III less. Eq. 23 is
    the border of II and III to within 10 % in speed, worst near R/H = 0.25. Of the three cited
    experiments the paper gives materials and regions, but neither thickness nor speed, so there are
    no points to draw. It puts Kharaz and Gorham's, on plastic loss, into region II, where the wave
    rules; on thick plates that region is a sliver, 0.1 $V_{Y0}$ wide at R/H = 0.1, so III may be meant.
    """
    figure, (axes,) = chart.sheet(
        (10.0, 6.6),
        "Wave or plastic flow: which loss is larger?",
        "share of the energy loss that is plastic, gamma-alumina on glass; black: the isolines 0 "
        "and 1/2 of the model, dashed: Eq. 23",
        Panel(SPEED.between(0.05, 10.0), SLENDERNESS.between(0.01, 1.8)),
    )
    v, ratio = np.linspace(0.05, 10.0, 200), np.linspace(0.01, 1.8, 120)
    one = impacts(v, ratio[:, None])
    share = np.asarray(one.plastic_fraction) / (1.0 - np.asarray(one.restitution) ** 2)
    label = "plastic share of the loss"
    chart.contours(axes, v, ratio, share, label, levels=np.linspace(0, 1, 11))
    half = np.linspace(0.05, 1.2, 24)
    exact = np.array([borderline(float(x)) for x in half])
    axes.plot(yield_speed_ratio(ETA * ratio**2), ratio, color="black", linewidth=2.2)
    axes.plot(exact, half, color="black", linewidth=2.2)
    axes.plot(closed_form.border(half), half, "--", color="white", linewidth=2.2)
    for x, y, text, cited in (
        (1.75, 1.5, "II  wave", "as cited: Kharaz & Gorham 2000;\nPatil & Higgs 2017 (to III)"),
        (6.2, 0.4, "III  plastic", "as cited: Patil & Higgs 2017 (from II)"),
    ):
        colour = "white" if x < 5 else "black"
        axes.text(x, y, text, fontsize=15, fontweight="bold", color=colour)
        axes.text(x, y - 0.03, cited, fontsize=10, color=colour, va="top")
    axes.text(0.15, 0.75, "I  elastic", fontsize=15, fontweight="bold", color="white", rotation=90)
    axes.text(0.55, 0.75, "as cited: Mueller et al. 2015", fontsize=10, color="white", rotation=90)
    off = np.abs(closed_form.border(half) / exact - 1)
    yields = float(yield_speed_ratio(ETA * half[1] ** 2))
    return figure, {
        "coefficient of Eq. 23, fitted over R/H 0.1 to 1.2": fitted_border(1.2),
        "the same, over R/H 0.1 to 1.1": fitted_border(1.1),
        "speed at which plastic loss overtakes at R/H = 1.2": borderline(1.2),
        "largest error of Eq. 23 in speed, R/H 0.05 to 1.2": off.max(),
        "R/H at which it is": half[off.argmax()],
        "width of region II at R/H = 0.1, in yield speeds": borderline(0.1) - yields,
    }


_STACKED = (0.2, 0.5, 1.2)


def fig09b_energy() -> chart.Drawn:
    """Fig. 9B: where the energy goes, against speed, at R/H = 0.2, 0.5 and 1.2.

    At R/H = 1.2 plastic flow takes more than the wave only above 9.98 $V_{Y0}$, beyond the paper's
    range; at 0.5 it does above 1.82 $V_{Y0}$, at 0.2 above 1.22. The shares sum to 1.
    """
    figure, panels = chart.by_thickness(
        (13.0, 5.0),
        "Thin plates lose energy to the wave, thick ones to plastic flow",
        "shares of the initial kinetic energy, gamma-alumina on glass",
        _STACKED,
        SPEED.between(0.05, FASTEST),
        Axis("share of the initial kinetic energy").between(0, 1),
    )
    v = np.linspace(0.05, FASTEST, 300)
    numbers = {f"plastic overtakes wave at R/H = {one:g}": borderline(one) for one in _STACKED}
    unaccounted = 0.0
    for ratio, axes in panels:
        one = impacts(v, ratio)
        kept, wave = np.asarray(one.restitution) ** 2, np.asarray(one.wave_fraction)
        plastic = np.asarray(one.plastic_fraction)
        axes.stackplot(
            v,
            kept,
            wave,
            plastic,
            colors=(PALE, BLUE, ORANGE),
            labels=("kept by the sphere", "bending wave", "plastic flow"),
        )
        if borderline(ratio) < FASTEST:
            words = "more plastic than wave beyond"
            axes.axvline(borderline(ratio), color=INK, linestyle=":", label=words)
        unaccounted = max(unaccounted, largest(kept + wave + plastic - 1))
    named = figure.axes[0].get_legend_handles_labels()
    figure.axes[2].legend(*named, loc="lower left", frameon=True)
    return figure, {**numbers, "energy not accounted for": unaccounted}


def fig10_contact_time() -> chart.Drawn:
    """Fig. 10: contact time against inelasticity, with and without plastic flow.

    Plastic flow shortens the contact by at most 9 % up to 7 $V_{Y0}$. Thinner plates prolong it, by 5 %
    at R/H = 1.8 and $V_{Y0}$. Finite elements (crosses) have contacts up to 4 % shorter than the
    model's, rms 2.3 %: theirs are stiffer than Hertz's. Where the bead yields, Zener's model is 4
    to 11 % long beside them, as the paper says.
    """
    figure, (axes,) = chart.sheet(
        (11.0, 6.0),
        "Plastic flow shortens the contact by a tenth at most",
        "gamma-alumina of 0.9 mm radius on glass at multiples of the yield speed V$_{Y0}$; along "
        "each line radius over thickness, R/H, goes from 0.05 to 1.8",
        Panel(INELASTICITY.between(0, 0.37), Axis("contact time  [µs]").between(2.6, 5.8)),
    )
    ratio = np.linspace(0.05, 1.8, 60)
    shorter = 0.0
    for v, colour in SPEEDS.items():
        one, elastic = impacts(v, ratio), np.asarray(impacts(v, ratio, law="hertz").contact_time)
        time = np.asarray(one.contact_time)
        axes.plot(one.inelasticity, time * 1e6, color=colour, label=f"{v:g} V$_{{Y0}}$")
        axes.plot(one.inelasticity, elastic * 1e6, "--", color=colour, linewidth=1.4)
        chart.matrix(axes, "contact_time", v, unit=1e-6)
        shorter = max(shorter, float((1 - time / elastic).max()))
    chart.key(axes, "modified Zener model", "-")
    chart.key(axes, "Zener's, elastic", "--", linewidth=1.4)
    chart.cross(axes, [], [], label="finite elements")
    axes.legend(ncols=3, loc="upper right")
    model, zener = contact_time_errors()
    thin, thick = impacts(1.0, 1.8).contact_time, impacts(1.0, 0.05).contact_time
    return figure, {
        "largest shortening by plastic flow up to 7 yield speeds": shorter,
        "R/H = 1.8 over 0.05 at the yield speed, contact time, less 1": thin / thick - 1,
        "model over finite elements, less 1, least": model.min(),
        "model over finite elements, less 1, largest": model.max(),
        "model over finite elements, less 1, rms": math.sqrt((model**2).mean()),
        "Zener over finite elements, less 1, above yield, least": zener.min(),
        "Zener over finite elements, less 1, above yield, largest": zener.max(),
    }
