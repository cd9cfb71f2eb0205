//! What a document keeps of issues, and what it says about data that make no sense.

use chordal_brep::{Issue, Model, Node, NodeId, Part, PartId, ReadIssue, Severity, Source};
use chordal_document::{DocumentError, from_json, to_json};
use chordal_nurbs::DAffine3;

fn model(issues: Vec<Issue>) -> Model {
    let root = Node {
        name: "root".into(),
        transform: DAffine3::IDENTITY,
        part: Some(PartId(0)),
        children: Vec::new(),
        color: None,
        source: Source::default(),
    };
    Model {
        parts: vec![Part::default()],
        nodes: vec![root],
        roots: vec![NodeId(0)],
        issues,
        ..Model::default()
    }
}

#[test]
fn issues_keep_code_sentence_severity_and_place() {
    let source = Source { entity: 42, line: 48 };
    let written = Issue::error(source, ReadIssue::NoEdges);
    let text = to_json(&model(vec![written.clone()])).expect("a form");
    let read = from_json(text.as_bytes()).expect("readable").issues.remove(0);
    assert_eq!(read.kind.code(), written.kind.code());
    assert_eq!(read.to_string(), written.to_string());
    assert_eq!((read.severity, read.source), (Severity::Error, source));
}

#[test]
fn documents_without_codes_are_read() {
    let text =
        to_json(&model(vec![Issue::warning(Source::default(), ReadIssue::ZeroWeight)])).expect("a form");
    let old = text.replace("\"code\":\"zero-weight\",", "");
    assert_ne!(old, text);
    assert_eq!(from_json(old.as_bytes()).expect("readable").issues[0].kind.code(), "recorded");
}

#[test]
fn trees_that_are_none_are_refused() {
    let text = to_json(&model(Vec::new())).expect("a form");
    let twice = text.replace("\"roots\":[0]", "\"roots\":[0,0]");
    assert_ne!(twice, text);
    assert!(matches!(from_json(twice.as_bytes()), Err(DocumentError::Tree { node: 0, .. })));
}
