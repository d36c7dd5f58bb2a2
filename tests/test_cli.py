"""The command line: what it prints, and its exit status."""

import json
import signal
import subprocess
import sys

import numpy as np
import pytest

import contactlaw as cl
from contactlaw import laws, table
from contactlaw.cli import main
from contactlaw.table import file

COR = ["cor", "--sphere", "gamma-alumina", "--plate", "glass"]
IMPACT = [*COR, "--radius", "0.9e-3", "--thickness", "1e-3", "--speed", "12"]


def test_cor_json_holds_every_field(model, capsys):
    assert main([*IMPACT, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    hit = model.lookup(12.0, 0.9e-3, 1e-3)
    assert set(printed) == {*cl.Rebound.__dataclass_fields__, "yield_speed"}
    assert printed["restitution"] == hit.restitution
    assert printed["contact_time"] == hit.contact_time
    assert printed["yield_speed"] == model.yield_speed(0.9e-3, 1e-3)
    assert printed["flags"] == []


def test_cor_text_has_units(capsys):
    assert main(IMPACT) == 0
    out = capsys.readouterr().out
    assert "restitution           0.871554\n" in out
    assert "contact_time          4.04768e-06 s\n" in out
    assert "inside every limit" in out


def test_cor_names_the_limits_exceeded(capsys):
    assert main([*COR, "--radius", "1e-3", "--thickness", "0.5e-3", "--speed", "70"]) == 0
    out = capsys.readouterr().out
    assert "THIN_PLATE, FAST_IMPACT" in out
    for words in cl.explain(cl.Validity.THIN_PLATE | cl.Validity.FAST_IMPACT):
        assert words in out


def test_cor_can_integrate(model, capsys):
    assert main([*IMPACT, "--solve", "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["restitution"] == model.solve(12.0, 0.9e-3, 1e-3).restitution


def test_an_infinite_yield_speed_is_valid_json(capsys):
    elastic = ["--sphere", "glass", "--law", "hertz", "--json"]
    assert main([*IMPACT, *elastic]) == 0
    assert json.loads(capsys.readouterr().out)["yield_speed"] is None


def test_the_law_of_hertz_names_the_yield_speed_too(model, capsys):
    assert main([*IMPACT, "--law", "hertz", "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)["yield_speed"]
    assert printed == pytest.approx(model.yield_speed(0.9e-3, 1e-3), rel=1e-12)


def test_cor_of_a_plate_too_thin_for_a_yield_speed(capsys):
    thin = [*COR, "--radius", "0.9e-3", "--thickness", "0.05e-3", "--speed", "5"]
    assert main(thin) == 1
    assert "outside the table" in capsys.readouterr().err
    assert main([*thin, "--outside", "solve"]) == 0
    assert "none within the table" in capsys.readouterr().out
    assert main([*thin, "--solve", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["yield_speed"] is None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (["--speed", "-1"], "speed: got"),
        (["--speed", "nan"], "speed: got"),
        (["--radius", "0"], "radius: got"),
        (["--thickness=-inf"], "thickness: got"),
        (["--sphere", "gamma-alumnia"], "gamma-alumina"),
        (["--sphere", "glass"], 'law="fem"'),
        (["--law", "herz"], "did you mean 'hertz'"),
        (["--speed", "1e4"], "outside the table"),
    ],
)
def test_refused_physics_is_status_1_and_one_sentence(change, message, capsys):
    assert main([*IMPACT, *change]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("contactlaw: ")
    assert message in captured.err


@pytest.mark.parametrize(
    "argv", [[], ["core"], COR, [*IMPACT, "--speed", "fast"], [*IMPACT, "--outside", "x"]]
)
def test_wrong_usage_is_status_2(argv, capsys):
    with pytest.raises(SystemExit) as stop:
        main(argv)
    assert stop.value.code == 2
    assert "usage:" in capsys.readouterr().err


def test_materials(capsys):
    assert main(["materials"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines[1:]] == list(cl.materials())
    assert main(["materials", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    glass = next(entry for entry in listed if entry["name"] == "glass")
    assert (glass["youngs_modulus"], glass["yield_strength"]) == (73e9, None)
    assert main(["materials", "glass"]) == 0
    assert "Table 1" in capsys.readouterr().out
    assert main(["materials", "glas"]) == 1
    assert "glass" in capsys.readouterr().err


def test_table_build(tmp_path, capsys):
    assert main(["table", "build", "--law", "hertz", "--out", str(tmp_path / "t.h5")]) == 1
    assert list(tmp_path.iterdir()) == []
    assert main(["table", "build", "--out", str(tmp_path / "missing" / "t.h5")]) == 1
    assert "missing" in capsys.readouterr().err


def test_table_info_and_check(capsys):
    assert main(["table", "info"]) == 0
    info = capsys.readouterr().out
    assert "law myc" in info
    assert "restitution" in info
    assert main(["table", "check", "--points", "1000", "--seed", "5"]) == 0
    assert "seed 5" in capsys.readouterr().out
    assert main(["table", "check", "--points", "5"]) == 1
    assert "points: at least 100" in capsys.readouterr().err


def test_table_check_fails_above_the_bounds(tmp_path, capsys):
    coarse = table.Settings(inelasticity_nodes=9, log_overload_step=0.5)
    file.write(table.build(laws.law("myc"), coarse), tmp_path / "coarse.h5")
    assert main(["table", "check", str(tmp_path / "coarse.h5"), "--points", "500"]) == 1
    assert "exceeds its bounds" in capsys.readouterr().err


# Says when it is in the middle of a long check, and stays there.
SLOW = """
import sys, time
from contactlaw import table
from contactlaw.cli import main
def slow(*arguments, **options):
    print("inside", flush=True)
    time.sleep(60)
table.certify = slow
sys.exit(main(["table", "check"]))
"""


def test_ctrl_c_leaves_a_sentence_and_nothing_else(tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-c", SLOW],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout.readline() == "inside\n"
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=30)[1] == "contactlaw: interrupted\n"
    assert process.returncode == 130
    assert list(tmp_path.iterdir()) == []


def test_a_reader_that_goes_away():
    command = f"{sys.executable} -m contactlaw materials | head -1"
    done = subprocess.run(command, shell=True, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_as_a_module():
    done = subprocess.run(
        [sys.executable, "-m", "contactlaw", *IMPACT, "--json"], capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout)["flags"] == []


def test_history_prints_csv(capsys, model):
    assert main(["history", *IMPACT[1:], "--samples", "5"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "time_s,force_N,compression_m,impulse_Ns,plate_displacement_m"
    printed = np.array([[float(value) for value in line.split(",")] for line in lines[1:]])
    contact = model.force_history(12.0, 0.9e-3, 1e-3, samples=5)
    assert printed == pytest.approx(np.column_stack(contact), rel=1e-8)


def test_history_draws(tmp_path, capsys):
    picture = tmp_path / "contact.png"
    assert main(["history", *IMPACT[1:], "--solve", "--plot", str(picture)]) == 0
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert main(["history", *IMPACT[1:], "--plot", str(tmp_path / "contact.xyz")]) == 1
    assert "xyz" in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["contact.png"]


def test_history_refuses(capsys):
    assert main(["history", *IMPACT[1:], "--samples", "1"]) == 1
    assert "samples: must be an integer from 2" in capsys.readouterr().err
