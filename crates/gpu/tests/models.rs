//! Every spline surface of the models, all of a model in one dispatch, on the device and by the twins.
//!
//! The models are no part of the repository: `CHORDAL_MODELS` names their folder (default `../shared/models` next to it).

mod common;

use chordal::brep::FaceGeometry;
use chordal::nurbs::{DVec2, DVec3, NurbsSurface, Surface};
use chordal_gpu::{Evaluator, Request, Samples, Search, SurfaceSet, Variant, Wanted, evaluate_twin};
use common::gpu;
use std::path::{Path, PathBuf};

/// Larger files take long to read in a test.
const LARGEST_FILE: u64 = 1_500_000;

fn files() -> Vec<PathBuf> {
    let folder = std::env::var_os("CHORDAL_MODELS")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models"), PathBuf::from);
    let mut found = Vec::new();
    for kind in ["step", "iges", "3dm", "iv", "json", "obj", "brep"] {
        let Ok(entries) = std::fs::read_dir(folder.join(kind)) else { continue };
        let small = |path: &PathBuf| path.metadata().is_ok_and(|m| m.len() <= LARGEST_FILE);
        found.extend(entries.flatten().map(|e| e.path()).filter(small));
    }
    found.sort();
    found
}

fn spline_surfaces(path: &Path) -> Vec<NurbsSurface> {
    let Ok(model) = chordal::read_model(path) else { return Vec::new() };
    let faces = model.parts.iter().flat_map(|p| &p.faces);
    faces
        .filter_map(|face| match &face.geometry {
            FaceGeometry::Surface(surface) => match surface.as_ref() {
                Surface::Nurbs(nurbs) => Some(nurbs.clone()),
                _ => None,
            },
            FaceGeometry::Failed(_) => None,
        })
        .collect()
}

#[test]
fn surfaces_of_models_keep_the_bound() {
    let files = files();
    if files.is_empty() {
        eprintln!("NOT TESTED: no models here (CHORDAL_MODELS)");
        return;
    }
    let evaluators = [Variant::Packed, Variant::Direct, Variant::Bernstein]
        .map(|v| (v, Evaluator::new(gpu(), v, Search::Host).unwrap()));
    let (mut count, mut worst) = (0, 0.0_f64);
    for path in files {
        let surfaces = spline_surfaces(&path);
        if surfaces.is_empty() {
            continue;
        }
        let mut set = SurfaceSet::<f32>::with_bezier();
        surfaces.iter().for_each(|s| {
            set.push_surface(s);
        });
        let requests: Vec<_> = (0..set.len()).map(|i| Request::even_grid(&set, i, 5, 6)).collect();
        let samples = Samples::new(&set, &requests).unwrap();
        for (variant, evaluator) in &evaluators {
            let found = evaluator.evaluate(gpu(), &set, &samples, Wanted::Points).unwrap().values;
            let twin = evaluate_twin(&set, &samples, *variant, Wanted::Points, Search::Host).unwrap();
            for (index, (surface, request)) in surfaces.iter().zip(&requests).enumerate() {
                let Request::Grid { us, vs, .. } = request else { unreachable!() };
                let entry = &set.entries()[index];
                let uvs = us.iter().flat_map(|&u| vs.iter().map(move |&v| DVec2::new(u, v)));
                for (k, uv) in samples.range(index).zip(uvs) {
                    for values in [&found, &twin] {
                        let local = DVec3::from_slice(&[0, 1, 2].map(|c| f64::from(values[3 * k + c])));
                        let p = entry.frame.middle + local * entry.frame.size;
                        let ratio = p.distance(surface.point(uv)) / entry.point_bound::<f32>();
                        assert!(ratio <= 1.0, "{} surface {index}, {variant:?}: {ratio}", path.display());
                        worst = worst.max(ratio);
                    }
                }
            }
        }
        count += surfaces.len();
    }
    eprintln!("{count} spline surfaces, at most {worst:.3} of the bound");
    assert!(count > 0);
}
