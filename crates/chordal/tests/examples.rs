//! The examples run, and the shortest one stays short.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where `cargo test` puts the examples: beside the folder of the tests.
fn built(name: &str) -> PathBuf {
    let test = env::current_exe().expect("the path of this test");
    let folder = test.ancestors().nth(2).expect("the folder of the profile").join("examples");
    folder.join(name).with_extension(env::consts::EXE_EXTENSION)
}

#[test]
fn every_example_runs() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let sources = std::fs::read_dir(folder).expect("the examples");
    let mut names: Vec<String> = sources
        .map(|entry| entry.expect("an example").path())
        .filter(|path| path.extension().is_some_and(|e| e == "rs"))
        .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert!(names.len() >= 6, "{names:?}");
    if names.iter().any(|name| !built(name).exists()) {
        // A test that is run alone does not build them.
        let cargo =
            Command::new(env!("CARGO")).args(["build", "--quiet", "-p", "chordal", "--examples"]).status();
        assert!(cargo.expect("cargo").success());
    }
    for name in names {
        let ran = Command::new(built(&name)).output().expect("the example starts");
        let (out, err) = (String::from_utf8_lossy(&ran.stdout), String::from_utf8_lossy(&ran.stderr));
        assert!(ran.status.success() && !out.is_empty(), "{name}: {err}");
    }
}

/// From bytes to triangles with face ids and parameters in at most 25 lines.
#[test]
fn the_shortest_example_is_short() {
    let source = include_str!("../examples/triangles.rs");
    assert!(source.lines().count() <= 25);
    for word in ["from_bytes", "triangle.face", "triangle.uv"] {
        assert!(source.contains(word), "{word}");
    }
}
