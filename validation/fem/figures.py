"""Figures of the stored results: ``python -m validation.fem figures`` draws them.

One function per figure; each reads its files and returns the figure. They are saved as
``validation/figures/fem_<name>.png``.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

import contactlaw as cl
from dem_demo.figures import _style
from dem_demo.figures._style import BLUE, GREEN, INK, MUTED, ORANGE, VERMILION
from validation.fem import compare, published, store
from validation.fem.cases import PAPER, RADIUS
from validation.fem.studies import SLENDERNESS, SPEED_RATIO

FOLDER = Path(__file__).parent.parent / "figures"
_MARKERS = "os^D"


def verification() -> Figure:
    """Convergence with the mesh, and Hertz's limit."""
    data = store.read("verification").data
    figure = _style.figure(
        12.0, 5.4, "The finite elements converge, and tend to Hertz for small contacts",
        "left: gamma-alumina at 26 m/s on 0.5 mm (full) and 1 mm (dashed) of glass, difference "
        "from the finest mesh; right: elastic, frictionless, 9 mm block, difference from Hertz",
    )  # fmt: skip
    left, right = figure.subplots(1, 2)
    mesh = data["check"] == "mesh"
    fields = {
        "restitution": "COR", "peak_force": "peak force", "contact_time": "contact time",
        "plastic_strain": "largest plastic strain",
    }  # fmt: skip
    for thickness, line in ((0.5e-3, "-"), (1e-3, "--")):
        rows = mesh & (data["thickness"] == thickness)
        size = data["size"][rows]
        for (name, label), colour in zip(
            fields.items(), (BLUE, ORANGE, GREEN, VERMILION), strict=True
        ):
            value = data[name][rows]
            off = np.maximum(np.abs(value[:-1] / value[-1] - 1.0), 1e-5)
            left.loglog(
                size[:-1], off, line, marker="o", color=colour, label=label if line == "-" else None
            )
    left.loglog([0.01, 0.04], [0.001, 0.004], color=MUTED, linewidth=1)
    left.annotate("first order", (0.0103, 0.00125), color=MUTED)
    left.set_xticks([0.01, 0.02, 0.04], ["0.01 R", "0.02 R", "0.04 R"])
    left.minorticks_off()
    left.set_xlabel("smallest element")
    left.set_ylabel("difference from elements of 0.005 R")
    left.yaxis.set_major_formatter(PercentFormatter(1.0))
    left.legend()
    hertz = data["check"] == "hertz"
    model = cl.ImpactModel(PAPER, law="hertz").solve(data["speed"][hertz], RADIUS, np.inf)
    width = np.sqrt(np.asarray(model.peak_compression) / RADIUS)
    for name, label, colour in (
        ("peak_force", "peak force", BLUE), ("contact_time", "contact time", ORANGE),
        ("peak_compression", "peak compression", GREEN),
    ):  # fmt: skip
        off = data[name][hertz] / getattr(model, name) - 1.0
        right.plot(width, off, "o-", color=colour, label=label)
    right.axhline(0.0, color=INK, linewidth=1)
    right.set_xlim(0.0)
    right.set_xlabel("radius of the contact over that of the sphere")
    right.set_ylabel("difference from Hertz")
    right.yaxis.set_major_formatter(PercentFormatter(1.0))
    right.legend()
    return figure


