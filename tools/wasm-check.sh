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

# The module has all readers. Its stack is that of the main thread of a native program. Without optimisation at link
# time and debug information it is built in half the time, and node compiles it sooner; its results are the same.
export CARGO_PROFILE_RELEASE_LTO=off CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 CARGO_PROFILE_RELEASE_DEBUG=0
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

# The program is that of the README's command, if it is built already.
unset CARGO_PROFILE_RELEASE_LTO CARGO_PROFILE_RELEASE_CODEGEN_UNITS CARGO_PROFILE_RELEASE_DEBUG
if [ -z "${CHORDAL:-}" ]; then
    cargo build -q --release -p chordal-cli
    CHORDAL="${CARGO_TARGET_DIR:-target}/release/chordal"
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# A module has no clock, so the program gets no time limit. Nor does a module have the name of the file, which names
# the part in formats without names: the program reads a copy with the name `model`.
for index in "${!models[@]}"; do
    mkdir "$folder/$index"
    cp -- "${models[index]}" "$folder/$index/model.${models[index]##*.}"
done
inputs() { for index in "${!models[@]}"; do echo "$folder/$index"/model.*; done; }

# natives: meshes all models with the program, one after the other; the exit codes lie beside the meshes.
natives() {
    local input here code
    while read -r input; do
        here=$(dirname "$input")
        code=0
        "$CHORDAL" mesh "$input" --tolerance "${tolerance}mm" --face-timeout 0 -o "$here/native.ply" --quiet \
            2>"$here/native.log" || code=$?
        echo "$code" >"$here/native.code"
    done < <(inputs)
}

# The program and the module work at the same time. The module is compiled once for all models.
natives &
inputs | while read -r input; do printf '%s\t%s\n' "$input" "$(dirname "$input")/wasm.ply"; done |
    node apps/wasm/mesh.mjs "$module" - "$tolerance" >"$folder/codes" 2>"$folder/wasm.log"
wait $!
mapfile -t codes <"$folder/codes"

# compare INDEX: states in one line how the two meshes of a model compare; fails if they differ.
compare() {
    local here="$folder/$1" native wasm=${codes[$1]:-none}
    native=$(cat "$here/native.code")
    if [ "$native" != "$wasm" ]; then
        echo "exit code $native, in WebAssembly $wasm: $(grep -F "$here/" "$folder/wasm.log" | sed 's/.*: //' || true)"
        return 1
    elif [ "$native" = 2 ]; then
        echo "no mesh by either"
    elif cmp "$here/native.ply" "$here/wasm.ply" >"$here/difference" 2>&1; then
        echo "$(wc -c <"$here/native.ply") equal bytes"
    else
        sed "s|$here/||g" "$here/difference"
        return 1
    fi
}

wrong=0
for index in "${!models[@]}"; do
    if line=$(compare "$index"); then
        [ -z "$list" ] || echo "$(basename "${models[index]}"): $line"
    else
        echo "$(basename "${models[index]}"): $line"
        wrong=$((wrong + 1))
    fi
done
echo "$((${#models[@]} - wrong)) of ${#models[@]} models are the same bytes; module: $(wc -c <"$module") bytes"
[ "$wrong" = 0 ]
