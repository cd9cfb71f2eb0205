//! Trims given as polylines come out as smooth as the same trims given as curves.
//!
//! The survey of the Blender wiki tells of a tessellator that subdivides trimming curves but takes the points
//! of trimming polylines as they are: on a curved surface, where a straight line of parameters is no straight
//! line in space, its edges are far off.

#![cfg(feature = "methods")]

use chordal::mesh::Origin;
use chordal::methods::strategy_named;
use chordal::nurbs::DVec3;
use chordal::{MeshOptions, Meshed, Mesher, Model, Tolerance};
use chordal_nurbs::math;
use std::path::PathBuf;

/// A trim with few, long sides in the plane of parameters.
const DIAMOND: [(f64, f64); 5] = [(0.5, 0.05), (0.95, 0.5), (0.5, 0.95), (0.05, 0.5), (0.5, 0.05)];

fn list(points: &[(f64, f64)]) -> String {
    points.iter().map(|(u, v)| format!("[{u}, {v}]")).collect::<Vec<_>>().join(", ")
}

fn polyline(points: &[(f64, f64)]) -> String {
    format!(r#"{{"type": "freeform", "dimension": 2, "points": [{}], "reversed": 1}}"#, list(points))
}

/// The same polyline as a spline of degree 1, or with every side as a Bézier curve of a higher one.
fn spline(degree: usize) -> String {
    let mut points = vec![DIAMOND[0]];
    for w in DIAMOND.windows(2) {
        points.extend((1..=degree).map(|k| {
            let t = k as f64 / degree as f64;
            (w[0].0 + (w[1].0 - w[0].0) * t, w[0].1 + (w[1].1 - w[0].1) * t)
        }));
    }
    let mut knots = vec![0; degree + 1];
    (1..4).for_each(|k| knots.extend(vec![k; degree]));
    knots.extend(vec![4; degree + 1]);
    format!(
        r#"{{"type": "spline", "degree": {degree}, "knotvector": {knots:?}, "dimension": 2,
            "control_points": {{"points": [{}]}}, "reversed": 1}}"#,
        list(&points)
    )
}

/// A bicubic sheet, 10 wide, with a bump 4 high.
fn mesh(name: &str, trim: &str, strategy: &str) -> Meshed {
    let height = |i: usize, j: usize| if (1..3).contains(&i) && (1..3).contains(&j) { 4.0 } else { 0.0 };
    let place = |k: usize| {
        format!(
            "[{}, {}, {}]",
            (k / 4) as f64 * 10.0 / 3.0,
            (k % 4) as f64 * 10.0 / 3.0,
            height(k / 4, k % 4)
        )
    };
    let net = (0..16).map(place).collect::<Vec<_>>().join(", ");
    let text = format!(
        r#"{{"shape": {{"type": "surface", "count": 1, "data": [{{
            "type": "spline", "rational": false, "dimension": 3, "degree_u": 3, "degree_v": 3,
            "knotvector_u": [0, 0, 0, 0, 1, 1, 1, 1], "knotvector_v": [0, 0, 0, 0, 1, 1, 1, 1], "size_u": 4,
                "size_v": 4,
            "control_points": {{"points": [{net}]}}, "delta": [0.05, 0.05],
            "trims": {{"count": 1, "data": [{trim}]}}}}]}}}}"#
    );
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.json"));
    std::fs::write(&path, text).expect("written");
    let options = MeshOptions::default()
        .with_tolerance(Tolerance::Millimetres(0.01))
        .with_angle(None)
        .with_fill_method(strategy_named(strategy).expect("a known name").fill_method());
    Mesher::new(options).mesh(&Model::open(path).expect("a model")).expect("a mesh")
}

fn samples_of_edges(meshed: &Meshed) -> usize {
    let origins = &meshed.scene().parts[0].mesh.origins;
    origins.iter().filter(|o| matches!(o, Origin::Edge { .. })).count()
}

/// ∫√(κ/8ε) ds along one side of the diamond on the sheet (10u, 10v, 36 u (1 − u) v (1 − v)), rounded up.
fn fewest_chords(tolerance: f64) -> f64 {
    let at = |s: f64| {
        let (u, v) = (0.5 + 0.45 * s, 0.05 + 0.45 * s);
        DVec3::new(10.0 * u, 10.0 * v, 36.0 * u * (1.0 - u) * v * (1.0 - v))
    };
    let (n, h) = (1000, 1e-4);
    let rate = |s: f64| {
        let (d1, d2) = ((at(s + h) - at(s - h)) / (2.0 * h), (at(s + h) - 2.0 * at(s) + at(s - h)) / (h * h));
        (d1.cross(d2).length() / d1.length() / (8.0 * tolerance)).sqrt()
    };
    ((0..n).map(|k| rate((f64::from(k) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n)).ceil()
}

#[test]
fn a_polyline_is_subdivided_as_finely_as_a_curve() {
    for strategy in ["default", "recursive", "bezier"] {
        let given = [("polyline", polyline(&DIAMOND)), ("degree_1", spline(1)), ("degree_3", spline(3))];
        let meshes = given.map(|(name, trim)| mesh(&format!("{name}_{strategy}"), &trim, strategy));
        let counts = meshes.each_ref().map(samples_of_edges);
        // Four straight sides over a bump: left alone they would have no sample at all. All sagittas allow at
        // least this many chords.
        assert!((counts[0] + 4) as f64 >= 4.0 * fewest_chords(0.01), "{strategy}: {counts:?}");
        assert!(counts.iter().all(|c| c.abs_diff(counts[0]) <= 4), "{strategy}: {counts:?}");
        for meshed in &meshes {
            assert!(meshed.report().clean, "{strategy}: {:?}", meshed.report().error_sentences());
            assert!(meshed.report().boundary_error.is_some_and(|e| e > 0.002 && e <= 0.01));
            assert!(meshed.report().proven_error <= Some(0.01));
        }
        let areas = meshes.each_ref().map(|meshed| meshed.report().area);
        assert!(areas.iter().all(|a| (a / areas[0] - 1.0).abs() < 1e-3), "{strategy}: {areas:?}");
    }
}

/// As many sides as a modeller writes for a smooth trim: far more than the tolerance asks for.
const DENSE: usize = 720;

#[test]
fn chords_pass_over_the_points_of_dense_polylines() {
    let on_ellipse = |k: usize| {
        let (sine, cosine) = math::sin_cos(std::f64::consts::TAU * (k % DENSE) as f64 / DENSE as f64);
        (0.5 + 0.4 * cosine, 0.5 + 0.25 * sine)
    };
    let points: Vec<(f64, f64)> = (0..=DENSE).map(on_ellipse).collect();
    let meshed = mesh("dense", &polyline(&points), "default");
    let samples = samples_of_edges(&meshed);
    // The ellipse of semi-axes 4 and 2.5 has ∮√κ ds = 11.06; over √8ε that is 39 chords, and the sheet adds
    // to them.
    assert!((39..DENSE / 5).contains(&samples), "{samples}");
    assert!(meshed.report().clean, "{:?}", meshed.report().error_sentences());
    assert!(meshed.report().boundary_error.is_some_and(|e| e > 0.001 && e <= 0.01));
}
