"""Command lines with mistakes: each ends with a status and a sentence, none with a traceback."""

import contextlib
import io
import shlex
import sys

import pytest

from contactlaw.cli import main

PAIR = "--sphere gamma-alumina --plate glass"
SIZES = f"cor {PAIR} --radius 0.9mm --thickness 1mm"
HIT = f"{SIZES} --speed 5 --no-band"
FAST = f"cor {PAIR} --speed 5 --no-band"
PLOT = f"cor {PAIR} --no-band --plot cor.png"
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
    f"{FAST} --thickness 1mm --radius 0.9kg": "'kg' is no unit of length; take m, cm, mm, um or nm",
    f"{FAST} --thickness 1mm --radius 0,9mm": "is it a decimal comma? Write 0.9mm",
    f"{FAST} --thickness 1mm --radius 0.9mm,": "--radius: got '', expected a length",
    f"{FAST} --thickness 1mm --radius 1e-3,1mm": "'1e-3' has no unit and others have",
    f"{FAST} --thickness 1mm --radius 1mm --diameter 2mm": "--diameter: not allowed with argument --radius",
    f"{SIZES} --speed fast": "got 'fast', expected a speed such as 0.5",
    f"{SIZES} --speed 1:5": "got '1:5'; a range is start:stop:count",
    f"{SIZES} --speed 1:5:0": "a range has from 2 to",
    f"{SIZES} --speed 0:5:5log": "logarithmic steps need ends above 0",
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
}
REFUSED = {  # status 1
    f"{HIT} --sphere steel": "--sphere: unknown material 'steel': did you mean 'carbon-steel-1020' or ",
    f"{HIT} --sphere ''": "--sphere: unknown material '': `contactlaw materials` lists all",
    f"{HIT} --sphere gamma-alumnia": "did you mean 'gamma-alumina' or 'alumina'?",
    f"{HIT} --plate 'E=2GPa nuu=0.3 rho=1000'": "--plate: unknown 'nuu'; did you mean nu?",
    f"{HIT} --plate 'E=2GPa nu=0.3'": "lacks rho, as in",
    f"{FAST} --thickness 1mm --radius -1mm": "--radius: got '-1mm'; must lie between",
    f"{FAST} --thickness 1mm --diameter -1mm": "--radius: got '-1mm/2'; must lie between",
    f"{FAST} --thickness 1mm --radius 0": "--radius: got '0'; must lie between",
    f"{FAST} --radius 1mm --thickness 1mm,-2mm": "--thickness: got '-2mm'; must lie between",
    f"{FAST} --radius 1mm --thickness -.5mm": "--thickness: got '-.5mm'; must lie between",
    f"{FAST} --radius 1mm --thickness -inf": "--thickness: got '-inf'; must lie between",
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
    f"{HIT} --on steel-s235:inf": "--on: got 'steel-s235:inf'; the thickness of a layer must be positive and finite",
    f"{HIT} --on steel-s235:nan": "--on: got 'steel-s235:nan'; the thickness of a layer must be positive and finite",
    f"{HIT} --thickness inf --on glass:1mm": "--thickness: got 'inf'; a half-space has no layer below it: leave out",
    f"{HIT} --plate 鋼": "--plate: unknown material '鋼': `contactlaw materials` lists all",
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
    "bounces drop.wav": "the app phyphox hears bounces",
    f"experiment {PAIR}": "`experiment` is gone",
}


def answered(line, capsys):
    try:
        status = main(shlex.split(line))
    except SystemExit as stop:
        status = stop.code
    printed = capsys.readouterr()
    assert printed.out == "" and "Traceback" not in printed.err
    return status, printed.err


@pytest.mark.parametrize(("line", "words"), [*MISUSED.items(), *REFUSED.items(), *OLD.items()])
def test_a_mistake_is_answered_in_words(line, words, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    status, message = answered(line, capsys)
    assert status == (1 if line in REFUSED else 2)
    assert words in message
    *_, sentence = message.splitlines()
    assert sentence.startswith("contactlaw") and ("usage:" in message) == (line in MISUSED)
    assert [*tmp_path.iterdir()] == []


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
