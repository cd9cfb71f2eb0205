//! The shape of the source code, checked: which module uses which, and which crate depends on which.
//!
//! 1. Inside a crate, the arrows between the modules of one folder point one way. A module stands for
//!    everything below it: at the top of a crate `edges` is `edges.rs` with all of `edges/`, and inside
//!    `edges/` its files are compared with each other. The parent file is not a node: children may use what
//!    it defines.
//! 2. Between crates, `ARCHITECTURE.md` draws every arrow that a `Cargo.toml` has, directly or over other
//!    arrows.
//!
//! Not seen: methods called on a value whose type comes from elsewhere, and paths made by macros.

mod graph;
mod manifest;
mod modules;
mod tokens;

use graph::Graph;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Crates that depend on each other in a circle once their tests are counted. None may be added.
const TESTS_IN_A_CIRCLE: &[&str] = &[];

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The folder of every crate and program of the workspace, by the folder's name.
fn packages() -> BTreeMap<String, PathBuf> {
    let mut found = BTreeMap::new();
    for group in ["crates", "apps"] {
        let folder = workspace().join(group);
        for entry in std::fs::read_dir(&folder).expect("the workspace has this folder").flatten() {
            if entry.path().join("Cargo.toml").exists() {
                found.insert(entry.file_name().to_string_lossy().into_owned(), entry.path());
            }
        }
    }
    assert!(found.len() > 10, "the packages of the workspace are not found");
    found
}

/// Each folder of a package whose modules form cycles, with one paragraph for each cycle.
fn cycles_between_modules(name: &str, package: &Path) -> BTreeMap<String, Vec<String>> {
    let mut found = BTreeMap::new();
    for root in
        ["src/lib.rs", "src/main.rs"].map(|root| package.join(root)).iter().filter(|root| root.exists())
    {
        for (folder, graph) in modules::read(root).folders() {
            let cycles = graph.cycles();
            if !cycles.is_empty() {
                let full: Vec<&str> =
                    std::iter::once(name).chain(folder.iter().map(String::as_str)).collect();
                found.insert(full.join("/"), cycles);
            }
        }
    }
    found
}

