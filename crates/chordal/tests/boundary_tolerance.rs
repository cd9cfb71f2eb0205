//! Separate tolerances for edges and facets: each is kept, by every strategy, and the mesh stays closed.

#![cfg(feature = "methods")]

use chordal::methods::{StrategyEntry, strategies};
use chordal::{Closedness, MeshOptions, Mesher, Model, Report, Tolerance};
use std::path::Path;

fn mesh(name: &str, strategy: &StrategyEntry, inside: f64, boundary: Option<f64>) -> Report {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus").join(name).with_extension("step");
    let options = MeshOptions::default()
        .with_angle(None)
        .with_tolerance(Tolerance::Percent(inside))
        .with_boundary_tolerance(boundary.map(Tolerance::Percent))
        .with_fill_method(strategy.fill_method());
    let model = Model::open(path).expect("a model");
    Mesher::new(options).mesh(&model).expect("a mesh").into_report()
}

const MODELS: [&str; 4] = ["bracket", "fillet_torus", "blade", "sphere_side_cut"];

#[test]
fn finer_edges_leave_the_inside_as_coarse_as_asked() {
    for name in MODELS {
        for entry in strategies() {
            let plain = mesh(name, entry, 0.5, None);
            let fine = mesh(name, entry, 0.5, Some(0.05));
            let asked = &fine.options;
            assert!(fine.errors().next().is_none(), "{name}, {}: {:?}", entry.name, fine.error_sentences());
            assert!((asked.tolerance - 10.0 * asked.boundary_tolerance).abs() < 1e-9 * asked.tolerance);
            assert!(fine.boundary_error <= Some(asked.boundary_tolerance), "{name}, {}", entry.name);
            assert!(fine.proven_error <= Some(asked.tolerance), "{name}, {}", entry.name);
            assert!(
                plain.boundary_error > Some(asked.boundary_tolerance),
                "{name}: there is something to do"
            );
            // Uniform grids may have been halved as a whole for the sake of a coarse edge.
            let more = fine.triangles > plain.triangles;
            assert!(more || entry.strategy.is_some(), "{name}, {}", entry.name);
        }
    }
}

#[test]
fn coarser_edges_save_triangles_and_facets_away_from_them_keep_their_tolerance() {
    for name in MODELS {
        let fine = mesh(name, &strategies()[0], 0.05, None);
        let coarse = mesh(name, &strategies()[0], 0.05, Some(0.5));
        let asked = &coarse.options;
        assert!(
            coarse.clean && coarse.closedness == Some(Closedness::Closed),
            "{name}: {:?}",
            coarse.error_sentences()
        );
        assert!(coarse.boundary_error <= Some(asked.boundary_tolerance), "{name}");
        assert!(coarse.proven_error <= Some(asked.boundary_tolerance), "{name}");
        assert!(coarse.triangles < fine.triangles, "{name}: {} {}", coarse.triangles, fine.triangles);
    }
}

#[test]
fn the_same_tolerance_twice_is_the_same_mesh() {
    let one = mesh("bracket", &strategies()[0], 0.1, None);
    let two = mesh("bracket", &strategies()[0], 0.1, Some(0.1));
    assert_eq!((one.triangles, one.proven_error), (two.triangles, two.proven_error));
    assert_eq!(one.options.boundary_tolerance, one.options.tolerance);
}
