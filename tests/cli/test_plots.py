"""What pictures of the COR show, and that nothing in them lies over something else."""

import dataclasses
import itertools
import math
import os
from errno import ENOSPC

import numpy as np
import pytest
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure

import contactlaw as cl
from contactlaw.cli import main

R, INF = 0.9e-3, math.inf


@pytest.fixture
def drawn(monkeypatch):
    """Figures as they would have been saved."""
    kept = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: kept.append(figure))
    return kept


def picture(drawn, tmp_path, asked, pair="gamma-alumina on glass", command="cor"):
    sphere, plate = pair.split(" on ")
    words = f"{command} --sphere {sphere} --plate {plate} {asked} --plot {tmp_path}/it.png"
    assert main(words.split()) == 0
    return drawn[-1]


def caption(figure):
    return " ".join(figure.texts[1].get_text().split())


@pytest.mark.parametrize("command", ["cor", "history"])
def test_a_full_disk_leaves_the_picture_that_was_there(command, tmp_path, monkeypatch, capsys):
    def full(*_):
        raise OSError(ENOSPC, os.strerror(ENOSPC))

    (tmp_path / "it.png").write_text("before")
    monkeypatch.setattr(os, "fsync", full)
    words = "--sphere gamma-alumina --plate glass --law myc --radius 1mm --thickness 1mm --speed 1"
    assert main([command, *words.split(), "--plot", f"{tmp_path}/it.png"]) == 1
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
    assert e == pytest.approx(model.solve(**impact).restitution, abs=1e-9)
    assert len(x) >= 400 and (x.min(), x.max()) == pytest.approx(axes.get_xlim())


def test_the_half_space_is_a_thin_line_over_thickness(drawn, tmp_path):
    figure = picture(drawn, tmp_path, f"--radius {R} --thickness 1mm,9mm,inf --speed 30 --no-band")
    curve, thin = figure.axes[0].lines[0], figure.axes[0].lines[-1]
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    assert curve.get_linewidth() > 2.0 * thin.get_linewidth()
    assert thin.get_ydata() == pytest.approx(model.restitution(30.0, R, INF), abs=1e-12)
    assert "Thin line: half-space" in caption(figure)


def test_two_long_lists_are_a_map(drawn, tmp_path):
    asked = f"--radius {R} --thickness 0.4mm:4mm:9 --speed 0.5:90:9"
    figure = picture(drawn, tmp_path, asked)
    axes, bar = figure.axes
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    contours = [part for part in axes.collections if isinstance(part, QuadContourSet)]
    filled, *hatched, at_yield, lines = contours
    for level, paths in zip(lines.levels, lines.get_paths(), strict=True):
        speed, thickness = paths.vertices.T
        e = model.restitution(speed, R, thickness * 1e-3)
        assert e == pytest.approx(level, abs=2e-3)
    named = {float(text.get_text()) for text in axes.texts}
    assert named <= set(lines.levels.round(9)) == set(bar.get_yticks().round(9)) and len(named) > 4
    speed, thickness = at_yield.get_paths()[0].vertices.T
    assert speed == pytest.approx(model.yield_speed(R, thickness * 1e-3), rel=0.01)
    (fast,) = hatched
    flagged = model.lookup([40.0, 55.0], R, 1e-3).flags & cl.Validity.FAST_IMPACT > 0
    assert fast.hatches == ["///"] and flagged.tolist() == [False, True]
    assert fast.get_paths()[0].contains_points([(40.0, 1.0), (55.0, 1.0)]).tolist() == [False, True]
    assert axes.get_ylabel() == "plate thickness [mm]"
    assert "two of three impacts" in caption(figure)


def test_a_map_of_one_value(drawn, tmp_path):
    asked = "--radius 1mm:2mm:9 --thickness inf --speed 1:2:9 --law hertz --no-band"
    figure = picture(drawn, tmp_path, asked)
    assert caption(figure).endswith("half-space. Nothing yields")
    assert [text.get_text() for text in figure.axes[1].get_yticklabels()] == ["1"]


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (
            "--radius 1mm:2mm:9 --thickness 1mm:9mm:9 --speed 1,2",
            "--speed, --thickness, --radius: got 2, 9, 9 values, too many for one picture: give one",
        ),
        ("--radius 1mm:2mm:7 --thickness 1mm,2mm --speed 1,2", "got 2, 2, 7 values, too many"),
        (
            "--radius 1mm --thickness 1mm:9mm:9,inf --speed 1:2:9",
            "--thickness: got inf; no axis of a map reaches it: leave it out",
        ),
    ],
)
def test_what_no_picture_shows_is_refused(asked, said, tmp_path, capsys):
    path = tmp_path / "cor.svg"
    body = ["cor", "--sphere=gamma-alumina", "--plate=glass", f"--plot={path}"]
    assert main([*body, *asked.split()]) == 1
    assert said in capsys.readouterr().err and not path.exists()


