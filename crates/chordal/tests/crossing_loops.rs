//! Loops that cross, touch or run over each other, in a format whose faces share edges: the region is what
//! the winding numbers of the loops say, proven, and neighbours keep their common edges.

#![cfg(feature = "methods")]

use chordal::methods::strategy_named;
use chordal::nurbs::DVec3;
use chordal::{MeshOptions, Meshed, Mesher, Model, Tolerance};
use std::path::PathBuf;

type Corner = (f64, f64);

/// Height of the sheet over the unit square, 10 wide.
fn height(u: f64, v: f64, bump: f64) -> f64 {
    9.0 * bump * u * (1.0 - u) * v * (1.0 - v)
}

fn surface(bump: f64) -> String {
    let place = |k: usize| {
        let inner = (1..3).contains(&(k / 4)) && (1..3).contains(&(k % 4));
        let z = if inner { bump } else { 0.0 };
        format!("[{}, {}, {z}]", (k / 4) as f64 * 10.0 / 3.0, (k % 4) as f64 * 10.0 / 3.0)
    };
    let points: Vec<String> = (0..16).map(place).collect();
    format!(
        r#"{{"nurbs": {{"degree": [3, 3], "knots_u": [0,0,0,0,1,1,1,1], "knots_v": [0,0,0,0,1,1,1,1],
            "points": [{}]}}}}"#,
        points.join(", ")
    )
}

/// Faces of the sheet, each with its loops as corners of a common list; sides between the same two corners
/// are one edge.
fn mesh(name: &str, bump: f64, corners: &[Corner], faces: &[&[&[usize]]], strategy: &str) -> Meshed {
    let mut edges: Vec<[usize; 2]> = Vec::new();
    let mut texts = Vec::new();
    for loops in faces {
        let mut of_face = Vec::new();
        for (l, ids) in loops.iter().enumerate() {
            let mut coedges = Vec::new();
            for (k, &a) in ids.iter().enumerate() {
                let b = ids[(k + 1) % ids.len()];
                let edge = edges.iter().position(|e| *e == [a, b] || *e == [b, a]).unwrap_or_else(|| {
                    edges.push([a, b]);
                    edges.len() - 1
                });
                coedges.push(format!(
                    r#"{{"edge": {edge}, "forward": {}, "pcurves": []}}"#,
                    edges[edge] == [a, b]
                ));
            }
            of_face.push(format!(
                r#"{{"edges": {{"outer": {}, "coedges": [{}]}}}}"#,
                l == 0,
                coedges.join(", ")
            ));
        }
        texts.push(format!(r#"{{"surface": 0, "loops": [{}]}}"#, of_face.join(", ")));
    }
    let vertex =
        |&(u, v): &Corner| format!(r#"{{"point": [{}, {}, {}]}}"#, 10.0 * u, 10.0 * v, height(u, v, bump));
    let edge = |&[a, b]: &[usize; 2]| {
        let ((au, av), (bu, bv)) = (corners[a], corners[b]);
        format!(
            r#"{{"curve": {{"on_surface": {{"surface": 0, "curve": {{"nurbs": {{"degree": 1,
                "knots": [0,0,1,1],
                "points": [[{au}, {av}], [{bu}, {bv}]]}}}}}}}}, "range": [0, 1], "start": {a}, "end": {b}}}"#
        )
    };
    let text = format!(
        r#"{{"schema": "chordal-model/1", "name": "{name}", "unit": "mm", "nodes": [{{"name": "{name}",
            "transform": [[1,0,0],[0,1,0],[0,0,1],[0,0,0]], "part": 0}}], "roots": [0],
                "parts": [{{"name": "{name}",
            "surfaces": [{}], "vertices": [{}], "edges": [{}], "faces": [{}]}}]}}"#,
        surface(bump),
        corners.iter().map(vertex).collect::<Vec<_>>().join(", "),
        edges.iter().map(edge).collect::<Vec<_>>().join(", "),
        texts.join(", ")
    );
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.json"));
    std::fs::write(&path, text).expect("written");
    let options = MeshOptions::default()
        .with_tolerance(Tolerance::Millimetres(0.02))
        .with_fill_method(strategy_named(strategy).expect("a known name").fill_method());
    Mesher::new(options).mesh(&Model::open(path).expect("a model")).expect("a mesh")
}

fn odd(polygon: &[Corner], u: f64, v: f64) -> bool {
    let crosses = |k: usize| {
        let ((au, av), (bu, bv)) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        (av > v) != (bv > v) && u < au + (v - av) / (bv - av) * (bu - au)
    };
    (0..polygon.len()).filter(|&k| crosses(k)).count() % 2 == 1
}

/// The area of the sheet over a region, by midpoints.
fn area(bump: f64, inside: impl Fn(f64, f64) -> bool) -> f64 {
    const N: u32 = 250;
    let (at, h) = (|k: u32| (f64::from(k) + 0.5) / f64::from(N), 1e-5);
    let density = |u: f64, v: f64| {
        let p = |u: f64, v: f64| DVec3::new(10.0 * u, 10.0 * v, height(u, v, bump));
        ((p(u + h, v) - p(u - h, v)).cross(p(u, v + h) - p(u, v - h)) / (4.0 * h * h)).length()
    };
    let all = (0..N * N).map(|k| (at(k / N), at(k % N))).filter(|&(u, v)| inside(u, v));
    all.map(|(u, v)| density(u, v)).sum::<f64>() / f64::from(N * N)
}

fn check(outcome: &Meshed, expected: f64, what: &str) {
    let report = outcome.report();
    assert!(report.clean, "{what}: {:?}", report.error_sentences());
    assert!(report.proven_error <= Some(0.02), "{what}: {:?}", report.proven_error);
    assert!((report.area / expected - 1.0).abs() < 0.01, "{what}: {} for {expected}", report.area);
}

