"""Reports of records, each number against the rows or another reader."""

import csv
import math
import re

import numpy as np
import pytest
from command_line import run
from impacted import impacted

import contactlaw as cl
from contactlaw import style
from contactlaw.engines.record import IMPACT
from contactlaw.record.file import Surface
from contactlaw.reporting import meshes, summary, surface
from contactlaw.reporting.figures import places
from contactlaw.reporting.figures.impacts import angle
from contactlaw.reporting.run import CAUSES, Run, by_cause

WIDE = "[...document.querySelectorAll('*')].filter((e) => e.scrollWidth > innerWidth).length"


def struck(count):
    """Rows of impacts at 1 m/s on a plate of 1 mm."""
    rows = np.zeros(count, IMPACT)
    rows["approach_speed"], rows["radius"], rows["thickness"], rows["mass"] = 1.0, 1e-3, 1e-3, 1e-5
    return rows


@pytest.fixture(scope="module")
def record():
    """Beads that fall on three plates of two materials, and one on another bead."""
    rng, rows = np.random.default_rng(1), struck(37)
    rows["plate"], rows["time"] = np.arange(37) % 3, np.arange(37)
    rows["thickness"] = np.array([0.5e-3, 1e-3, 3e-3])[rows["plate"]]
    which = rows["plate"] // 2
    rows["plate"][-1] = -1
    for name, ends in {"x": (0.0, 0.3), "approach_speed": (1.0, 3.0), "restitution": (0.5, 0.9)}.items():
        rows[name] = rng.uniform(*ends, 37)
    for cause in CAUSES:
        rows[f"{cause}_energy"] = rng.uniform(-1e-7, 1e-6, 37)
    return cl.Record(rows, [cl.Bodies(cl.Pair("pom", plate), "fem") for plate in ("glass", "carbon-steel-1020")], which)


@pytest.fixture(scope="module")
def folder(record, tmp_path_factory):
    out = tmp_path_factory.mktemp("report") / "out"
    assert cl.report(record, out) == out / "index.html"
    return out


def test_the_energies_of_walls_and_causes_are_those_of_the_record(record, folder):
    assert cl.read_record(folder / "record.h5").rows.tolist() == record.rows.tolist()
    rows = record.rows[record.rows["plate"] >= 0]
    walls = Run(record).walls
    assert [wall.rows.size for wall in walls] == np.bincount(rows["plate"]).tolist()
    text = (folder / "summary.txt").read_text()
    (unit,) = set(re.findall(r"\[([nµm]?)J\]", text))
    table = text[text.index("plastic") :]
    shown = re.findall(r"^(?:wall (\d), .*|(all) walls) +((?:[\d.e-]+ +){5})[\d.]+%$", table, re.M)
    assert ["".join(name) for *name, _ in shown] == ["0", "1", "2", "all"]
    size = {"n": 1e-9, "µ": 1e-6, "m": 1e-3, "": 1.0}[unit]
    owners = [rows["plate"] == n for n in range(3)] + [slice(None)]
    for (*_, cells), own in zip(shown, owners, strict=True):
        expected = [rows[own][f"{cause}_energy"].sum() for cause in CAUSES]
        assert [float(cell) * size for cell in cells.split()] == pytest.approx([*expected, sum(expected)], rel=5e-3)