def test_kinds_of_flags_are_told_apart_and_the_yield_point_marked(drawn, tmp_path):
    asked = f"--radius {R} --thickness 0.3mm,1mm --speed 1,100 --law myc --no-band"
    figure = picture(drawn, tmp_path, asked)
    (axes,) = figure.axes
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    fast, step = 7.0 * model.pair.yield_speed, 100.0 ** (1 / 399)
    curved = [line for line in axes.lines if line.get_transform() == axes.transData]
    parts = [line for line in curved if line.get_marker() != "v"]
    thin, both, clear, swift = (line.get_xdata() for line in parts)
    assert thin[0] == clear[0] == 1.0 and thin[-1] == both[0] and clear[-1] == swift[0]
    for beyond in (both, swift):
        assert fast < beyond[0] < fast * step
    keys = figure.legends[0]
    words = [text.get_text() for text in keys.get_texts()]
    assert [text.split()[0] for text in words] == ["plate", "faster"]
    of_thin, of_fast = (key._unscaled_dash_pattern[1] for key in keys.legend_handles)
    patterns = [line._unscaled_dash_pattern[1] for line in parts]
    assert patterns == [of_thin, [*of_thin, *of_fast], None, of_fast]
    marks = [line.get_xydata()[0] for line in axes.lines if line.get_marker() == "v"]
    for mark, thickness in zip(marks, (0.3e-3, 1e-3), strict=True):
        v = model.yield_speed(R, thickness)
        assert mark == pytest.approx([v, model.restitution(v, R, thickness)], rel=1e-3)
    assert "radius 0.9 mm. Triangle: yield point" in caption(figure)
    assert axes.get_xscale() == "log" and axes.get_ylabel() == "coefficient of restitution [-]"


@pytest.mark.parametrize(
    ("sizes", "said"),
    [
        ("0.9mm --thickness 0.3mm --speed 60", "Beyond a limit: plate thinner than R/1.8"),
        ("0.9mm --thickness 1mm --speed 5", "Inside every limit"),
    ],
)
def test_a_history_says_its_limits(drawn, sizes, said, tmp_path):
    picked = f"history --sphere gamma-alumina --plate glass --law myc --radius {sizes} --plot"
    main([*picked.split(), str(tmp_path / "contact.png")])
    assert drawn[0].texts[1].get_text().startswith(said)


@pytest.mark.parametrize("axis", ["angle", "thickness"])
def test_oblique_impacts_over_angle_and_sizes(axis, drawn, tmp_path):
    ends, at = {"angle": ("5,85", 40.0), "thickness": ("0.5mm,8mm", 2.0)}[axis]
    sizes = {"radius": "1mm", "thickness": "1mm", "speed": "3", "angle": "40"} | {axis: ends}
    asked = " ".join(f"--{name} {size}" for name, size in sizes.items())
    pair = "stainless-steel-304 on glass"
    figure = picture(drawn, tmp_path, f"{asked} --friction 0.1,0.2", pair, "oblique")
    (axes,) = figure.axes
    assert [text.get_text() for text in axes.texts] == ["friction 0.1", "friction 0.2"]
    assert "friction makes a body flow" in figure.legends[0].get_texts()[0].get_text()
    model = cl.ImpactModel(cl.Pair("stainless-steel-304", "glass"))
    h = at * 1e-3 if axis == "thickness" else 1e-3
    speed, sliding = 3 * np.cos(np.radians(40)), 3 * np.sin(np.radians(40))
    for mu, colour in ((0.1, axes.lines[0].get_color()), (0.2, axes.lines[-1].get_color())):
        hit = model.oblique(speed, sliding, 1e-3, h, mu, method="solve")
        points = [line.get_xydata() for line in axes.lines if line.get_color() == colour]
        x, value = np.concatenate([part for part in points if len(part) > 1 and part[0, 0] != 1]).T
        order = np.argsort(x, kind="stable")
        shown = np.interp(at, x[order], value[order])
        assert shown == pytest.approx(hit.tangential_restitution, abs=1e-3)


def test_the_band_is_shaded_and_explained(pair, drawn, tmp_path):
    asked = "--radius 0.9mm --thickness 1mm --speed 1,20 --sphere-error=yield_strength=20%"
    figure = picture(drawn, tmp_path, asked)
    bead = dataclasses.replace(pair.sphere, uncertainty={"yield_strength": 0.2})
    model = cl.ImpactModel(cl.Pair(bead, pair.plate))
    (shaded,) = figure.axes[0].collections
    ends = shaded.get_paths()[0].vertices[:, 1]
    assert ends.min() == pytest.approx(model.uncertainty(20.0, 0.9e-3, 1e-3).restitution.low)
    said = "Shaded: two of three impacts, as far as errors are known, mostly by the yield"
    assert said in caption(figure)


