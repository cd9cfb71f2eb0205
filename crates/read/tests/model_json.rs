//! Chordal's own JSON: what is written is what comes back, and broken documents end in a sentence or are
//! saved.

mod common;

use chordal_brep::{FaceGeometry, Loop, Model, ReadIssue};
use chordal_document::{SCHEMA, from_json, to_json};
use common::{read_bytes, read_file};
use proptest::prelude::*;
use std::path::{Path, PathBuf};

fn corpus() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../corpus")
}

fn models() -> Option<PathBuf> {
    let given = std::env::var_os("CHORDAL_MODELS").map(PathBuf::from);
    let beside = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/models");
    let folder = given.unwrap_or_else(beside).join("step");
    let found = folder.is_dir();
    if !found {
        println!("SKIPPED: no models at {}", folder.display());
    }
    found.then_some(folder)
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let mut files: Vec<_> = entries.filter(|path| path.is_file()).collect();
    files.sort();
    files
}

/// Everything that the file holds, with the signs of zeros, as text: `==` takes -0 for 0.
fn all_of(model: &Model) -> String {
    format!("{model:?}")
}

/// The model with its issues as a document keeps them: by code and sentence.
fn recorded(mut model: Model) -> Model {
    let faces = model.parts.iter_mut().flat_map(|part| &mut part.faces);
    let failures = faces.filter_map(|face| match &mut face.geometry {
        FaceGeometry::Failed(issue) => Some(issue),
        FaceGeometry::Surface(_) => None,
    });
    for issue in failures.chain(&mut model.issues) {
        issue.kind = ReadIssue::Recorded { code: issue.kind.code(), sentence: issue.kind.to_string() }.into();
    }
    model
}

fn comes_back(path: &Path) -> bool {
    let Ok(model) = read_file(path) else { return false };
    let text = to_json(&model).expect("every kind has a form");
    let back = read_bytes(text.as_bytes(), "another name").expect("what was written can be read");
    assert!(back == recorded(model), "{} comes back changed", path.display());
    assert_eq!(to_json(&back).expect("as before"), text, "{}", path.display());
    true
}

#[test]
fn the_corpus_comes_back_exactly() {
    let good = files(&corpus());
    let bad = files(&corpus().join("bad"));
    let back = good.iter().chain(&bad).filter(|path| comes_back(path)).count();
    assert!(back > 100, "{back} files only");
}

#[test]
fn real_files_come_back_exactly() {
    let Some(folder) = models() else { return };
    let all = files(&folder);
    let back = all.iter().filter(|path| comes_back(path)).count();
    assert!(back + 1 >= all.len(), "{back} of {}", all.len());
}

/// A shape of two faces, small enough to be cut at every byte.
fn small() -> (Model, String) {
    let model = read_file(corpus().join("cone_apex.step")).expect("a corpus file is readable");
    let text = to_json(&model).expect("every kind has a form");
    (model, text)
}

#[test]
fn signs_of_zero_come_back() {
    let (model, text) = small();
    let back = read_bytes(text.as_bytes(), "").expect("readable");
    assert_eq!(all_of(&back), all_of(&model));
}

#[test]
fn a_file_cut_anywhere_is_refused() {
    let (_, text) = small();
    for end in 0..text.trim_end().len() {
        let said = read_bytes(&text.as_bytes()[..end], "part").expect_err("half a file").to_string();
        assert!(!said.is_empty() && !said.contains('\n'), "cut at {end}: {said}");
    }
}

