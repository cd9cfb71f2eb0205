//! Real Inventor, VRML and X3D files: each holds what was counted in it by hand, or is refused for a reason
//! that is true.
//!
//! The files lie outside the repository: in the folder that CHORDAL_MODELS names, else in `../shared/models`
//! beside it.

mod common;

use chordal_brep::{Face, FaceGeometry, Model, Part};
use chordal_nurbs::{NurbsSurface, Surface};
use std::path::PathBuf;

/// Surfaces counted in the text of each file, the solids' faces with them.
const FACES: &[(&str, usize)] = &[
    ("iv/coin_SoNurbsSurface_doc.iv", 1),
    ("iv/mentor_08.3.BezSurf.iv", 1),
    ("iv/mentor_08.4.TrimSurf.iv", 1),
    ("iv/sgi_teapot_ascii.iv", 32),
    ("iv/sgi_teapot_binary.iv", 32),
    ("x3d/DefaultTextureCoordClosed.x3dv", 1),
    ("x3d/FredTheBunny.x3dv", 20),
    ("x3d/HoleCentered.x3dv", 1),
    ("x3d/MobiusNurbs.x3dv", 3),
    ("x3d/NurbsPatchSurfaceExampleLarge.x3dv", 1),
    ("x3d/NurbsPrimitives.x3d", 5),
    ("x3d/NurbsSphere.x3d", 1),
    ("x3d/castle_nurbs_dune_primitives.x3dv", 5),
    ("x3d/castle_nurbs_dune_tests.wrl", 1),
    ("x3d/castle_nurbs_surface_interpolator.x3dv", 3),
];

/// Files without a surface that can be said exactly.
const REFUSED: &[(&str, &str)] = &[
    ("x3d/B.x3d", "the trajectory is closed; a section that turns with it has no exact spline form"),
    (
        "x3d/NurbsSweptSurface.x3d",
        "the trajectory is bent; a section that turns with it has no exact spline form",
    ),
    // Its points are computed by a script.
    ("x3d/torus.x3d", "number of control points is 0, at least 49 needed"),
];

fn folder() -> Option<PathBuf> {
    let given = std::env::var_os("CHORDAL_MODELS").map(PathBuf::from);
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    let folder = given.unwrap_or_else(beside);
    let found = folder.join("INDEX.tsv").is_file();
    if !found {
        println!("SKIPPED: no models at {}", folder.display());
    }
    found.then_some(folder)
}

fn model(name: &str) -> Option<Model> {
    Some(common::read_file(folder()?.join(name)).expect("readable"))
}

fn splines(part: &Part) -> Vec<&NurbsSurface> {
    part.faces.iter().filter_map(spline).collect()
}

fn spline(face: &Face) -> Option<&NurbsSurface> {
    let FaceGeometry::Surface(surface) = &face.geometry else { return None };
    if let Surface::Nurbs(nurbs) = surface.as_ref() { Some(nurbs) } else { None }
}

#[test]
fn every_surface_arrives_or_is_refused_for_a_reason() {
    let Some(folder) = folder() else { return };
    for (name, faces) in FACES {
        let model = common::read_file(folder.join(name)).expect("readable");
        assert_eq!(model.placed_faces(), *faces, "{name}");
        let sound = |part: &Part| part.faces.iter().all(|f| matches!(f.geometry, FaceGeometry::Surface(_)));
        assert!(model.parts.iter().all(sound), "{name}");
        assert!(model.issues.iter().all(|w| !w.is_error()), "{name}: {:?}", model.issues);
    }
    for (name, reason) in REFUSED {
        let error = common::read_file(folder.join(name)).expect_err("nothing in it").to_string();
        assert!(error.contains(reason), "{name}: {error}");
    }
    // No file is forgotten.
    let listed = std::fs::read_to_string(folder.join("INDEX.tsv")).expect("the index is readable");
    let listed = listed.lines().filter(|line| line.starts_with("iv\t") || line.starts_with("x3d\t")).count();
    assert_eq!(listed, FACES.len() + REFUSED.len());
}

#[test]
fn the_binary_teapot_is_the_written_one() {
    let (Some(written), Some(binary)) = (model("iv/sgi_teapot_ascii.iv"), model("iv/sgi_teapot_binary.iv"))
    else {
        return;
    };
    let (a, b) = (splines(&written.parts[0]), splines(&binary.parts[0]));
    assert_eq!((a.len(), b.len()), (32, 32));
    for (a, b) in a.iter().zip(b) {
        assert_eq!((a.degree(), a.counts()), (b.degree(), b.counts()));
        assert_eq!((a.knots_u(), a.knots_v()), (b.knots_u(), b.knots_v()));
        // The text has six digits.
        let far = a.points().iter().zip(b.points()).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
        assert!(far < 1e-6, "{far}");
    }
}

#[test]
fn trims_arrive() {
    let (Some(mentor), Some(hole)) = (model("iv/mentor_08.4.TrimSurf.iv"), model("x3d/HoleCentered.x3dv"))
    else {
        return;
    };
    assert_eq!(mentor.parts[0].faces[0].loops.len(), 2);
    assert_eq!(hole.parts[0].faces[0].loops.len(), 3);
    // The circles, of radius 1 around (0, 0) and (2, 2).
    for boundary in &hole.parts[0].faces[0].loops[1..] {
        let chordal_brep::Loop::Edges { coedges, .. } = boundary else { panic!("a loop of edges") };
        for coedge in coedges {
            let edge = &hole.parts[0].edges[coedge.edge.index()];
            let curve = edge.curve.as_ref().expect("a curve");
            for k in 0..=16 {
                let p = curve.point(edge.range.start + edge.range.length() * f64::from(k) / 16.0).truncate();
                let off = p.length().min((p - 2.0).length());
                assert!((off - 1.0).abs() < 1e-4, "{p}");
            }
        }
    }
}
