#!/usr/bin/env bash
# Builds Chordal for WebAssembly, meshes models in node, and compares the meshes with those of the program: the PLY
# files must be equal, byte for byte, and the exit codes, too.
#
#   tools/wasm-check.sh [--help | --list] [TOLERANCE_MM] [MODEL…]
#
# Without models: all models of the corpus, in every format, but those that are broken on purpose. The tolerance
# is 0.1 mm unless the first argument is a number.
# With --list, it prints a line for every model, not only for those that differ.
#
# Needs node, and a Rust compiler with the target wasm32-unknown-unknown: `rustup target add
# wasm32-unknown-unknown`, or Debian's packages rustc-web, cargo-web, rust-web-src, rust-web-llvm and lld-22,
# whose compiler builds the standard library itself. Without either it says so and ends with 0; with
# CHORDAL_REQUIRE_WASM=1 that is a failure.
# CHORDAL names the program to compare with; without it, one is built. MODULE names a module that exists already.
set -euo pipefail

list=
case "${1:-}" in
-h | --help)
    sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "$0"
    exit 0
    ;;
--list)
    list=yes
    shift
    ;;
esac
tolerance=0.1
if [[ ${1:-} =~ ^[0-9.]+$ ]]; then
    tolerance=$1
    shift
fi
models=()
for model in "$@"; do
    models+=("$(realpath -- "$model")")
done
cd "$(dirname "$0")/.."
if [ ${#models[@]} = 0 ]; then
    for model in corpus/*.step corpus/{brep,exchange,iges,iv,region,x3d}/*.*; do
        [[ $model == *.tsv ]] || models+=("$model")
    done
fi

skip() {
    echo "wasm-check: $1; WebAssembly is not checked" >&2
    if [ -n "${CHORDAL_REQUIRE_WASM:-}" ]; then exit 1; fi
    exit 0
}

# The module has all readers. Its stack is that of the main thread of a native program.
target=wasm32-unknown-unknown
flags="-C link-arg=-zstack-size=8388608"
arguments=(--release -p chordal-wasm --target "$target")

command -v node >/dev/null || skip "node is not installed"
if [ -n "${MODULE:-}" ]; then
    module=$MODULE
elif rustc --print target-libdir --target "$target" 2>/dev/null | xargs -I{} test -d {}; then
    RUSTFLAGS="$flags" cargo build -q "${arguments[@]}"
elif [ -d /usr/lib/rustlib/src/rust/library ] && /usr/bin/cargo --version >/dev/null 2>&1; then
    PATH="/usr/bin:$PATH" RUSTC_BOOTSTRAP=1 RUSTC=/usr/bin/rustc RUSTFLAGS="$flags" \
        /usr/bin/cargo build -q "${arguments[@]}" -Zbuild-std=std,panic_abort
else
    skip "no Rust compiler for $target (rustup target add $target)"
fi
module=${module:-${CARGO_TARGET_DIR:-target}/$target/release/chordal_wasm.wasm}

if [ -z "${CHORDAL:-}" ]; then
    cargo build -q --release -p chordal-cli
    CHORDAL="${CARGO_TARGET_DIR:-target}/release/chordal"
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# compare MODEL: says in one line how the two meshes compare; fails where they differ. A module has no clock, so the
# program gets no time limit either. Nor does a module know the name of the file, which names the part where a format
# has no names: the program reads it as `model`.
compare() {
    local native=0 wasm=0 input="$folder/model.${1##*.}"
    rm -f "$folder"/*
    cp -- "$1" "$input"
    "$CHORDAL" mesh "$input" --tolerance "${tolerance}mm" --face-timeout 0 -o "$folder/native.ply" --quiet \
        2>"$folder/native.log" || native=$?
    node apps/wasm/mesh.mjs "$module" "$input" "$tolerance" "$folder/wasm.ply" 2>"$folder/wasm.log" || wasm=$?
    if [ "$native" != "$wasm" ]; then
        echo "exit code $native, in WebAssembly $wasm: $(tail -n 1 "$folder/wasm.log")"
        return 1
    elif [ "$native" = 2 ]; then
        echo "no mesh by either"
    elif cmp "$folder/native.ply" "$folder/wasm.ply" >"$folder/difference" 2>&1; then
        echo "$(wc -c <"$folder/native.ply") equal bytes"
    else
        sed "s|$folder/||g" "$folder/difference"
        return 1
    fi
}

wrong=0
for model in "${models[@]}"; do
    if line=$(compare "$model"); then
        [ -z "$list" ] || echo "$(basename "$model"): $line"
    else
        echo "$(basename "$model"): $line"
        wrong=$((wrong + 1))
    fi
done
echo "$((${#models[@]} - wrong)) of ${#models[@]} models are the same bytes; module: $(wc -c <"$module") bytes"
[ "$wrong" = 0 ]
