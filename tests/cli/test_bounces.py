"""From a recording to a fit on the command line, and heights in place of speeds."""

import json

import numpy as np
import pytest
from command_line import refused
from scipy.io import wavfile

import contactlaw as cl
from contactlaw.cli import main
from contactlaw.cli.parts import rebounds
from contactlaw.physical import flight
from validation.hostile import recordings

BODIES = ["--sphere", "glass", "--plate", "carbon-steel-1020", "--radius", "2mm"]


@pytest.mark.filterwarnings("ignore:the air changes")
def test_from_a_recording_to_a_thickness(tmp_path, capsys):
    _, cors, x, drop = recordings.drops(np.random.default_rng(16), 44100, 1, 35.0)
    wavfile.write(tmp_path / "drop.wav", 44100, np.int16(32000 * x))
    asked = ["bounces", str(tmp_path / "drop.wav"), "--drop", f"{drop}m", "--sphere", "glass", "--radius", "2mm"]
    assert main(asked) == 0
    table = tmp_path / "bounces.csv"
    table.write_text(capsys.readouterr().out)
    assert main(["fit", str(table), "--sphere", "glass", "--plate", "glass", "--unknown", "thickness", "--json"]) == 0
    said = capsys.readouterr()
    fitted = json.loads(said.out)["values"]["thickness"]
    model = cl.ImpactModel(cl.Pair("glass", "glass"))
    speed = flight.of_height(drop, 2e-3, model.pair.sphere.density).down
    assert model.restitution(speed, 2e-3, fitted) == pytest.approx(cors[0], abs=0.03) and "not used" not in said.err
    assert main([*asked, "--plot", str(tmp_path / "drop.png")]) == 0
    assert (tmp_path / "drop.png").read_bytes().startswith(b"\x89PNG")
    capsys.readouterr()
    (tmp_path / "drop.m4a").write_bytes(b"")
    refused([*asked[:1], str(tmp_path / "drop.m4a")], "ffmpeg -i drop.m4a drop_new.wav", capsys=capsys)
    wavfile.write(tmp_path / "none.wav", 44100, np.zeros(44100, dtype=np.int16))
    refused([*asked[:1], str(tmp_path / "none.wav")], "none.wav: silent", capsys=capsys)
    refused([*asked[:2], "--drop", "30"], "--drop: got 30.0", capsys=capsys)
    refused([*asked[:4], "--sphere", "glass", "--radius=-2mm"], "--radius: got -0.002", capsys=capsys)


def test_times_of_an_app(tmp_path, capsys):
    path = tmp_path / "times.csv"
    path.write_text('"No";"Time (ms)"\n1;100\n2;600\n3;1000,0\n4;1320\n')
    assert main(["bounces", str(path)]) == 0
    head, *rows = capsys.readouterr().out.splitlines()
    assert head == "speed_m/s,COR" and [row.split("  #")[0] for row in rows] == ["2.45166,0.8", "1.96133,0.8"]
    path.write_text("time_s\n0.1\n\n0.6\n0.5\n")
    refused(["bounces", str(path)], "times.csv, line 5: got 0.5", capsys=capsys)
    path.write_text("time_s\n0.1\n7\n")
    refused(["bounces", str(path), "--drop", "1m"], "times.csv: t1: got 6.9", capsys=capsys)


def test_times_between_bounces_and_their_error_are_no_contact_times(tmp_path, capsys):
    path = tmp_path / "drops.csv"
    path.write_text("drop_cm,t1_ms,t2_ms,time_error_ms\n30,380,300,1\n")
    data = rebounds.completed(rebounds.read(path), path, 2500.0, radius=2e-3)
    assert data.contact_time is None and data.restitution_error == pytest.approx([0.00287, 0.00578], rel=0.02)
    path.write_text("speed_m/s,time_us,time_error_us\n1,9,0.5\n")
    assert rebounds.completed(rebounds.read(path), path, 2500.0).contact_time_error == pytest.approx(5e-7)
    path.write_text("speed_m/s,drop_cm,bounce_cm\n2.4,,18\n,30,17\n")
    assert rebounds.completed(rebounds.read(path), path, 2500.0, radius=2e-3).speed.size == 2


@pytest.mark.filterwarnings("ignore:the air changes")
def test_heights_in_place_of_speeds_and_cors(capsys):
    fell, rose = (flight.of_height(z, 2e-3, cl.material("glass").density) for z in (0.3, 0.12))
    assert main(["thickness", *BODIES, "--drop", "30cm", "--bounce", "12cm", "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)
    assert found["speed"] == pytest.approx(float(fell.down))
    assert found["restitution"] == pytest.approx(float(rose.up / fell.down))
    noted = ["--drop", "30cm", "--bounce", "12cm", "--unknown", "thickness", "--json"]
    assert main(["fit", *BODIES, *noted]) == 0
    fitted = json.loads(capsys.readouterr().out)["values"]["thickness"]
    assert fitted == pytest.approx(found["thickness"], rel=1e-3)
    assert main(["cor", *BODIES, "--thickness", "3mm", "--drop", "30cm", "--json", "--no-band"]) == 0
    assert json.loads(capsys.readouterr().out)["speed"] == pytest.approx(float(fell.down))
    refused(["cor", *BODIES[:-1], "1mm,2mm", "--thickness", "3mm", "--drop", "1cm"], "--drop: takes one", capsys=capsys)
    refused(["fit", *BODIES, "--unknown", "thickness"], "--drop, --bounce: give these without", capsys=capsys)
    refused(["cor", *BODIES, "--thickness", "3mm", "--drop", "30"], "--drop: got 30.0", capsys=capsys)
    refused(["fit", *BODIES, "--unknown", "thickness", "--bounce", "9cm"], "--drop: a bounce alone", capsys=capsys)
    small = [*BODIES[:-1], "10um", "--thickness", "3mm", "--drop", "30cm"]
    refused(["cor", *small], "--radius: got 1e-05; such a bead has fallen", capsys=capsys)
