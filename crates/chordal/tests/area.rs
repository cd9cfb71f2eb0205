//! The area of meshes against closed forms.

#![cfg(feature = "methods")]

use chordal::methods::strategy_named;
use chordal::{MeshOptions, Mesher, Model, Tolerance};
use std::f64::consts::PI;
use std::path::Path;

/// A sphere of radius 10, a torus of radii 20 and 6.
const AREAS: [(&str, f64); 2] =
    [("sphere_full", 4.0 * PI * 100.0), ("torus_full", 4.0 * PI * PI * 20.0 * 6.0)];

fn area(name: &str, strategy: &str, percent: f64) -> f64 {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus").join(name).with_extension("step");
    let fill = strategy_named(strategy).expect("a known name").fill_method();
    let options = MeshOptions::default().with_tolerance(Tolerance::Percent(percent)).with_fill_method(fill);
    let model = Model::open(path).expect("a model");
    Mesher::new(options).mesh(&model).expect("a mesh").report().area
}

#[test]
fn areas_of_spheres_and_tori_come_nearer_to_the_exact_ones() {
    for (name, exact) in AREAS {
        for strategy in ["default", "bezier"] {
            let [coarse, fine] =
                [1.0, 0.05].map(|percent| (area(name, strategy, percent) / exact - 1.0).abs());
            assert!(fine < 3e-3 && fine < coarse, "{name}, {strategy}: {coarse:.2e} {fine:.2e}");
        }
    }
}
