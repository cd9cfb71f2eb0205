//! `chordal mesh --device` on the command line.

mod common;

use common::{model, run};

/// Without the feature the program says how to get a build that knows GPUs, and writes nothing.
#[cfg(not(feature = "gpu"))]
#[test]
fn a_build_without_gpu_says_how_to_get_one_with() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.stl");
    let ran = run("mesh {} -o {} --device gpu", &[&model("bracket"), &out]).exits(&[2]).says_one_sentence();
    assert!(ran.stderr.contains("--features gpu"), "{}", ran.stderr);
    assert!(!out.exists());
}

/// The adapter is named, the mesh written.
#[cfg(feature = "gpu")]
#[test]
fn a_mesh_is_written_and_the_adapter_named() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.stl");
    let ran = run("mesh {} -o {} --device gpu --tolerance 0.001%", &[&model("spline_ball"), &out]);
    if ran.lacks_gpu() {
        return;
    }
    let ran = ran.exits(&[0]);
    assert!(ran.stderr.contains("dispatches"), "{}", ran.stderr);
    assert!(out.exists());
}
