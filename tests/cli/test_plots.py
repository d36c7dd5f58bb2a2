"""What plots show, and that nothing in them lies over something else."""

import dataclasses
import itertools
import math
import os
from errno import ENOSPC

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.cli.parts.figure import Points, draw_points

R, INF = 0.9e-3, math.inf


@pytest.fixture
def drawn(monkeypatch):
    """Figures as they would have been saved."""
    kept = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: kept.append(figure))
    return kept


def picture(drawn, tmp_path, asked, pair="gamma-alumina on glass"):
    sphere, plate = pair.split(" on ")
    words = f"cor --sphere {sphere} --plate {plate} {asked} --plot {tmp_path}/it.png"
    assert main(words.split()) == 0
    return drawn[-1]


def caption(figure):
    return " ".join(figure.texts[1].get_text().split())


def test_a_full_disk_leaves_the_picture_that_was_there(tmp_path, monkeypatch, capsys):
    def full(*_):
        raise OSError(ENOSPC, os.strerror(ENOSPC))

    (tmp_path / "it.png").write_text("before")
    monkeypatch.setattr(os, "fsync", full)
    words = "--sphere gamma-alumina --plate glass --law myc --radius 1mm --thickness 1mm --speed 1"
    assert main(["cor", *words.split(), "--plot", f"{tmp_path}/it.png"]) == 1
    assert f"--plot: cannot write {tmp_path}/it.png: No space left" in capsys.readouterr().err
    assert (tmp_path / "it.png").read_text() == "before"


@pytest.mark.parametrize("axis", ["speed", "thickness", "radius"])
def test_curves_are_the_models_over_any_list(axis, drawn, tmp_path):
    ends, label, scale = {
        "speed": ("1:20:9", "impact speed [m/s]", 1.0),
        "thickness": ("0.5mm,4mm", "plate thickness [mm]", 1e3),
        "radius": ("60um,90um", "bead radius [µm]", 1e6),
    }[axis]
    sizes = {"speed": "2", "thickness": "1mm", "radius": "0.9mm"} | {axis: ends}
    asked = " ".join(f"--{name} {size}" for name, size in sizes.items())
    (axes,) = picture(drawn, tmp_path, f"{asked} --no-band --law myc --solve").axes
    assert axes.get_xlabel() == label
    x, e = np.concatenate([line.get_xydata() for line in axes.lines if len(line.get_xdata()) > 1]).T
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    impact = {"speed": 2.0, "thickness": 1e-3, "radius": R} | {axis: x / scale}
    shown = np.isfinite(e)  # points beyond a limit are those of a dashed line
    assert e[shown] == pytest.approx(np.asarray(model.solve(**impact).restitution)[shown], abs=1e-9)
    assert shown.sum() >= 200 and (x.min(), x.max()) == pytest.approx(axes.get_xlim())


def test_the_half_space_is_a_thin_line_over_thickness(drawn, tmp_path):
    figure = picture(drawn, tmp_path, f"--radius {R} --thickness 1mm,9mm,inf --speed 30 --no-band")
    curve, thin = figure.axes[0].lines[0], figure.axes[0].lines[-1]
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    assert curve.get_linewidth() > 2.0 * thin.get_linewidth()
    assert thin.get_ydata() == pytest.approx([model.restitution(30.0, R, INF)] * 2, abs=1e-12)
    assert "Thin line: half-space" in caption(figure)


def test_without_a_list_the_axis_has_the_speeds_up_to_the_one_stated(drawn, tmp_path):
    (axes,) = picture(drawn, tmp_path, f"--radius {R} --thickness 1mm --speed 5 --no-band").axes
    assert axes.get_xlim() == pytest.approx((0.5, 5.0)) and not axes.get_legend()


@pytest.mark.parametrize("lists", ["--thickness inf,inf --speed 2", "--thickness 1mm,2mm --speed 2,2"])
def test_a_list_of_equal_values_is_one_value(lists, drawn, tmp_path):
    figure = picture(drawn, tmp_path, f"--radius 0.9mm --no-band {lists}")
    assert len(figure.axes[0].lines) == 2 and ("half-space" in caption(figure)) == ("inf" in lists)


def test_a_name_is_no_formula(tmp_path, capsys):
    bead = "E=2GPa nu=0.3 rho=1000 kind=ceramic name=$\\foo{$"
    words = "--plate glass --radius 1mm --thickness 1mm --speed 1 --no-band --plot".split()
    assert main(["cor", "--sphere", bead, *words, f"{tmp_path}/it.svg"]) == 0


