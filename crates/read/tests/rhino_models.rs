//! Real 3DM archives, versions 1 to 7: every face arrives.

mod common;

use chordal_brep::{BodyKind, FaceGeometry, Loop};
use std::path::PathBuf;

#[test]
fn every_face_of_real_archives_arrives() {
    let given = std::env::var_os("CHORDAL_MODELS").map(PathBuf::from);
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    let folder = given.unwrap_or_else(beside);
    let Ok(index) = std::fs::read_to_string(folder.join("INDEX.tsv")) else {
        println!("SKIPPED: no models at {}", folder.display());
        return;
    };
    let rows = index.lines().map(|line| line.split('\t').collect::<Vec<_>>()).filter(|row| row[0] == "3dm");
    let mut wrong = Vec::new();
    for row in rows {
        let (name, faces, solids): (_, usize, usize) =
            (row[1], row[6].parse().expect("faces"), row[8].parse().expect("solids"));
        let model = common::read_file(folder.join("3dm").join(name)).expect("readable");
        let part = &model.parts[0];
        let failed = part.faces.iter().filter(|f| matches!(f.geometry, FaceGeometry::Failed(_))).count();
        if part.faces.len() != faces || failed > 0 {
            wrong.push(format!("{name}: {} faces, {failed} failed, expected {faces}", part.faces.len()));
        }
        // Version 1 says nothing of solids: every face is an island there.
        let found = part.bodies.iter().filter(|body| body.kind == BodyKind::Solid).count();
        if found < solids {
            wrong.push(format!("{name}: {found} solids, expected {solids}"));
        }
        let lost: Vec<_> = model.issues.iter().filter(|issue| issue.is_error()).collect();
        if !lost.is_empty() {
            wrong.push(format!("{name}: {lost:?}"));
        }
        for coedges in part.faces.iter().flat_map(|face| &face.loops).filter_map(|l| match l {
            Loop::Edges { coedges, .. } => Some(coedges),
            _ => None,
        }) {
            let ends = |i: usize| {
                let coedge = &coedges[i % coedges.len()];
                let edge = &part.edges[coedge.edge.index()];
                if coedge.forward { (edge.start, edge.end) } else { (edge.end, edge.start) }
            };
            if (0..coedges.len()).any(|i| ends(i).1 != ends(i + 1).0) {
                wrong.push(format!("{name}: a loop is broken"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
