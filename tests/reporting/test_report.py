"""Reports of small runs in pymunk and LAMMPS, each number against the record or another reader."""

import math
import re
import sys

import numpy as np
import pymunk
import pytest
from pymunk_room import G, make_bead, make_plate, make_space, steps

import contactlaw as cl
from contactlaw import style
from contactlaw.cli import main
from contactlaw.engines.pymunk import attach
from contactlaw.engines.record import IMPACT
from contactlaw.record.file import Surface
from contactlaw.reporting import meshes, summary, surface
from contactlaw.reporting.figures import energy, places
from contactlaw.reporting.figures.impacts import angle
from contactlaw.reporting.run import CAUSES, Run, by_cause

PLATES = {0.5e-3: "glass", 1e-3: "glass", 3e-3: "carbon-steel-1020"}
WIDE = "[...document.querySelectorAll('*')].filter((e) => e.scrollWidth > innerWidth).length"


def lost(rows):
    return sum(rows[f"{cause}_energy"] for cause in CAUSES)


def struck(count):
    """Rows of impacts at 1 m/s on a plate of 1 mm."""
    rows = np.zeros(count, IMPACT)
    rows["approach_speed"], rows["radius"], rows["thickness"], rows["mass"] = 1.0, 1e-3, 1e-3, 1e-5
    return rows


@pytest.fixture(scope="module")
def run():
    """Beads that fall slantwise on three plates."""
    space = make_space(G)
    models = [cl.ImpactModel(cl.Pair("gamma-alumina", one)) for one in dict.fromkeys(PLATES.values())]
    impacts = attach(space, models)
    rng = np.random.default_rng(1)
    for n, (thickness, material) in enumerate(PLATES.items()):
        shape = make_plate(space, (0.1 * n, 0), (0.1 * n + 0.09, -0.02))
        impacts.add_plate(shape, thickness, material=material, friction=0.2)
        for x in rng.uniform(0.1 * n, 0.1 * n + 0.09, 12):
            radius, speed = rng.uniform(0.6e-3, 1.2e-3), (rng.uniform(-1, 1), rng.uniform(-3, -1))
            impacts.add_bead(make_bead(space, (x, 0.02), speed, radius))
    steps(space, 800)
    return space, impacts, models  # the space holds the shapes


@pytest.fixture(scope="module")
def folder(run, tmp_path_factory):
    out = tmp_path_factory.mktemp("report") / "out"
    assert run[1].report(out) == out / "index.html"
    return out


def test_the_energies_of_walls_and_causes_are_those_of_the_record(run, folder):
    rows = run[1].collisions()
    order = np.lexsort((rows["bead"], rows["time"]))
    assert cl.read_record(folder / "record.h5").rows.tolist() == rows[order].tolist()
    rows = rows[rows["plate"] >= 0]
    walls = Run(cl.Record(rows)).walls
    assert [wall.rows.size for wall in walls] == np.bincount(rows["plate"]).tolist()
    text = (folder / "summary.txt").read_text()
    (unit,) = set(re.findall(r"\[([nµm]?)J\]", text))
    table = text[text.index("plastic") :]
    shown = re.findall(r"^(?:wall (\d), .*|(all) walls) +((?:[\d.e-]+ +){5})[\d.]+%$", table, re.M)
    names = ["".join(name) for *name, _ in shown]
    assert names == ["0", "1", "2", "all"]
    size = {"n": 1e-9, "µ": 1e-6, "m": 1e-3, "": 1.0}[unit]
    owners = [rows["plate"] == n for n in range(3)] + [slice(None)]
    for name, (*_, cells), own in zip(names, shown, owners, strict=True):
        found = [float(cell) * size for cell in cells.split()]
        expected = [rows[own][f"{cause}_energy"].sum() for cause in CAUSES]
        assert found == pytest.approx([*expected, sum(expected)], rel=5e-3), name


def test_the_constant_is_that_of_the_model(run):
    _, impacts, models = run
    rows, walls = impacts.collisions(), Run(cl.Record(impacts.collisions())).walls
    for n, (thickness, material) in enumerate(PLATES.items()):
        own = rows[(rows["plate"] == n) & (rows["kind"] == 0)]
        radius = impacts.beads()["radius"][own["bead"]]
        assert own["radius"].tolist() == radius.tolist()
        assert set(own["thickness"]) == {thickness}
        model = models[material != "glass"]
        best = model.constant(own["approach_speed"], radius, thickness)
        found = walls[n].best
        assert found.restitution == pytest.approx(best.restitution, rel=1e-12)
        assert found.rebound_error == pytest.approx(best.rebound_error, rel=1e-9)
        assert found.flags == best.flags


def test_a_rebound_of_next_to_nothing_has_no_long_number(run):
    rows = run[1].collisions()[:2]
    rows["restitution"] = 0.0, 0.3
    rows["plate"], rows["thickness"], rows["kind"] = 0, 0.5e-3, 0
    assert summary.impacts(Run(cl.Record(rows)))[1][-1] == ">1000%"


