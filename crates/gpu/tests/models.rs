//! Every surface and every edge curve of the models, all of a file in one dispatch, on the device and by the
//! twins.
//!
//! Splines are taken whole, other surfaces in their exact NURBS form over a box of their parameters. The
//! models are no part of the repository: `CHORDAL_MODELS` names their folder (default `../shared/models` next
//! to it).

mod common;

use chordal_brep::{FaceGeometry, Model, Part};
use chordal_gpu::{KernelRunner, Request, Samples, Search, SurfaceSet, Variant, Wanted, evaluate_twin};
use chordal_nurbs::{DVec2, DVec3, NurbsCurve3, NurbsSurface, Range, Surface, UvBox};
use common::{gpu, no_gpu};
use std::path::{Path, PathBuf};

/// Files of all formats.
fn files() -> Vec<PathBuf> {
    let folder = std::env::var_os("CHORDAL_MODELS")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models"), PathBuf::from);
    let mut found = Vec::new();
    for kind in ["step", "iges", "iv", "x3d", "obj", "brep", "json", "3dm"] {
        let Ok(entries) = std::fs::read_dir(folder.join(kind)) else { continue };
        found.extend(entries.flatten().map(|e| e.path()).filter(|p| p.is_file()));
    }
    found.sort();
    found
}

/// Half the side of a box of parameters where the domain is infinite: about the part's size.
fn extent(part: &Part) -> f64 {
    let size = part.vertices.iter().map(|v| v.point.abs().max_element()).fold(0.0, f64::max);
    if size > 0.0 && size.is_finite() { size } else { 1.0 }
}

fn finite(range: Range, extent: f64) -> Range {
    let start = if range.start.is_finite() { range.start } else { (-extent).min(range.end - extent) };
    let end = if range.end.is_finite() { range.end } else { extent.max(start + extent) };
    Range::new(start, end)
}

fn nurbs_of(surface: &Surface, extent: f64) -> Option<NurbsSurface> {
    if let Surface::Nurbs(nurbs) = surface {
        return Some(nurbs.clone());
    }
    let domain = surface.domain();
    surface.to_nurbs(UvBox::from_ranges(finite(domain.u(), extent), finite(domain.v(), extent))).ok()
}

/// What the bound is stated for.
fn positive(weights: Option<&[f64]>) -> bool {
    weights.is_none_or(|w| w.iter().all(|&w| w > 0.0))
}

#[derive(Default)]
struct Found {
    surfaces: Vec<NurbsSurface>,
    curves: Vec<NurbsCurve3>,
    /// Surfaces without an exact form, and with weights that are not positive.
    left_out: usize,
}

fn geometry_of(model: &Model) -> Found {
    let mut found = Found::default();
    for part in &model.parts {
        let extent = extent(part);
        for face in &part.faces {
            let FaceGeometry::Surface(surface) = &face.geometry else { continue };
            match nurbs_of(surface, extent).filter(|s| positive(s.weights())) {
                Some(surface) => found.surfaces.push(surface),
                None => found.left_out += 1,
            }
        }
        let curve = |edge: &chordal_brep::Edge| edge.curve.as_deref()?.to_nurbs(edge.range).ok();
        found.curves.extend(part.edges.iter().filter_map(curve).filter(|c| positive(c.weights())));
    }
    found
}

/// The requests of a file and the exact points that they ask for, surfaces first. Few a surface where there
/// are many.
fn requests(set: &SurfaceSet<f32>, found: &Found) -> (Vec<Request>, Vec<DVec3>) {
    let [width, height] = if found.surfaces.len() > 400 { [3, 3] } else { [5, 6] };
    let (mut requests, mut exact) = (Vec::new(), Vec::new());
    for (index, surface) in found.surfaces.iter().enumerate() {
        let request = Request::even_grid(set, index, width, height);
        if let Request::Grid { us, vs, .. } = &request {
            exact.extend(us.iter().flat_map(|&u| vs.iter().map(move |&v| surface.point(DVec2::new(u, v)))));
        }
        requests.push(request);
    }
    for (index, curve) in found.curves.iter().enumerate() {
        let domain = curve.domain();
        let ts: Vec<f64> = (0..5).map(|k| domain.start + domain.length() * 0.25 * f64::from(k)).collect();
        exact.extend(ts.iter().map(|&t| curve.point(t)));
        requests.push(Request::curve(found.surfaces.len() + index, ts));
    }
    (requests, exact)
}

