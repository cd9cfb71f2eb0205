//! One problem of a report: an issue of any stage as data.

use super::entity_name;
use chordal_brep::{Issue, IssueKind, Severity, Source};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Something that was repaired, ignored, dropped or not achieved.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Problem {
    /// A stable name for programs to match, such as `unproven-face`.
    pub code: String,
    /// `note`, `warning` or `error`; a report with an error is not clean.
    pub severity: Severity,
    /// The stage that found it: `read`, `mesh`, `audit` or `result`.
    pub stage: String,
    /// The entity in the file, `#123`.
    pub entity: Option<String>,
    /// The line in the file, from 1.
    pub line: Option<u32>,
    /// The name of the part.
    pub part: Option<String>,
    /// Index into `faces_detail`.
    pub face: Option<usize>,
    /// The figures of the message, by name; lengths are millimetres.
    pub values: Map<String, Value>,
    /// One sentence, without the entity and the line.
    pub message: String,
}

impl Problem {
    /// An issue as data.
    pub(crate) fn new(issue: &Issue) -> Self {
        Self {
            code: issue.kind.code().into(),
            severity: issue.severity,
            stage: issue.kind.stage().into(),
            entity: entity_name(issue.source),
            line: (issue.source.line > 0).then_some(issue.source.line),
            part: None,
            face: None,
            values: values(&issue.kind),
            message: issue.kind.to_string(),
        }
    }

    /// In the part of this name.
    pub(crate) fn in_part(mut self, name: &str) -> Self {
        self.part = (!name.is_empty()).then(|| name.to_owned());
        self
    }

    /// About the face at this index of `faces_detail`.
    pub(crate) fn of_face(mut self, index: usize) -> Self {
        self.face = Some(index);
        self
    }

    /// The message behind its entity and line: `#42 (line 48): …`.
    pub fn sentence(&self) -> String {
        match self.place() {
            Some(place) => format!("{place}: {}", self.message),
            None => self.message.clone(),
        }
    }

    /// The entity and line as numbers; 0 where the format has none.
    pub fn source(&self) -> Source {
        let number = |entity: &String| entity.trim_start_matches('#').parse().ok();
        Source { entity: self.entity.as_ref().and_then(number).unwrap_or(0), line: self.line.unwrap_or(0) }
    }

    /// `#42 (line 48)`.
    pub(crate) fn place(&self) -> Option<String> {
        match (&self.entity, self.line) {
            (Some(entity), Some(line)) => Some(format!("{entity} (line {line})")),
            (Some(entity), None) => Some(entity.clone()),
            (None, Some(line)) => Some(format!("line {line}")),
            (None, None) => None,
        }
    }
}

/// The fields of the variant. A variant without fields has none; a variant with one unnamed field calls it
/// `value`.
fn values(kind: &IssueKind) -> Map<String, Value> {
    let variant = match kind {
        IssueKind::Read(kind) => serde_json::to_value(kind),
        IssueKind::Mesh(kind) => serde_json::to_value(kind),
        IssueKind::Audit(kind) => serde_json::to_value(kind),
        IssueKind::Result(kind) => serde_json::to_value(kind),
        _ => Ok(Value::Null),
    };
    match variant {
        Ok(Value::Object(named)) => match named.into_iter().next() {
            Some((_, Value::Object(fields))) => fields,
            Some((_, value)) => Map::from_iter([("value".to_owned(), value)]),
            None => Map::new(),
        },
        // A number that JSON cannot hold, or a variant without fields.
        _ => Map::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_brep::ResultIssue;

    #[test]
    fn an_issue_keeps_its_code_place_and_values() {
        let kind = ResultIssue::OverTolerance { error: 0.5, tolerance: 0.25 };
        let problem =
            Problem::new(&Issue::new(Severity::Error, Source { entity: 42, line: 48 }, kind)).in_part("lid");
        assert_eq!((problem.code.as_str(), problem.stage.as_str()), ("over-tolerance", "result"));
        assert_eq!(
            (problem.values["error"].as_f64(), problem.values["tolerance"].as_f64()),
            (Some(0.5), Some(0.25))
        );
        assert_eq!(
            problem.sentence(),
            "#42 (line 48): the proven error 0.5 mm exceeds the tolerance 0.25 mm"
        );
        let text = serde_json::to_value(&problem).expect("JSON");
        assert_eq!(
            (&text["severity"], &text["entity"], &text["line"]),
            (&"error".into(), &"#42".into(), &48.into())
        );
        assert_eq!(text["face"], Value::Null);
    }

    #[test]
    fn a_variant_without_fields_has_no_values() {
        let problem = Problem::new(&Issue::new(Severity::Error, Source::default(), ResultIssue::Unproven));
        assert_eq!((problem.values.len(), problem.entity.as_ref(), problem.line), (0, None, None));
        assert_eq!(problem.sentence(), problem.message);
    }
}