def test_limits_are_dashed(drawn, tmp_path):
    asked = f"--radius {R} --thickness 0.3mm,1mm --speed 1,100 --law myc --no-band"
    figure = picture(drawn, tmp_path, asked)
    (axes,) = figure.axes
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    fast = 7.0 * model.pair.yield_speed
    parts = [line.get_xydata() for line in axes.lines if len(line.get_xdata()) > 1]
    dashed, thin, swift, clear = (part[np.isfinite(part[:, 1]), 0] for part in parts)
    for below in (dashed, swift):  # the whole curve, over which the part inside all limits is drawn
        assert below[[0, -1]] == pytest.approx([1.0, 100.0])
    assert thin.size == 0 and clear[0] == pytest.approx(1.0)
    assert clear[-1] <= fast <= clear[-1] * 100.0 ** (1 / 199)
    assert [line.is_dashed() for line in axes.lines] == [True, False] * 2
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["thickness 0.3 mm", "thickness 1 mm"]
    said = caption(figure)
    assert "radius 0.9 mm. Dashed: plate thinner than" in said
    assert "; or faster than the impacts" in said
    assert axes.get_xscale() == "log" and axes.get_ylabel() == "coefficient of restitution [-]"


def test_points_beyond_a_limit_are_hollow():
    figure = Figure()
    axes = figure.subplots()
    flags = np.array([0, cl.Validity.THIN_PLATE])
    draw_points(
        axes, Points(np.array([1.0, 2.0]), np.array([0.5, 0.5]), "measured", np.array([0.1, 0.1]), flags), "blue", 1, 1
    )
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())
    for x, colour in ((1.0, [0, 0, 255, 255]), (2.0, [255, 255, 255, 255])):
        column, row = axes.transData.transform((x, 0.5)).round().astype(int)
        assert pixels[len(pixels) - row, column].tolist() == colour


def test_a_history_is_the_force_over_time(drawn, tmp_path):
    asked = f"--history --law myc --radius {R} --thickness 0.3mm --speed 60 --samples 50"
    figure = picture(drawn, tmp_path, asked)
    (axes,) = figure.axes
    contact = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc").force_history(60.0, R, 0.3e-3, 50, "solve")
    time, force = axes.lines[0].get_xydata().T
    assert (time, force) == (pytest.approx(1e6 * contact.time), pytest.approx(contact.force))
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time since touch [µs]", "contact force [N]")
    assert "Dashed: plate thinner than R/1.8" in caption(figure)


@pytest.mark.parametrize("axis", ["angle", "thickness"])
def test_oblique_impacts_over_angle_and_sizes(axis, drawn, tmp_path):
    ends, at = {"angle": ("0,85", 40.0), "thickness": ("0.5mm,8mm", 2.0)}[axis]
    sizes = {"radius": "1mm", "thickness": "1mm", "speed": "3", "angle": "40"} | {axis: ends}
    asked = " ".join(f"--{name} {size}" for name, size in sizes.items())
    figure = picture(drawn, tmp_path, f"{asked} --friction 0.1,0.2", "stainless-steel-304 on glass")
    (axes,) = figure.axes
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["friction 0.1", "friction 0.2"]
    assert axes.get_ylabel() == "tangential restitution [-]"
    assert "friction makes a body flow" in caption(figure)
    model = cl.ImpactModel(cl.Pair("stainless-steel-304", "glass"))
    h = at * 1e-3 if axis == "thickness" else 1e-3
    speed, sliding = 3 * np.cos(np.radians(40)), 3 * np.sin(np.radians(40))
    for mu, colour in ((0.1, axes.lines[0].get_color()), (0.2, axes.lines[-1].get_color())):
        hit = model.oblique(speed, sliding, 1e-3, h, mu, method="solve")
        lines = [line.get_xydata() for line in axes.lines if line.get_color() == colour]
        x, value = np.concatenate([part[np.isfinite(part[:, 1])] for part in lines if len(part) > 1]).T
        order = np.argsort(x, kind="stable")
        assert np.interp(at, x[order], value[order]) == pytest.approx(hit.tangential_restitution, abs=1e-3)