#[test]
fn no_module_cycle_inside_a_crate() {
    let mut found = BTreeMap::new();
    for (name, folder) in packages() {
        found.extend(cycles_between_modules(&name, &folder));
    }
    let faults: Vec<String> = found
        .iter()
        .map(|(folder, cycles)| {
            format!("{folder}: modules use each other in a circle\n{}", cycles.join("\n"))
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_arrow_between_crates_is_drawn() {
    let text =
        std::fs::read_to_string(workspace().join("ARCHITECTURE.md")).expect("ARCHITECTURE.md is there");
    let drawn = manifest::drawn(&text);
    let mut faults = Vec::new();
    for (name, folder) in packages() {
        if !drawn.contains_key(&name) {
            faults.push(format!("{name} is not in the tree of ARCHITECTURE.md"));
            continue;
        }
        let reachable = manifest::reachable(&drawn, &name);
        for other in manifest::dependencies(&folder.join("Cargo.toml"), manifest::Kind::Normal) {
            if !reachable.contains(&other) {
                faults.push(format!("{name} → {other} is in Cargo.toml and not drawn in ARCHITECTURE.md"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// `cargo package` refuses crates that need each other, even if only their tests do.
#[test]
fn crates_with_their_tests_are_in_no_circle() {
    let mut graph = Graph::default();
    for (name, folder) in packages() {
        for kind in [manifest::Kind::Normal, manifest::Kind::Development] {
            for other in manifest::dependencies(&folder.join("Cargo.toml"), kind) {
                graph.add(&name, &other, "Cargo.toml");
            }
        }
    }
    let circles = graph.components();
    let found: BTreeSet<&str> = circles.iter().flatten().map(String::as_str).collect();
    let known: BTreeSet<&str> = TESTS_IN_A_CIRCLE.iter().copied().collect();
    assert_eq!(found, known, "{}", graph.cycles().join("\n"));
}

/// Lines of the default mesher: a reader must be able to read it in a few days. What grows past this belongs
/// in a crate of its own, as `chart` is. Counted as `wc -l` counts, with comments and blank lines, but
/// without the tests at the ends of the files.
const MOST_LINES_OF_THE_MESHER: usize = 8_000;

#[test]
fn the_default_mesher_stays_small() {
    let lines = lines_below(&workspace().join("crates/tessellate/src"));
    assert!(lines > 1_000, "the sources of the mesher are not found");
    assert!(lines < MOST_LINES_OF_THE_MESHER, "crates/tessellate/src has {lines} lines");
}

/// Lines of all Rust files in a folder and below it, without the tests at their ends.
fn lines_below(folder: &Path) -> usize {
    let entries = std::fs::read_dir(folder).expect("the folder can be read").flatten();
    let lines = |path: PathBuf| {
        if path.is_dir() {
            return lines_below(&path);
        }
        let is_rust = path.extension().is_some_and(|e| e == "rs");
        let count = || {
            let text = std::fs::read_to_string(&path).expect("the file can be read");
            text.lines().take_while(|line| *line != "#[cfg(test)]").count()
        };
        if is_rust { count() } else { 0 }
    };
    entries.map(|entry| lines(entry.path())).sum()
}

#[test]
fn a_cycle_put_in_by_hand_is_found() {
    let mut graph = Graph::default();
    graph.add("edges", "faces", "edges.rs");
    graph.add("faces", "proof", "faces.rs");
    assert!(graph.cycles().is_empty(), "a chain is no cycle");
    graph.add("proof", "edges", "proof.rs");
    assert_eq!(graph.components(), [vec!["edges".to_owned(), "faces".into(), "proof".into()]]);
    assert!(graph.cycles()[0].contains("proof → edges (proof.rs)"));
}

/// Writes the files of a small crate and returns the cycles between its modules.
fn cycles_of(files: &[(&str, &str)]) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in files {
        let path = folder.path().join("src").join(name);
        std::fs::create_dir_all(path.parent().expect("a file is in a folder")).expect("a folder is made");
        std::fs::write(path, text).expect("a file is written");
    }
    cycles_between_modules("small", folder.path()).into_values().flatten().collect()
}

#[test]
fn a_cycle_in_sources_is_found() {
    let root = "mod one;\nmod two;\npub use two::Two;\n";
    let clean = cycles_of(&[
        ("lib.rs", root),
        ("one.rs", "// use crate::two::Two;\nconst TEXT: &str = \"crate::two::Two\";\npub struct One;\n"),
        ("two.rs", "use crate::one::One;\npub struct Two(One);\n"),
    ]);
    assert!(clean.is_empty(), "comments and strings are not code: {clean:?}");
    let tests_only = cycles_of(&[
        ("lib.rs", root),
        ("one.rs", "pub struct One;\n#[cfg(test)]\nmod tests {\n    use crate::two::Two;\n}\n"),
        ("two.rs", "use crate::one::One;\npub struct Two(One);\n"),
    ]);
    assert!(tests_only.is_empty(), "tests are no arrows: {tests_only:?}");
    let uses: [(&str, &str); 4] = [
        ("a use", "use crate::two::Two;\npub struct One;\n"),
        ("a path in code", "pub struct One;\nfn f() -> usize { size_of::<super::two::Two>() }\n"),
        ("a group", "use crate::{two::{Two}};\npub struct One;\n"),
        ("an item of the root that comes from another module", "use crate::Two;\npub struct One;\n"),
    ];
    for (what, one) in uses {
        let found = cycles_of(&[
            ("lib.rs", root),
            ("one.rs", one),
            ("two.rs", "use crate::one::One;\npub struct Two(One);\n"),
        ]);
        assert_eq!(found.len(), 1, "{what} is an arrow");
        assert!(found[0].contains("one → two (one.rs"), "{}", found[0]);
    }
    let below = cycles_of(&[
        ("lib.rs", "mod folder;\n"),
        ("folder/mod.rs", "mod a;\nmod b;\n"),
        ("folder/a.rs", "use super::b::B;\npub struct A;\n"),
        ("folder/b.rs", "use super::a::A;\npub struct B;\n"),
    ]);
    assert_eq!(below.len(), 1, "the files of a folder are compared with each other");
}

#[test]
fn an_arrow_that_is_not_drawn_is_found() {
    let text = "```text\ncrates/\n  base/    uses none of ours   points\n  mid/     → \
        base   more\n  top/     → mid, far-off   x\n```\n";
    let drawn = manifest::drawn(text);
    let of = |name: &str| manifest::reachable(&drawn, name).into_iter().collect::<Vec<_>>();
    assert_eq!(of("top"), ["base", "far-off", "mid"]);
    assert_eq!(of("mid"), ["base"]);
    assert!(of("base").is_empty());
}
