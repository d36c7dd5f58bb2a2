"""`contactlaw fit`: what it prints and draws, and what it says of tables as people have them."""

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest
from command_line import refused
from rebounds import RADIUS, STEEL, THICKNESS, rebounds

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.cli.parts import columns
from contactlaw.cli.parts import rebounds as tables
from contactlaw.cli.parts.figure import MOST_CURVES, Figure
from contactlaw.engines.record import IMPACT
from contactlaw.physical import flight
from contactlaw.physical.kind import Kind

BODIES = ["--sphere", STEEL.sphere.name, "--plate", STEEL.plate.name]
FIT = [*BODIES, "--radius", "1mm", "--unknown", "thickness"]
GLASS = ["--sphere", "glass", "--plate", "carbon-steel-1020", "--radius", "2mm"]


@pytest.fixture(scope="module")
def found():
    """Fit of the thickness to the usual rebounds; every worker would compute a constant for it."""
    return cl.fit(STEEL, rebounds(STEEL, noise=0.01, without=("thickness",)), "thickness")


@pytest.fixture
def table(tmp_path):
    """Write rows of text into a file and give its name."""

    def write(*lines):
        path = tmp_path / "rebounds.csv"
        path.write_text("\n".join(lines), encoding="utf-8")
        return str(path)

    return write


def measured(path, **sizes):
    """Rebounds of a table of bearing balls."""
    return tables.read(path, {}, lambda _: STEEL, **sizes).rebounds


@pytest.fixture
def usual(table):
    data = rebounds(STEEL, noise=0.01)
    columns = np.column_stack([data["speed"], data["restitution"], data["restitution_error"]])
    return table("speed_m/s,COR,COR_error", *(",".join(map(repr, row)) for row in columns.tolist()))


