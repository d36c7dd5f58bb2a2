"""``contactlaw oblique`` against the model and the numbers that follow from its columns."""

import csv
import ctypes
import io
import itertools
import re
import subprocess

import numpy as np
import pytest
from command_line import refused

import contactlaw as cl
from contactlaw.cli import main

NAMED = "E=375GPa nu=0.22 rho=3890 hardness=14.12GPa kind=ceramic name=*/int x;/*\n}"  # alumina's
BEAD = "oblique --sphere alumina --plate glass --radius 2.5mm --thickness 25mm --speed 3.9".split()


def test_rows_are_those_of_the_model(capsys):
    assert main([*BEAD, "--angle", "0,10,60", "--friction", "0.1,0.3", "--csv"]) == 0
    rows = list(csv.DictReader(io.StringIO(capsys.readouterr().out)))
    assert [(row["friction"], row["angle_deg"]) for row in rows[2:4]] == [("0.1", "60.0"), ("0.3", "0.0")]
    row = {name: float(value) for name, value in rows[4].items() if value and not value[0].isalpha()}
    angle = np.radians(10)
    speed, sliding = 3.9 * np.cos(angle), 3.9 * np.sin(angle)
    model = cl.ImpactModel(cl.Pair("alumina", "glass"))
    hit = model.oblique(speed, sliding, 2.5e-3, 25e-3, 0.3, method="solve")
    assert row["tangential_restitution"] == pytest.approx(hit.tangential_restitution, rel=1e-12)
    assert row["sliding_speed_m/s"] == pytest.approx(hit.sliding_speed, rel=1e-12)
    velocity, spin = model.collide(
        [sliding, 0, -speed], [0, 0, 0], [0, 0, 1], 2.5e-3, 25e-3, 0.3
    )  # by the table, whose error is 2e-3 of friction times speed
    assert row["spin_rad/s"] == pytest.approx(spin[1], abs=2e-3 * 0.3 * 3.9 / 2.5e-3)
    leaves = np.degrees(np.arctan2(velocity[0], velocity[2]))
    assert row["rebound_angle_deg"] == pytest.approx(leaves, abs=0.1)


