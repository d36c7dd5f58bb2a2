"""Figures for people who simulate."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw import style
from contactlaw.cli.compare import curve as model_curve
from contactlaw.cli.parts.figure import Curve, Points, draw_curve, draw_points
from contactlaw.equation import outcome, zener
from contactlaw.equation.corrections import CONTACT_TIME
from contactlaw.equation.edge import Edge, Edges
from contactlaw.equation.force import HERTZ
from contactlaw.physical.responses import response_of
from contactlaw.physical.scaling import wave_path
from contactlaw.style import BLUE, GREEN, INK, MUTED, ORANGE, PALE, SKY, VERMILION
from validation import figures
from validation.accuracy import acceptance, measured
from validation.accuracy.acceptance import Member, Row
from validation.accuracy.edges import FILE
from validation.accuracy.measured import FOLDER, Source
from validation.derivations.walls import restitution
from validation.figures import chart
from validation.figures.chart import RESTITUTION, Axis, Panel

PART = figures.PRACTICE


_LOOK = {  # by the body that yields: marker, colour and words
    "none": ("D", SKY, "neither yields"),
    "sphere": ("o", BLUE, "the sphere yields"),
    "plate": ("s", VERMILION, "the plate yields"),
    "both": ("^", GREEN, "both yield"),
}
_TITLES = {"paper": "impacts of the paper's kind", "kept out": "everyday impacts, kept out of the fit"}
_FEM = Axis("COR by finite elements").between(0.0, 1.005)
_WIDEST = 5.0  # [%]; a larger error is drawn here, with its value


def fig25_fem() -> chart.Drawn:
    """Fig. 25: law fem, which was fitted to finite elements, against impacts by finite elements.

    Left, its COR over that of finite elements, by the body that yields; crosses are law myc, which
    has no answer where the sphere has no yield strength. Right, the errors of law fem in COR, above
    for impacts of the paper's kind, to which it was fitted too, below for everyday impacts that
    were drawn before the fit and kept out of it. The target is that 95 % of the impacts lie in the
    band, and that those outside of it carry a flag of accuracy, which an open mark shows.
    """
    rows = acceptance.rows(_TITLES)
    others = {name: acceptance.members(row.target, "myc") for name, row in rows.items()}
    figure = style.figure(
        14.0,
        7.4,
        "Law fem has the COR of finite elements, whichever body yields",
        "left: the coefficient of restitution (COR) of each impact, coloured: law fem, crosses: "
        "law myc, in which the sphere alone yields; right: errors of law fem, band: their bound",
    )
    panels = figure.subplot_mosaic([["cor", "paper"], ["cor", "kept out"]], width_ratios=(1.0, 1.15))
    Panel(_FEM, _FEM._replace(label="COR by law")).set_up(panels["cor"])
    _parity(panels["cor"], rows, others)
    for name, row in rows.items():
        _errors(panels[name], _TITLES[name], row)
    panels["paper"].set_xlabel("")
    panels["paper"].tick_params(labelbottom=False)
    return figure, _numbers(rows, others)


def _parity(axes: Axes, rows: dict[str, Row], others: dict[str, tuple[Member, ...]]) -> None:
    axes.plot([0.0, 1.0], [0.0, 1.0], color=INK, linewidth=1)
    every = [one for listed in others.values() for one in listed]
    axes.plot(
        [one.fem for one in every],
        [one.law for one in every],
        "x",
        color=MUTED,
        markersize=6,
        alpha=0.7,
        label="law myc",
        zorder=1,
    )
    for row in rows.values():
        _marks(axes, row, lambda one: one.law, 8.0)
    chart.key(axes, "open: with a flag", "o", markerfacecolor="white", color=BLUE)
    named = dict(zip(*axes.get_legend_handles_labels()[::-1], strict=True))
    axes.legend(named.values(), named.keys(), loc="upper left", fontsize=12)


def _marks(axes: Axes, row: Row, value: Callable[[Member], float], size: float) -> None:
    """Mark impacts by the body that yields; those that carry a flag of accuracy are open."""
    for yielding, (marker, colour, words) in _LOOK.items():
        for flagged in (False, True):
            some = [one for one in row.members if (one.yielding, one.flagged) == (yielding, flagged)]
            if not some:  # an empty mark takes room in the layout
                continue
            axes.plot(
                [one.fem for one in some],
                [value(one) for one in some],
                marker,
                color=colour,
                markersize=size,
                markerfacecolor="white" if flagged else colour,
                markeredgecolor=colour if flagged else "white",
                markeredgewidth=0.8,
                label=None if flagged else words,
                clip_on=False,
                zorder=2,
            )


def _errors(axes: Axes, title: str, row: Row) -> None:
    """Draw errors of law fem in COR, and their bound as a band."""
    bound = 100.0 * row.target.bounds.restitution
    right = sum(abs(one.errors.restitution) <= 0.01 * bound for one in row.members)
    title = f"{title}: {right} of {len(row.members)} within {bound:g} %"
    Panel(_FEM, Axis("error of the COR  [%]").between(-5.6, 5.6), title).set_up(axes)
    axes.axhspan(-bound, bound, color=PALE, alpha=0.6, linewidth=0)
    axes.axhline(0.0, color=INK, linewidth=1)

    def error(one: Member) -> float:
        return float(np.clip(100.0 * one.errors.restitution, -_WIDEST, _WIDEST))

    _marks(axes, row, error, 7.0)
    far = [one for one in row.members if abs(100.0 * one.errors.restitution) > _WIDEST]
    for n, one in enumerate(sorted(far, key=lambda one: one.fem)):
        percent = 100.0 * one.errors.restitution
        lift = 9 + 12 * (n % 2)  # apart from its neighbours
        axes.annotate(
            f"{percent:+.1f}",
            (one.fem, error(one)),
            (0, -lift if percent > 0.0 else lift),
            textcoords="offset points",
            ha="center",
            va="center_baseline",
            fontsize=10,
        )


def _numbers(rows: dict[str, Row], others: dict[str, tuple[Member, ...]]) -> dict[str, float]:
    numbers: dict[str, float] = {}
    for name, row in rows.items():
        numbers[f"{name}: impacts"] = len(row.members)
        numbers[f"{name}: with a flag of accuracy"] = len(row.members) - len(row.counted)
        numbers[f"{name}: beyond a bound without one"] = len(row.silent)
        for field, share, error in zip(acceptance.Errors._fields, row.shares, row.largest, strict=True):
            words = field.replace("_", " ")
            numbers[f"{name}: share within, {words}"] = share
            numbers[f"{name}: largest error, {words}"] = error
        numbers[f"{name}: rms error, restitution"] = row.rms
        listed = others[name]
        errors = np.array([one.errors.restitution for one in listed])
        numbers[f"{name}: answered by myc"] = len(listed)
        numbers[f"{name}: rms error of myc, restitution"] = float(np.sqrt(np.mean(errors**2)))
    return numbers


_OBLIQUE_RADIUS, _OBLIQUE_SPEED, _FRICTION = 2.5e-3, 3.9, 0.092  # [m, m/s, -]
_SLIDING = 28.0  # [deg] angle of incidence from which the bead slides all the time

_ANGLE = Axis("angle of incidence from the normal  [°]").between(0.0, 90.0)
_ALONG = Axis("tangential restitution of the centre  v$_t$' / v$_t$").between(0.5, 1.0)
_COLUMNS = {"tangential restitution": "tangential_restitution", "spin": "spin_rad_per_s"}
_SPIN = Axis("spin after the impact  [rad/s]").between(0.0, 700.0)


def _oblique(angle: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Tangential restitution and spin [rad/s] of the model at angles of incidence [deg]."""
    model = cl.ImpactModel(cl.Pair("alumina", "glass"))
    normal, along = (_OBLIQUE_SPEED * np.cos(np.radians(angle)), _OBLIQUE_SPEED * np.sin(np.radians(angle)))
    hit = model.oblique(normal, along, _OBLIQUE_RADIUS, math.inf, _FRICTION, method="solve")
    restitution = np.asarray(hit.tangential_restitution)
    return restitution, 2.5 * along * (1.0 - restitution) / _OBLIQUE_RADIUS