def indentation() -> Figure:
    """Fig. 3: force against compression."""
    figure = _style.figure(
        13.0, 6.6, "MYC follows the finite elements to 10 yield compressions, the others do not",
        "gamma-alumina hemisphere pressed slowly into glass and drawn back, friction 0.1",
    )  # fmt: skip
    left, right = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    for n, name in enumerate(("30", "10", "5", "2")):
        way, force, top = compare.indentation(name)
        label = "finite elements" if n == 0 else None
        left.plot(way, force, color=INK, linewidth=2, label=label)
    way, force, _ = compare.indentation("calculix")
    left.plot(way[::3], force[::3], "o", color=ORANGE, markersize=5, label="CalculiX")
    grid = np.linspace(0.01, 30.0, 600)
    looks = {"myc": (BLUE, "-"), "thornton": (GREEN, "-."), "stronge": (VERMILION, "--")}
    way, force, top = compare.indentation("30")
    fem = np.interp(grid, way[: top + 1], force[: top + 1])
    for name, curve in compare.loading_curves(grid).items():
        colour, line = looks.get(name, (MUTED, ":"))
        left.plot(grid, curve, line, color=colour, linewidth=1.8, label=name)
        shown = grid > 0.4
        right.plot(grid[shown], (curve / fem - 1.0)[shown], line, color=colour, label=name)
    left.set_ylim(0.0, 95.0)
    left.set_xlim(0.0, 30.0)
    left.set_xlabel("compression over yield compression of MYC")
    left.set_ylabel("force over force at yield")
    left.legend(loc="upper left")
    right.axhspan(-0.06, 0.06, color=_style.PALE, alpha=0.6)
    right.axhline(0.0, color=INK, linewidth=1)
    right.annotate("within 6 %", (0.42, 0.075), color=MUTED)
    right.set_xscale("log")
    right.set_xticks([0.5, 1, 2, 5, 10, 30], ["0.5", "1", "2", "5", "10", "30"])
    right.minorticks_off()
    right.set_ylim(-0.85, 0.85)
    right.set_xlabel("compression over yield compression of MYC")
    right.set_ylabel("loading force, difference from finite elements")
    right.yaxis.set_major_formatter(PercentFormatter(1.0))
    return figure


def restitution() -> Figure:
    """Figs 7 and 8: COR against speed and against lambda."""
    case = compare.comparison("matrix")
    figure = _style.figure(
        13.0, 6.4, "The modified Zener model holds where yielding ends Zener's",
        "gamma-alumina on glass; points: finite elements (open: no plastic strain), lines: the "
        "modified Zener model, dotted: Zener",
    )  # fmt: skip
    left, right = figure.subplots(1, 2)
    colours = _colours(len(SLENDERNESS))
    fine = np.geomspace(0.25, 7.6, 100)
    model = cl.ImpactModel(PAPER)
    e_thick = float(case.fem["restitution"][len(SPEED_RATIO) - 1])
    for slenderness, colour in zip(SLENDERNESS, colours, strict=True):
        rows = np.isclose(case.slenderness, slenderness)
        v, e = case.speed_ratio[rows], case.fem["restitution"][rows]
        elastic = case.fem["plastic_strain"][rows] == 0.0
        thickness = RADIUS / slenderness
        line = model.lookup(fine * PAPER.yield_speed, RADIUS, thickness)
        for axes, x, at in ((left, v, fine), (right, case.inelasticity[rows], line.inelasticity)):
            axes.plot(at, line.restitution, color=colour, linewidth=1.6)
            axes.plot(x[~elastic], e[~elastic], "o", color=colour)
            axes.plot(x[elastic], e[elastic], "o", color=colour, markerfacecolor="white")
        lift = {0.1: 3, 0.25: -7, 0.5: -6}.get(slenderness, -4)  # apart from each other
        left.annotate(
            f"{slenderness:g}", (7.0, e[-1]), (12, lift), textcoords="offset points", color=colour
        )
    left.annotate("R/H", (7.0, e_thick), (12, 20), textcoords="offset points", color=INK)
    lam = np.linspace(0.0, 0.38, 60)
    zener = cl.ImpactModel(PAPER, law="hertz")
    slow = 1.0
    thick = [RADIUS * np.sqrt(_inelasticity(slow) / value) for value in lam[1:]]
    right.plot(lam[1:], zener.solve(slow, RADIUS, thick).restitution, ":", color=INK)
    left.set_xscale("log")
    left.set_xticks([0.3, 0.6, 1, 2, 3.5, 7], ["0.3", "0.6", "1", "2", "3.5", "7"])
    left.minorticks_off()
    left.set_xlim(0.27, 9.0)
    left.set_xlabel("impact speed over yield speed of the half-space")
    right.set_xlabel("inelasticity")
    for axes in (left, right):
        axes.set_ylim(0.3, 1.02)
        axes.set_ylabel("coefficient of restitution")
    return figure


