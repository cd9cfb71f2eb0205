#!/usr/bin/env bash
# Builds the Python package into a clean virtual environment and tests it there: pytest, mypy, the snippets of
# docs/python.md, the same bytes as the command line.
#
#   tools/python-check.sh [--help | --release] [PYTEST_ARGUMENT…]
#
# With --release, the wheel is built as it is published, and may have at most 4 MB; without, it is built
# without the slow optimisations.
#
# Needs Python 3.10 or later with venv, and packages from PyPI. Where they cannot be had it says so and ends
# with 0; with CHORDAL_REQUIRE_PYTHON=1 that is a failure.
# CHORDAL_BINARY names a program `chordal` to compare with; without it, that in the wheel is used.
# KEEP names a folder for the environment, which is used again; without it, a temporary one is made.
set -euo pipefail

profile=quick
case "${1:-}" in
-h | --help)
    sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "$0"
    exit 0
    ;;
--release)
    profile=release
    shift
    ;;
esac
cd "$(dirname "$0")/.."

# The most bytes of a published wheel.
limit=4000000

skip() {
    echo "python-check: $*" >&2
    [ -z "${CHORDAL_REQUIRE_PYTHON:-}" ] || exit 1
    exit 0
}

command -v python3 >/dev/null || skip "Python is missing, so its package is not tested"
python3 -c 'import sys; sys.exit(sys.version_info < (3, 10))' ||
    skip "Python is older than 3.10, so its package is not tested"

folder=${KEEP:-$(mktemp -d)}
[ -n "${KEEP:-}" ] || trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder"

# A system's Python may lack the part that fills environments with pip.
new_environment() { python3 -m venv --clear "$1" >/dev/null 2>&1; }
new_environment "$folder/clean" || skip "python3 cannot make virtual environments (package python3-venv)"
python=$folder/clean/bin/python
export PIP_DISABLE_PIP_VERSION_CHECK=1

if [ ! -x "$folder/tools/bin/maturin" ]; then
    new_environment "$folder/tools"
    "$folder/tools/bin/pip" install --quiet --retries 1 'maturin>=1.9,<2' 'mypy>=1.15' >/dev/null 2>&1 ||
        skip "pip reaches no packages, so the Python package is not tested"
fi
manifest=apps/python/Cargo.toml
cargo fmt --check --manifest-path $manifest
rm -rf "$folder/wheels"
"$folder/tools/bin/maturin" build --quiet --locked --profile $profile --manifest-path $manifest \
    --out "$folder/wheels" --interpreter "$python"
wheel=$(echo "$folder"/wheels/*.whl)
bytes=$(wc -c <"$wheel")
echo "python-check: $(basename "$wheel") has $bytes bytes (limit of a release: $limit)"
[ $profile != release ] || [ "$bytes" -le $limit ] || { echo "python-check: that is too large" >&2; exit 1; }

"$python" -m pip install --quiet "$wheel"
"$python" -m pip check
"$python" -m pip list --format=freeze | grep -v '^\(pip\|setuptools\|wheel\)=' | sed 's/=.*//' | sort |
    diff - <(printf 'chordal\nnumpy\n') || { echo "python-check: numpy is not the only dependency" >&2; exit 1; }
"$python" -m pip install --quiet pytest 'mypy>=1.15' types-networkx
# Tests with these packages are skipped where there is none for this platform.
for package in trimesh meshio geomdl networkx cadquery-ocp; do
    "$python" -m pip install --quiet --only-binary :all: $package ||
        echo "python-check: no $package here, its tests are skipped"
done
cd apps/python
"$python" -m pytest -q -p no:cacheprovider "$@"