def _readings(column: str) -> NDArray[np.float64]:
    """Angles [deg], measured values and who read them, shape (3, n)."""
    with (FOLDER / "kharaz-2001.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    names = "angle_deg", column, "source"
    return np.array([[float(r[name]) for name in names] for r in rows if r[column]]).T


def fig26_oblique() -> chart.Drawn:
    """Fig. 26: oblique impacts, measured by Kharaz, Gorham and Salman (2001) and by the model.

    Beads of alumina, 5 mm in diameter, come without spin at 3.9 m/s onto a thick anvil of glass. At
    steep angles of incidence they stick for most of the contact; the elastic contact, stretched
    sideways, throws them back while they turn. From about 28 degrees on they slide all the time,
    and friction takes what Coulomb's law says. Two others have read the points off the paper's
    figures, and they agree within 1 %. The coefficient of friction, 0.092, is the paper's, and
    nothing is fitted. The paper may have got it from the points that slide: those below 28 degrees
    test the model.
    """
    figure, every = chart.sheet(
        (12.0, 5.4),
        "A bead that comes at an angle: sticking at first, sliding beyond",
        "alumina on glass, R = 2.5 mm, 3.9 m/s, friction 0.092, no spin before; nothing is fitted",
        Panel(_ANGLE, _ALONG),
        Panel(_ANGLE, _SPIN),
    )
    numbers = {}
    angle = np.linspace(0.5, 89.5, 179)
    for n, (name, axes, curve) in enumerate(zip(_COLUMNS, every, _oblique(angle), strict=True)):
        at, value, _ = _readings(_COLUMNS[name])
        axes.plot(angle, curve, color=BLUE, linewidth=2.4, label="model")
        axes.plot(at, value, "o", color=INK, markersize=6, markerfacecolor="none", label="measured")
        off = _oblique(at)[n] / value - 1.0
        slides = at > _SLIDING
        for motion, part in (("sticking", ~slides), ("sliding", slides)):
            numbers[f"{name}, {motion}: largest error"] = off[part][np.abs(off[part]).argmax()]
        axes.axvline(_SLIDING, color=INK, linewidth=1.0, linestyle=":")
    chart.note(every[0], _SLIDING + 1.5, 0.52, "slides all the time")
    every[0].legend(loc="lower right")
    return figure, numbers


_OVER_SPEED = Axis("impact speed  [m/s]").between(0.3, 10.0).log(0.5, 1, 2, 5, 10)
_OVER_THICKNESS = Axis("thickness of the plate  [mm]").between(5.0, 100.0).log(5, 10, 20, 50, 100)


def fig27_measured() -> chart.Drawn:
    """Fig. 27: normal CORs that could be read, beside the model, to which none is fitted.

    Alumina on a thick anvil of glass (Kharaz, Gorham and Salman 2001) keeps 98 % of its speed; by the
    model, 98.5 %. The difference, 0.005, is what rounding may have taken from the published number,
    and a little more than a standard error of the model. Such beads stay elastic, so this tests the
    energy that goes into waves, not plastic flow. The source calls the anvil thick and gives no
    number: 2 cm or more agrees with the measurement, and 1 cm does not. Of glass on acrylic the speed
    is not stated (the bar is a factor e), of nylon on aluminium the thickness, and both lack the
    polymer's loss factor: they agree, and hardly could disagree. No measurement over plate thickness
    could be read.
    """
    sources = measured.sources()
    figure, every = chart.sheet(
        (12.0, 1.0 + 4.4 * len(sources)),
        "Measured rebounds agree with the model, as far as their conditions are known",
        "bands and bars are the errors of model and measurement; nothing is fitted",
        *(panel for source in sources for panel in _panels(source)),
        rows=len(sources),
    )
    numbers: dict[str, float] = {}
    for source, left, right in zip(sources, every[::2], every[1::2], strict=True):
        model, found = cl.ImpactModel(source.pair), source.compared()
        cor, error = (np.asarray(one) for one in (found.data.restitution, found.data.restitution_error))
        at = {name: np.asarray(getattr(found.data, name)) for name in ("speed", "radius", "thickness")}
        first = {name: values[0].item() for name, values in at.items()}
        speed, thickness = np.geomspace(0.3, 10.0, 60), np.geomspace(5e-3, 0.1, 120)
        others = {name: size for name, size in source.errors.items() if name != "speed_error"}
        over = ("speed", speed, left, 1.0, others), ("thickness", thickness, right, 1e-3, source.errors)
        for name, x, axes, size, errors in over:
            _, y, low, high = model_curve(model, first | {name: x}, errors)
            draw_curve(axes, Curve(x, y, "model", low, high), BLUE, size, 1.0)
        draw_points(left, Points(at["speed"], cor, "measured", error), ORANGE, 1.0, 1.0)
        if unsure := source.errors.get("speed_error"):
            left.plot(at["speed"] * np.exp([-unsure, unsure]), [cor[0], cor[0]], color=INK)
        least, most = (cor[0] + sign * error[0] for sign in (-1.0, 1.0))
        right.axhspan(least, most, color=ORANGE, alpha=0.5, linewidth=0.0, label="measured, thickness unknown")
        for axes in (left, right):
            axes.legend(loc="lower right")
        numbers |= {
            f"{source.title}: COR": found.restitution[0],
            f"{source.title}: COR, standard error": 0.5 * np.ravel(found.band.high - found.band.low)[0],
            f"{source.title}: COR, model minus measured": found.restitution[0] - cor[0],
            f"{source.title}: share of cases as far off by chance": found.probability,
        }
        rising = np.asarray(model.restitution(first["speed"], first["radius"], thickness))
        if rising[0] < least < rising[-1]:
            thinnest = 1e3 * float(np.interp(least, rising, thickness))
            numbers[f"{source.title}: least thickness within the error, mm"] = thinnest
    return figure, numbers


def _panels(source: Source) -> tuple[Panel, Panel]:
    speed = np.ravel(source.rebounds.speed)[0]
    right = Panel(_OVER_THICKNESS, chart.RESTITUTION, f"at {speed:g} m/s")
    return Panel(_OVER_SPEED, chart.RESTITUTION, source.title), right


_EDGE_RADIUS, _EDGE_THICKNESS, _EDGE_SPEED = 1.2973e-3, 1e-3, 2.0  # [m, m, m/s]: lambda is 0.3
_DISTANCE = Axis("distance from the edge  [mm]").between(0.0, 10.3)
# colour, and place of its name
_KINDS: tuple[tuple[Edge, str, tuple[float, float]], ...] = (
    ("free", VERMILION, (1.45, 0.33)),
    ("supported", GREEN, (1.08, 0.665)),
    ("clamped", BLUE, (2.75, 0.85)),
)
# radius [mm], name and its place
_HOLES = ((1.0, "hole, 1 mm", (0.28, 0.578)), (3.0, "3 mm", (0.28, 0.476)), (10.0, "10 mm", (0.15, 0.338)))
_LEAST = 0.3  # distance from a hole [mm]; nearer ones are of no use


def _edge_elements(kind: Edge) -> np.ndarray:
    """Distances [sqrt(b T_H)] and CORs of the finite elements, for lambda 0.3, shape (2, n)."""
    with FILE.open(encoding="utf-8") as file:
        rows = [
            (float(row["distance"]), float(row["restitution"]))
            for row in csv.DictReader(file)
            if row["edge"] == kind
            and row["law"] == "hertz"
            and row["inelasticity"] == "0.3"
            and row["poissons_ratio"] == ("0.2" if kind == "free" else "0.3")
        ]
    return np.array(rows).T


def fig28_edges() -> chart.Drawn:
    """Fig. 28: how the edge of a plate changes the COR of impacts near it.

    A plate gives way more near a free edge, and less where it is held, so that a bead loses more or
    less. Near a hole the same plate gives way less than at a straight edge, because waves run round
    the hole. The points are finite elements in time of thin plates, which share no code with the
    model. Beyond `edge_distance` none of this matters. In the grey band, nearer than the plate is
    thick, the answers are flagged.
    """
    figure, (axes,) = chart.sheet(
        (11.0, 6.4),
        "Near a free edge a bead loses more to the plate, near a held one next to nothing",
        "elastic bead of glass, 2.6 mm in diameter, on 1 mm of glass at 2 m/s; "
        "lines: model, thin ones at the rims of holes; circles: independent finite elements",
        Panel(_DISTANCE, RESTITUTION.between(0.0, 1.03)),
    )
    model = cl.ImpactModel(cl.Pair("glass", "glass"), law="hertz")
    impact = _EDGE_SPEED, _EDGE_RADIUS, _EDGE_THICKNESS
    endless = model.solve(*impact)
    cor, path = float(endless.restitution), wave_path(model.pair.plate)
    reach = 1e3 * float(cl.edge_distance(model.pair.plate, _EDGE_THICKNESS, endless.contact_time))
    unit = 1e3 * math.sqrt(path * _EDGE_THICKNESS * _hertz_time(model.pair))
    s = np.linspace(0.02, 10.3, 515)
    numbers, off, change = {"COR far from edges": cor}, [], []
    axes.axvspan(0.0, 1e3 * _EDGE_THICKNESS, color=PALE, alpha=0.5, linewidth=0)
    axes.axhline(cor, color=INK, linestyle="--", linewidth=1.2)
    axes.axvline(reach, color=MUTED, linestyle=":")
    for radius, name, place in _HOLES:
        at = s[s >= _LEAST]
        near = model.solve(*impact, edge_distance=1e-3 * at, hole_radius=1e-3 * radius).restitution
        axes.plot(at, near, color=VERMILION, linewidth=1.2)
        chart.note(axes, *place, name, VERMILION, va="center")
        numbers[f"COR 2 mm from a hole of {radius:g} mm"] = np.interp(2.0, at, near)
    for kind, colour, place in _KINDS:
        near = np.asarray(model.solve(*impact, edge=kind, edge_distance=1e-3 * s).restitution)
        at, found = _edge_elements(kind)
        here = model.solve(*impact, edge=kind, edge_distance=1e-3 * unit * at).restitution
        axes.plot(s, near, color=colour, linewidth=2.6)
        axes.plot(unit * at, found, "o", color=colour, markersize=8, markerfacecolor="white", markeredgewidth=1.8)
        axes.text(*place, kind, color=colour, fontsize=14, fontweight="bold", ha="left")
        numbers[f"COR 2 mm from a {kind} edge"] = np.interp(2.0, s, near)
        off.append(np.abs(here - found).max())
        change.append(np.abs(near[s > reach] / cor - 1.0).max())
    numbers["largest difference from the finite elements"] = max(off)
    numbers["largest change of the COR from `edge_distance` on"] = max(change)
    chart.note(axes, 0.5, 0.66, "flagged:\nnearer than\nthe plate\nis thick", MUTED, ha="center")
    chart.note(axes, reach - 0.1, 0.04, "cl.edge_distance", MUTED, ha="right")
    chart.note(axes, 7.0, cor - 0.05, f"far from edges: {cor:.2f}")
    return figure, numbers


def _hertz_time(pair: cl.Pair) -> float:
    """T_H, in which the finite elements count [s]."""
    mass = 4.0 / 3.0 * math.pi * _EDGE_RADIUS**3 * pair.sphere.density
    stiffness = 4.0 / 3.0 * pair.effective_modulus * math.sqrt(_EDGE_RADIUS)
    return float((mass / (stiffness * math.sqrt(_EDGE_SPEED))) ** 0.4)


_SWINGS = Axis(r"contact time times angular frequency of the wall,  $\omega_0 T$").between(0.0, 4.0)
_BENDS = Axis("radius of the wall  [mm]").between(8.0, 1100.0).log(10, 30, 100, 300, 1000)
_CURVED = ("sphere", BLUE, "sphere, or on a foundation"), ("cylinder", GREEN, "cylinder")


def fig31_walls() -> chart.Drawn:
    """Fig. 31: a wall that swings back gives a bead some of its energy back.

    Left, elastic impacts on walls that are curved or lie on a foundation; T is the contact time of
    Hertz's law, the number at a curve the loss to the flat plate. The circles are a convolution in
    time, which has neither the fit nor the equation of the model. Right, one bead inside walls of one
    thickness: from a radius of some 200 mm on they are flat.
    """
    figure, (left, right) = chart.sheet(
        (14.0, 6.2),
        "A wall that is curved, or lies on something, swings back and gives energy back",
        "left: elastic impacts, circles: independent convolution in time; "
        "right: bead of glass, 4 mm in diameter, inside walls of steel of 0.7 mm at 2 m/s",
        Panel(_SWINGS, RESTITUTION.between(0.0, 1.02), "any wall"),
        Panel(_BENDS, RESTITUTION.between(0.0, 1.02), "a steel wall"),
    )
    swings, off = np.linspace(0.0, 4.0, 33), []
    numbers: dict[str, float] = {}
    for lam, place in ((0.1, 0.79), (0.3, 0.54), (0.6, 0.28)):
        for kind, colour, _ in _CURVED:
            none = 0.0 * swings
            one = none + 1.0
            edges = Edges(response_of(kind, 0.3, none), one, swings / CONTACT_TIME, none)
            found = outcome.at(lam * one, math.inf * one)
            zener.solve_all(HERTZ, 1e-10, found, edges=edges)
            exact = np.array([restitution(lam, one / CONTACT_TIME, kind) for one in swings[4::8]])
            left.plot(swings, found.restitution, color=colour, linewidth=2.6)
            left.plot(
                swings[4::8], exact, "o", color=colour, markersize=8, markerfacecolor="white", markeredgewidth=1.8
            )
            off.append(np.abs(found.restitution[4::8] - exact).max())
        chart.note(left, 0.1, place, rf"$\lambda$ = {lam:g}")
    steel, radii = cl.ImpactModel(cl.Pair("glass", "steel-s235")), np.geomspace(8.0, 1100.0, 60)
    for kind, colour, name in _CURVED:
        cor = steel.solve(2.0, 2e-3, cl.Shell(0.7e-3, 1e-3 * radii, kind)).restitution
        right.plot(radii, cor, color=colour, linewidth=2.6, label=name)
        numbers |= {f"COR in a {kind} of {a:g} mm": np.interp(a, radii, cor) for a in (20.0, 100.0)}
    flat = float(steel.solve(2.0, 2e-3, 0.7e-3).restitution)
    right.axhline(flat, color=INK, linestyle="--", linewidth=1.2, label="flat")
    right.legend(loc="upper right")
    return figure, {**numbers, "COR of the flat wall": flat, "largest difference from the convolution": max(off)}
