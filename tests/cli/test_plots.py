"""What plots show, and that nothing in them lies over something else."""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from matplotlib.figure import Figure

import contactlaw as cl
from contactlaw.cli.parts.figure import Points, draw_points

R, INF = 0.9e-3, math.inf


@pytest.fixture
def picture(monkeypatch, folder, answer):
    """Give the figure of ``cor --plot`` as it would be saved."""
    drawn = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: drawn.append(figure))

    def saved(impacts, pair="gamma-alumina on glass"):
        sphere, plate = pair.split(" on ")
        answer(f"cor --sphere {sphere} --plate {plate} {impacts} --plot it.png")
        return drawn[-1]

    return saved


def caption(figure):
    return " ".join(figure.texts[1].get_text().split())


@pytest.mark.parametrize(
    ("axis", "ends", "label", "scale"),
    [
        ("speed", "1:20:9", "impact speed [m/s]", 1.0),
        ("thickness", "0.5mm,4mm", "plate thickness [mm]", 1e3),
        ("radius", "60um,90um", "bead radius [µm]", 1e6),
    ],
)
def test_curves_are_the_models_over_any_list(axis, ends, label, scale, picture):
    sizes = {"speed": "2", "thickness": "1mm", "radius": "0.9mm"} | {axis: ends}
    impacts = " ".join(f"--{name} {size}" for name, size in sizes.items())
    (axes,) = picture(f"{impacts} --no-band --law myc --solve").axes
    assert axes.get_xlabel() == label
    x, e = np.concatenate([line.get_xydata() for line in axes.lines if len(line.get_xdata()) > 1]).T
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    impact = {"speed": 2.0, "thickness": 1e-3, "radius": R} | {axis: x / scale}
    shown = np.isfinite(e)  # points beyond a limit are those of a dashed line
    assert e[shown] == pytest.approx(np.asarray(model.solve(**impact).restitution)[shown], abs=1e-9)
    assert shown.sum() >= 200 and (x.min(), x.max()) == pytest.approx(axes.get_xlim())


def test_a_name_is_no_formula(answer, folder):
    bead = "'E=2GPa nu=0.3 rho=1000 kind=ceramic name=$\\foo{$'"
    answer(f"cor --sphere {bead} --plate glass --radius 1mm --thickness 1mm --speed 1 --no-band --plot it.svg")


def test_limits_are_dashed(picture):
    figure = picture(f"--radius {R} --thickness 0.3mm,1mm --speed 1,100 --law myc --no-band")
    (axes,) = figure.axes
    fast = 7.0 * cl.Pair("gamma-alumina", "glass").yield_speed
    parts = [line.get_xydata() for line in axes.lines if len(line.get_xdata()) > 1]
    dashed, thin, swift, clear = (part[np.isfinite(part[:, 1]), 0] for part in parts)
    for below in (dashed, swift):  # the whole curve, over which the part inside all limits is drawn
        assert below[[0, -1]] == pytest.approx([1.0, 100.0])
    assert thin.size == 0 and clear[0] == pytest.approx(1.0)
    assert clear[-1] <= fast <= clear[-1] * 100.0 ** (1 / 199)
    # of the thin plate nothing is inside all limits: its name in the legend stands beside dashes, too
    assert [line.is_dashed() for line in axes.lines] == [True, True, True, False]
    assert "radius 0.9 mm. Dashed: plate thinner than" in caption(figure)
    assert "; or faster than the impacts" in caption(figure)
    assert axes.get_xscale() == "log" and axes.get_ylabel() == "coefficient of restitution [-]"


@pytest.mark.parametrize(("flags", "face"), [([1, 1], "white"), ([1, 0], "red"), (0, "red")])
def test_the_legend_has_hollow_points_if_all_are(flags, face):
    axes = Figure().subplots()
    beyond = np.asarray(flags) * cl.Validity.THIN_PLATE
    draw_points(axes, Points(np.ones(2), np.ones(2), "measured", flags=beyond), "red", 1.0, 1.0)
    (handle,), (label,) = axes.get_legend_handles_labels()
    assert (handle.get_markerfacecolor(), label) == (face, "measured")


def test_a_history_is_the_force_over_time(picture):
    figure = picture(f"--history --law myc --radius {R} --thickness 0.3mm --speed 60 --samples 50")
    (axes,) = figure.axes
    contact = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc").force_history(60.0, R, 0.3e-3, 50, "solve")
    time, force = axes.lines[0].get_xydata().T
    assert (time, force) == (pytest.approx(1e6 * contact.time), pytest.approx(contact.force))
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time since touch [µs]", "contact force [N]")
    assert "Dashed: plate thinner than R/1.8" in caption(figure)


