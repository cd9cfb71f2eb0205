//! Meshes whose points a device has evaluated keep the same promises as any.

#![cfg(feature = "gpu")]

use chordal::gpu::{BACKENDS, DeviceChoice, GpuError};
use chordal::nurbs::BulkEvaluator;
use chordal::nurbs::DVec2;
use chordal::tessellate::Bulk;
use chordal::{GpuEvaluator, MeshOptions, Mesher, Model, Report, Tolerance};
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

/// Spline surfaces, doubly curved.
const MODELS: [&str; 3] = ["spline_ball.step", "blade.step", "fillet_bspline.step"];

/// A device with double precision in shaders. Without one the test is skipped, and a line on standard error
/// says so; `CHORDAL_REQUIRE_GPU=1` makes it fail instead.
fn evaluator() -> Option<GpuEvaluator> {
    match GpuEvaluator::open(DeviceChoice::Best) {
        Ok(evaluator) => Some(evaluator),
        Err(error @ (GpuError::NoDevice { .. } | GpuError::Lacks { .. })) => {
            let required = std::env::var_os("CHORDAL_REQUIRE_GPU").is_some_and(|v| v != "0");
            assert!(!required, "CHORDAL_REQUIRE_GPU is set, but {error}");
            let thread = std::thread::current();
            let name = thread.name().unwrap_or("a test");
            let _ = writeln!(std::io::stderr(), "{name}: skipped: no {BACKENDS} device");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

fn corpus(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../corpus").join(name)
}

fn meshed(name: &str, strategy: &str, bulk: Bulk) -> Report {
    let options = MeshOptions::default()
        .with_tolerance(Tolerance::Percent(0.05))
        .with_fill_method(chordal::methods::strategy_named(strategy).expect("a name").fill_method())
        .with_bulk(bulk);
    let model = Model::open(corpus(name)).expect("it can be read");
    Mesher::new(options).mesh(&model).expect("it can be meshed").into_report()
}

#[test]
fn a_device_changes_no_promise() {
    let Some(device) = evaluator() else { return };
    let device = Arc::new(device.with_fewest(1));
    for name in MODELS {
        for strategy in ["default", "grid", "delaunay-uniform"] {
            let before = device.work();
            let host = meshed(name, strategy, Bulk::default());
            let report = meshed(name, strategy, Bulk::new(device.clone()));
            assert_eq!(device.failure(), None);
            let (points, dispatches) = device.work();
            assert!(points > before.0 && dispatches > before.1, "{name} {strategy}: the device did nothing");
            assert_eq!(
                (report.clean, report.closedness, report.faces.total),
                (host.clean, host.closedness, host.faces.total),
                "{name} {strategy}"
            );
            let proven = report.proven_error.expect("every face is proven");
            assert!(proven <= report.options.tolerance, "{name} {strategy}: {proven}");
            // The same points to rounding: next to the same mesh.
            let ratio = report.triangles as f64 / host.triangles as f64;
            assert!(
                (0.99..=1.01).contains(&ratio),
                "{name} {strategy}: {} for {}",
                report.triangles,
                host.triangles
            );
        }
    }
}

#[test]
fn a_device_that_goes_away_leaves_the_work_to_the_host() {
    let Some(device) = evaluator() else { return };
    let device = Arc::new(device.with_fewest(1));
    device.gpu().device.destroy();
    let report = meshed(MODELS[0], "default", Bulk::new(device.clone()));
    let host = meshed(MODELS[0], "default", Bulk::default());
    assert!(device.failure().is_some());
    assert_eq!(
        (report.clean, report.triangles, report.proven_error),
        (host.clean, host.triangles, host.proven_error)
    );
}

#[test]
fn few_points_stay_here() {
    let Some(device) = evaluator() else { return };
    let device = device.with_fewest(10);
    let surface = chordal::nurbs::NurbsSurface::new(
        [1, 1],
        vec![0.0, 0.0, 1.0, 1.0],
        vec![0.0, 0.0, 2.0, 2.0],
        [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 3.0]]
            .map(|[x, y]| chordal::nurbs::DVec3::new(x, y, x * y))
            .into(),
        None,
    )
    .expect("a quadrilateral");
    let at: Vec<DVec2> = (0..10).map(|k| DVec2::new(0.1 * f64::from(k), 0.17 * f64::from(k))).collect();
    assert!(device.jets(&surface, &at[..9]).is_none());
    for (jet, &uv) in device.jets(&surface, &at).expect("enough points").iter().zip(&at) {
        let exact = surface.jet(uv);
        for (a, b) in [(jet.p, exact.p), (jet.du, exact.du), (jet.dv, exact.dv), (jet.duv, exact.duv)] {
            assert!(a.distance(b) < 1e-14, "{uv}: {a} {b}");
        }
        assert!(jet.duu.length() < 1e-14 && jet.dvv.length() < 1e-14);
    }
}
