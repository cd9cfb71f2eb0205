//! The corpus of exchange formats: each file holds what its index says, each broken one ends in a sentence or
//! is saved.

mod common;

use chordal_brep::{BodyKind, FaceGeometry, Model};
use common::{read_bytes, read_file};
use proptest::prelude::*;
use std::path::PathBuf;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../corpus/exchange")
}

/// The rows of the index: file, faces, exit codes and the phrase that must be said.
fn rows() -> Vec<(String, usize, String, String)> {
    let text =
        std::fs::read_to_string(folder().join("INDEX.tsv")).expect("the index is part of the repository");
    let row = |line: &str| {
        let columns: Vec<&str> = line.split('\t').collect();
        (
            columns[0].to_owned(),
            columns[2].parse().expect("a number"),
            columns[4].to_owned(),
            columns[5].to_owned(),
        )
    };
    text.lines().skip(1).map(row).collect()
}

fn said(model: &Model) -> String {
    let faces = model.parts.iter().flat_map(|part| &part.faces);
    let failed = faces.filter_map(|face| match &face.geometry {
        FaceGeometry::Failed(reason) => Some(reason.to_string()),
        FaceGeometry::Surface(_) => None,
    });
    failed.chain(model.issues.iter().map(ToString::to_string)).collect::<Vec<_>>().join("\n")
}

#[test]
fn every_file_is_what_its_index_says() {
    let mut wrong = Vec::new();
    for (name, faces, exits, phrase) in rows() {
        let said = match read_file(folder().join(&name)) {
            Ok(model) => {
                if model.placed_faces() != faces {
                    wrong.push(format!("{name}: {} faces, expected {faces}", model.placed_faces()));
                }
                let said = said(&model);
                if exits == "0" && phrase.is_empty() && !said.is_empty() {
                    wrong.push(format!("{name}: {said}"));
                }
                said
            }
            Err(error) if exits.contains('2') => error.to_string(),
            Err(error) => {
                wrong.push(format!("{name}: {error}"));
                continue;
            }
        };
        if !said.contains(&phrase) {
            wrong.push(format!("{name}: says {said:?}, not {phrase:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn light_extrusions_are_solids() {
    for name in ["rhino_extrusions.3dm", "rhino_solids_2.3dm", "rhino_solids_8.3dm"] {
        let model = read_file(folder().join(name)).expect("readable");
        let part = &model.parts[0];
        assert_eq!(part.bodies.len(), 3, "{name}");
        assert!(part.bodies.iter().all(|body| body.kind == BodyKind::Solid), "{name}: {:?}", part.bodies);
        assert!(
            (model.placements()[0].world.matrix3.determinant() - 1000.0).abs() < 1e-9,
            "{name}: centimetres"
        );
    }
}

/// Archives cut anywhere end in a model or a sentence; the small one at every byte.
#[test]
fn archives_cut_anywhere_end() {
    for (name, step) in [("rhino_mesh_5.3dm", 1), ("rhino_solids_2.3dm", 7), ("rhino_solids_8.3dm", 7)] {
        let whole = std::fs::read(folder().join(name)).expect("a corpus file");
        for end in (0..whole.len()).step_by(step) {
            if let Err(error) = read_bytes(&whole[..end], "cut") {
                assert!(!error.to_string().contains('\n'), "{name} cut at {end}: {error}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]
    #[test]
    fn mutated_archives_end(
        which in 0..5usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..20),
    ) {
        const FILES: [&str; 5] = [
            "rhino_solids_2.3dm", "rhino_solids_8.3dm", "rhino_extrusions.3dm", "rhino_mesh_5.3dm",
            "rhino_revolutions.3dm",
        ];
        let mut bytes = std::fs::read(folder().join(FILES[which])).expect("a corpus file");
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        // Anything but a panic.
        let _ = read_bytes(&bytes, "mutant");
    }
}
