#!/usr/bin/env bash
# Draws the three pictures of README.md: the exact surfaces of a bracket, its mesh, and the error of the mesh.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

if [ $# -gt 0 ]; then
    echo "Usage: tools/readme_pictures.sh"
    echo "Writes docs/pictures/bracket_{exact,mesh,error}.png."
    echo "CHORDAL names the program, built with the feature \`gpu\` [default: target/release/chordal]."
    case $1 in -h | --help) exit 0 ;; *) exit 2 ;; esac
fi

draw() { # draw NAME OPTION…
    "${CHORDAL:-$root/target/release/chordal}" render "$root/corpus/bracket.step" \
        -o "$root/docs/pictures/bracket_$1.png" --size 420x340 --background '#ffffff' --quiet "${@:2}"
}
draw exact --mode nurbs
draw mesh --style wireframe --tolerance 0.1%
draw error --style error --tolerance 0.1%
