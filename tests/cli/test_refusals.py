"""Command lines and files with mistakes: each ends with a status and a sentence, none with a traceback."""

import contextlib
import io
import pickle
import shlex
import sys

import numpy as np
import pytest
from command_line import run

import contactlaw as cl
from contactlaw.answers.backend import OutsideTableError, UnsolvedError
from contactlaw.cli import main
from contactlaw.engines.record import IMPACT
from contactlaw.physical.materials import NoYieldStrengthError, UnknownMaterialError

PAIR = "--sphere gamma-alumina --plate glass"
SIZES = f"cor {PAIR} --radius 0.9mm --thickness 1mm"
HIT = f"{SIZES} --speed 5 --no-band"
FAST = f"cor {PAIR} --speed 5 --no-band"
PLOT = f"cor {PAIR} --no-band --plot cor.png"
BALL = "--sphere stainless-steel-304-ball --plate glass --radius 1mm"
WALL = f"constant {PAIR} --radius 0.9mm --thickness 1mm"
FIT = f"fit good.csv {PAIR} --radius 0.9mm --unknown"
JUDGE = f"compare good.csv {PAIR}"
FILES = {
    "good.csv": b"speed_m/s,COR,COR_error\n1,0.96,0.01\n2,0.95,0.01\n3,0.94,0.01\n4,0.94,0.01",
    "exact.csv": b"speed,COR\n1,0.9",
    "times.csv": b"drop_cm,t1_ms\n30,400",
    "binary.csv": bytes(range(256)),
    "binary.npy": b"speed",
    "binary.h5": bytes(range(256)),
}
MISUSED = {  # status 2
    "core": "got 'core', did you mean cor?",
    "materals": "did you mean materials?",
    "table chek": "got 'chek', did you mean check?",
    "cro --sphere glass": "did you mean cor?",
    "--vresion": "--vresion: no such option, did you mean --version?",
    f"{HIT} --thicknes 2mm": "--thicknes: no such option, did you mean --thickness?",
    f"{HIT} --frction 0.1": "did you mean --friction?",
    f"{HIT} --edge 2mm": "edges are for Python",
    f"{HIT} extra": "unrecognized arguments: extra",
    f"{FAST} --thickness 1mm": "one of the arguments --radius --diameter is required",
    f"{FAST} --thickness 1mm --radius ''": "--radius: got '', expected a length such as 0.5 or 0.5mm",
    f"{FAST} --thickness 1mm --radius 1mm --diameter 2mm": "--diameter: not allowed with argument --radius",
    f"{SIZES} --speed 1 --drop 1m": "--drop: not allowed with argument --speed",
    f"{HIT} --mass heavy": "got 'heavy', expected a mass such as 0.5 or 0.5mg",
    f"{HIT} --outside x": "got 'x'; choose from raise, solve, clamp",
    f"{HIT} --cylinder 5cm --bowl 5cm": "--bowl: not allowed with argument --cylinder",
    f"{SIZES} --speed 5 --speed-error five": "got 'five', expected a share",
    f"{SIZES} --speed 5 --plate-error density": "expected a property and its error, such as yield_strength=15%",
    f"{HIT} --csv --json": "--json: not allowed with argument --csv",
    f"{HIT} --plot cor.png --csv": "not allowed with argument",
    f"{HIT} --out cor.csv --json": "--json: not allowed with argument --out",
    f"{HIT} --history --samples many": "invalid int value: 'many'",
    f"{HIT} --materials no.toml": "--materials: no.toml: No such file or directory",
    f"{HIT} --materials .": "--materials: .: it is no regular file",
    "export yade": "got 'yade'; choose from header, lammps, liggghts",
    "": "COMMAND",
    "table": "ACTION",
    SIZES: "one of the arguments --speed --drop is required",
    f"{HIT} -Thick=1mm": "did you mean --thickness?",
    f"{HIT} --materials /dev/zero": "/dev/zero: it is no regular",
    f"{WALL} --speed 1,2 --table --error small": "'small'",
    f"{WALL} --speed 1,2 --csv --table": "not allowed with argument",
    f"export lammps {PAIR}": "--sphere: no such option, known: --materials, --law, --out, --set",
    "materials glass pom": "unrecognized arguments: pom",
    f"find radius {BALL}": "got 'radius'; choose from thickness, speed",
    f"find thickness {BALL} --speed 2": "--cor",
    f"find thickness {BALL} --cor 0.5": "--speed",
    f"find thickness {BALL} --cor 0.5 --speed 2 --thickness 1mm": "--thickness: no such option",
    f"find speed {BALL} --cor 0,5 --thickness 1mm": "is it a decimal comma? Write 0.5",
    f"fit {PAIR} --unknown thickness": "the following arguments are required: FILE",
    f"fit good.csv {PAIR} --radius 0.9mm": "--unknown",
    f"{FIT} thicknes": "unknown 'thicknes'; did you mean thickness?",
    f"{FIT} xyz": "unknown 'xyz'; known: yield_strength, ",
    f"{FIT} thickness --prior radiu=1mm": "unknown 'radiu'; did you mean radius?",
    f"{FIT} thickness --prior radius=": "got 'radius=', expected NAME=ERROR",
    f"{FIT} thickness --prior radius=1kg": "'kg' is no unit of length",
    f"{JUDGE} good.csv": "unrecognized arguments: good.csv",
}
REFUSED = {  # status 1
    f"{HIT} --sphere steel": "--sphere: unknown material 'steel': did you mean 'carbon-steel-1020' or ",
    f"{HIT} --sphere ''": "--sphere: unknown material '': `contactlaw materials` lists all",
    f"{HIT} --sphere gamma-alumnia": "did you mean 'gamma-alumina' or 'alumina'?",
    f"{HIT} --plate 'E=2GPa nuu=0.3 rho=1000'": "--plate: unknown 'nuu'; did you mean nu?",
    f"{HIT} --sphere pomm": "did you mean 'pom' or 'pmma'? `contactlaw materials` lists all; one of your own is",
    f"{HIT} --sphere E=2.8GPa": "'E=2.8GPa' lacks nu and rho, as in \"E=2.8GPa nu",
    f"{HIT} --sphere 'E=2.8GPa nu=0.35 rho=1410m'": "--sphere: got '1410m': 'm' is no unit of density",
    f"{HIT} --sphere 'E=2.8 nu=0.35 rho=1410'": '--sphere: E=2.8 has no unit, as in "E=2.8GPa nu=0.35',
    f"{HIT} --sphere 'E=200GPa nu=0.3 rho=7800 hardness=62'": "--sphere: hardness=62 has no unit",
    f"{HIT} --sphere 'name=a E=2GPa nu=0.35 rho=1410 name=b'": "has a key twice: leave one out",
    f"{HIT} --sphere 'yeild 350MPa E=207GPa nu=0.3 rho=7850'": "--sphere: unknown material 'yeild 350MPa'",
    f"{HIT} --sphere 'pmma loss_factor=handbook'": "must be (tan delta, frequency), the frequency in Hz: write "
    "loss_factor = [",
    f"{FAST} --thickness 1mm --radius -1mm": "--radius: got '-1mm'; must lie between",
    f"{FAST} --thickness 1mm --diameter -1mm": "--radius: got '-1mm/2'; must lie between",
    f"{FAST} --thickness 1mm --radius 0": "--radius: got '0'; must lie between",
    f"{FAST} --radius 1mm --thickness 1mm,-2mm": "--thickness: got '-2mm'; must lie between",
    f"{FAST} --radius 1mm --thickness -.5mm": "--thickness: got '-.5mm'; must lie between",
    f"{FAST} --radius 1mm --thickness 9nm": "must be at least",
    f"{SIZES} --speed -1": "--speed: got '-1'; must lie between",
    f"{SIZES} --speed 1,nan": "--speed: got 'nan'; must lie between",
    f"{SIZES} --speed 0:2:3": "--speed: got 0.0 (element 0); must lie between",
    f"{SIZES} --drop -5cm": "--drop: got '-5cm'; must lie between",
    f"{SIZES} --drop 30": "--drop: got '30'; must lie between 1e-05 and 10 metres; in cm or mm?",
    f"cor {PAIR} --radius 1mm,2mm --thickness 1mm --drop 30cm": "--drop: takes one radius",
    f"{SIZES} --speed 1e4 --no-band": "10000 m/s, radius 0.9 mm, thickness 1 mm: outside the table",
    f"{SIZES} --speed 1:9:1000 --thickness 1mm:2mm:2000": "--speed: every combination is 2000000 impacts",
    f"{HIT} --mass -1g": "--mass: got '-1g'; must lie between",
    f"{HIT} --angle 30": "--angle: needs --friction, too",
    f"{HIT} --angle 30 --friction inf": "--friction: got 'inf'; must lie between 0 and 1000\n",
    f"{HIT} --angle 0 --friction 0.1,0.2 --plot a.png": "--angle: got '0'; without a speed along the plate there is",
    f"{HIT} --friction 0.1": "--friction: needs --angle, too",
    f"{HIT} --angle 90 --friction 0.1": "--angle: got '90'; must lie between 0 and 89.999 degrees",
    f"{HIT} --angle 30,-5 --friction 0.1": "--angle: got '-5'",
    f"{HIT} --angle 30 --friction -0.1": "--friction: got '-0.1'",
    f"{SIZES} --speed 5 --angle 3 --friction 1 --causes": "--causes: does not go with --angle: leave out one of them",
    f"{SIZES} --speed 5 --angle 3 --friction 1 --speed-error 5%": "--speed-error: does not go with --angle",
    f"{HIT} --angle 30 --friction 0.1 --history": "--history: does not go with --angle",
    f"{HIT} --law herz": "unknown law; did you mean 'hertz'?",
    f"{HIT} --law ''": "--law: got ''; unknown law",
    f"{HIT} --on steel": "expected a material and a thickness, as steel-s235:3mm",
    f"{HIT} --on steel-s235:thick": "--on: got 'steel-s235:thick'; got 'thick', expected a length",
    f"{HIT} --on steel-s235:-1mm": "--on: got 'steel-s235:-1mm'; the thickness of a layer must be positive and finite",
    f"{HIT} --on steel-s235:nan": "--on: got 'steel-s235:nan'; the thickness of a layer must be positive and finite",
    f"{HIT} --thickness inf --on glass:1mm": "--thickness: got 'inf'; a half-space has no layer below it: leave out",
    f"{HIT} --cylinder 0": "--cylinder: got '0'; must be larger than the bead's radius",
    f"{HIT} --foundation -1": "--foundation: got '-1'; must lie between",
    f"{SIZES} --speed 5 --bowl 5cm --causes": "--causes: does not go with --bowl: leave out one of them",
    f"{HIT} --causes": "--causes: does not go with --no-band: leave out one of them",
    f"{SIZES} --speed 5 --speed-error -1%": "--speed-error: got '-1%'; must lie between 0 and 1",
    f"{SIZES} --speed 5 --plate-error yeld=5%": "--plate-error: uncertainty: unknown 'yeld'",
    f"{SIZES} --speed 5 --plate-error hardness=20%": "--plate-error: got 'hardness'; 'glass' has no such number",
    f"{HIT} --plot cor.xyz": "--plot: got 'cor.xyz'; must end in .png, .svg or .pdf",
    f"{HIT} --plot ''": "--plot: got ''; expected the name of a file",
    f"{HIT} --plot nowhere/cor.png": "--plot: there is no folder nowhere",
    f"{PLOT} --radius 1mm --thickness 1mm:9mm:9 --speed 1:2:9": "--speed, --thickness: got 9, 9 values; a plot has one",
    f"{PLOT} --radius 1mm,2mm --thickness 1mm,2mm --speed 1,2": "got 2, 2, 2 values; a plot has one list as its axis",
    f"{HIT} --out cor": "--out: got 'cor'; must end in .csv, .h5 or .hdf5",
    f"{HIT} --out cor.xls": "--out: got 'cor.xls'; must end in",
    f"{HIT} --history --out cor.h5": "--out: got 'cor.h5'; must end in .csv",
    f"{HIT} --out nowhere/cor.h5": "--out: there is no folder nowhere",
    f"{HIT} --out .": "--out: . is a folder",
    f"{HIT} --history --speed 1,2": "--speed: every combination is 2 impacts; --history takes at most 1",
    f"{HIT} --history --samples 1": "--samples: got 1; must be an integer from 2",
    f"{SIZES} --speed 5 --history --causes": "--causes: does not go with --history",
    f"{HIT} --samples 5": "--samples: needs --history, too",
    f"explore {PAIR} --out ''": "--out: got ''; expected the name of a file",
    f"export header {PAIR} --out ''": "--out: got ''; expected the name of a file",
    "export lammps --out ''": "--out: got ''; expected the name of a folder",
    "export lammps --out no/where": "--out: there is no folder no",
    f"{HIT} --law myc --sphere glass": "--sphere: law 'myc' needs a yield strength, and material 'glass' has "
    "none (brittle, or no citable value): take --law fem",
    f"{HIT} --law kogut_etsion(9)": "poissons_ratio must lie between 0 and 0.5, not '9'",
    f"{SIZES} --speed 1,1e4": "--outside solve integrates the equation there, --outside clamp",
    f"{HIT} --thickness 0.1mm --mass 6mg --law myc": ", mass 6 mg: outside the table, its inelasticity",
    f"cor {PAIR} --solve --law hertz --speed 1e4 --radius 1m --thickness 1cm": "did not solve",
    f"{SIZES} --radius 10um --drop 30cm": "--radius: got '10um'; such a bead has fallen",
    "table check --points 5": "--points: got 5; at least 100",
    "table info --law hertz": "--law: got 'hertz'; never yields",
    "table info missing.h5": "table: there is no file missing.h5",
    "table info --law fem --sphere glass": "--plate: has to be given, no record or file says it\n",
    "table info --law fem --sphere steal --plate glass": "--sphere: unknown material 'steal'",
    "table build --out nowhere/t.h5": "--out: there is no folder nowhere",
    "table build --out .": "--out: . is a folder",
    "materials glas": "unknown material 'glas': did you mean 'glass'",
    "constant --radius 1mm --thickness 1mm --speed 1": "--sphere: has to be given, no record or file says it",
    f"constant {PAIR} --speed 1 --radius 1mm": "--thickness: has to be given",
    f"{WALL} --speed 1,1e4": "10000 m/s, radius 0.9 mm, thickness 1 mm: outside",
    f"constant {PAIR} no.h5 no.npy": "no.h5: No such file or directory",
    f"constant {PAIR} no.csv": "no.csv: No such file or directory",
    f"constant {PAIR} --radius 1mm /dev/null": "/dev/null: ",
    f"constant {PAIR} binary.npy": "binary.npy: no file of np.save",
    f"constant {PAIR} good.csv binary.npy": "binary.npy: only the files of one record are put together",
    f"{WALL} a.h5 --table": "--table: give the least and the largest speed, as in --speed 0.1",
    f"{WALL} --table --speed 2,2": "--table: give the least and the largest speed, as in --speed 0.1",
    f"{WALL} --table --speed 1,2 --thickness 1mm,2mm": "--thickness: --table takes one value",
    f"{WALL} --table --speed 1,2 --radius 1mm,2mm": "--radius: --table takes one value",
    f"{WALL} --table --speed 1,2 --error 1": "--error: got 1.0; must lie between 1e-05 and 0.1",
    f"{WALL} --speed 1,2 --error 1e-4": "--error: got 0.0001; only --table takes it",
    f"find thickness {BALL} --cor 1.5 --speed 2": "--cor: got '1.5'; must lie between",
    f"find thickness {BALL} --cor 0.99 --speed 2": "COR 0.99: no thickness: ",
    f"find speed {BALL} --cor 0.01 --thickness inf": "COR 0.01: no speed: ",
    f"find thickness {BALL} --cor 0.5 --speed 2e4": "--speed: got '2e4'; no thickness brings the impact",
    f"find speed {BALL} --cor 0.5 --thickness 10um": "--thickness: got '10um'; no speed brings the impact",
    f"{FIT} thickness,radius --unknown radius": "--unknown: got ['thickness', 'radius', 'radius']; must be one to 3",
    f"{FIT} thickness --prior radius=-1mm": "--prior: got -0.001; the standard error of radius",
    f"{FIT} thickness --prior plate_yield_strength=5GPa": "--prior: plate_yield_strength has no value that 50000",
    f"{FIT} thickness --plot fit.txt": "--plot: got 'fit.txt'; must end in .png",
    f"{FIT} thickness --thickness 1mm": "--thickness: is unknown and given",
    f"{FIT} plate_density --thickness 1mm --friction -1": "--friction: got '-1'",
    f"{FIT} yield_strength --thickness 1mm": "--unknown: no yield_strength gives the COR 0.94 of rebound 3, line 5",
    f"fit good.csv {PAIR} --unknown thickness": "--radius: has to be given",
    f"fit . {PAIR} --unknown thickness": ".: it is no regular file",
    f"fit binary.csv {PAIR} --unknown thickness": "binary.csv: a binary file, expected a table of text",
    f"fit binary.h5 {PAIR} --unknown thickness": "binary.h5: no HDF5 file, or a damaged one",
    f"fit good.csv good.csv {PAIR} --unknown thickness": "good.csv: only the files of one record",
    f"{JUDGE} --thickness 1mm --radius 1": "R/H is 1000 beside a radius of 1.0",
    f"compare exact.csv {PAIR} --thickness 1mm --radius 1mm": "of heights or times their own, bounce_error or time_e",
    f"compare times.csv {PAIR} --thickness 1mm": "radius: has to be given with heights or times",
}
# Command lines of 0.3: what the answer says to type.
OLD = {
    f"thickness --cor 0.5 {PAIR} --speed 2": f"`find`; type: contactlaw find thickness --cor 0.5 {PAIR} --speed 2",
    f"speed --cor 0.5 {PAIR}": f"type: contactlaw find speed --cor 0.5 {PAIR}",
    "sweep --sphere 'E=2GPa nu=0.3' --out a.h5": "type: contactlaw cor --sphere 'E=2GPa nu=0.3' --out a.h5",
    f"history {PAIR} --speed 1": f"type: contactlaw cor --history {PAIR} --speed 1",
    f"oblique {PAIR} --angle 30": f"type: contactlaw cor {PAIR} --angle 30",
    f"oblique --fluent wall.c {PAIR}": "`cor` prints the same columns; type: contactlaw cor --angle ... --csv",
    f"oblique {PAIR} --acusolve=wall.inp": "type: contactlaw cor --angle ... --csv",
    f"speed-table {PAIR} --slowest 1 --csv": "type: contactlaw constant --table --speed 0.1,10 ...",
    "constant --record=hits.npy": "type: contactlaw constant hits.npy",
    "constant --record hits.npy --csv": "type: contactlaw constant hits.npy --csv",
    "constant --record": "type: contactlaw constant FILE",
}


