#!/bin/sh
# Builds wall_contactlaw.so for Debian's LIGGGHTS, from the headers beside this script:
#     apt-get install liggghts libliggghts-dev libopenmpi-dev g++
set -e
cd "$(dirname "$0")"

# LIGGGHTS lists its models in headers that its own build makes, and no package has
styles=$(mktemp -d)
trap 'rm -rf "$styles"' EXIT
list() {
    kind=$1
    shift
    printf '#include "%s"\n' "$@" > "$styles/style_${kind}_model.h"
}
list normal normal_model_contactlaw.h
list tangential tangential_model_history.h tangential_model_contactlaw.h
list surface surface_model_default.h
: > "$styles/style_cohesion_model.h"
: > "$styles/style_rolling_model.h"

mpicxx -O2 -shared -fPIC $CXXFLAGS -I. -isystem "$styles" -isystem /usr/include/liggghts \
    wall_contactlaw.cpp -o wall_contactlaw.so -lliggghts

echo "built; run:  LD_PRELOAD=$PWD/wall_contactlaw.so liggghts -in FILE"