def errors() -> Figure:
    """Where the model is off: COR, contact time, force, plastic share."""
    case = compare.comparison("matrix")
    off = compare.field_errors(case)
    restitution_error = case.model["restitution"] / case.fem["restitution"] - 1.0
    panels = {
        "COR": restitution_error, "contact time": off["contact time"],
        "peak force": off["peak force"], "plastic share of the energy": off["plastic share"],
    }  # fmt: skip
    figure = _style.figure(
        13.0, 8.6, "The model is within a few percent; it overrates the plastic work",
        "modified Zener model minus finite elements, in percent (of the value; plastic share: of "
        "the initial energy); gamma-alumina on glass",
    )  # fmt: skip
    shape = len(SLENDERNESS), len(SPEED_RATIO)
    for axes, (title, values) in zip(figure.subplots(2, 2).flat, panels.items(), strict=True):
        table = 100.0 * values.reshape(shape)
        axes.imshow(table, cmap="RdBu_r", vmin=-10, vmax=10, aspect="auto", origin="lower")
        for (i, j), value in np.ndenumerate(table):
            ink = "white" if abs(value) > 6.5 else INK
            axes.text(j, i, f"{value:+.1f}", ha="center", va="center", fontsize=10, color=ink)
        axes.set_title(title, fontweight="bold", loc="left")
        axes.set_xticks(range(shape[1]), [f"{v:g}" for v in SPEED_RATIO])
        axes.set_yticks(range(shape[0]), [f"{s:g}" for s in SLENDERNESS])
        axes.set_xlabel("speed over yield speed")
        axes.set_ylabel("R/H")
        axes.grid(visible=False)
    return figure


def energy() -> Figure:
    """Where the energy goes."""
    case = compare.comparison("matrix")
    figure = _style.figure(
        13.0, 5.2, "Where the energy goes: plate, plastic flow, and little else",
        "gamma-alumina on glass; areas: finite elements, lines: the modified Zener model",
    )  # fmt: skip
    shares = {
        "wave": (BLUE, "plate"), "plastic": (VERMILION, "plastic work"),
        "vibration": (ORANGE, "left in the sphere"), "friction": (GREEN, "friction"),
    }  # fmt: skip
    for axes, slenderness in zip(
        figure.subplots(1, 3, sharey=True), (0.25, 0.75, 1.8), strict=True
    ):
        rows = np.isclose(case.slenderness, slenderness)
        v = case.speed_ratio[rows]
        fem = {k: case.fem["friction_loss" if k == "friction" else k][rows] for k in shares}
        axes.stackplot(
            v, *fem.values(), colors=[c for c, _ in shares.values()], alpha=0.55,
            labels=[label for _, label in shares.values()],
        )  # fmt: skip
        wave, plastic = case.model["wave_fraction"][rows], case.model["plastic_fraction"][rows]
        axes.plot(v, wave, color=INK, linewidth=1.6)
        axes.plot(v, wave + plastic, color=INK, linewidth=1.6, label="model: plate, and plastic")
        axes.set_title(f"R/H = {slenderness:g}", fontweight="bold", loc="left")
        axes.set_xscale("log")
        axes.set_xticks([0.3, 1, 2, 3.5, 7], ["0.3", "1", "2", "3.5", "7"])
        axes.minorticks_off()
        axes.set_xlim(0.3, 7.0)
        axes.set_ylim(0.0, 1.0)
        axes.set_xlabel("speed over yield speed")
        if slenderness == 0.25:
            axes.set_ylabel("share of the initial energy")
            axes.legend(loc="upper left")
    return figure