@pytest.mark.parametrize(("line", "words"), [*MISUSED.items(), *REFUSED.items(), *OLD.items()])
def test_a_mistake_is_answered_in_words(line, words, folder, capsys):
    for name, content in FILES.items():
        (folder / name).write_bytes(content)
    made = run(line, capsys)
    assert (made.status, made.out) == (1 if line in REFUSED else 2, "")
    assert words in made.err
    *_, sentence = made.err.splitlines()
    assert sentence.startswith("contactlaw") and ("usage:" in made.err) == (line in MISUSED)
    for for_python in ("ImpactModel", "Material(", 'law="', "materials()"):
        assert for_python not in sentence
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == FILES


def saved(rows):
    """Content of a file of ``np.save``."""
    file = io.BytesIO()
    np.save(file, rows, allow_pickle=True)
    return file.getvalue()


READ = {
    "constant": f"constant {PAIR} a.csv",
    "rows": f"constant {PAIR} a.npy",
    "fit": "fit a.csv --sphere bearing-steel-52100 --plate aluminium-6061-t6 --radius 1mm --unknown thickness",
    "compare": f"compare a.csv {PAIR} --radius 1mm --thickness 1mm",
    "materials": "materials --materials a.csv",
}
POM = "[my-pom]\nE = 2.8e9\nnu = 0.35\n"
CONTENTS = [
    ("constant", "time,radius\n1,2\n", "no column of speeds in its first line, 'time, rad"),
    ("constant", "", "no column of speeds in its first line, ''"),
    ("constant", "speed_m/s\n", "it has no impact on a plate"),
    ("constant", "speed,plate\n1,-1\n", "a column plate: remove it"),
    ("constant", "speed_m/s\n1\nfast\n", "line 3, column 'speed_m/s': 'fast' is no number"),
    ("constant", "speed_m/s\n1\n-2\n", "speed: got -2.0 (element 1); must lie between"),
    ("constant", "speed_m/s\n1\nnan\n", "speed: got nan"),
    ("constant", "speed,radius_mm\n1,900000000\n", "radius: got 900000.0"),
    ("constant", "speed [mph]\n1\n", "no column of speeds in its first line, 'speed [mph]': call one speed_m/s"),
    ("constant", "speed,normal speed\n1,2\n", "two columns of speed, 'speed' and 'normal speed'"),
    ("rows", saved(np.array([object()])), "a damaged file of np.save, or one of objects"),
    ("rows", saved(np.zeros(3)), "an array of shape (3,) and type float64, expected rows with named"),
    ("rows", saved(np.zeros((2, 2), IMPACT)), "expected rows with named columns"),
    ("rows", saved(np.zeros(2, [("approach_speed", "f8")])), "one of them time"),
    ("rows", saved(np.zeros(2, [("time", "f8"), ("x", "U4")])), "x holds values of type <U4"),
    ("rows", saved(np.zeros(2, [("time", "f8"), ("x", "f8", 3)])), "holds values of type float64, shape (2, 3)"),
    (
        "rows",
        saved(np.array([(1.0, 0.5)], [("time", "f8"), ("plate", "f8")])),
        "plate of row 0 is 0.5, expected a whole",
    ),
    (
        "rows",
        saved(np.zeros(9, IMPACT)).replace(b"(9,), }" + 10 * b" ", b"(90000000000,), }"),
        "a damaged file of np.save",
    ),
    ("rows", b"\x93NUMPY\x01\x00\x40\x00" + b"((((((".ljust(64), "a damaged file of np.save"),
    ("fit", "velocty,COR\n1,0.5", "speeds in its first line, 'velocty, COR': call one speed_m/s, or drop_cm"),
    ("fit", "v,COR,diameter,radius\n1,0.5,1,1", "two columns of radius, 'diameter' and 'radius'"),
    ("fit", "speed_m/s,rebound\n1,0.5", "nothing measured in its first line"),
    ("fit", "drop_cm,bounce_cm\n30,12\n12,30", "line 3: bounce: got 0.3; a bead that arrives at 1.5"),
    ("fit", "drop,bounce\n30,12", "drop: got 30.0; must lie between 1e-05 and 10 metres; in cm"),
    ("fit", "drop_mm,t1_ms,t2_ms\n300,400,400", "line 2: t2: got 0.4; a bead that arrives at 1.9"),
    ("fit", "drop_cm,t1,t2\n30,400,300", "t1: got 400.0; must lie between 0.001 and 5 seconds; in ms"),
    ("fit", "drop_cm,v,COR\n30,2.4,0.9", "drop: give speeds or drops, not both"),
    ("fit", "bounce_cm\n30", "drop: a bounce alone has no COR: add the drop (in a head: # drop = '30cm')"),
    ("fit", "Start (s),Stop (s)\n0.4,257.1", "t1: got 256.7; must lie between"),
    ("fit", "drop_cm,bounce_cm,COR\n30,20,0.9", "restitution: leave it out beside bounce"),
    ("fit", "speed,COR\n1,\n2,n/a", "got no rebound, at least one is needed"),
    ("fit", "# in May\nspeed;COR\n1;2", ": line 3: restitution: got 2.0"),
    ("fit", "speed;COR\n1;0.5;late", "delete what is beyond the columns"),
    ("fit", "speed,COR\n1,5,0,9", "line 2 fills 4 of 2 columns, '1,5,0,9': a decimal comma?"),
    ("fit", "speed,COR,radius_mm\n1,0.5,1", "--radius: the table has its own"),
    ("fit", "normal speed,angle,beta\n3,60,0.1", "with angles the speed is that of the bead"),
    ("fit", "speed,COR,remark\n1,0.8," + 140_000 * "x", "cannot read it: Error: field larger than"),
    ("fit", 'speed,COR,remark\n1,0.8,"mine\n2,0.7,\n3,0.6,', "a.csv: cannot read it: Error: unexpected end of data"),
    ("fit", "# title = steel\nspeed,COR\n1,0.9", "the lines with # above its table are no TOML"),
    ("fit", '# diameter = "6 inch"\nspeed,COR\n1,0.9', "diameter in its head: got '6 inch': 'inch' is no unit"),
    ("fit", '# diametre = "6mm"\nspeed,COR\n1,0.9', "unknown 'diametre'; did you mean diameter?"),
    ("fit", "# plate = 3\nspeed,COR\n1,0.9", "plate in its head: plate: name: got 3; must be a string"),
    ("fit", '# [plate]\n# knd = "metal"\nspeed,COR\n1,0.9', "did you mean kind"),
    ("materials", POM + "densty = 1410", "[my-pom]: unknown 'densty'; did you mean density?"),
    ("materials", POM, "[my-pom]: give density, in SI units"),
    ("materials", POM + "density = ", "Invalid value"),
    ("materials", POM + "density = " + 3000 * "[", "recursion"),
    ("materials", POM + "density = 1410\nuncertainty = 0.1", "must be a table as {yield_strength = 0.15}, got 0.1"),
    ("materials", POM + 'rho = "1.4 psi"', "'psi' is no unit of density"),
    ("materials", POM + "density = 1410\nyoungs_modulus = 2.8e9", "give the short name or the long one"),
    ("materials", '[a]\nlike = "304L"', "[a]: like = '304L' is no entry"),
    ("materials", '[a]\nlike = "a"', "[a]: like = 'a' is no other entry"),
    ("materials", "pom = 3", "pom = 3 is no material: write [pom]"),
    ("materials", '[a]\nlike = "pom"\naliases = ["B 1"]\n[b-1]\nlike = "pom"', "[b-1]: leave out 'b-1', a name of [a]"),
    ("materials", '[a]\nlike = "pom"\naliases = ["pom-1", "POM_1"]', "[a]: leave out 'POM_1', a name of [a]"),
    ("materials", '[a]\nlike = "pom"\n[A]\nlike = "pom"', "[A]: leave out 'A', a name of [a]"),
    ("materials", '[a]\nlike = "pom"\naliases = "b"', "[a]: aliases must be a list of names, got 'b'"),
]