def test_a_parcel_counts_for_its_beads():
    rows = struck(3)
    rows["parcel"] = 2.0, 1.0, 2.0
    assert summary.counts(Run(cl.Record(rows))).startswith("3 impacts on 1 wall, which stand for 17 of single beads, ")


def test_what_friction_gives_back_is_taken_off_its_loss():
    rows = np.zeros(2, IMPACT)
    rows["friction_energy"] = 3e-6, -1e-6
    assert by_cause(rows).tolist() == pytest.approx([0.0, 0.0, 0.0, 2e-6])


@pytest.mark.parametrize("beads", [1, 5])
def test_contacts_on_one_flat_plate_have_room(beads):
    rows = struck(beads)
    rows["x"] = np.linspace(-0.05, 0.05, beads)
    figure = places.draw(Run(cl.Record(rows)))
    (axes,) = figure.axes
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    assert high - low > 0.1 * (right - left) > 0.0
    shown = axes.collections[0].get_offsets()
    assert len(shown) == beads
    assert (shown[:, 1] > low).all() and (shown[:, 1] < high).all()


def test_the_angle_is_that_of_the_flight():
    rows = struck(2)
    rows["sliding_speed"] = 0.0, math.tan(math.radians(30.0))
    assert angle(rows) == pytest.approx([0.0, 30.0], abs=1e-9)


@pytest.mark.parametrize("width", [390, 1280])
def test_the_page_is_whole_in_one_small_file_and_fits_the_screen(folder, page, width):
    text = (folder / "index.html").read_text()
    assert len(text) < 2e6
    sources = re.findall(r"(?:src|href|srcset)=['\"]([^'\"]*)", text)
    assert len(sources) == 4 and all(one.startswith("data:") for one in sources)
    assert "http" not in text
    page.open(folder / "index.html", width)
    assert page.value("innerWidth") == width and page.value(WIDE) == 0
    assert page.value("[...document.images].every((one) => one.naturalWidth > 300)")


def test_a_phone_shows_letters_of_a_size_to_read_and_each_name_once(folder, page):
    page.open(folder / "index.html", 390)
    points = 72.0 / 150.0  # of a pixel of a figure
    sizes = page.value("[...document.images].map((one) => one.clientWidth / one.naturalWidth)")
    assert all(11.0 / points * size > 8.5 for size in sizes)  # [pixels of the phone] of 11 points
    heads, cells = "[...document.querySelectorAll('th')]", "[...document.querySelectorAll('td')]"
    assert page.value(f"{heads}.filter((one) => one.textContent === 'median COR' && one.checkVisibility()).length") == 1
    assert page.value(f"{cells}.every((one) => getComputedStyle(one, '::before').content === 'none')")


@pytest.mark.parametrize("long", [0.05, 0.5])
@pytest.mark.parametrize("known", [True, False])
def test_the_map_begins_below_its_title_and_explains_its_colours(known, long):
    rows = struck(9)
    rows["x"], rows["y"] = np.tile([0.01, 0.025, 0.04], 3), np.repeat([0.01, 0.025, 0.04], 3)
    rows["wave_energy"] = 1e-6
    corners = np.array([[[0, 0, 0], [long, 0, 0], [long, 0.05, 0]], [[0, 0, 0], [long, 0.05, 0], [0, 0.05, 0]]])
    point = np.stack([rows["x"], rows["y"], rows["z"]], axis=1)
    walls = Surface(corners, np.zeros(2, int), (rows["y"] * long > 0.05 * rows["x"]).astype(int), point)
    with style.applied():
        figure = places.draw(Run(cl.Record(rows, surface=walls if known else None)))
        figure.draw_without_rendering()
    gap = min(text.get_window_extent().y0 for text in figure.texts) - figure.axes[0].get_window_extent().y1
    assert 0.0 < gap < 0.35 * figure.dpi
    assert ("grey" in figure.texts[1].get_text()) == (known and long > 0.05)