def test_rows_are_summed_up_with_signs_and_parcels():
    """In words of the summary: a rebound of next to nothing has no long number."""
    rows = struck(3)
    rows["parcel"], rows["restitution"] = [2.0, 1.0, 2.0], [0.0, 0.3, 0.3]
    rows["friction_energy"] = 3e-6, -1e-6, 0.0  # friction gives the second bead energy back
    run = Run(cl.Record(rows))
    assert summary.counts(run).startswith("3 impacts on 1 wall, which stand for 17 of single beads, ")
    assert summary.impacts(run)[1][-1] == ">1000%"
    assert by_cause(rows).tolist() == pytest.approx([0.0, 0.0, 0.0, 2e-6])
    rows["sliding_speed"] = math.tan(math.radians(30.0)), 0.0, 0.0
    assert angle(rows) == pytest.approx([30.0, 0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("width", [390, 1280])
def test_the_page_is_whole_in_one_small_file_and_fits_the_screen(folder, page, width):
    text = (folder / "index.html").read_text()
    assert len(text) < 2e6 and "http" not in text
    sources = re.findall(r"(?:src|href|srcset)=['\"]([^'\"]*)", text)
    assert len(sources) == 4 and all(source.startswith("data:") for source in sources)
    page.open(folder / "index.html", width)
    assert page.value("innerWidth") == width and page.value(WIDE) == 0
    assert page.value("[...document.images].every((one) => one.naturalWidth > 300)")
    points = 72.0 / 150.0  # of a pixel of a figure
    sizes = page.value("[...document.images].map((one) => one.clientWidth / one.naturalWidth)")
    assert all(11.0 / points * size > 8.5 for size in sizes)  # [pixels of a phone] of 11 points


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


def test_what_is_no_impact_is_left_out_and_said(record, tmp_path, monkeypatch, answer, empty_pictures):
    monkeypatch.chdir(tmp_path)
    rows = record.rows[record.rows["plate"] >= 0]
    rows["kind"][:2] = 3, 4
    np.save("run.npy", rows)
    assert answer("report run.npy --out out").out == "out/index.html\n"
    for name in ("index.html", "summary.txt"):
        share = f"{100.0 / rows.size:.2g} %"
        words = f"Of {rows.size} contacts, {share} were struck by another bead while they touched the wall and {share}"
        text = " ".join((tmp_path / "out" / name).read_text().replace("\xa0", " ").split())
        assert words in text and "Shared plates are not checked: the record lacks materials." in text
    assert not (tmp_path / "out/energy.vtk").exists()


def test_the_power_by_frequency_is_in_the_report_and_in_a_table(tmp_path, monkeypatch, answer, capsys):
    monkeypatch.chdir(tmp_path)
    columns = {"approach_speed": np.full(4, 2.0), "radius": 1e-3, "thickness": 1e-3, "kind": [0, 0, 3, 0]}
    record = impacted("myc", **columns, plate=[0, 0, 0, 1], time=[0.0, 1.0, 2.0, 4.0])
    record.save("run.h5")
    answer("report run.h5 --spectrum bands.csv")
    bands = csv.DictReader((tmp_path / "bands.csv").read_text().splitlines())
    power = sum(float(row["power_W"]) for row in bands)
    assert power == pytest.approx(0.75 * record.rows["wave_energy"].sum() / 4.0, rel=1e-3)
    table = (tmp_path / "report/summary.txt").read_text().partition("power")[2]
    assert re.findall(r"([\d.]+)%$", table, re.M) == ["33.3", "0.0"]
    assert (tmp_path / "report/spectrum.png").exists()
    np.save("rows.npy", record.rows)
    assert "rows.npy: record: lacks materials" in run("report rows.npy --out new --spectrum new.csv", capsys).err
    assert not [*tmp_path.glob("new*")]
    answer("report rows.npy --out new")
    assert "not known by frequency: record: lacks" in " ".join((tmp_path / "new/summary.txt").read_text().split())


def test_a_report_that_cannot_be_made_says_why_and_leaves_the_record(record, tmp_path, monkeypatch):
    with pytest.raises(ValueError, match="has no impact on a wall yet"):
        cl.report(record.part(record.rows["plate"] < 0), tmp_path / "out")
    assert not (tmp_path / "out").exists()
    rows = struck(2)
    with pytest.raises(ValueError, match="has no column mass, thickness: a report needs"):
        Run(cl.Record(rows[[name for name in rows.dtype.names if name not in ("mass", "thickness")]]))
    wrong = {"approach_speed": math.nan, "mass": 0.0, "thickness": math.nan, "restitution": 300.0}
    for name, value in (wrong | {"wave_energy": math.inf}).items():
        rows = struck(2)
        rows[name][1] = value
        with pytest.raises(ValueError, match=f"{name} of row 1 is {value}: leave the row out"):
            Run(cl.Record(rows))
    monkeypatch.setattr("contactlaw.reporting.summary.energies", lambda run: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        cl.report(record, tmp_path / "out")
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["out", "record.h5"]  # which is kept


def test_parts_of_triangles_cover_them_and_have_their_own_points():
    rng = np.random.default_rng(2)
    corners, share = rng.normal(size=(5, 3, 3)), rng.dirichlet([1, 1, 1], 200)
    which = rng.integers(0, 5, 200)
    point = (share[:, :, None] * corners[which]).sum(axis=1)
    parts, where, whole = surface.refined(corners, which, point, 0.4)
    assert np.bincount(whole, surface.areas(parts)) == pytest.approx(surface.areas(corners))
    assert whole[where].tolist() == which.tolist()
    triangles = pytest.importorskip("trimesh.triangles", reason="trimesh is missing: pip install contactlaw[lammps]")
    assert triangles.points_to_barycentric(parts[where], point).min() > -1e-9
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


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_contacts_on_either_side_of_a_mesh_are_of_one_that_moves(side):
    """The record alone does not say so; it shows in the map, which such a wall has not."""
    surface = Surface(np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]]), np.zeros(1, int), np.zeros(1, int), None)
    assert meshes._still(surface, np.array([[0.2, 0.2, 0.0]]), 1e-3)
    assert not meshes._still(surface, np.array([[0.2, 0.2, side * 0.01]]), 1e-3)