#[test]
fn islands_share_nothing_and_keep_their_shape() {
    for path in files(&corpus()).iter().filter(|path| path.extension().is_some_and(|e| e == "step")) {
        let model = read_file(path).expect("a corpus file is readable");
        let apart = model.unsewn();
        let back = read_bytes(to_json(&apart).expect("a form").as_bytes(), "").expect("readable");
        assert!(back == recorded(apart.clone()), "{}", path.display());
        for (whole, apart) in model.parts.iter().zip(&apart.parts) {
            let mut user = vec![None; apart.edges.len()];
            let mut corner_of = vec![None; apart.vertices.len()];
            assert_eq!(whole.faces.len(), apart.faces.len());
            for (f, (a, b)) in whole.faces.iter().zip(&apart.faces).enumerate() {
                assert_eq!(a.geometry, b.geometry);
                let old = a.loops.iter().flat_map(edges_of);
                let new = b.loops.iter().flat_map(edges_of);
                for (e, n) in old.zip(new) {
                    assert_eq!(*user[n].get_or_insert(f), f, "{}: edge of two faces", path.display());
                    let (old, new) = (&whole.edges[e], &apart.edges[n]);
                    assert_eq!((&old.curve, old.range), (&new.curve, new.range));
                    for (old, new) in [(old.start, new.start), (old.end, new.end)] {
                        assert_eq!(*corner_of[new.index()].get_or_insert(f), f, "vertex of two faces");
                        assert_eq!(whole.vertices[old.index()].point, apart.vertices[new.index()].point);
                    }
                }
            }
            assert!(user.iter().all(Option::is_some), "{}: an edge of no face", path.display());
        }
    }
}

fn edges_of(boundary: &Loop) -> Vec<usize> {
    match boundary {
        Loop::Edges { coedges, .. } => coedges.iter().map(|c| c.edge.index()).collect(),
        _ => Vec::new(),
    }
}

#[test]
fn numbers_that_json_lacks_are_refused_face_by_face() {
    let (_, text) = small();
    let broken = text.replacen("\"radius\":", "\"radius\":\"inf\",\"was\":", 1);
    let model = read_bytes(broken.as_bytes(), "").expect("the other faces are fine");
    let failed = model.parts[0].faces.iter().filter_map(|face| match &face.geometry {
        FaceGeometry::Failed(why) => Some(why.to_string()),
        FaceGeometry::Surface(_) => None,
    });
    assert!(failed.into_iter().any(|why| why.contains("the radius is not finite")));
}

/// A document with one sentence of it replaced, and what must be said.
#[test]
fn what_is_wrong_is_said() {
    let (_, text) = small();
    let cases: [(&str, &str, &str); 7] = [
        (SCHEMA, "chordal-model/99", "chordal-model/99"),
        ("\"roots\":[0]", "\"roots\":[7]", "node 7 of the tree is not there"),
        ("\"roots\":[0]", "\"roots\":[0,0]", "node 0 of the tree is used twice"),
        ("\"roots\":[0]", "\"roots\":\"0\"", "line"),
        ("\"surface\":0", "\"surface\":99", "NotFound { what: \"surface\", number: 99 }"),
        ("\"edge\":0", "\"edge\":99", "NotFound { what: \"edge\", number: 99 }"),
        ("\"faces\":[0", "\"faces\":[99,0", "NotFound { what: \"face\", number: 99 }"),
    ];
    for (from, to, phrase) in cases {
        let broken = text.replacen(from, to, 1);
        assert_ne!(broken, text, "{from} is not in the file");
        let said = match read_bytes(broken.as_bytes(), "part") {
            Err(error) => error.to_string(),
            Ok(model) => all_of(&model),
        };
        assert!(said.contains(phrase), "{from} → {to}: {said}");
    }
}

#[test]
fn other_json_is_told_apart() {
    for text in ["{}", "{\"asset\": {\"version\": \"2.0\"}}"] {
        let said = read_bytes(text.as_bytes(), "part").expect_err("no model").to_string();
        assert!(said.contains("neither the \"schema\""), "{said}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]
    /// Bytes changed at random: a model or a sentence, never a panic, and what was read can be written.
    #[test]
    fn mutants_end(changes in prop::collection::vec((any::<prop::sample::Index>(), 32u8..127), 1..6)) {
        let mut bytes = small().1.into_bytes();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if let Ok(model) = read_bytes(&bytes, "part") {
            prop_assert!(from_json(to_json(&model).expect("a form").as_bytes()).is_ok());
        }
    }
}

#[test]
fn the_example_of_the_documentation_is_a_disc() {
    let text = include_str!("../../../docs/model-json.md");
    let (_, rest) = text.split_once("```json\n").expect("an example");
    let (example, _) = rest.split_once("```").expect("it ends");
    let model = read_bytes(example.as_bytes(), "").expect("readable");
    assert!(matches!(model.parts[0].faces[0].geometry, FaceGeometry::Surface(_)), "{model:?}");
}
