#!/bin/sh
# Builds contactlaw.so for one LAMMPS: sh build.sh [lmp]
# What the plugin is built with has to be that of the program: its headers, its MPI, its integers.
set -e
cd "$(dirname "$0")"
lmp=$(command -v "${1:-lmp}") || { echo "build.sh: ${1:-lmp}: no such program; give the path of lmp" >&2; exit 1; }
said=$("$lmp" -h) || { echo "build.sh: $lmp -h fails; does it run at all?" >&2; exit 1; }