@pytest.mark.filterwarnings("ignore:the air changes")
@pytest.mark.parametrize(("command", "content", "words"), CONTENTS, ids=[row[2] for row in CONTENTS])
def test_a_file_with_a_mistake_is_refused_by_its_name(command, content, words, folder, capsys):
    name = "a.npy" if command == "rows" else "a.csv"
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    made = run(READ[command], capsys)
    assert made.status in (1, 2) and made.out == ""
    assert words in made.err and (f"{name}: " in made.err or "--radius" in words)


@pytest.mark.parametrize("line", [f"{HIT} --sphere steel", f"{HIT} --quantity 1", "speed-table"])
def test_a_message_fits_a_terminal_and_is_one_line_elsewhere(line, monkeypatch):
    texts = []
    for is_terminal in (True, False):
        err = io.StringIO()
        err.isatty = lambda is_terminal=is_terminal: is_terminal
        monkeypatch.setattr(sys, "stderr", err)
        with contextlib.suppress(SystemExit):
            main(shlex.split(line))
        texts.append(err.getvalue())
    wrapped, whole = texts
    assert max(map(len, wrapped.splitlines())) <= 80 < len(whole.splitlines()[-1])
    assert wrapped.split() == whole.split()


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (cl.ArgumentError("speed", np.float64(-1.0), "must be above 0", 2), "speed: got -1.0 (element 2); must be"),
        (OutsideTableError(3, "too fast"), 'outside="solve"'),
        (UnsolvedError(3, "lambda = 200", "too many steps"), "lambda = 200 (element 3): too"),
        (UnknownMaterialError("glas", ("glass",)), "mean 'glass'? contactlaw.materials()"),
        (NoYieldStrengthError("myc", "glass"), "Material("),
    ],
)
def test_errors_of_the_library_speak_of_python_and_travel(error, words):
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), vars(again), str(again)) == (type(error), vars(error), str(error))
    assert words in str(error)