def test_the_band_is_shaded_and_explained(pair, drawn, tmp_path):
    asked = "--radius 0.9mm --thickness 1mm --speed 1,20 --sphere-error=yield_strength=20%"
    figure = picture(drawn, tmp_path, asked)
    bead = dataclasses.replace(pair.sphere, uncertainty={"yield_strength": 0.2})
    model = cl.ImpactModel(cl.Pair(bead, pair.plate))
    (shaded,) = figure.axes[0].collections
    ends = shaded.get_paths()[0].vertices[:, 1]
    assert ends.min() == pytest.approx(model.uncertainty(20.0, 0.9e-3, 1e-3).restitution.low)
    assert "radius 0.9 mm. Shaded: two in three real impacts lie here" in caption(figure)


def test_nothing_is_explained_that_is_not_there(drawn, tmp_path):
    figure = picture(drawn, tmp_path, f"--radius {R} --thickness 1mm --speed 1,5 --law myc --no-band")
    assert caption(figure) == "gamma-alumina on glass, law myc, thickness 1 mm, radius 0.9 mm"
    assert figure.axes[0].get_xscale() == "linear" and not figure.axes[0].get_legend()


@pytest.mark.parametrize(
    ("radii", "plates", "speeds", "names"),
    [
        ([R], [1e-3], [1.0, 20.0], []),
        ([R], [n * 1e-3 for n in range(1, 10)], [1.0, 2.0, 50.0], ["speed 1 m/s", "speed 2 m/s", "speed 50 m/s"]),
        (
            [R],
            [0.4e-3, 0.7e-3, 1e-3, 2e-3, INF],
            [0.1, 150.0],
            ["thickness 0.4 mm", "thickness 0.7 mm", "thickness 1 mm", "thickness 2 mm", "half-space"],
        ),
        ([R], [n * 1e-3 for n in range(4, 12)], [1.0, 20.0], [f"thickness {n} mm" for n in range(4, 12)]),
        ([50e-6, 0.3e-3, 0.9e-3], [1e-3], [0.01, 10.0], ["radius 50 µm", "radius 0.3 mm", "radius 0.9 mm"]),
        ([0.3e-3, 0.9e-3], [INF], [1e-25, 50.0], ["radius 0.3 mm", "radius 0.9 mm"]),
    ],
)
def test_every_curve_is_named_and_nothing_overlaps(drawn, tmp_path, radii, plates, speeds, names):
    sizes = zip(("radius", "thickness", "speed"), (radii, plates, speeds), strict=True)
    asked = " ".join(f"--{name} {','.join(map(str, listed))}" for name, listed in sizes)
    figure = picture(drawn, tmp_path, f"{asked} --law myc --no-band --outside solve")
    (axes,) = figure.axes
    legends = [*filter(None, [axes.get_legend()]), *figure.legends]
    labels = [text for legend in legends for text in legend.get_texts()]
    assert [text.get_text() for text in labels] == names
    ticks = [
        tick
        for tick in axes.get_xticklabels()
        if axes.viewLim.x0 <= tick.get_position()[0] <= axes.viewLim.x1  # others are not drawn
    ]
    texts = [axes.xaxis.label, *ticks, *labels, *figure.texts]
    figure.draw_without_rendering()
    boxes = {text: text.get_window_extent() for text in texts if text.get_text()}
    for one, other in itertools.combinations(boxes, 2):
        x, y = (
            min(getattr(boxes[one], high), getattr(boxes[other], high))
            - max(getattr(boxes[one], low), getattr(boxes[other], low))
            for low, high in (("x0", "x1"), ("y0", "y1"))
        )
        assert min(x, y) < 3.0, (one, other)  # the line of a text reaches 2 pixels beyond its letters
    for text, box in boxes.items():
        assert 0 <= box.x0 and box.x1 <= figure.bbox.x1, text
        assert 0 <= box.y0 and box.y1 <= figure.bbox.y1, text


@pytest.mark.parametrize(("suffix", "begins"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("PDF", b"%PDF")])
def test_formats(suffix, begins, tmp_path, capsys):
    path = tmp_path / f"cor.{suffix}"
    bead = "cor --sphere gamma-alumina --plate glass --radius 0.9mm --thickness 1mm:2mm:9 --speed 1,5 --no-band"
    assert main([*bead.split(), "--plot", str(path)]) == 0
    assert capsys.readouterr().out == f"{path}\n"
    assert path.read_bytes().startswith(begins)
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
