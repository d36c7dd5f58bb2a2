"""Lines for engines, read by the engines themselves: each has to give the COR it was asked for."""

import shutil
import subprocess

import numpy as np
import pytest
from command_line import refused

import contactlaw as cl
from contactlaw import cli

R = 0.9e-3
SPEED = np.array([0.1, 1.0, 10.0])  # of the drops: damping of another kind depends on it
PLATES = ["0.5mm", "1mm", "inf"]
BODIES = ["--sphere", "gamma-alumina", "--plate", "glass", "--law", "myc", "--radius", "0.9mm"]
ASKED = ["constant", *BODIES, "--speed", "0.5:60:20log", "--thickness", ",".join(PLATES)]
STEP, STEPS = 2e-8, 2000  # 40 us: contacts last 4 to 12


def lines(engine, capsys, *more):
    assert cli.main([*ASKED, f"--{engine}", *more]) == 0
    return capsys.readouterr().out


@pytest.fixture(scope="module")
def wanted():
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    v = np.geomspace(0.5, 60, 20)
    walls = [model.constant(v, R, h).restitution for h in (0.5e-3, 1e-3, np.inf)]
    e = model.lookup_sphere_sphere(v, R, R).restitution
    return [*walls, np.sqrt(np.sum(v**2 * e**2) / np.sum(v**2))]


def beads():
    """Positions and velocities: three beads fly at each wall, and three at beads at rest."""
    rows = []
    for wall in range(3):
        towards = np.eye(3)[2 - wall]  # the planes z = 0, y = 0, x = 0
        for k, speed in enumerate(SPEED):
            aside = 0.01 + 0.004 * k
            rows.append((np.where(towards > 0, R * (1 + 1e-6), aside), -speed * towards))
    for k, speed in enumerate(SPEED):
        low = np.array([0.03, 0.03, 0.01 + 0.004 * k])
        rows += [(low, speed * np.eye(3)[0]), (low + [2 * R * (1 + 1e-6), 0, 0], np.zeros(3))]
    return rows


def check(velocity, wanted):
    """Check the rebounds from walls, and the relative speed of two equal beads after an impact."""
    walls = np.stack([velocity[3 * n : 3 * n + 3, 2 - n] for n in range(3)])
    assert walls / SPEED == pytest.approx(np.tile(np.array(wanted[:3])[:, None], 3), abs=1e-3)
    low, high = velocity[9:, 0].reshape(3, 2).T
    assert (high - low) / SPEED == pytest.approx(wanted[3], abs=1e-3)


def script(style, types):
    """A box with the beads in it, in commands that LAMMPS and LIGGGHTS share."""
    box = f"""
        units si
        newton off
        atom_style {style}
        boundary f f f
        neighbor 0.0005 bin
        region box block -0.001 0.05 -0.001 0.05 -0.001 0.05 units box
        create_box {types} box"""
    put = [f"create_atoms 1 single {x:.15g} {y:.15g} {z:.15g} units box" for (x, y, z), _ in beads()]
    move = [
        f"group one id {n}\nvelocity one set {x} {y} {z} units box\ngroup one delete"
        for n, (_, (x, y, z)) in enumerate(beads(), start=1)
    ]
    return "\n".join([box, *put, f"set group all diameter {2 * R} density 879", *move])


@pytest.mark.parametrize("engine", ["lammps", "liggghts"])
def test_no_name_is_a_command(engine, capsys):
    named = 'E=12.23GPa nu=0.21 rho=879 yield=472.5MPa name=a\nrun 1 """ &'
    plain = lines(engine, capsys).splitlines()
    found = lines(engine, capsys, "--sphere", named).splitlines()
    plain, found = ([line for line in lines if not line.startswith("#")] for lines in (plain, found))
    assert found == plain and '"""' not in "".join(found)


def test_lammps_reads_them(capsys, tmp_path, wanted):
    from lammps_box import quiet

    (tmp_path / "walls.lammps").write_text(lines("lammps", capsys))
    lmp = quiet(f"""{script("sphere", 1)}
        comm_modify vel yes
        variable wall1 string "zplane 0 NULL"
        variable wall2 string "yplane 0 NULL"
        variable wall3 string "xplane 0 NULL"
        pair_style granular
        include {tmp_path / "walls.lammps"}
        fix move all nve/sphere
        timestep {STEP}
        run {STEPS}""")
    order = np.argsort(lmp.numpy.extract_atom("id")[:15])
    velocity = lmp.numpy.extract_atom("v")[:15][order].copy()
    lmp.close()
    check(velocity, wanted)


