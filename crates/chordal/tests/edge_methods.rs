//! Every edge method on the whole corpus: what is clean with the default's chords is clean with any.

#![cfg(feature = "methods")]

use chordal::methods::{EdgeMethodEntry, edge_method_named, edge_methods};
use chordal::{MeshOptions, Meshed, Mesher, Model, Report, Tolerance};
use std::path::{Path, PathBuf};

fn corpus(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus").join(name).with_extension("step")
}

fn mesh(name: &str, percent: f64, method: &EdgeMethodEntry) -> Result<Report, String> {
    let options = MeshOptions::default()
        .with_tolerance(Tolerance::Percent(percent))
        .with_edge_splitter(method.edge_splitter());
    let model = Model::open(corpus(name)).map_err(|e| e.to_string())?;
    Mesher::new(options).mesh(&model).map(Meshed::into_report).map_err(|e| e.to_string())
}

/// Where another method's mesh is not as clean as the default's.
fn faults(name: &str, percent: f64, methods: &[&str]) -> Vec<String> {
    let Ok(default) = mesh(name, percent, &edge_methods()[0]) else { return Vec::new() };
    if !default.clean {
        return Vec::new();
    }
    let fault = |method: &&str| {
        let of_name = edge_method_named(method).expect("a known name");
        match mesh(name, percent, of_name) {
            Ok(report) if report.clean && report.closedness == default.closedness => None,
            Ok(report) => Some(format!("{name}, {method}: {}", report.error_sentences().join("; "))),
            Err(error) => Some(format!("{name}, {method}: {error}")),
        }
    };
    methods.iter().filter_map(fault).collect()
}

fn models() -> Vec<String> {
    let index = std::fs::read_to_string(corpus("x").with_file_name("INDEX.tsv")).expect("the corpus");
    index.lines().skip(1).filter_map(|l| l.split('\t').next()).map(str::to_owned).collect()
}

/// Many chords of the plane of parameters meet in a pole of `no_pcurves`; one long chord runs along a side of
/// `spline_forms` over which the face turns to and fro; weights of `weight_range` differ by a million.
#[test]
fn chords_that_know_nothing_of_their_faces_do_no_harm() {
    let methods: Vec<&str> = edge_methods().iter().map(|e| e.name).collect();
    let wrong: Vec<String> =
        ["no_pcurves", "spline_forms"].iter().flat_map(|name| faults(name, 0.1, &methods)).collect();
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn every_edge_method_meshes_what_the_default_meshes() {
    const SLOW: &[&str] = &["degree_100", "degree_25", "degree_mixed"];
    let all = models();
    let fast = all.iter().filter(|n| !SLOW.contains(&n.as_str()));
    let wrong: Vec<String> =
        fast.flat_map(|name| faults(name, 0.5, &["bezier2d", "bezier3d", "bezier3d-worst-point"])).collect();
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}