def test_json_holds_all_of_the_fit(usual, found, capsys):
    assert main(["fit", usual, *FIT, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["values"]["thickness"] == pytest.approx(found.values["thickness"], rel=1e-9)
    assert printed["errors"]["thickness"] == pytest.approx(found.errors["thickness"], rel=1e-9)
    assert printed["residuals"]["restitution"] == pytest.approx(found.residuals["restitution"].tolist(), abs=1e-9)
    assert printed["radius_m"] == 1e-3
    assert len(printed["flags"]) == 12 and printed["units"] == {"thickness": "m"}


@pytest.mark.parametrize(
    ("head", "rows"),
    [
        ("speed_m/s,COR,contact_time_us", ["1,0.5,", "2,,7.5"]),
        ("Speed [cm/s];COR [%];Contact time [µs]", ["100;50;", "200;;7.5"]),
        ("impact speed (mm/s)\te\tduration ns", ["1000\t0.5\t", "2000\t\t7500"]),
        ("speed,restitution,contact_time", ["1,0.5,", "2,,7.5e-6"]),
        ("Velocity (m/s);CoR;Duration [µs]", ["1,0;0,5;n/a", "2;-;7,5", ";;"]),
        ("v;e;time_us;diameter_mm", ["1,0;0,5;NA;2,0", "2,0;;7,5;2"]),
        ("v;e;time_us", ["1,0;0,5;", "1,5;;n.a.", "2,0;;7,5"]),  # one row has no rebound
        ("impact_velocity_mm/s,cor,duration_ns,bead_radius_um", ["1e3,.5,,1e3", "2e3,,7500,1e3"]),
    ],
)
def test_tables_as_people_write_them(head, rows, table):
    path = table(head, *rows)
    sizes = {} if "dia" in head or "radius" in head else {"radius": RADIUS}
    data = measured(path, thickness=THICKNESS, **sizes)
    assert data.radius == pytest.approx([RADIUS] * 2)
    assert data.speed == pytest.approx([1.0, 2.0])
    assert data.restitution == pytest.approx([0.5, np.nan], nan_ok=True)
    assert data.contact_time == pytest.approx([np.nan, 7.5e-6], nan_ok=True)


HEARD = [1.25, 1.65, 2.01, 2.334, 0.0, 0.0]  # phyphox writes 0 for a bounce that it did not hear
PHYPHOX = {
    "energy": (
        [
            f"{what} {n}{unit}"
            for n in range(6)
            for what, unit in (("Bounce", " (s)"), ("Height", " (m)"), ("Energy", ""))
        ],
        [[x for t in HEARD for x in (t, 9.9, 0.5)]],
    ),
    "multiple": (["Start (s)", *(f"Stop {n} (s)" for n in range(1, 6))], [HEARD]),
    "all": (["Event time (s)", "Interval (s)"], [[t, 0.3] for t in HEARD[:4]]),
}


@pytest.mark.parametrize("name", PHYPHOX)
@pytest.mark.parametrize(("between", "point"), [",.", "\t.", ";.", "\t,", ";,"])
def test_what_phyphox_exports(name, between, point, table):
    """The instants give the times between bounces; heights and energies that it derives without air are not read."""
    names, rows = PHYPHOX[name]
    cells = [[f"{x:.9E}".replace("E+0", "E").replace(".", point) for x in row] for row in rows]
    lines = [f'"{one}"' for one in names], *cells
    path = table(*(between.join(line) for line in lines))
    data = measured(path, radius=0.01, time_error=1e-3)
    times = {"t1": 0.4, "t2": 0.36, "t3": 0.324, "radius": 0.01, "time_error": 1e-3}
    wanted = cl.Measurements.of(times, density=STEEL.sphere.density)
    for field in ("speed", "restitution", "restitution_error"):
        assert getattr(data, field) == pytest.approx(getattr(wanted, field), rel=1e-6)
    assert data.restitution == pytest.approx([0.9, 0.9], abs=2e-3) and {*data.line} == {2}


def test_a_head_says_what_options_may_say(usual, table, capsys):
    """Materials, sizes and their errors; the errors enter as priors, and options come first."""
    bodies = [f'# {body} = "{name}"' for body, name in (("sphere", BODIES[1]), ("plate", BODIES[3]))]
    lines = Path(usual).read_text().splitlines()
    assert main(["fit", usual, *FIT, "--prior", "radius=0.05mm", "--json"]) == 0
    wanted = json.loads(capsys.readouterr().out)
    path = table('# title = "steel"', *bodies, '# diameter = "2mm"', '# radius_error = "5%"', *lines)
    asked = ["fit", path, "--unknown", "thickness"]
    assert main([*asked, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["values"] == wanted["values"] and printed["errors"] == wanted["errors"]
    assert main([*asked, "--radius", "2mm", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["values"]["thickness"] > 1.5 * printed["values"]["thickness"]


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (['# plates = "glass"', "speed,COR", "1,0.5"], "unknown 'plates'; did you mean plate?"),
        (
            ["velocty,COR", "1,0.5"],
            "no column of speeds in its first line, 'velocty, COR': call one speed_m/s, or drop_cm",
        ),
        (["v,COR,diameter,radius", "1,0.5,1,1"], "two columns of radius, 'diameter' and 'radius'"),
        (["speed,COR", "", "1,o.5"], "line 3, column 'COR': 'o.5' is no number"),
        (["speed;COR", "1;0,5", "2;1,5"], "line 3: restitution: got 1.5; must lie"),
        (["speed_m/s,rebound", "1,0.5"], "nothing measured in its first line"),
        (["drop_cm,bounce_cm", "30,12", "12,30"], "line 3: bounce: got 0.3; a bead that arrives at 1.5"),
        (["drop,bounce", "30,12"], "drop: got 30.0; must lie between 1e-05 and 10 metres; in cm"),
        (["drop_mm,t1_ms,t2_ms", "300,400,400"], "line 2: t2: got 0.4; a bead that arrives at 1.9"),
        (["drop_cm,t1,t2", "30,400,300"], "t1: got 400.0; must lie between 0.001 and 5 seconds; in ms"),
        (["drop_cm,v,COR", "30,2.4,0.9"], "drop: give speeds or drops, not both"),
        (["bounce_cm", "30"], "drop: a bounce alone has no COR: add this, its speed"),
        (["drop_cm,bounce_cm,COR", "30,20,0.9"], "restitution: leave it out beside bounce"),
        (["speed,COR,COR", "1,0.5,0.5"], "two columns of restitution"),
        (["speed,COR", "1,", "2,n/a"], "got no rebound, at least one is needed"),
        (["# in May", "speed;COR", "1;2"], ": line 3: restitution: got 2.0"),
        (["speed;COR", "1;0.5;late"], "delete what is beyond the columns"),
        (["speed,COR,radius_mm", "1,0.5,1"], "--radius: the table has its own"),
    ],
)
def test_tables_that_are_refused(lines, words, table, capsys):
    refused(["fit", table(*lines), *FIT], words, capsys=capsys)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ([*BODIES, "--unknown", "thickness"], "--radius: has to be given"),
        ([*FIT, "--thickness", "1mm"], "--thickness: is unknown and given"),
        (
            [*FIT, "--prior", "plate_yield_strength=5GPa"],
            "--prior: got 5000000000.0; the standard error of plate_yield_strength must",
        ),
        ([*FIT[:-1], "yield_strength", "--thickness", "1.2mm"], "--unknown: the data do not determine"),
    ],
)
def test_errors_speak_of_options(options, words, usual, capsys):
    refused(["fit", usual, *options], words, capsys=capsys)


def test_a_prior_with_its_unit(usual, found, capsys):
    assert main(["fit", usual, *FIT, "--prior", "density=0.5g/cm3", "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    data = rebounds(STEEL, noise=0.01, without=("thickness",))
    own = cl.fit(STEEL, data, "thickness", priors={"density": 500.0})
    assert printed["errors"]["thickness"] == pytest.approx(own.errors["thickness"], rel=1e-6)
    assert own.errors["thickness"] > 1.2 * found.errors["thickness"]


def test_friction_from_a_table_with_angles(table, capsys, tmp_path, figures):
    """As `contactlaw cor` has it: angles from the normal, and the speed of the bead."""
    rows = ("300,20,,5000", "300,60,0.95,", "300,70,0.96,2500")
    path = table("speed_cm/s,angle_deg,Tangential restitution,spin [rpm]", *rows)
    options = [*BODIES, "--radius", "1mm", "--thickness", "inf"]
    plot = tmp_path / "friction.png"
    assert main(["fit", path, *options, "--unknown", "friction", "--plot", str(plot)]) == 0
    assert plot.read_bytes().startswith(b"\x89PNG")
    ((curve,), (points,)) = figures[0].curves, figures[0].points
    assert figures[0].x == "angle" and points.x == pytest.approx([60.0, 70.0])
    found = re.search(r"coefficient of friction  (\S+) \+- (\S+) ", capsys.readouterr().out)
    angle = [20.0, 60.0, 70.0]
    data = {"speed": 3.0, "angle": angle, "radius": 1e-3, "thickness": np.inf}
    data["tangential_restitution"] = [np.nan, 0.95, 0.96]
    data["spin"] = [5000 * np.pi / 30, np.nan, 2500 * np.pi / 30]
    own = cl.fit(STEEL, data, "friction")
    assert float(found[1]) == pytest.approx(own.values["friction"], rel=0.01)
    assert float(found[2]) == pytest.approx(own.errors["friction"], rel=0.05)
    slope = np.radians(curve.x[60])
    hit = cl.ImpactModel(STEEL).oblique(
        3.0 * np.cos(slope), 3.0 * np.sin(slope), 1e-3, np.inf, own.values["friction"], method="solve"
    )
    assert curve.y[60] == pytest.approx(hit.tangential_restitution, rel=1e-4)
    wrong = [*options, "--unknown", "plate_density", "--friction", "-1"]
    refused(["fit", path, *wrong], "--friction: got '-1'", capsys=capsys)
    path = table("normal speed,angle,beta", "3,60,0.1")
    wrong = ["fit", path, *options, "--unknown", "friction"]
    refused(wrong, "with angles the speed is that of the bead", capsys=capsys)


def test_a_rebound_straight_down_stands_at_the_angle_0(table, capsys, tmp_path, figures):
    rows = "3,0,0.9921,", "3,15,0.9922,0.62", "3,40,0.9929,0.70", "3,60,0.9938,0.85"
    path = table("speed,angle,COR,tangential restitution", *rows)
    words = "--sphere glass --plate glass --radius 1mm --thickness 10mm --unknown friction".split()
    assert main(["fit", path, *words, "--plot", f"{tmp_path}/it.png"]) == 0
    assert capsys.readouterr().err == ""
    ((curve,), (points,)) = figures[0].curves, figures[0].points
    assert (figures[0].x, figures[0].y, points.x[0]) == ("angle", "restitution", 0.0)
    assert curve.x[0] < 0.1 and np.isfinite(curve.y).all()


def test_columns_that_are_not_used_are_named(table, capsys):
    assert main(["fit", table("speed,COR,COR_eror", "1,0.4497,3", "2,0.3716,3"), *FIT]) == 0
    assert "columns that are not used: COR_eror" in capsys.readouterr().err


def test_rows_without_a_rebound_are_left_out_and_named(table, capsys):
    """As a spreadsheet has them for beads that were lost; the fit is that of the other rows."""
    head, *rows = "speed,COR,contact time [us],by", "1,0.4497,,A", "2,0.3716,7.4,B"
    whole = table(head, *rows)
    assert main(["fit", whole, *FIT, "--json"]) == 0
    values = json.loads(capsys.readouterr().out)["values"]
    gaps = table(head, "1.5,,,A", *rows, "3,,n/a,")
    assert main(["fit", gaps, *FIT, "--json"]) == 0
    printed = capsys.readouterr()
    assert json.loads(printed.out)["values"] == values
    assert "lines without a rebound are left out: 2, 5" in printed.err


def test_a_table_of_windows_and_the_lines_of_its_doubtful_rows(tmp_path, capsys):
    path = tmp_path / "rebounds.csv"
    heads = "Velocity [m/s];Bemerkung µ;COR;Contact time [µs]"
    rows = ("1,0;;0,45;7,9", "", "2,0;;1,03;7,5")
    path.write_bytes("\r\n".join([heads, *rows]).encode("cp1252"))
    assert measured(path).contact_time == pytest.approx([7.9e-6, 7.5e-6])
    assert main(["fit", str(path), *FIT]) == 1
    assert "COR of rebound 1, line 4 is above 1" in capsys.readouterr().err


@pytest.fixture
def figures(monkeypatch):
    """Figures that are drawn."""
    drawn, save = [], Figure.save
    monkeypatch.setattr(Figure, "save", lambda self, path: (drawn.append(self), save(self, path)))
    return drawn


def test_a_picture(usual, tmp_path, capsys, figures):
    path = tmp_path / "fit.png"
    unknown = ["--thickness", "1.2mm", "--unknown", "plate_yield_strength"]
    assert main(["fit", usual, *BODIES, "--radius", "1mm", *unknown, "--plot", str(path)]) == 0
    assert path.read_bytes().startswith(b"\x89PNG")
    (figure,) = figures
    (curve,), (points,) = figure.curves, figure.points
    middle = curve.x.size // 2
    model = cl.ImpactModel(STEEL).solve(curve.x[middle], RADIUS, THICKNESS)
    assert curve.y[middle] == pytest.approx(model.restitution, rel=0.01)
    assert (curve.low < curve.y).all() and (curve.y < curve.high).all() and points.x.size == points.error.size == 12
    assert "Fit: yield strength of the plate" in figure.title and "thickness 1.2 mm" in figure.about
    assert str(path) in capsys.readouterr().out


def test_of_several_quantities_the_one_with_the_most_values_is_drawn(table, tmp_path, figures):
    """And each plate has its curve, up to the most that can be distinguished."""
    rows = [f"{v},0.3,,{h}" for v in (1, 2) for h in range(1, 13)]
    path = table("speed_m/s,COR,contact_time_us,thickness_mm", "1,0.3,20,1", *rows)
    asked = ["fit", path, *BODIES, "--radius", "1mm", "--unknown", "plate_yield_strength"]
    assert main([*asked, "--plot", str(tmp_path / "fit.png")]) == 0
    (figure,) = figures
    assert (figure.x, figure.y) == ("thickness", "restitution") and len(figure.curves) == 2
    assert [curve.label for curve in figure.curves] == ["speed 1 m/s", "speed 2 m/s"]
    path = table("speed_m/s,COR,thickness_mm", *(f"{v},0.3,{h}" for v in range(1, 15) for h in range(1, 13)))
    assert main([*asked, "--plot", str(tmp_path / "fit.png")]) == 0
    _, figure = figures
    assert len(figure.curves) == MOST_CURVES and len(figure.points) == MOST_CURVES + 1
    assert sum(points.x.size for points in figure.points) == 14 * 12


@pytest.mark.parametrize(
    "text",
    [
        "speed,COR,remark\n1,0.8\n2,0.7,ok\n",
        "speed,COR\n1,0.8,\n2,0.7,\n",
        "speed,COR,\n1,0.8\n2,0.7\n",
        'speed,COR,"remark, mine"\n1,0.8,"a, b"\n2,0.7,""\n',
        "speed,COR\n1,0.8 # first, of two\n2,0.7\n",
    ],
    ids=["no remark", "commas at the ends", "comma after the heads", "quoted", "comment"],
)
def test_rows_as_spreadsheets_and_people_end_them(text):
    found = columns.read(text.encode(), tables._FIELDS).values
    assert found["speed"].tolist() == [1.0, 2.0]
    assert found["restitution"].tolist() == [0.8, 0.7]


def test_what_is_too_long_for_a_cell_is_refused_in_words():
    with pytest.raises(csv.Error, match="field larger than"):
        columns.read(b"speed,COR,remark\n1,0.8," + b"x" * 140_000 + b"\n", tables._FIELDS)


def test_a_quote_that_is_not_closed_does_not_take_the_rows_below_it(table, capsys):
    path = table("speed,COR,remark", '1,0.8,"mine', "2,0.7,", "3,0.6,")
    refused(["fit", path, *FIT], f"{path}: cannot read it: Error: unexpected end of data", capsys=capsys)


@pytest.fixture
def run(tmp_path):
    """A run's record: impacts on two walls, of which one is of glass, an edge, and two beads."""
    on_steel = rebounds(STEEL, noise=0.01)
    rows = np.zeros(20, IMPACT)
    for name in ("restitution", "radius", "thickness"):
        rows[name][:12] = on_steel[name]
    rows["approach_speed"][:12] = on_steel["speed"]
    rows[12:] = rows[0]
    rows["plate"][12:] = [-1, 0, 1, 1, 1, 1, 1, 1]
    rows["restitution"][12:], rows["kind"][13] = 0.1, Kind.OVER_EDGE
    which = np.where(rows["plate"] == 1, 1, 0)
    which[12] = 2
    glass = cl.Pair(STEEL.sphere, "glass")
    pairs = STEEL, glass, cl.Pair(STEEL.sphere, STEEL.sphere)
    record = cl.Record(rows, [cl.Bodies(pair, "fem") for pair in pairs], which)
    record.save(tmp_path / "run.h5")
    return record, str(tmp_path / "run.h5")


def test_a_record_of_a_run_is_fitted(run, found, capsys):
    record, path = run
    asked = ["fit", path, "--plate", STEEL.plate.name, "--unknown", "thickness"]
    assert main([*asked, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["values"]["thickness"] == pytest.approx(found.values["thickness"], rel=0.02)
    assert printed["sphere"] == STEEL.sphere.name and len(printed["flags"]) == 12
    walls = record.part(record.which == 0)
    assert cl.fit(STEEL, walls, "thickness").values == pytest.approx(printed["values"], rel=1e-9)
    assert main(asked) == 0 and "\n  11       8  +" in capsys.readouterr().out
    half = [f"{path[:-3]}{n}.npy" for n in (1, 2)]
    for name, part in zip(half, (walls.rows[:7], walls.rows[7:]), strict=True):
        np.save(name, part)
    asked = ["fit", *half, *BODIES, "--unknown", "thickness"]
    assert main([*asked, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["values"] == pytest.approx(printed["values"], rel=1e-9)
    asked = ["fit", path, "--plate", STEEL.plate.name, "--unknown", "thickness"]
    for words, said in (
        (["fit", path, "--unknown", "thickness"], "several pairs, bearing-steel-52100 on aluminium"),
        ([*asked, "--radius", "1mm"], "--radius: the record has its own"),
    ):
        refused(words, said, capsys=capsys)


def test_times_between_bounces_and_their_error_are_no_contact_times(tmp_path):
    path = tmp_path / "drops.csv"
    path.write_text("drop_cm,t1_ms,t2_ms,time_error_ms\n30,380,300,1\n")
    data = measured(path, radius=2e-3)
    assert data.contact_time is None and data.restitution_error == pytest.approx([0.00287, 0.00578], rel=0.02)
    path.write_text("speed_m/s,time_us,duration_error_us\n1,9,0.5\n")
    assert measured(path).contact_time_error == pytest.approx(5e-7)
    path.write_text("speed_m/s,drop_cm,bounce_cm\n2.4,,18\n,30,17\n")
    assert measured(path, radius=2e-3).speed.size == 2


@pytest.mark.filterwarnings("ignore:the air changes")
def test_heights_in_place_of_speeds_and_cors(table, capsys):
    fell, rose = (flight.of_height(z, 2e-3, cl.material("glass").density) for z in (0.3, 0.12))
    restitution = float(rose.up / fell.down)
    assert main(["find", "thickness", *GLASS, "--drop", "30cm", "--cor", str(restitution), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["speed"] == pytest.approx(float(fell.down))
    path = table("drop_cm,bounce_cm", "30,12")
    assert main(["fit", path, *GLASS, "--unknown", "thickness", "--json"]) == 0
    fitted = json.loads(capsys.readouterr().out)["values"]["thickness"]
    assert fitted == pytest.approx(found["thickness"], rel=1e-3)
    assert main(["cor", *GLASS, "--thickness", "3mm", "--drop", "30cm", "--json", "--no-band"]) == 0
    assert json.loads(capsys.readouterr().out)["speed"] == pytest.approx(float(fell.down))
    refused(["cor", *GLASS[:-1], "1mm,2mm", "--thickness", "3mm", "--drop", "1cm"], "--drop: takes one", capsys=capsys)
    refused(["cor", *GLASS, "--thickness", "3mm", "--drop", "30"], "--drop: got '30'", capsys=capsys)
    small = [*GLASS[:-1], "10um", "--thickness", "3mm", "--drop", "30cm"]
    refused(["cor", *small], "--radius: got '10um'; such a bead has fallen", capsys=capsys)