/// The largest share of the bound that a point of these results takes.
fn worst(set: &SurfaceSet<f32>, samples: &Samples<f32>, values: &[f32], exact: &[DVec3]) -> (f64, usize) {
    let mut worst = (0.0, 0);
    for (index, entry) in set.entries().iter().enumerate() {
        let bound = entry.point_bound::<f32>();
        for k in samples.range(index) {
            let local = DVec3::from_slice(&[0, 1, 2].map(|c| f64::from(values[3 * k + c])));
            let ratio = (entry.frame.middle + local * entry.frame.size).distance(exact[k]) / bound;
            // Also where it is not a number.
            if !(ratio <= worst.0) {
                worst = (ratio, index);
            }
        }
    }
    worst
}

#[test]
fn surfaces_and_curves_of_models_keep_the_bound() {
    let files = files();
    if files.is_empty() {
        eprintln!("skipped: no models here (CHORDAL_MODELS)");
        return;
    }
    if no_gpu() {
        return;
    }
    let evaluators = Variant::ALL
        .map(|v| (v, KernelRunner::<f32>::new(gpu(), v, Search::Host).expect("the kernels compile")));
    let next = std::sync::atomic::AtomicUsize::new(0);
    let totals = std::sync::Mutex::new(([0; 3], 0.0_f64));
    let check = |path: &Path| {
        let Ok(model) = chordal_read::read_file(path, &chordal_read::ReadOptions::default()) else { return };
        let found = geometry_of(&model);
        let mut set = SurfaceSet::<f32>::with_bezier();
        for surface in &found.surfaces {
            set.push_surface(surface);
        }
        for curve in &found.curves {
            set.push_curve(curve);
        }
        if set.is_empty() {
            return;
        }
        let (requests, exact) = requests(&set, &found);
        let samples = Samples::new(&set, &requests).expect("few points");
        for (k, (variant, evaluator)) in evaluators.iter().enumerate() {
            let on_device =
                evaluator.evaluate(gpu(), &set, &samples, Wanted::Points).expect("it fits").values;
            let mut results = vec![("device", on_device)];
            // Twins are slow in this profile: where there is much, each file has one of them.
            if exact.len() < 20_000 || k == exact.len() % evaluators.len() {
                let twin = evaluate_twin(&set, &samples, *variant, Wanted::Points, Search::Host);
                results.push(("twin", twin.expect("it fits")));
            }
            for (who, values) in results {
                let (ratio, index) = worst(&set, &samples, &values, &exact);
                assert!(ratio <= 1.0, "{} number {index}, {variant:?}, {who}: {ratio}", path.display());
                let mut totals = totals.lock().expect("no thread has panicked");
                totals.1 = totals.1.max(ratio);
            }
        }
        let counts = [found.surfaces.len(), found.curves.len(), found.left_out];
        let mut totals = totals.lock().expect("no thread has panicked");
        totals.0.iter_mut().zip(counts).for_each(|(total, count)| *total += count);
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from).min(4) {
            scope.spawn(|| {
                while let Some(path) = files.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
                    check(path);
                }
            });
        }
    });
    let ([surfaces, curves, left_out], worst) = totals.into_inner().expect("no thread has panicked");
    eprintln!(
        "{surfaces} surfaces and {curves} curves at most {worst:.3} of the bound; {left_out} surfaces have \
         no exact form"
    );
    assert!(surfaces > 0 && curves > 0);
}
