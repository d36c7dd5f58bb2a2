"""`contactlaw fit`: what it prints and draws, and what it reads of tables as people have them."""

import numpy as np
import pytest
from command_line import run
from rebounds import RADIUS, STEEL, THICKNESS, rebounds

import contactlaw as cl
from contactlaw.cli.parts import rebounds as tables
from contactlaw.cli.parts.figure import Figure
from contactlaw.engines.record import IMPACT
from contactlaw.physical import flight
from contactlaw.physical.kind import Kind

BODIES = f"--sphere {STEEL.sphere.name} --plate {STEEL.plate.name}"
FIT = f"fit a.csv {BODIES} --radius 1mm --unknown thickness"
GLASS = "--sphere glass --plate carbon-steel-1020 --radius 2mm"


@pytest.fixture(scope="module")
def found():
    """Fit of the thickness to the usual rebounds; every worker would compute a constant for it."""
    return cl.fit(STEEL, rebounds(STEEL, noise=0.01, without=("thickness",)), "thickness")


@pytest.fixture
def table(folder):
    """Write rows of text into the file a.csv."""
    return lambda *lines: (folder / "a.csv").write_text("\n".join(lines), encoding="utf-8")


def measured(**sizes):
    """Rebounds of bearing balls in a.csv."""
    return tables.read("a.csv", {}, lambda _: STEEL, **sizes).rebounds


@pytest.fixture
def usual(table):
    """Rows of the usual rebounds, which stand in a.csv."""
    data = rebounds(STEEL, noise=0.01)
    columns = np.column_stack([data["speed"], data["restitution"], data["restitution_error"]])
    rows = ["speed_m/s,COR,COR_error", *(",".join(map(repr, row)) for row in columns.tolist())]
    table(*rows)
    return rows


@pytest.fixture
def figures(monkeypatch):
    """Figures that are drawn."""
    drawn, save = [], Figure.save
    monkeypatch.setattr(Figure, "save", lambda self, path: (drawn.append(self), save(self, path)))
    return drawn


def test_json_holds_all_of_the_fit(usual, found, answer):
    printed = answer(f"{FIT} --json").values
    assert printed["values"]["thickness"] == pytest.approx(found.values["thickness"], rel=1e-9)
    assert printed["errors"]["thickness"] == pytest.approx(found.errors["thickness"], rel=1e-9)
    assert printed["residuals"]["restitution"] == pytest.approx(found.residuals["restitution"].tolist(), abs=1e-9)
    assert printed["radius_m"] == 1e-3 and printed["units"] == {"thickness": "m"}
    data = rebounds(STEEL, noise=0.01, without=("thickness",))
    own = cl.fit(STEEL, data, "thickness", priors={"density": 500.0})
    uncertain = answer(f"{FIT} --prior density=0.5g/cm3 --json").values["errors"]["thickness"]
    assert uncertain == pytest.approx(own.errors["thickness"], rel=1e-6)
    assert uncertain > 1.2 * found.errors["thickness"]


@pytest.mark.parametrize(
    ("head", "rows"),
    [
        ("speed_m/s,COR,contact_time_us", ["1,0.5,", "2,,7.5"]),
        ("Speed [cm/s];COR [%];Contact time [µs]", ["100;50;", "200;;7.5"]),
        ("impact speed (mm/s)\te\tduration ns", ["1000\t0.5\t", "2000\t\t7500"]),
        ("Velocity (m/s);CoR;Duration [µs]", ["1,0;0,5;n/a", "2;-;7,5", ";;"]),
        ("v;e;time_us;diameter_mm", ["1,0;0,5;NA;2,0", "2,0;;7,5;2"]),
        ("v;e;time_us", ["1,0;0,5;", "1,5;;n.a.", "2,0;;7,5"]),  # one row has no rebound
        ("impact_velocity_mm/s,cor,duration_ns,bead_radius_um", ["1e3,.5,,1e3", "2e3,,7500,1e3"]),
        ("speed,COR,time_us,remark", ["1,0.5,", "2,,7.5,ok"]),
        ("speed,COR,time_us", ["1,0.5,,,", "2,,7.5 # first, of two"]),
        ("speed,COR,time_us,", ["1,0.5,", "2,,7.5"]),
        ('speed,COR,time_us,"remark, mine"', ['1,0.5,,"a, b"', '2,,7.5,""']),
    ],
)
def test_tables_as_people_write_them(head, rows, table):
    table(head, *rows)
    sizes = {} if "dia" in head or "radius" in head else {"radius": RADIUS}
    data = measured(thickness=THICKNESS, **sizes)
    assert data.radius == pytest.approx([RADIUS] * 2)
    assert data.speed == pytest.approx([1.0, 2.0])
    assert data.restitution == pytest.approx([0.5, np.nan], nan_ok=True)
    assert data.contact_time == pytest.approx([np.nan, 7.5e-6], nan_ok=True)


