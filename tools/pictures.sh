#!/usr/bin/env bash
# Draws models into a folder, to be looked at: by their mesh, and exactly with both ways of trimming, at three zooms.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

usage() {
    cat <<'TEXT'
Usage: tools/pictures.sh FOLDER [MODEL…]

Without models: fourteen of the corpus, with trims that break tessellators and solids to be looked at close up.

Environment:
  CHORDAL   the program, built with the feature `gpu` [default: target/release/chordal]
  SIZE      size of a picture [default: 480x360]
TEXT
}

case ${1:-} in
-h | --help) usage && exit 0 ;;
'') usage >&2 && exit 2 ;;
esac
folder=$1
shift
chordal=${CHORDAL:-$root/target/release/chordal}
size=${SIZE:-480x360}
if [ $# = 0 ]; then
    for name in iv/duck.iv iv/airplane_in_a_box.iv iv/concave_trim.iv nested_loops.step touching_loops.step sliver_loops.step \
        holes_wrong_way.step sphere_holes.step torus_villarceau.step bracket.step fillets.step fillet_torus.step blade.step gear.step; do
        set -- "$@" "$root/corpus/$name"
    done
fi
mkdir -p "$folder"
for model in "$@"; do
    name=$(basename "$model")
    for zoom in 1 4 16; do
        for way in mesh exact texture; do
            case $way in
            mesh) mode=(--mode mesh) ;;
            *) mode=(--mode nurbs --trim "$way") ;;
            esac
            "$chordal" render "$model" -o "$folder/${name%.*}-$zoom-$way.png" "${mode[@]}" --zoom "$zoom" --size "$size" --quiet ||
                [ $? = 1 ] # 1: the model has problems, which the program has listed
        done
    done
done
