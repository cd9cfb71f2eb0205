//! The sentences and codes of issues.

use chordal_brep::{Issue, Millimetres, NodeId, ReadIssue, Severity, Source};
use std::collections::BTreeSet;

fn at(entity: u64, line: u32) -> Source {
    Source { entity, line }
}

#[test]
fn a_sentence_names_the_entity_the_line_and_the_unit() {
    let kind = ReadIssue::UnknownKind { found: "CIRCLE".into(), expected: "a surface" };
    assert_eq!(Issue::error(at(166, 173), kind).to_string(), "#166 (line 173): CIRCLE is not a surface");
    let gap = ReadIssue::GapClosed { gap: Millimetres(5.0) };
    let gap = Issue::warning(at(42, 48), gap);
    assert_eq!(
        gap.to_string(),
        "#42 (line 48): gap of 5 mm between consecutive edges closed with a straight edge"
    );
    assert_eq!((gap.kind.code(), gap.severity), ("gap-closed", Severity::Warning));
}

#[test]
fn an_issue_of_another_entity_keeps_its_code_and_names_that_entity() {
    let kind = ReadIssue::Recursive { keyword: "OFFSET_SURFACE".into(), levels: 32 };
    let issue = Issue::error(at(155, 162), kind);
    let of_face = issue.for_owner(at(182, 189));
    assert_eq!(of_face.source, at(182, 189));
    assert_eq!(of_face.kind.code(), "recursive");
    assert_eq!(
        of_face.to_string(),
        "#182 (line 189): #155 (line 162): OFFSET_SURFACE is recursive or nested more than 32 levels"
    );
    assert_eq!(issue.for_owner(at(155, 162)), issue);
    assert_eq!(issue.about(at(155, 162)), "OFFSET_SURFACE is recursive or nested more than 32 levels");
}

#[test]
fn codes_are_distinct_and_plain() {
    let distinct: BTreeSet<_> = ReadIssue::CODES.iter().collect();
    assert_eq!(distinct.len(), ReadIssue::CODES.len());
    let plain = |code: &str| code.bytes().all(|b| b.is_ascii_lowercase() || b == b'-');
    assert!(ReadIssue::CODES.iter().all(|code| plain(code)));
}

#[test]
fn ids_are_positions() {
    assert_eq!(NodeId::from(7).index(), 7);
}