HEARD = [1.25, 1.65, 2.01, 2.334, 0.0, 0.0]  # phyphox writes 0 for a bounce that it did not hear
PHYPHOX = {
    "energy": (
        [f"{name.format(n)}" for n in range(6) for name in ("Bounce {} (s)", "Height {} (m)", "Energy {}")],
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
    table(*(between.join(line) for line in ([f'"{head}"' for head in names], *cells)))
    data = measured(radius=0.01, time_error=1e-3)
    times = {"t1": 0.4, "t2": 0.36, "t3": 0.324, "radius": 0.01, "time_error": 1e-3}
    wanted = cl.Measurements.of(times, density=STEEL.sphere.density)
    for field in ("speed", "restitution", "restitution_error"):
        assert getattr(data, field) == pytest.approx(getattr(wanted, field), rel=1e-6)
    assert data.restitution == pytest.approx([0.9, 0.9], abs=2e-3) and {*data.line} == {2}


def test_a_head_says_what_options_may_say(usual, table, answer):
    """Materials, sizes and their errors; the errors enter as priors, and options come first."""
    wanted = answer(f"{FIT} --prior radius=0.05mm --json").values
    bodies = f'# sphere = "{STEEL.sphere.name}"', f'# plate = "{STEEL.plate.name}"'
    table('# title = "steel"', *bodies, '# diameter = "2mm"', '# radius_error = "5%"', *usual)
    printed = answer("fit a.csv --unknown thickness --json").values
    assert printed["values"] == wanted["values"] and printed["errors"] == wanted["errors"]
    thicker = answer("fit a.csv --unknown thickness --radius 2mm --json").values
    assert thicker["values"]["thickness"] > 1.5 * printed["values"]["thickness"]


def test_friction_from_a_table_with_angles(table, answer, folder, figures):
    """As `contactlaw cor` has it: angles from the normal, and the speed of the bead."""
    rows = "300,20,,5000", "300,60,0.95,", "300,70,0.96,2500"
    table("speed_cm/s,angle_deg,Tangential restitution,spin [rpm]", *rows)
    line = FIT.replace("--unknown thickness", "--thickness inf --unknown friction")
    printed = answer(f"{line} --json").values
    data = {"speed": 3.0, "angle": [20.0, 60.0, 70.0], "radius": 1e-3, "thickness": np.inf}
    data["tangential_restitution"] = [np.nan, 0.95, 0.96]
    data["spin"] = [5000 * np.pi / 30, np.nan, 2500 * np.pi / 30]
    own = cl.fit(STEEL, data, "friction")
    assert (printed["values"], printed["errors"]) == (pytest.approx(own.values), pytest.approx(own.errors))
    answer(f"{line} --plot friction.png")
    ((curve,), (points,)) = figures[0].curves, figures[0].points
    assert figures[0].x == "angle" and points.x == pytest.approx([60.0, 70.0])
    slope, mu = np.radians(curve.x[60]), own.values["friction"]
    hit = cl.ImpactModel(STEEL).oblique(3 * np.cos(slope), 3 * np.sin(slope), 1e-3, np.inf, mu, method="solve")
    assert curve.y[60] == pytest.approx(hit.tangential_restitution, rel=1e-4)


def test_rows_without_a_rebound_and_unknown_columns_are_left_out_and_named(table, answer):
    """As a spreadsheet has them for beads that were lost; the fit is that of the other rows."""
    head, *rows = "speed,COR,contact time [us],COR_eror", "1,0.4497,,A", "2,0.3716,7.4,B"
    table(head, *rows)
    whole = answer(f"{FIT} --json")
    table(head, "1.5,,,A", *rows, "3,,n/a,")
    gaps = answer(f"{FIT} --json")
    assert gaps.values["values"] == whole.values["values"]
    assert "lines without a rebound are left out: 2, 5" in gaps.err
    assert "columns that are not used: COR_eror" in whole.err


def test_a_table_of_windows_and_the_lines_of_its_doubtful_rows(folder, capsys):
    heads = "Velocity [m/s];Bemerkung µ;COR;Contact time [µs]"
    rows = ("1,0;;0,45;7,9", "", "2,0;;1,03;7,5")
    (folder / "a.csv").write_bytes("\r\n".join([heads, *rows]).encode("cp1252"))
    assert measured().contact_time == pytest.approx([7.9e-6, 7.5e-6])
    made = run(FIT, capsys)
    assert made.status == 1 and "COR of rebound 1, line 4 is above 1" in made.err


def test_a_picture(usual, folder, answer, figures):
    line = FIT.replace("--unknown thickness", "--thickness 1.2mm --unknown plate_yield_strength")
    assert "fit.png" in answer(f"{line} --plot fit.png").out and (folder / "fit.png").exists()
    (figure,) = figures
    (curve,), (points,) = figure.curves, figure.points
    middle = curve.x.size // 2
    model = cl.ImpactModel(STEEL).solve(curve.x[middle], RADIUS, THICKNESS)
    assert curve.y[middle] == pytest.approx(model.restitution, rel=0.01)
    assert (curve.low < curve.y).all() and (curve.y < curve.high).all() and points.x.size == points.error.size == 12
    assert "Fit: yield strength of the plate" in figure.title and "thickness 1.2 mm" in figure.about


def test_a_record_of_a_run_is_fitted(folder, answer, capsys):
    """Impacts on two walls, of which one is of glass, an edge, and two beads."""
    on_steel = rebounds(STEEL, noise=0.01)
    rows = np.zeros(20, IMPACT)
    rows["approach_speed"][:12] = on_steel["speed"]
    for name in ("restitution", "radius", "thickness"):
        rows[name][:12] = on_steel[name]
    rows[12:] = rows[0]
    rows["plate"][12:], rows["restitution"][12:], rows["kind"][13] = [-1, 0, *6 * [1]], 0.1, Kind.OVER_EDGE
    which = np.array([*12 * [0], 2, *rows["plate"][13:]])
    pairs = STEEL, cl.Pair(STEEL.sphere, "glass"), cl.Pair(STEEL.sphere, STEEL.sphere)
    record = cl.Record(rows, [cl.Bodies(pair, "fem") for pair in pairs], which)
    record.save("run.h5")
    line = f"fit run.h5 --plate {STEEL.plate.name} --unknown thickness"
    printed = answer(f"{line} --json").values
    assert printed["sphere"] == STEEL.sphere.name and len(printed["flags"]) == 12
    walls = record.part(which == 0)
    assert cl.fit(STEEL, walls, "thickness").values == pytest.approx(printed["values"], rel=1e-9)
    np.save("1.npy", walls.rows[:7])
    np.save("2.npy", walls.rows[7:])
    halves = answer(f"fit 1.npy 2.npy {BODIES} --unknown thickness --json").values
    assert halves["values"] == pytest.approx(printed["values"], rel=1e-9)
    for refused, words in (
        ("fit run.h5 --unknown thickness", "several pairs, bearing-steel-52100 on aluminium"),
        (f"{line} --time-error 1ms", "--time-error: a record does not need it"),
        (f"{line} --radius 1mm", "--radius: a record does not need it"),
    ):
        assert words in run(refused, capsys).err


def test_times_between_bounces_and_their_error_are_no_contact_times(table):
    table("drop_cm,t1_ms,t2_ms,time_error_ms", "30,380,300,1")
    data = measured(radius=2e-3)
    assert data.contact_time is None and data.restitution_error == pytest.approx([0.00287, 0.00578], rel=0.02)
    table("speed_m/s,time_us,duration_error_us", "1,9,0.5")
    assert measured().contact_time_error == pytest.approx(5e-7)
    table("speed_m/s,drop_cm,bounce_cm", "2.4,,18", ",30,17")
    assert measured(radius=2e-3).speed.size == 2


def test_the_error_of_instants_is_an_option_or_in_the_head_behind_an_equals_sign(table, answer):
    rows, line = ("drop_cm,t1_ms,t2_ms", "30,250,150"), f"fit a.csv {GLASS} --unknown thickness --json"
    table(*rows)
    without, by_option = answer(line), answer(f"{line} --time-error 1ms")
    table('# time_error = "1ms"', *rows)
    assert answer(line).values == by_option.values and by_option.values["errors"] != without.values["errors"]
    table("# time_error: 1ms", *rows)
    remark = answer(line)
    assert remark.values == without.values and "the lines with # above its table are not used" in remark.err


@pytest.mark.filterwarnings("always:the air changes")
def test_heights_in_place_of_speeds_and_cors(table, answer):
    fell, rose = (flight.of_height(z, 2e-3, cl.material("glass").density) for z in (0.3, 0.12))
    sought = answer(f"find thickness {GLASS} --drop 30cm --cor {float(rose.up / fell.down)!r} --json").values
    assert sought["speed"] == pytest.approx(float(fell.down))
    table("drop_cm,bounce_cm", "30,12")
    fitted = answer(f"fit a.csv {GLASS} --unknown thickness --json").values
    assert fitted["values"]["thickness"] == pytest.approx(sought["thickness"], rel=1e-3)
    dropped = answer(f"cor {GLASS} --thickness 3mm --drop 30cm --json --no-band").values
    assert dropped["speed"] == pytest.approx(float(fell.down))
    light = answer(f"cor {GLASS} --radius 0.5mm --thickness 3mm --drop 30cm --no-band").err
    assert light.startswith("contactlaw: warning: the air changes")  # no path or line of a source