def test_oblique_impacts_over_the_angle(picture):
    sizes = "--radius 1mm --thickness 1mm --speed 3 --angle 0,85 --friction 0.1,0.2"
    figure = picture(sizes, "stainless-steel-304 on glass")
    (axes,) = figure.axes
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["friction 0.1", "friction 0.2"]
    assert axes.get_ylabel() == "tangential restitution [-]"
    assert "friction makes a body flow" in caption(figure)
    model = cl.ImpactModel(cl.Pair("stainless-steel-304", "glass"))
    speed, sliding = 3 * np.cos(np.radians(40)), 3 * np.sin(np.radians(40))
    hit = model.oblique(speed, sliding, 1e-3, 1e-3, [0.1, 0.2], method="solve")
    # whole curves are dashed, under the parts inside all limits
    curves = [line.get_xydata().T for line in axes.lines if line.is_dashed()]
    values = [np.interp(40.0, x[np.isfinite(y)], y[np.isfinite(y)]) for x, y in curves]
    assert values == pytest.approx(hit.tangential_restitution.tolist(), abs=1e-3)


def test_the_band_is_shaded_and_explained(pair, picture):
    figure = picture("--radius 0.9mm --thickness 1mm --speed 1,20 --sphere-error=yield_strength=20%")
    bead = dataclasses.replace(pair.sphere, uncertainty={"yield_strength": 0.2})
    model = cl.ImpactModel(cl.Pair(bead, pair.plate))
    (shaded,) = figure.axes[0].collections
    ends = shaded.get_paths()[0].vertices[:, 1]
    assert ends.min() == pytest.approx(model.uncertainty(20.0, 0.9e-3, 1e-3).restitution.low)
    assert "radius 0.9 mm. Shaded: two in three real impacts lie here" in caption(figure)
    figure = picture(f"--radius {R} --thickness 1mm --speed 1,5 --law myc --no-band")  # with nothing to explain
    assert caption(figure) == "gamma-alumina on glass, law myc, thickness 1 mm, radius 0.9 mm"
    assert figure.axes[0].get_xscale() == "linear"


@pytest.mark.parametrize(
    ("impacts", "names"),
    [
        ("--radius 0.9mm --thickness 1mm --speed 1,20", []),
        ("--radius 0.9mm --thickness 1mm:9mm:9 --speed 1,2,50", ["speed 1 m/s", "speed 2 m/s", "speed 50 m/s"]),
        (
            "--radius 0.9mm --thickness 0.4mm,0.7mm,1mm,2mm,inf --speed 0.1,150",
            [*(f"thickness {size} mm" for size in (0.4, 0.7, 1, 2)), "half-space"],
        ),
        ("--radius 0.9mm --thickness 4mm:11mm:8 --speed 1,20", [f"thickness {n} mm" for n in range(4, 12)]),
        (
            "--radius 50um,0.3mm,0.9mm --thickness 1mm --speed 0.01,10",
            ["radius 50 µm", "radius 0.3 mm", "radius 0.9 mm"],
        ),
        ("--radius 0.3mm,0.9mm --thickness inf --speed 1e-25,50", ["radius 0.3 mm", "radius 0.9 mm"]),
    ],
)
def test_every_curve_is_named_and_nothing_overlaps(impacts, names, picture):
    figure = picture(f"{impacts} --law myc --no-band --outside solve")
    (axes,) = figure.axes
    legends = [*filter(None, [axes.get_legend()]), *figure.legends]
    labels = [text for legend in legends for text in legend.get_texts()]
    assert [text.get_text() for text in labels] == names
    left, right = axes.get_xlim()
    ticks = [tick for tick in axes.get_xticklabels() if left <= tick.get_position()[0] <= right]  # others are not drawn
    texts = [axes.xaxis.label, *ticks, *labels, *figure.texts]
    figure.draw_without_rendering()
    boxes = [(text.get_text(), text.get_window_extent()) for text in texts if text.get_text()]
    # the line of a text reaches 2 pixels beyond its letters
    for (name, box), (its_name, its_box) in itertools.combinations(boxes, 2):
        assert not box.padded(-1.5).overlaps(its_box.padded(-1.5)), (name, its_name)
    for name, box in boxes:
        assert 0 <= box.x0 and box.x1 <= figure.bbox.x1, name
        assert 0 <= box.y0 and box.y1 <= figure.bbox.y1, name


@pytest.mark.parametrize(("name", "begins"), [("cor.png", b"\x89PNG"), ("cor.svg", b"<?xml"), ("cor.PDF", b"%PDF")])
def test_formats(name, begins, folder, answer):
    bead = "cor --sphere gamma-alumina --plate glass --radius 0.9mm --thickness 1mm:2mm:9 --speed 1,5 --no-band"
    assert answer(f"{bead} --plot {name}").out == f"{name}\n"
    assert (folder / name).read_bytes().startswith(begins)
    assert [path.name for path in folder.iterdir()] == [name]