def test_a_table_and_a_plot(capsys, tmp_path):
    assert main([*BEAD, "--angle", "10:80:3", "--friction", "0.2"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "alumina on glass, law fem"
    assert len(lines) == 6 and lines[1].split()[:6] == ["angle", "friction", "speed", "radius", "thickness", "COR"]
    path = tmp_path / "oblique.png"
    assert main([*BEAD, "--angle", "1:80:9", "--friction", "0.1", "--plot", str(path)]) == 0
    assert path.read_bytes().startswith(b"\x89PNG")
    sorted_too = tmp_path / "sorted.svg", tmp_path / "unsorted.svg"
    for file, angles, frictions in zip(sorted_too, ("0,30,60", "60,0,30,30"), ("0.1,0.2", "0.2,0.1,0.2"), strict=True):
        options = ["--angle", angles, "--friction", frictions, "--plot", str(file)]
        assert main([*BEAD, *options]) == 0
    paths = [re.findall(r'<path d="[^"]*"', file.read_text()) for file in sorted_too]
    assert paths[0] == paths[1]
    capsys.readouterr()
    empty = tmp_path / "empty.png"
    assert main([*BEAD, "--angle", "30", "--friction", "0.1", "--plot", str(empty)]) == 1
    assert "--plot: got no two values of angle, speed, thickness, radius, friction to draw" in capsys.readouterr().err
    assert not empty.exists()


# What the UDF manual of Fluent says of the names that a boundary condition uses.
UDF = """
#include <math.h>
typedef double real;
typedef struct { real v[3], v0[3]; } Tracked_Particle;
typedef void Thread;
typedef int face_t;
enum { PATH_ACTIVE = 7 };
#define TP_VEL(tp) ((tp)->v)
#define TP_VEL0(tp) ((tp)->v0)
#define DEFINE_DPM_BC(name, tp, t, f, normal, dim) \\
    int name(Tracked_Particle *tp, Thread *t, face_t f, real normal[], int dim)
"""


def test_fluents_function_reflects_as_the_model_does(tmp_path):
    """Compiled beside a stand-in for Fluent's header; Fluent itself is not at hand."""
    source, library = tmp_path / "wall.c", tmp_path / "wall.so"
    wall = ["--angle", "0:89:90", "--friction", "0.1", "--fluent", str(source)]
    assert main([*BEAD, *wall, "--sphere", NAMED]) == 0
    assert "int x;" not in re.sub(r"/\*.*?\*/", "", source.read_text(), flags=re.DOTALL)
    (tmp_path / "udf.h").write_text(UDF)
    command = ["gcc", "-std=c90", "-Wall", "-Wextra", "-Wno-unused-parameter", "-Werror", "-I"]
    subprocess.run([*command, tmp_path, "-shared", "-fPIC", source, "-o", library, "-lm"], check=True)
    normal, along = np.array([2.0, -1.0, 2.0]) / 3.0, np.array([1.0, 2.0, 0.0]) / 5.0**0.5
    reflect = ctypes.CDLL(library).contactlaw_reflect
    model = cl.ImpactModel(cl.Pair("alumina", "glass"))
    for sign, angle in itertools.product((1.0, -1.0), np.radians([0.0, 3.0, 17.3, 60.0, 89.5])):
        speed, sliding = 3.9 * np.cos(angle), 3.9 * np.sin(angle)
        particle = np.array([*(speed * normal + sliding * along), 0.0, 0.0, 0.0])
        given = (ctypes.c_double * 3)(*(sign * normal))
        assert reflect(particle.ctypes.data_as(ctypes.c_void_p), None, 0, given, 3) == 7
        assert particle[:3].tolist() == particle[3:].tolist()
        hit = model.oblique(speed, sliding, 2.5e-3, 25e-3, 0.1, method="solve")
        assert particle[:3] @ normal == pytest.approx(-hit.restitution * speed, rel=1e-3)
        part = np.nan_to_num(hit.tangential_restitution)
        assert particle[:3] @ along == pytest.approx(part * sliding, rel=4e-3, abs=1e-12)


def test_acutrace_gets_both_coefficients_over_the_normal_speed(tmp_path):
    path = tmp_path / "wall.inp"
    wall = ["--angle", "60,0,30", "--friction", "0.1", "--acusolve", str(path)]
    assert main([*BEAD, *wall, "--sphere", NAMED]) == 0
    text = re.sub("^#.*\n", "", path.read_text(), flags=re.MULTILINE)
    assert text.count("{") == text.count("}") == 3
    model = cl.ImpactModel(cl.Pair("alumina", "glass"))
    speed, sliding = (3.9 * part(np.radians([60, 30, 0.01])) for part in (np.cos, np.sin))
    hit = model.oblique(speed, sliding, 2.5e-3, 25e-3, 0.1, method="solve")
    for name, values in (("en", hit.restitution), ("et", hit.tangential_restitution)):
        block = re.search(rf"wall_{name}_curve_fit_values = {{(.*?)}}", text, re.DOTALL)[1]
        rows = [row.split(",") for row in block.split(";") if row.strip()]
        expected = np.column_stack([speed, values])
        assert np.array(rows, dtype=float) == pytest.approx(expected, rel=1e-5)

    # Close to the normal, the normal speeds of two angles differ by 3e-7 of them.
    wall = ["--angle", "0,0.0445,80", "--friction", "0.1", "--acusolve", str(path)]
    assert main([*BEAD, *wall]) == 0
    block = re.search(r"wall_en_curve_fit_values = {(.*?)}", path.read_text(), re.DOTALL)[1]
    assert len({row.split(",")[0] for row in block.split(";") if row.strip()}) == 3


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--friction", "0.1,0.2", "--angle", "1,80"], "--fluent: got 2 angles and of speed, thickness"),
        (
            ["--friction", "0.1", "--angle", "40,40"],
            "--fluent: got 1 angles and of speed, thickness, radius, friction 1, 1, 1, 1 values",
        ),
    ],
)
def test_a_wall_has_one_friction_and_a_range_of_angles(options, message, tmp_path, capsys):
    path = tmp_path / "wall.c"
    refused([*BEAD, *options, "--fluent", str(path)], message, capsys=capsys)
    assert not path.exists()


@pytest.mark.parametrize(
    ("angle", "friction", "message"),
    [
        ("90", "0.1", "--angle: got 90.0; must lie between 0 and 89.999 degrees from the normal"),
        ("-1", "0.1", "--angle: got -1.0"),
        ("10", "-0.1", "--friction: got -0.1"),
        ("10", "inf", "--friction: got inf"),
    ],
)
def test_refusals(capsys, angle, friction, message):
    refused([*BEAD, f"--angle={angle}", f"--friction={friction}"], message, capsys=capsys)
