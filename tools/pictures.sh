#!/usr/bin/env bash
# Draws models in both modes and at three zooms into a folder, to be looked at:
#     tools/pictures.sh FOLDER MODEL…
# CHORDAL names the program (default: the release build with the feature `render`).
set -euo pipefail
folder=$1
shift
chordal=${CHORDAL:-$(dirname "$0")/../target/release/chordal}
mkdir -p "$folder"
for model in "$@"; do
    name=$(basename "$model")
    for mode in mesh nurbs; do
        for zoom in 1 4 16; do
            "$chordal" render "$model" -o "$folder/$name-$mode-$zoom.png" --mode "$mode" --zoom "$zoom" --size 640x480 ||
                [ $? = 1 ] # 1: something of the model was left undone, and said
        done
    done
done
