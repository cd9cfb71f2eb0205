#!/usr/bin/env bash
# Mesa's GLU NURBS on the scenes of `gpu-bench surfaces`: frames a second, as a table in Markdown. Needs a C compiler, GLU and
# OSMesa with their headers; installs the latter two as root on Debian and Ubuntu, else says what to install.
set -euo pipefail
cd "$(dirname "$0")/.."

usage="Usage: tools/glu_bench.sh GPU_BENCH [WIDTH HEIGHT]

GPU_BENCH is the program gpu-bench of crates/gpu. Prints frames per second of Mesa's GLU NURBS as a table in Markdown."
case ${1:-} in
-h | --help) echo "$usage" && exit 0 ;;
'') echo "$usage" >&2 && exit 2 ;;
esac
bench=$1
width=${2:-640}
height=${3:-480}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

build() { cc -O2 -std=c11 -D_POSIX_C_SOURCE=199309L tools/glu_bench.c -o "$work/glu_bench" -lGLU -lOSMesa -lm 2>"$work/cc.log"; }
if ! build; then
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
        apt-get update -qq
        DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends libglu1-mesa-dev libosmesa6-dev >/dev/null
    fi
    if ! build; then
        cat "$work/cc.log" >&2
        echo "NOT MEASURED: install a C compiler, GLU and OSMesa (Debian: apt-get install gcc libglu1-mesa-dev libosmesa6-dev)" >&2
        exit 1
    fi
fi

echo "| surfaces | frames/s, its own half pixel | frames/s, as many points as ours, four samples a pixel |"
echo "|---|---|---|"
# The steps are those that `gpu-bench surfaces` takes on the average at 640 × 480; four samples are a picture twice as wide and high.
for scene in 3:30 30:22 300:15 3000:10 30000:8; do
    count=${scene%:*} steps=${scene#*:}
    "$bench" --scene "$count" "$work/scene.txt"
    read -r _ _ _ seconds rate _ < <("$work/glu_bench" "$work/scene.txt" "$width" "$height" 0 ${GLU_BENCH_PICTURES:+"$GLU_BENCH_PICTURES.$count.ppm"})
    read -r _ _ _ slow fine _ < <("$work/glu_bench" "$work/scene.txt" $((2 * width)) $((2 * height)) "$steps")
    echo "| $count | $rate | $fine |"
    if awk -v a="$seconds" -v b="$slow" 'BEGIN { exit !(a > 10 || b > 10) }'; then
        echo
        echo "A frame took more than 10 s: larger scenes are left out."
        break
    fi
done