def test_nothing_is_explained_that_is_not_there(drawn, tmp_path):
    figure = picture(drawn, tmp_path, f"--radius {R} --thickness 1mm --speed 1,5 --law myc --no-band")
    assert caption(figure) == "gamma-alumina on glass, law myc, plate 1 mm, radius 0.9 mm. Nothing yields"
    assert figure.axes[0].get_xscale() == "linear" and not figure.legends
    asked = f"--radius {R} --thickness 1mm --speed 0.5,1 --no-band"
    figure = picture(drawn, tmp_path, asked, "stainless-steel-304 on glass")
    assert caption(figure).endswith("A body yields everywhere")


@pytest.mark.parametrize(
    ("radii", "plates", "speeds", "names"),
    [
        ([R], [1e-3], [1.0, 20.0], []),
        ([R], [n * 1e-3 for n in range(1, 10)], [1.0, 2.0, 50.0], ["1 m/s", "2 m/s", "50 m/s"]),
        ([R], [n * 1e-4 for n in range(3, 99)], np.geomspace(0.01, 99, 9), None),
        (
            [R],
            [0.4e-3, 0.7e-3, 1e-3, 2e-3, INF],
            [0.1, 150.0],
            ["plate 0.4 mm", "plate 0.7 mm", "plate 1 mm", "plate 2 mm", "half-space"],
        ),
        (
            [R],
            [n * 1e-3 for n in range(4, 12)],
            [1.0, 20.0],  # within 0.003 of each other
            [f"plate {n} mm" for n in range(4, 12)],
        ),
        ([50e-6, 0.3e-3, 0.9e-3], [1e-3], [0.01, 10.0], ["radius 50 µm", "radius 0.3 mm", "radius 0.9 mm"]),
        ([0.3e-3, 0.9e-3], [INF], [1e-25, 50.0], ["radius 0.3 mm", "radius 0.9 mm"]),
        ([0.3e-3, 0.9e-3], [1e-3, INF], [1.0, 20.0], ["plate 1 mm", "half-space"] * 2),
        (
            [n * 0.2e-3 for n in range(1, 6)],
            [n * 1e-3 for n in range(1, 9)],
            [0.1, 50.0],
            [f"plate {n} mm" for n in range(1, 9)] * 5,
        ),
    ],
)
def test_every_curve_is_named_and_nothing_overlaps(drawn, tmp_path, radii, plates, speeds, names):
    sizes = zip(("radius", "thickness", "speed"), (radii, plates, speeds), strict=True)
    asked = " ".join(f"--{name} {','.join(map(str, listed))}" for name, listed in sizes)
    figure = picture(drawn, tmp_path, f"{asked} --law myc --no-band --outside solve")
    panels = [axes for axes in figure.axes if axes.get_visible()]
    labels = [text for axes in panels for text in axes.texts if names is not None]
    assert names is None or [text.get_text() for text in labels] == names
    texts = [text for axes in panels for text in (axes.title, axes.xaxis.label)]
    texts += [
        tick
        for axes in panels
        for tick in axes.get_xticklabels()
        if axes.viewLim.x0 <= tick.get_position()[0] <= axes.viewLim.x1  # others are not drawn
    ]
    texts += [*labels, *figure.texts, *(text for keys in figure.legends for text in keys.get_texts())]
    figure.draw_without_rendering()
    boxes = {text: text.get_window_extent() for text in texts if text.get_text()}
    for one, other in itertools.combinations(boxes, 2):
        x, y = (
            min(getattr(boxes[one], high), getattr(boxes[other], high))
            - max(getattr(boxes[one], low), getattr(boxes[other], low))
            for low, high in (("x0", "x1"), ("y0", "y1"))
        )
        # the line of a text reaches 2 pixels beyond its letters
        assert min(x, y) < 3.0, (one, other)
    for text, box in boxes.items():
        assert 0 <= box.x0 and box.x1 <= figure.bbox.x1, text
        assert 0 <= box.y0 and box.y1 <= figure.bbox.y1, text


@pytest.mark.parametrize(("suffix", "begins"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("PDF", b"%PDF")])
@pytest.mark.parametrize("speeds", ["1,5", "1:60:9"])
def test_formats(suffix, begins, speeds, tmp_path, capsys):
    path = tmp_path / f"cor.{suffix}"
    bead = "cor --sphere gamma-alumina --plate glass --radius 0.9mm --thickness 1mm:2mm:9 --no-band"
    assert main([*bead.split(), "--speed", speeds, "--plot", str(path)]) == 0
    assert capsys.readouterr().out == f"{path}\n"
    assert path.read_bytes().startswith(begins)
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


def test_panels_have_labels_below_the_lowest_alone(drawn, tmp_path):
    asked = "--radius 1mm --thickness 3mm,inf --speed 2 --angle 30,60 --friction 0.05:0.5:4"
    axes = picture(drawn, tmp_path, asked, command="oblique").axes
    assert [bool(one.get_xlabel()) for one in axes] == [False, False, True, True]
