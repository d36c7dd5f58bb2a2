"""What pictures of the COR over speed show, and that nothing in them lies over something else."""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from matplotlib.figure import Figure

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.cli.cor import curves
from contactlaw.cli.cor.figure import save_restitution

R, INF = 0.9e-3, math.inf


@pytest.fixture
def drawn(monkeypatch):
    """Figures as they would have been saved."""
    kept = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, path: kept.append(figure))
    return kept


def picture(drawn, model, speeds, radii, plates, **options):
    found = curves.restitution_curves(model, speeds, radii, plates, **options)
    save_restitution(found, "gamma-alumina on glass", "cor.png")
    return found, drawn[-1]


def test_curves_are_the_models(model):
    low, high = curves.restitution_curves(model, [20.0, 1.0, 3.0], [R], [INF, 1e-3, 1e-3])
    assert (low.thickness, high.thickness) == (1e-3, INF)
    for curve in (low, high):
        assert (curve.speed[0], curve.speed[-1]) == (1.0, 20.0)
        hit = model.lookup(curve.speed, R, curve.thickness)
        assert np.array_equal(curve.restitution, hit.restitution)
        assert np.array_equal(curve.flags, hit.flags)
        assert curve.yield_speed == model.yield_speed(R, curve.thickness)
        assert curve.at_yield == model.restitution(curve.yield_speed, R, curve.thickness)


def test_curves_can_be_integrated(model):
    (curve,) = curves.restitution_curves(model, [15.0], [R], [1e-3], solve=True)
    assert curve.speed[0] == 1.5
    assert curve.restitution[-1] == model.solve(15.0, R, 1e-3).restitution


def test_a_curve_that_does_not_yield(model):
    (curve,) = curves.restitution_curves(model, [1.0, 7.0], [R], [1e-3])
    assert math.isnan(curve.at_yield)
    elastic = cl.ImpactModel(cl.Pair("glass", "glass"), law="hertz")
    (curve,) = curves.restitution_curves(elastic, [1.0, 7.0], [R], [1e-3])
    assert (curve.yield_speed, math.isnan(curve.at_yield)) == (INF, True)


def test_too_many_curves_are_refused(model):
    nine = [n * 1e-3 for n in range(1, 10)]
    for radii, plates in (([R], nine), (nine, [R]), (nine[:7], nine[:2])):
        with pytest.raises(ValueError, match="too many for one picture"):
            curves.restitution_curves(model, [1.0, 2.0], radii, plates)


def lines(axes, style):
    return [line for line in axes.lines if line.get_linestyle() == style and len(line.get_xdata())]


def test_the_range_with_a_flag_is_dashed_and_first_yield_marked(model, drawn):
    (curve,), figure = picture(drawn, model, [1.0, 100.0], [R], [1e-3])
    (axes,) = figure.axes
    fast = 7.0 * model.pair.yield_speed
    (dashed,) = lines(axes, "--")
    (solid,) = (line for line in lines(axes, "-") if line.get_transform() == axes.transData)
    step = curve.speed[1] / curve.speed[0]
    assert fast < dashed.get_xdata()[0] < fast * step
    assert solid.get_xdata()[-1] == dashed.get_xdata()[0]
    (mark,) = (line for line in axes.lines if line.get_marker() == "v")
    assert mark.get_xydata()[0] == pytest.approx([curve.yield_speed, curve.at_yield])
    shown = " ".join(text.get_text() for text in figure.texts).replace("\n", " ")
    for words in ("0.9 mm", "Triangle: first yield", "Dashed: faster than the impacts"):
        assert words in shown
    assert (axes.get_xlabel(), axes.get_xscale()) == ("impact speed [m/s]", "log")
    assert axes.get_ylabel() == "coefficient of restitution [-]"


@pytest.mark.parametrize(
    ("sizes", "said"),
    [("0.9mm --thickness 0.3mm --speed 60", "Beyond a limit: plate thinner than R/1.8"),
     ("0.9mm --thickness 1mm --speed 5", "Inside every limit")],
)  # fmt: skip
def test_a_history_says_its_limits(drawn, sizes, said, tmp_path):
    picked = f"history --sphere gamma-alumina --plate glass --law myc --radius {sizes} --plot"
    main([*picked.split(), str(tmp_path / "contact.png")])
    assert drawn[0].texts[1].get_text().startswith(said)


