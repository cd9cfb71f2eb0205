//! JSON exported by geomdl: real exports, and what is wrong with made ones.

mod common;

use chordal_brep::{FaceGeometry, Loop, LooseKind, Model, ReadIssue};
use common::{read_bytes, read_file};
use proptest::prelude::*;
use std::path::PathBuf;

/// A file's faces where they differ from its surfaces, and why.
const EXPLAINED: &[(&str, usize)] = &[
    // The third surface's trim touches two of its sides: what is left is two slivers.
    ("geomdl_trim_separate_surfaces.json", 4),
];

fn rows() -> Vec<(PathBuf, usize)> {
    let given = std::env::var_os("CHORDAL_MODELS").map(PathBuf::from);
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    let folder = given.unwrap_or_else(beside);
    let Ok(index) = std::fs::read_to_string(folder.join("INDEX.tsv")) else {
        println!("SKIPPED: no models at {}", folder.display());
        return Vec::new();
    };
    let rows = index.lines().map(|line| line.split('\t').collect::<Vec<_>>()).filter(|row| row[0] == "json");
    rows.map(|row| (folder.join("json").join(row[1]), row[6].parse().expect("a number of faces"))).collect()
}

fn failures(model: &Model) -> Vec<String> {
    let faces = model.parts.iter().flat_map(|part| &part.faces);
    let failed = faces.filter_map(|face| match &face.geometry {
        FaceGeometry::Failed(reason) => Some(reason.to_string()),
        FaceGeometry::Surface(_) => None,
    });
    failed.collect()
}

#[test]
fn every_surface_arrives() {
    for (path, surfaces) in rows() {
        let model = read_file(&path).expect("readable");
        let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
        let expected = EXPLAINED.iter().find(|(file, _)| *file == name).map_or(surfaces, |&(_, faces)| faces);
        assert_eq!(model.placed_faces(), expected, "{name}");
        assert_eq!(failures(&model), [""; 0], "{name}");
    }
}

/// A flat unit square with these trims.
fn square(trims: &str) -> String {
    format!(
        r#"{{"shape": {{"type": "surface", "count": 1, "data": [{{
  "type": "spline", "rational": false, "dimension": 3, "degree_u": 1, "degree_v": 1,
  "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1], "size_u": 2, "size_v": 2,
  "control_points": {{"points": [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]]}}, "delta": [0.05, 0.05],
  "trims": {{"count": 1, "data": [{trims}]}}}}]}}}}"#
    )
}

const TRIANGLE: &str = r#"{"type": "freeform", "dimension": 2, "points": [[0.2, 0.2], [0.8, 0.2], [0.5, 0.8],
    [0.2, 0.2]], "reversed": 1}"#;

fn loops(text: &str) -> Vec<usize> {
    let model = read_bytes(text.as_bytes(), "square").expect("readable");
    assert_eq!(failures(&model), [""; 0]);
    let coedges = |l: &Loop| match l {
        Loop::Edges { coedges, .. } => coedges.len(),
        _ => 0,
    };
    model.parts[0].faces.iter().flat_map(|face| &face.loops).map(coedges).collect()
}

#[test]
fn reversed_trims_keep_their_inside() {
    assert_eq!(loops(&square(TRIANGLE)), [3]);
    assert_eq!(loops(&square(&TRIANGLE.replace("\"reversed\": 1", "\"reversed\": 0"))), [4, 3]);
    assert_eq!(loops(&square(&TRIANGLE.replace(", \"reversed\": 1", ""))), [4, 3]);
}

#[test]
fn curves_of_a_container_are_put_in_order() {
    let curve = |a: &str, b: &str| {
        format!(
            r#"{{"type": "spline", "degree": 1, "knotvector": [0, 0, 1, 1],
                "control_points": {{"points": [{a}, {b}]}}}}"#
        )
    };
    let [a, b, c] = ["[0.2, 0.2]", "[0.8, 0.2]", "[0.5, 0.8]"];
    let container = format!(
        r#"{{"type": "container", "count": 3, "reversed": 1, "data": [{}, {}, {}]}}"#,
        curve(a, b),
        curve(c, b),
        curve(c, a)
    );
    let text = square(&container);
    assert_eq!(loops(&text), [3]);
    let model = read_bytes(text.as_bytes(), "square").expect("readable");
    assert!(model.issues.iter().any(|w| w.kind == ReadIssue::EdgeTurned.into()), "{:?}", model.issues);
}

#[test]
fn an_open_trim_is_closed_along_the_border() {
    let open = r#"{"type": "freeform", "points": [[0.5, 0], [0.5, 0.5], [0, 0.5]]}"#;
    assert_eq!(loops(&square(open)), [6]);
}

#[test]
fn what_is_wrong_is_said() {
    let whole = square(TRIANGLE);
    for (from, to, phrase) in [
        ("\"degree_u\": 1", "\"degree_u\": 2", "4 knots for 2 control points of degree 2"),
        ("[0, 0, 1, 1]", "[0, 2, 1, 1]", "knot 2 decreases"),
        ("[0, 0, 0]", "[0]", "number of coordinates of a control point is 1, at least 2 needed"),
        ("[0, 0, 0]", "[0, \"a\", 0]", "invalid type"),
        ("\"size_v\": 2,", "", "size_v"),
        ("\"freeform\"", "\"hyperform\"", "hyperform"),
        ("[0.8, 0.2]", "[0.8]", "trim 1: number of coordinates of a point is 1"),
    ] {
        let broken = whole.replacen(from, to, 1);
        assert_ne!(broken, whole, "{from}");
        let model = read_bytes(broken.as_bytes(), "square").expect("a failed face");
        let said = failures(&model);
        assert!(said.len() == 1 && said[0].contains(phrase), "{from} → {to}: {said:?}");
    }
    for (from, to, phrase) in [("{\"shape\": {", "{\"shape\": ", "line 1"), ("\"data\"", "\"date\"", "data")]
    {
        let broken = whole.replacen(from, to, 1);
        let said = read_bytes(broken.as_bytes(), "square").expect_err("refused").to_string();
        assert!(said.contains(phrase), "{said}");
    }
}

#[test]
fn curves_are_loose_and_volumes_lost() {
    let curve = r#"{"shape": {"type": "curve", "count": 1, "data": [{"type": "spline", "name": "c"}]}}"#;
    let model = read_bytes(curve.as_bytes(), "c").expect("readable");
    assert_eq!(model.parts[0].loose[0].kind, LooseKind::Wire);
    let volume = r#"{"shape": {"type": "volume", "count": 1, "data": [{"degree_w": 1}]}}"#;
    let model = read_bytes(volume.as_bytes(), "v").expect("readable");
    assert!(model.issues[0].is_error(), "{:?}", model.issues);
}

#[test]
fn a_file_cut_anywhere_is_refused() {
    let whole = square(TRIANGLE);
    for end in 0..whole.len() {
        let said = read_bytes(&whole.as_bytes()[..end], "square").expect_err("half a file").to_string();
        assert!(!said.is_empty() && !said.contains('\n'), "cut at {end}: {said}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn mutants_end(changes in prop::collection::vec((any::<prop::sample::Index>(), 32u8..127), 1..6)) {
        let mut bytes = square(TRIANGLE).into_bytes();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        // Anything but a panic.
        let _ = read_bytes(&bytes, "square");
    }
}
