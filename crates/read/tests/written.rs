//! Files written by hand in formats other than STEP: each holds what its index says, each broken one ends in
//! a sentence or is saved, and no mutant of them does harm.

mod common;

use chordal_brep::{BodyKind, FaceGeometry, Loop, Model};
use common::{read_bytes, read_file};
use std::path::PathBuf;

/// Folder in the corpus and suffix of its files.
const KINDS: [(&str, &str); 4] = [("brep", "brep"), ("iges", "igs"), ("iv", "iv"), ("x3d", "x3d")];

fn corpus(kind: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../corpus").join(kind)
}

fn table(path: PathBuf) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path).expect("the index is part of the repository");
    text.lines().skip(1).map(|line| line.split('\t').map(str::to_owned).collect()).collect()
}

fn model(kind: &str, suffix: &str, name: &str) -> Model {
    read_file(corpus(kind).join(format!("{name}.{suffix}"))).expect("a corpus file is readable")
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
fn every_file_has_the_faces_of_its_index() {
    let mut wrong = Vec::new();
    for (kind, suffix) in KINDS {
        for row in table(corpus(kind).join("INDEX.tsv")) {
            let model = model(kind, suffix, &row[0]);
            let solids: usize = model
                .placements()
                .iter()
                .map(|p| &model.parts[p.part.index()].bodies)
                .map(|bodies| bodies.iter().filter(|body| body.kind == BodyKind::Solid).count())
                .sum();
            let found = (model.placed_faces().to_string(), solids.to_string());
            let failed = failures(&model);
            let said = !model.issues.is_empty();
            if found != (row[2].clone(), row[3].clone()) || !failed.is_empty() || said {
                let warnings = &model.issues;
                wrong.push(format!("{kind} {}: faces and solids {found:?}; {failed:?} {warnings:?}", row[0]));
            }
            sound(&model);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn broken_files_end_in_a_sentence_or_are_saved() {
    let mut wrong = Vec::new();
    for (kind, suffix) in KINDS {
        for row in table(corpus(kind).join("bad/INDEX.tsv")) {
            let (name, exits, phrase) = (&row[0], &row[2], row[3].to_lowercase());
            let said = match read_file(corpus(kind).join(format!("bad/{name}.{suffix}"))) {
                Err(error) if !exits.contains('2') => format!("NOT SAVED: {error}"),
                Ok(_) if exits == "2" => "READ AS IF NOTHING WERE WRONG".to_owned(),
                Err(error) => error.to_string(),
                Ok(model) => {
                    let warned = model.issues.iter().map(ToString::to_string);
                    let failed = failures(&model).into_iter();
                    warned.chain(failed).collect::<Vec<_>>().join("\n")
                }
            };
            if !said.to_lowercase().contains(&phrase) {
                wrong.push(format!("{kind} {name}: says {said:?}, not {phrase:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What the types promise beyond what they enforce.
fn sound(model: &Model) {
    for part in &model.parts {
        assert!(part.vertices.iter().all(|vertex| vertex.point.is_finite()));
        for edge in &part.edges {
            assert!(edge.range.start < edge.range.end && edge.range.is_finite());
            assert!(edge.curve.is_some() || edge.start == edge.end, "a point with two vertices");
        }
        for boundary in part.faces.iter().flat_map(|face| &face.loops) {
            let Loop::Edges { coedges, .. } = boundary else { continue };
            let ends = |i: usize| {
                let coedge = &coedges[i % coedges.len()];
                let edge = &part.edges[coedge.edge.index()];
                if coedge.forward { (edge.start, edge.end) } else { (edge.end, edge.start) }
            };
            assert!((0..coedges.len()).all(|i| ends(i).1 == ends(i + 1).0), "an open loop");
        }
        let used = part.shells.iter().flat_map(|shell| &shell.faces);
        assert!(used.into_iter().all(|face| face.index() < part.faces.len()));
    }
}

fn survives(bytes: &[u8]) -> bool {
    let result = read_bytes(bytes, "mutant");
    if let Ok(model) = &result {
        sound(model);
    }
    result.is_ok()
}

#[test]
fn truncation_anywhere_is_survived() {
    for (kind, suffix) in KINDS {
        for row in table(corpus(kind).join("INDEX.tsv")) {
            let path = corpus(kind).join(format!("{}.{suffix}", row[0]));
            let bytes = std::fs::read(path).expect("a corpus file");
            for piece in 0..=40 {
                survives(&bytes[..bytes.len() * piece / 40]);
            }
        }
    }
}

#[test]
fn mutants_are_survived() {
    // xorshift with a fixed seed: the same mutants on every run.
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    let times = std::env::var("CHORDAL_MUTANTS").ok().and_then(|n| n.parse::<usize>().ok()).unwrap_or(1);
    let interesting = b"0123456789-+.,;*HED \nSCei";
    for (kind, suffix) in KINDS {
        for row in table(corpus(kind).join("INDEX.tsv")) {
            let path = corpus(kind).join(format!("{}.{suffix}", row[0]));
            let original = std::fs::read(path).expect("a corpus file");
            for _ in 0..150 * times {
                let mut bytes = original.clone();
                for _ in 0..1 + random(8) {
                    let at = random(bytes.len());
                    match random(4) {
                        0 => bytes[at] = interesting[random(interesting.len())],
                        1 => bytes[at] = random(256) as u8,
                        2 => {
                            bytes.remove(at);
                        }
                        _ => bytes.insert(at, interesting[random(interesting.len())]),
                    }
                }
                survives(&bytes);
            }
        }
    }
}

#[test]
fn the_same_shapes_elsewhere_are_the_same_part() {
    let model = model("brep", "brep", "instances");
    assert_eq!((model.parts.len(), model.placements().len()), (1, 3));
    let places: Vec<_> = model.placements().iter().map(|p| p.world.translation.to_array()).collect();
    assert_eq!(places, [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [-4.0, 0.0, 0.0]]);
}
