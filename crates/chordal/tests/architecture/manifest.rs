//! The arrows between crates: those of `Cargo.toml`, and those that `ARCHITECTURE.md` draws.
//!
//! The drawing is the first block of preformatted text in `ARCHITECTURE.md`. A line of it starts with the
//! name of a folder and `/`, then either `uses none of ours` or `→` and names with commas between them (`all
//! above` stands for every crate of an earlier line, and a word `only` behind a name has no meaning). Two
//! spaces end the list.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Which tables of a `Cargo.toml` are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Normal,
    Development,
}

/// The crates of this workspace that a `Cargo.toml` names, by the names of their folders.
pub fn dependencies(file: &Path, kind: Kind) -> BTreeSet<String> {
    let text = std::fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let mut found = BTreeSet::new();
    let mut is_read = false;
    for line in text.lines().map(str::trim) {
        if let Some(table) = line.strip_prefix('[') {
            let table = table.trim_end_matches(']');
            is_read = match kind {
                Kind::Normal => table.ends_with("dependencies") && !table.ends_with("dev-dependencies"),
                Kind::Development => table.ends_with("dev-dependencies"),
            };
            continue;
        }
        let name = line.split(['.', '=', ' ']).next().unwrap_or_default();
        if is_read && name.starts_with("chordal") {
            found.insert(name.strip_prefix("chordal-").unwrap_or(name).to_owned());
        }
    }
    found
}

/// The arrows in the drawing, by the names of folders.
pub fn drawn(architecture: &str) -> BTreeMap<String, BTreeSet<String>> {
    let mut arrows: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let block = architecture.split("```").nth(1).unwrap_or_default();
    for line in block.lines() {
        let Some((name, rest)) = line.trim().split_once('/') else { continue };
        let rest = rest.trim();
        let mut uses = BTreeSet::new();
        if let Some(list) = rest.strip_prefix('→') {
            let list = list.trim_start().split("  ").next().unwrap_or_default();
            for other in list.split(',').map(|other| other.trim().trim_end_matches(" only")) {
                match other {
                    "all above" => uses.extend(arrows.keys().cloned()),
                    _ => {
                        uses.insert(other.to_owned());
                    }
                }
            }
        } else if !rest.starts_with("uses none of ours") {
            continue;
        }
        arrows.insert(name.trim().to_owned(), uses);
    }
    arrows
}

/// All crates that can be reached along the drawn arrows.
pub fn reachable(drawn: &BTreeMap<String, BTreeSet<String>>, from: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(name) = open.pop() {
        for next in drawn.get(name).into_iter().flatten() {
            if found.insert(next.clone()) {
                open.push(next);
            }
        }
    }
    found
}