def paper() -> Figure:
    """Figs 11 to 13: plastic strain, deflection, force history."""
    data = store.read("paper").data
    figure = _style.figure(
        13.0, 9.0, "One impact in full: 26 m/s on 0.5 mm of glass",
        f"gamma-alumina sphere, R = 0.9 mm; largest plastic strain "
        f"{float(data['largest_plastic_strain']):.4f} (paper: about 0.039)",
    )  # fmt: skip
    (a, b), (c, d) = figure.subplots(2, 2)
    a.plot(data["time"] * 1e6, data["force"], color=INK, linewidth=2, label="finite elements")
    time, force = published.force_history(PAPER, 26.0, RADIUS, 0.5e-3)
    a.plot(time * 1e6, force, color=BLUE, linewidth=2, linestyle="--", label="modified Zener")
    a.set_xlabel("time [us]")
    a.set_ylabel("contact force [N]")
    a.legend(loc="lower center")
    for at, way, colour in zip(
        data["snapshot_time"], data["deflection"], (ORANGE, GREEN, VERMILION), strict=True
    ):
        b.plot(data["r"] * 1e3, -way * 1e6, color=colour, linewidth=2, label=f"{at * 1e6:.0f} us")
    b.set_xlim(0.0, 6.0)
    b.invert_yaxis()
    b.set_xlabel("distance from the axis [mm]")
    b.set_ylabel("deflection of the plate [um]")
    b.legend(loc="lower right")
    corners = data["corners"] * 1e3
    corners[..., 1] -= corners[..., 1].min()
    for axes, colours in ((c, False), (d, True)):
        quads = PolyCollection(list(corners), linewidth=0.3)
        if colours:
            quads.set_array(data["plastic_strain"])
            quads.set_cmap("cividis")
            quads.set_edgecolor("face")
            figure.colorbar(quads, ax=axes, pad=0.01).set_label("equivalent plastic strain")
        else:
            quads.set_facecolor("white")
            quads.set_edgecolor(INK)
        axes.add_collection(quads)
        axes.set_aspect("equal")
        axes.grid(visible=False)
        axes.set_xlabel("r [mm]")
        axes.set_ylabel("z [mm]")
    c.set_xlim(0.0, 1.4)
    c.set_ylim(-0.02, 1.82)
    c.set_title("mesh of the sphere", loc="left")
    d.set_xlim(0.0, 0.45)
    d.set_ylim(0.0, 0.3)
    d.set_title("plastic strain after separation", loc="left")
    return figure


def pairs() -> Figure:
    """Three pairs at equal inelasticity."""
    case = compare.comparison("pairs")
    figure = _style.figure(
        13.0, 5.2, "One table serves all pairs until they yield; steel then keeps more",
        "points: finite elements of pairs with the same inelasticity at the yield speed; line: the "
        "model, one for all",
    )  # fmt: skip
    names = list(dict.fromkeys(zip(case.fem["sphere"], case.fem["plate"], strict=True)))
    looks = dict(zip(names, (BLUE, ORANGE, VERMILION), strict=True))
    for axes, block in zip(
        figure.subplots(1, 3, sharey=True), np.split(np.arange(case.slenderness.size), 3),
        strict=True,
    ):  # fmt: skip
        for name, marker in zip(names, _MARKERS, strict=False):
            rows = [n for n in block if (case.fem["sphere"][n], case.fem["plate"][n]) == name]
            axes.plot(
                case.speed_ratio[rows], case.fem["restitution"][rows], marker, markersize=9,
                color=looks[name], alpha=0.85,
                label=f"{name[0]} on {name[1]}, R/H {case.slenderness[rows[0]]:.2f}",
            )  # fmt: skip
        first = block[:4]
        fine = np.geomspace(0.45, 7.4, 80)
        thickness = RADIUS / case.slenderness[first[0]]
        line = cl.ImpactModel(PAPER).restitution(fine * PAPER.yield_speed, RADIUS, thickness)
        axes.plot(fine, line, color=INK, linewidth=1.6)
        at_yield = case.inelasticity[first[0]] * 2.0**0.2
        axes.set_title(f"inelasticity at yield {at_yield:.3f}", fontweight="bold", loc="left")
        axes.set_xscale("log")
        axes.set_xticks([0.5, 1.5, 3.5, 7], ["0.5", "1.5", "3.5", "7"])
        axes.minorticks_off()
        axes.set_ylim(0.35, 1.02)
        axes.set_xlabel("speed over yield speed")
        axes.legend(loc="lower left", fontsize=8.5)
        if block[0] == 0:
            axes.set_ylabel("coefficient of restitution")
    return figure