def test_oblique_impacts_with_a_flag_are_dashed(drawn, tmp_path):
    bead = "--sphere stainless-steel-304 --plate glass --radius 1mm --thickness 1mm --speed 3"
    asked = f"oblique {bead} --angle 5:85:9 --friction 0.1 --plot"
    main([*asked.split(), str(tmp_path / "oblique.png")])
    (axes,) = drawn[0].axes
    assert "Dashed: friction makes a body flow" in drawn[0].texts[1].get_text().replace("\n", " ")
    model = cl.ImpactModel(cl.Pair("stainless-steel-304", "glass"))
    angle = np.radians(np.linspace(5, 85, 9))
    hit = model.oblique(3 * np.cos(angle), 3 * np.sin(angle), 1e-3, 1e-3, 0.1, method="solve")
    first = 5.0 + 10.0 * np.argmax(hit.flags & cl.Validity.ACCURACY > 0)
    assert [line.get_xdata()[0] for line in lines(axes, "--")] == [first] and first > 5.0
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["friction 0.1"]


def test_the_band_is_shaded_and_explained(pair, drawn, tmp_path):
    asked = "cor --sphere gamma-alumina --plate glass --radius 0.9mm --thickness 1mm --speed 1,20"
    main([*asked.split(), "--sphere-error=yield_strength=20%", "--plot", str(tmp_path / "cor.png")])
    bead = dataclasses.replace(pair.sphere, uncertainty={"yield_strength": 0.2})
    model = cl.ImpactModel(cl.Pair(bead, pair.plate))
    (shaded,) = drawn[0].axes[0].collections
    ends = shaded.get_paths()[0].vertices[:, 1]
    assert ends.min() == pytest.approx(model.uncertainty(20.0, 0.9e-3, 1e-3).restitution.low)
    said = "Shaded: two in three impacts, by the errors that are known, mostly by the yield"
    assert said in " ".join(drawn[0].texts[1].get_text().split())


def test_nothing_is_explained_that_is_not_there(model, drawn):
    _, figure = picture(drawn, model, [1.0, 5.0], [R], [1e-3])
    assert figure.texts[1].get_text() == "Bead radius 0.9 mm"
    assert figure.axes[0].get_xscale() == "linear"
    soft = cl.ImpactModel(cl.Pair("stainless-steel-304", "glass"), law="myc")
    _, figure = picture(drawn, soft, [0.5, 1.0], [R], [1e-3])
    assert "First yield below 0.5 m/s" in figure.texts[1].get_text()


@pytest.mark.parametrize(
    ("radii", "plates", "speeds", "names"),
    [
        ([R], [1e-3], [1.0, 20.0], ["plate 1 mm"]),
        ([R], [0.4e-3, 0.7e-3, 1e-3, 2e-3, INF], [0.1, 150.0],
         ["plate 0.4 mm", "plate 0.7 mm", "plate 1 mm", "plate 2 mm", "half-space"]),
        ([R], [n * 1e-3 for n in range(4, 12)], [1.0, 20.0],  # within 0.003 of each other
         [f"plate {n} mm" for n in range(4, 12)]),
        ([50e-6, 0.3e-3, 0.9e-3], [1e-3], [0.01, 10.0],
         ["radius 50 µm", "radius 0.3 mm", "radius 0.9 mm"]),
        ([0.3e-3, 0.9e-3], [INF], [1e-25, 50.0], ["radius 0.3 mm", "radius 0.9 mm"]),
        ([0.3e-3, 0.9e-3], [1e-3, INF], [1.0, 20.0], ["1 mm", "half-space"] * 2),
        ([n * 0.2e-3 for n in range(1, 6)], [n * 1e-3 for n in range(1, 9)], [0.1, 50.0],
         [f"{n} mm" for n in range(1, 9)] * 5),
    ],
)  # fmt: skip
def test_every_curve_is_named_and_nothing_overlaps(model, drawn, radii, plates, speeds, names):
    _, figure = picture(drawn, model, speeds, radii, plates)
    panels = [axes for axes in figure.axes if axes.get_visible()]
    assert [text.get_text() for axes in panels for text in axes.texts] == names
    texts = [text for axes in panels for text in (*axes.texts, axes.title, axes.xaxis.label)]
    texts += [tick for axes in panels for tick in axes.get_xticklabels()]
    texts += figure.texts
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


@pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
def test_formats(model, tmp_path, suffix):
    found = curves.restitution_curves(model, [1.0, 5.0], [R], [1e-3])
    save_restitution(found, "title", tmp_path / f"cor.{suffix}")
    assert (tmp_path / f"cor.{suffix}").stat().st_size > 1000
    with pytest.raises(ValueError, match=r"path: got 'cor.gif', must end in .png, .svg or .pdf"):
        save_restitution(found, "title", "cor.gif")
