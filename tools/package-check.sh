#!/usr/bin/env bash
# Packages every crate of the workspace in dependency order, as `cargo publish` would, and builds each one from its
# package. Cargo serves the packages to each other from a local registry, so nothing has to be published first.
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
    cat <<'TEXT'
Usage: tools/package-check.sh [--no-verify] [--allow-dirty]

  --no-verify    package only; do not build the packages (seconds in place of minutes)
  --allow-dirty  also package files with uncommitted changes

Checks that each package holds both licences and a README, and that its Cargo.toml has what crates.io needs.
Exits with 0 if all packages are good.
TEXT
}

options=()
for argument in "$@"; do
    case $argument in
    -h | --help) usage && exit 0 ;;
    --no-verify | --allow-dirty) options+=("$argument") ;;
    *) usage >&2 && exit 2 ;;
    esac
done

# One line per crate: name, then the fields that crates.io asks for or that make a crate findable.
crates=$(cargo metadata --no-deps --format-version 1 | python3 -c '
import json, sys
for package in json.load(sys.stdin)["packages"]:
    if package["publish"] == []:
        continue
    fields = ("description", "license", "repository", "homepage", "readme", "keywords", "categories", "rust_version")
    missing = [field for field in fields if not package[field]]
    print(package["name"], ",".join(missing) or "-")
')
faults=0
while read -r crate missing; do
    if [ "$missing" != - ]; then
        echo "$crate: Cargo.toml lacks $missing" >&2
        faults=1
    fi
    files=$(cargo package --list --package "$crate" --allow-dirty)
    for file in LICENSE-MIT LICENSE-APACHE README.md; do
        if ! grep -qx "$file" <<<"$files"; then
            echo "$crate: the package lacks $file" >&2
            faults=1
        fi
    done
done <<<"$crates"
[ "$faults" = 0 ] || exit 1

cargo package --workspace "${options[@]}"
echo "$(wc -l <<<"$crates") packages are complete"