def test_what_is_no_impact_is_left_out_and_said(folder, tmp_path, capsys):
    rows = cl.read_record(folder / "record.h5").rows
    rows = rows[rows["plate"] >= 0]
    rows["kind"][:2] = 3, 4
    np.save(tmp_path / "run.npy", rows)
    assert main(["report", str(tmp_path / "run.npy"), "--out", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().out == f"{tmp_path / 'out/index.html'}\n"
    for name in ("index.html", "summary.txt"):
        share = f"{200.0 / rows.size / 2:.2g} %"
        words = f"Of {rows.size} contacts, {share} were struck by another bead while they touched the wall and {share}"
        assert words in " ".join((tmp_path / "out" / name).read_text().replace("\xa0", " ").split())
    assert not (tmp_path / "out/energy.vtk").exists()


def test_a_report_that_cannot_be_made_says_why_and_leaves_the_record(run, tmp_path, monkeypatch):
    _, impacts, _ = run
    (tmp_path / "file").write_text("mine")
    with pytest.raises(NotADirectoryError, match="is a file, not a folder"):
        impacts.report(tmp_path / "file")
    with pytest.raises(FileNotFoundError, match="there is no such folder"):
        impacts.report(tmp_path / "no/out")
    half = attach(pymunk.Space(), cl.ImpactModel(cl.Pair("gamma-alumina", "glass")))
    with pytest.raises(ValueError, match="has no impact on a wall yet"):
        half.report(tmp_path / "out")
    assert not (tmp_path / "out").exists()
    with pytest.raises(ValueError, match="has no column mass, thickness: a report needs"):
        names = [name for name in impacts.collisions().dtype.names if name not in ("mass", "thickness")]
        Run(cl.Record(impacts.collisions()[names]))
    rows = impacts.collisions()
    row = int(np.flatnonzero((rows["kind"] == 0) & (rows["plate"] >= 0))[0])
    for name, value in (
        ("approach_speed", math.nan),
        ("mass", 0.0),
        ("thickness", math.nan),
        ("restitution", 300.0),
        ("wave_energy", math.inf),
    ):
        wrong = rows.copy()
        wrong[name][row] = value
        with pytest.raises(ValueError, match=f"{name} of row {row} is {value}: leave the row out"):
            Run(cl.Record(wrong))
    with monkeypatch.context() as patch:
        patch.setitem(sys.modules, "matplotlib", None)
        with pytest.raises(ImportError, match="pip install 'contactlaw"):
            impacts.report(tmp_path / "out")
    with monkeypatch.context() as patch:
        patch.setattr("contactlaw.reporting.summary.energies", lambda run: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            impacts.report(tmp_path / "out")
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["file", "out", "record.h5"]  # which is kept


def test_parts_of_triangles_cover_them_and_have_their_own_points():
    rng = np.random.default_rng(2)
    corners, share = rng.normal(size=(5, 3, 3)), rng.dirichlet([1, 1, 1], 200)
    which = rng.integers(0, 5, 200)
    point = (share[:, :, None] * corners[which]).sum(axis=1)
    parts, where, whole = surface.refined(corners, which, point, 0.4)
    assert np.bincount(whole, surface.areas(parts)) == pytest.approx(surface.areas(corners))
    assert whole[where].tolist() == which.tolist()
    a, b, c = np.moveaxis(parts[where], 1, 0)
    inside = np.stack([np.cross(q - p, point - p) for p, q in ((a, b), (b, c), (c, a))])
    assert ((inside * np.cross(b - a, c - a)).sum(axis=-1) > -1e-12).all()
    even = surface.averaged(parts, 2.5 * surface.areas(parts), 0.5)
    assert even == pytest.approx(2.5, rel=1e-12)


def test_a_fan_of_slivers_has_no_spikes_where_points_are_unknown():
    """Energy that one sliver of a disc took is spread over it, and averaged with its neighbours."""
    turn = np.linspace(0.0, 2.0 * math.pi, 121)
    rim = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=1)
    corners = np.stack([0.0 * rim[1:], rim[:-1], rim[1:]], axis=1)
    hit = np.repeat([3, 4], 20)
    walls = Surface(corners, np.zeros(120, int), hit, None)
    found = surface.energy_map(walls, np.full(40, 0.1))
    assert (found.energy.sum(), found.impacts.sum()) == pytest.approx((4.0, 40.0))
    centre = found.density[(np.linalg.norm(found.corners, axis=2) == 0.0).any(axis=1)]
    assert centre.size == 120 and centre.min() > 0.5 * centre.max()


@pytest.mark.parametrize("walls", [7, 10, 30])
def test_many_walls_are_counted_and_their_names_have_room(run, walls):
    rows = np.tile(run[1].collisions()[:1], walls)
    rows["plate"], rows["thickness"] = np.arange(walls), 1e-3
    many = Run(cl.Record(rows))
    assert f"on {walls} walls" in summary.counts(many)
    figure = energy.draw(many)
    figure.draw_without_rendering()
    boxes = [text.get_window_extent() for text in figure.axes[0].get_yticklabels()]
    assert all(one.y0 >= other.y1 for one, other in zip(boxes, boxes[1:], strict=False))
    assert min(box.x0 for box in boxes) >= 0.0


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_contacts_on_either_side_of_a_mesh_are_of_one_that_moves(side):
    """The record alone does not say so; it shows in the map, which such a wall has not."""
    surface = Surface(np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]]), np.zeros(1, int), np.zeros(1, int), None)
    assert meshes._still(surface, np.array([[0.2, 0.2, 0.0]]), 1e-3)
    assert not meshes._still(surface, np.array([[0.2, 0.2, side * 0.01]]), 1e-3)