@pytest.mark.skipif(not shutil.which("liggghts"), reason="LIGGGHTS: apt-get install liggghts")
def test_liggghts_reads_them(capsys, tmp_path, wanted):
    (tmp_path / "walls.liggghts").write_text(lines("liggghts", capsys))
    (tmp_path / "in.drops").write_text(f"""{script("granular", 4)}
        communicate single vel yes
        hard_particles yes
        include walls.liggghts
        fix e all property/global youngsModulus peratomtype 12.23e9 73e9 73e9 73e9
        fix nu all property/global poissonsRatio peratomtype 0.21 0.21 0.21 0.21
        fix mu all property/global coefficientFriction peratomtypepair 4 {" 0" * 16}
        pair_style gran model hertz tangential history
        pair_coeff * *
        fix w1 all wall/gran model hertz tangential history primitive type 2 zplane 0.0
        fix w2 all wall/gran model hertz tangential history primitive type 3 yplane 0.0
        fix w3 all wall/gran model hertz tangential history primitive type 4 xplane 0.0
        fix move all nve/sphere
        timestep {STEP}
        dump end all custom {STEPS} end.txt id vx vy vz
        dump_modify end sort id format "%d %.15g %.15g %.15g"
        run {STEPS}
""")
    done = subprocess.run(
        ["liggghts", "-in", "in.drops", "-log", "none"], cwd=tmp_path, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    last = (tmp_path / "end.txt").read_text().split("ITEM: ATOMS")[-1].splitlines()[1:]
    check(np.array([line.split()[1:] for line in last], dtype=float), wanted)


@pytest.mark.parametrize("engine", ["lammps", "liggghts"])
def test_what_a_constant_gets_wrong_stands_beside_it(engine, capsys):
    """The comments are what the command prints without an engine, and how the lines are used."""
    comments = [line for line in lines(engine, capsys).splitlines() if line.startswith("#")]
    assert max(map(len, comments)) <= 80
    assert cli.main(ASKED) == 0
    plain = capsys.readouterr().out.splitlines()
    assert [line[2:] for line in comments[: len(plain)]] == plain
    assert "COR: with it the wall takes the same energy as" in " ".join(plain)
    assert comments[len(plain)].startswith("# contactlaw ")


def test_the_modulus_of_lammps_walls_is_the_pairs(capsys, tmp_path):
    """LAMMPS turns the modulus into E/(2 (1 - nu^2)): a contact lasts as long as Hertz's."""
    from lammps_box import quiet

    assert cli.main([*ASKED[:5], "--law", "hertz", *ASKED[7:9], "--thickness", "inf", "--speed", "5", "--lammps"]) == 0
    (tmp_path / "walls.lammps").write_text(capsys.readouterr().out)
    lmp = quiet(f"""{script("sphere", 1)}
        comm_modify vel yes
        group rest id > 1
        delete_atoms group rest
        set group all vx 0 vy 0 vz -5
        variable wall1 string "zplane 0 NULL"
        pair_style granular
        include {tmp_path / "walls.lammps"}
        fix move all nve/sphere
        timestep 1e-8
        run 0""")
    steps = 0
    while lmp.numpy.extract_atom("x")[0, 2] < R or steps < 10:
        lmp.command("run 1 pre no post no")
        steps += 1
    lmp.close()
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="hertz")
    lasts = model.solve(5.0, R, np.inf).contact_time
    assert steps * 1e-8 == pytest.approx(lasts, abs=2e-8)  # of 5 us


def test_beads_on_beads_outside_the_table(capsys):
    steel = ["--sphere", "carbon-steel-1020", "--thickness", "1mm", "--speed", "3", "--lammps"]
    said = "bead on bead: 3 m/s, radius 0.9 mm, thickness inf: outside the table, its overload"
    refused(["constant", *BODIES, *steel], said, capsys=capsys)
