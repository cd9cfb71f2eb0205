#!/usr/bin/env bash
# Builds Chordal for WebAssembly, meshes models of the corpus in node, and compares the meshes with those of the
# program: the same triangles, and the same coordinates but for rounding (apps/wasm/compare.mjs says why).
#
#   tools/wasm-check.sh [--help]
#
# Needs node, and a Rust compiler with the target wasm32-unknown-unknown: `rustup target add
# wasm32-unknown-unknown`, or Debian's packages rustc-web, cargo-web, rust-web-src, rust-web-llvm and lld-22,
# whose compiler builds the standard library itself. Without either it says so and ends with 0; with
# CHORDAL_REQUIRE_WASM=1 that is a failure.
# CHORDAL names the program to compare with; without it, one is built.
set -euo pipefail
cd "$(dirname "$0")/.."

case "${1:-}" in
-h | --help)
    sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "$0"
    exit 0
    ;;
esac

skip() {
    echo "wasm-check: $1; WebAssembly is not checked" >&2
    if [ -n "${CHORDAL_REQUIRE_WASM:-}" ]; then exit 1; fi
    exit 0
}

# Readers keep the module small: STEP only. The stack is that of the main thread of a native program.
target=wasm32-unknown-unknown
flags="-C link-arg=-zstack-size=8388608"
arguments=(--release -p chordal-wasm --target "$target")

command -v node >/dev/null || skip "node is not installed"
if rustc --print target-libdir --target "$target" 2>/dev/null | xargs -I{} test -d {}; then
    RUSTFLAGS="$flags" cargo build -q "${arguments[@]}"
elif [ -d /usr/lib/rustlib/src/rust/library ] && /usr/bin/cargo --version >/dev/null 2>&1; then
    PATH="/usr/bin:$PATH" RUSTC_BOOTSTRAP=1 RUSTC=/usr/bin/rustc RUSTFLAGS="$flags" \
        /usr/bin/cargo build -q "${arguments[@]}" -Zbuild-std=std,panic_abort
else
    skip "no Rust compiler for $target (rustup target add $target)"
fi
module="${CARGO_TARGET_DIR:-target}/$target/release/chordal_wasm.wasm"

if [ -z "${CHORDAL:-}" ]; then
    cargo build -q --release -p chordal-cli
    CHORDAL="${CARGO_TARGET_DIR:-target}/release/chordal"
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
wrong=0
for model in bracket sphere_full torus_full gear blade mapped_items; do
    input="corpus/$model.step"
    "$CHORDAL" mesh "$input" --tolerance 0.1mm -o "$folder/native.ply" --quiet || [ $? = 1 ]
    node apps/wasm/mesh.mjs "$module" "$input" 0.1 "$folder/wasm.ply" || [ $? = 1 ]
    echo -n "$model: "
    node apps/wasm/compare.mjs "$folder/native.ply" "$folder/wasm.ply" || wrong=1
done
echo "module: $(wc -c <"$module") bytes"
exit $wrong