/// One face with these loops, the first of them the outer one.
fn one_face(name: &str, loops: &[&[Corner]], strategy: &str) -> Meshed {
    let corners: Vec<Corner> = loops.iter().flat_map(|l| l.iter().copied()).collect();
    let mut first = 0;
    let ids: Vec<Vec<usize>> = loops
        .iter()
        .map(|l| {
            first += l.len();
            (first - l.len()..first).collect()
        })
        .collect();
    let ids: Vec<&[usize]> = ids.iter().map(Vec::as_slice).collect();
    mesh(name, 6.0, &corners, &[&ids], strategy)
}

const OUTER: [Corner; 4] = [(0.1, 0.1), (0.7, 0.1), (0.7, 0.9), (0.1, 0.9)];

#[test]
fn regions_are_what_winding_numbers_say_by_every_strategy() {
    let eight: &[Corner] = &[(0.1, 0.1), (0.9, 0.9), (0.9, 0.1), (0.1, 0.9)];
    let across: &[Corner] = &[(0.5, 0.3), (0.5, 0.6), (0.9, 0.6), (0.9, 0.3)];
    let holes: [&[Corner]; 2] = [
        &[(0.2, 0.2), (0.2, 0.5), (0.5, 0.5), (0.5, 0.2)],
        &[(0.3, 0.4), (0.3, 0.8), (0.6, 0.8), (0.6, 0.4)],
    ];
    // Round the middle twice: what a loop goes round twice is outside.
    let star: &[Corner] = &[(0.5, 0.95), (0.25, 0.1), (0.95, 0.62), (0.05, 0.62), (0.75, 0.1)];
    let cases: [(&str, Vec<&[Corner]>); 4] = [
        ("eight", vec![eight]),
        ("hole_across", vec![&OUTER, across]),
        ("holes_that_cross", vec![&OUTER, holes[0], holes[1]]),
        ("star", vec![star]),
    ];
    for (name, loops) in &cases {
        let inside = |u, v| odd(loops[0], u, v) && !loops[1..].iter().any(|l| odd(l, u, v));
        let expected = area(6.0, inside);
        for strategy in ["default", "coving", "bezier"] {
            let outcome = one_face(&format!("crossing_{name}_{strategy}"), loops, strategy);
            check(&outcome, expected, &format!("{name} {strategy}"));
            assert!(outcome.report().problems.iter().any(|p| p.code == "loops-untangled"), "{name}");
        }
    }
}

#[test]
fn a_neighbour_keeps_the_edge_that_is_crossed() {
    // Two faces side by side; a hole of the first reaches over their common edge by much, and by less than
    // the file's accuracy.
    for (name, over) in [("wide", 0.1), ("hair", 1e-8)] {
        let corners = [
            (0.1, 0.1),
            (0.5, 0.1),
            (0.9, 0.1),
            (0.9, 0.9),
            (0.5, 0.9),
            (0.1, 0.9),
            (0.3, 0.4),
            (0.3, 0.6),
            (0.5 + over, 0.6),
            (0.5 + over, 0.4),
        ];
        let outcome = mesh(
            &format!("crossing_shared_{name}"),
            6.0,
            &corners,
            &[&[&[0, 1, 4, 5], &[6, 7, 8, 9]], &[&[1, 2, 3, 4]]],
            "default",
        );
        let expected = area(6.0, |u, v| {
            (0.1..0.9).contains(&u)
                && (0.1..0.9).contains(&v)
                && !((0.3..0.5).contains(&u) && (0.4..0.6).contains(&v))
        });
        check(&outcome, expected, name);
        // Both faces have a vertex where the hole crosses: the border has no T.
        let mesh = &outcome.scene().parts[0].mesh;
        let sides = |f: usize| {
            let face = &mesh.faces[f];
            face.triangles.iter().flat_map(|t| {
                let at = t.map(|c| face.corners[c as usize].position);
                [[at[0], at[1]], [at[1], at[2]], [at[2], at[0]]]
            })
        };
        let shared = sides(0).filter(|s| sides(1).any(|t| t == [s[1], s[0]])).count();
        assert!(shared >= 2, "{name}: {shared}");
    }
}

#[test]
fn random_loops() {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(1u32 << 31)
    };
    for trial in 0..24 {
        let mut loops: Vec<Vec<Corner>> = Vec::new();
        for _ in 0..1 + trial % 3 {
            let corners = 3 + (random() * 5.0) as usize;
            loops.push((0..corners).map(|_| (0.05 + 0.9 * random(), 0.05 + 0.9 * random())).collect());
        }
        let signed = |l: &[Corner]| -> f64 {
            (0..l.len()).map(|k| l[k].0 * l[(k + 1) % l.len()].1 - l[k].1 * l[(k + 1) % l.len()].0).sum()
        };
        loops.sort_by(|a, b| signed(b).abs().total_cmp(&signed(a).abs()));
        for (i, l) in loops.iter_mut().enumerate() {
            if (signed(l) > 0.0) != (i == 0) {
                l.reverse();
            }
        }
        let given: Vec<&[Corner]> = loops.iter().map(Vec::as_slice).collect();
        let expected = area(6.0, |u, v| odd(given[0], u, v) && !given[1..].iter().any(|l| odd(l, u, v)));
        let outcome = one_face(&format!("crossing_random_{trial}"), &given, "default");
        let report = outcome.report();
        assert!(report.clean, "{trial}: {:?}", report.error_sentences());
        assert!(
            (report.area - expected).abs() < 0.01 * expected + 0.2,
            "{trial}: {} for {expected}",
            report.area
        );
    }
}
