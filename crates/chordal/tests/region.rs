//! The right part of every surface: each model of `corpus/region` and `corpus/charts` has its area by
//! construction.

use chordal::{MeshOptions, Mesher, Model, Tolerance};
use std::path::{Path, PathBuf};

/// Windows and bands are cut into chords: at the tolerances below their areas are this near to the exact
/// ones.
const NEAR: f64 = 0.01;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpus").join(name)
}

/// (name, area) of every model of a folder.
fn models(folder: &Path) -> Vec<(String, f64)> {
    let index = std::fs::read_to_string(folder.join("INDEX.tsv")).expect("an index");
    let row = |line: &str| {
        let columns: Vec<&str> = line.split('\t').collect();
        (columns[0].to_owned(), columns[2].parse().expect("an area"))
    };
    index.lines().skip(1).map(row).collect()
}

#[test]
fn every_face_has_its_area() {
    check_areas(&folder("region"), 10);
}

/// Closed surfaces are cut open between holes of every shape, and no cut crosses a loop.
#[test]
fn every_closed_face_with_holes_has_its_area() {
    check_areas(&folder("charts"), 30);
}

fn check_areas(folder: &Path, least: usize) {
    let models = models(folder);
    assert!(models.len() > least, "{models:?}");
    let mut faults = Vec::new();
    for (name, area) in models {
        for share in [0.001, 0.0002] {
            let path = folder.join(&name);
            let options = MeshOptions::default().with_tolerance(Tolerance::Percent(100.0 * share));
            let report = match Model::open(path).and_then(|model| Mesher::new(options).mesh(&model)) {
                Ok(meshed) => meshed.into_report(),
                Err(error) => {
                    faults.push(format!("{name} at {share}: {error}"));
                    continue;
                }
            };
            if !report.clean {
                faults.push(format!("{name} at {share}: {:?}", report.error_sentences()));
            }
            if (report.area - area).abs() > NEAR * area {
                faults.push(format!("{name} at {share}: an area of {} for {area}", report.area));
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// The face between two edges that coincide is listed, and its neighbours close through it.
#[test]
fn a_face_without_area_is_listed_and_the_solid_is_watertight() {
    let path = folder("region").join("sliver_on_edge.step");
    let report = Mesher::default().mesh(&Model::open(path).expect("a model")).expect("a mesh").into_report();
    assert!(report.clean, "{:?}", report.error_sentences());
    assert_eq!(report.faces.zero_area, 1);
    assert_eq!((report.shells.closed, report.shells.leaking), (1, 0));
}

/// A fillet about as wide as the tolerance: chords of its rims that fold facets are made finer together, else
/// they take more rounds than there are.
#[test]
fn a_fillet_is_proven_at_every_coarse_tolerance() {
    let model = Model::open(folder("region").join("fillet_thin.step")).expect("a model");
    for tolerance in [0.6, 0.75, 0.914_162_843_853_344_6, 1.0, 1.2] {
        let options = MeshOptions::default().with_tolerance(Tolerance::Millimetres(tolerance));
        let report = Mesher::new(options).mesh(&model).expect("a mesh").into_report();
        assert!(report.clean, "{tolerance} mm: {:?}", report.error_sentences());
    }
}