def limits() -> Figure:
    """Thinner, faster, and smaller plates than the model's limits."""
    case = compare.comparison("limits")
    edge = store.read("edge").data
    figure = _style.figure(
        13.0, 5.6, "Beyond the limits the model errs slowly; an edge too near matters at once",
        "left: gamma-alumina on glass, error of the modified Zener model in COR; right: plate of "
        "finite radius, R/H = 1.5, at the yield speed",
    )  # fmt: skip
    left, right = figure.subplots(1, 2)
    values = sorted(set(case.slenderness.round(3)))
    for slenderness, colour, marker in zip(values, _colours(len(values)), _MARKERS, strict=True):
        rows = np.isclose(case.slenderness, slenderness, atol=1e-3)
        off = case.model["restitution"][rows] - case.fem["restitution"][rows]
        left.plot(
            case.speed_ratio[rows], off, marker + "-", color=colour, label=f"R/H {slenderness:g}"
        )
    left.axvline(7.0, color=MUTED, linestyle=":")
    left.annotate("the paper's fastest", (7.2, 0.0305), color=MUTED)
    left.axhline(0.0, color=INK, linewidth=1)
    left.set_xlabel("speed over yield speed")
    left.set_ylabel("COR of the model minus finite elements")
    left.legend(loc="lower left", ncols=2)
    left.set_ylim(-0.025, 0.033)
    ratio = edge["width"] / edge["edge_distance"]
    right.plot(ratio, edge["restitution"], "o-", color=BLUE, label="finite elements")
    model = cl.ImpactModel(PAPER).lookup(edge["speed"][0], RADIUS, edge["thickness"][0])
    right.axhline(float(model.restitution), color=INK, linestyle="--", label="model, no edge")
    right.axvline(1.0, color=MUTED, linestyle=":")
    right.annotate("cl.edge_distance", (1.03, 0.667), color=MUTED)
    right.set_xlabel("distance of the edge over cl.edge_distance")
    right.set_ylabel("coefficient of restitution")
    right.legend(loc="lower right")
    return figure


FIGURES: dict[str, Callable[[], Figure]] = {
    "verification": verification,
    "indentation": indentation,
    "restitution": restitution,
    "errors": errors,
    "energy": energy,
    "paper": paper,
    "pairs": pairs,
    "limits": limits,
}


def draw(folder: Path = FOLDER) -> None:
    """Draw every figure as a PNG file."""
    folder.mkdir(parents=True, exist_ok=True)
    with _style.applied():
        for name, make in FIGURES.items():
            make().savefig(folder / f"fem_{name}.png")


def _colours(count: int) -> list[tuple[float, ...]]:
    from matplotlib import colormaps

    return [tuple(colormaps["viridis"](0.82 * n / (count - 1))) for n in range(count)]


def _inelasticity(speed: float) -> float:
    """Lambda of an elastic impact on a plate as thick as the sphere's radius."""
    model = cl.ImpactModel(PAPER, law="hertz")
    return float(model.lookup(speed, RADIUS, RADIUS).inelasticity)
