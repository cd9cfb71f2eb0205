//! Every strategy on the whole corpus: closed where the file is, within tolerance where proven, and made by
//! its own parts.

#![cfg(feature = "methods")]

use chordal::methods::{StrategyEntry, strategies};
use chordal::{Bound, Closedness, MeshOptions, Meshed, Mesher, Model, Report, Tolerance};
use std::path::{Path, PathBuf};

fn corpus(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus").join(name).with_extension("step")
}

fn mesh(name: &str, strategy: &StrategyEntry, bound: Bound) -> Result<Report, String> {
    let options = MeshOptions::default()
        .with_tolerance(Tolerance::Percent(0.5))
        .with_fill_method(strategy.fill_method())
        .with_bound(bound);
    let model = Model::open(corpus(name)).map_err(|e| e.to_string())?;
    Mesher::new(options).mesh(&model).map(Meshed::into_report).map_err(|e| e.to_string())
}

/// Models whose every triangle counts for the time that a test may take.
const SLOW: &[&str] = &["degree_100", "degree_25", "degree_mixed", "weight_range", "weight_negative"];

/// Strategies whose facets cut facets of another face at the coarse tolerance of these tests, although the
/// exact faces do not cut each other, and which refining does not part (crescents, the second of them thinner
/// than the tolerance) or is slow to (blade). The audit finds them; any other crossing fails the test.
const CROSSING: &[(&str, &[&str])] = &[
    ("blade", &["recursive"]),
    ("crescent", &["cells"]),
    ("crescent_thin", &["kd-midpoint", "kd-worst", "binary-midpoint", "binary-worst", "grid", "cells"]),
    ("crescent_thin", &["recursive", "quadtree", "quadtree-eq3"]),
];

/// True where facets of this mesh cross and nothing else is wrong with it.
fn only_crosses_as_known(report: &Report, model: &str, strategy: &str) -> bool {
    let is_known = CROSSING.iter().any(|(name, strategies)| *name == model && strategies.contains(&strategy));
    is_known && !report.clean && report.errors().all(|problem| problem.code == "self-intersections")
}

fn models() -> Vec<String> {
    let index = std::fs::read_to_string(corpus("x").with_file_name("INDEX.tsv")).expect("the corpus");
    index.lines().skip(1).filter_map(|l| l.split('\t').next()).map(str::to_owned).collect()
}

#[test]
fn every_strategy_meshes_what_the_default_meshes() {
    let mut wrong = Vec::new();
    for name in models().iter().filter(|n| !SLOW.contains(&n.as_str())) {
        let Ok(default) = mesh(name, &strategies()[0], Bound::Proven) else { continue };
        if !default.clean {
            continue;
        }
        for entry in strategies().iter().skip(1) {
            match mesh(name, entry, Bound::Proven) {
                Ok(report) if report.clean && report.closedness == default.closedness => {}
                Ok(report) if only_crosses_as_known(&report, name, entry.name) => {}
                Ok(report) => {
                    wrong.push(format!("{name}, {}: {}", entry.name, report.error_sentences().join("; ")))
                }
                Err(error) => wrong.push(format!("{name}, {}: {error}", entry.name)),
            }
        }
    }
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn estimated_meshes_are_closed_too_and_not_larger() {
    for name in ["bracket", "fillet_bspline", "torus_hole", "blade"] {
        for entry in strategies().iter().skip(1) {
            let estimated = mesh(name, entry, Bound::Estimated).expect("a mesh");
            assert!(
                estimated.closedness != Some(Closedness::Leaking),
                "{name}, {}: {:?}",
                entry.name,
                estimated.error_sentences()
            );
            let proven = mesh(name, entry, Bound::Proven).expect("a mesh");
            // A face of which nothing could be proven is the default's.
            let left = proven.stages.iter().any(|s| s.name.starts_with("faces left to the default"));
            assert!(left || estimated.triangles <= proven.triangles, "{name}, {}", entry.name);
        }
    }
}

/// The part that only this strategy has, by its name in the report.
fn own_part(strategy: &str) -> &'static str {
    match strategy {
        "default" => "points in rows",
        "kd-midpoint" => "kd-tree cells, cut half way",
        "kd-worst" => "kd-tree cells, cut at the worst point",
        "binary-midpoint" => "binary cells, cut half way",
        "binary-worst" => "binary cells, cut where they bend most",
        "grid" => "uniform grid cells",
        "cells" => "parts of control cells",
        "recursive" => "recursively halved Bézier patches",
        "quadtree" | "quadtree-eq3" => "quadtree leaves",
        "coving" => "coving triangles",
        "bezier" => "Bézier patches by projected nets",
        "delaunay-uniform" => "uniform fill points",
        "delaunay-adaptive" => "adaptive fill points",
        other => panic!("{other} has no part in this test"),
    }
}

#[test]
fn each_strategy_runs_its_own_parts_and_no_others() {
    let names: Vec<&str> = strategies().iter().map(|e| e.name).collect();
    for entry in strategies() {
        let report = mesh("fillet_bspline", entry, Bound::Proven).expect("a mesh");
        let ran = |part: &str| report.stages.iter().find(|s| s.name == part);
        let own = own_part(entry.name);
        let stage =
            ran(own).unwrap_or_else(|| panic!("{}: {own} did not run: {:?}", entry.name, report.stages));
        assert!(stage.faces > 0 && stage.count > 0);
        for other in names.iter().map(|n| own_part(n)).filter(|&other| other != own) {
            assert!(ran(other).is_none(), "{}: {other} ran", entry.name);
        }
    }
}
